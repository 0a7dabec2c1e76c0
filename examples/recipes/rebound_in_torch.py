"""contactlab.rebound as a function of PyTorch that gradients pass through.

Run with ``pip install contactlab[recipes]``: ``python rebound_in_torch.py``.
"""

import torch

import contactlab


class Rebound(torch.autograd.Function):
    """psi2 of psi1 and chi, tensors of one shape on the CPU; chi from 0 to 2.5."""

    @staticmethod
    def forward(ctx, psi1, chi):
        """Return psi2, and keep both derivatives."""
        values = contactlab.rebound(psi1.detach().numpy(), chi.detach().numpy(), derivatives=True)
        psi2, *slopes = (torch.as_tensor(value, dtype=psi1.dtype) for value in values)
        ctx.save_for_backward(*slopes)
        return psi2

    @staticmethod
    def backward(ctx, gradient):
        """Return the gradients by psi1 and by chi."""
        by_psi1, by_chi = ctx.saved_tensors
        return gradient * by_psi1, gradient * by_chi


def rebound(psi1, chi):
    """Return psi2; psi1 and chi broadcast."""
    return Rebound.apply(*torch.broadcast_tensors(psi1, chi))


if __name__ == "__main__":
    psi1 = torch.tensor([0.5, 1.2, 7.0], dtype=torch.float64, requires_grad=True)
    psi2 = rebound(psi1, torch.tensor(49 / 34, dtype=torch.float64))
    psi2.sum().backward()
    print(psi2.detach().numpy(), psi1.grad.numpy())
