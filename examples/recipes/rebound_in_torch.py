"""contactlab.rebound as a function of PyTorch that gradients pass through.

Run with ``pip install ".[recipes]"`` in the clone: ``python rebound_in_torch.py``.
"""

import torch

import contactlab


class Rebound(torch.autograd.Function):
    """psi2 of psi1 and chi, tensors of one shape on the CPU; chi from 0 to 2.5."""

    @staticmethod
    def forward(ctx, psi1, chi):
        """Return psi2 and its derivatives by psi1 and by chi."""
        values = contactlab.rebound(psi1.detach().numpy(), chi.detach().numpy(), derivatives=True)
        psi2, *slopes = (torch.as_tensor(value, dtype=psi1.dtype) for value in values)
        ctx.save_for_backward(*slopes)
        ctx.set_materialize_grads(False)
        return psi2, *slopes

    @staticmethod
    def backward(ctx, gradient, *second):
        """Return the gradients by psi1 and by chi."""
        if any(each is not None for each in second):
            raise NotImplementedError("psi2 has first derivatives only: its table holds no others")
        by_psi1, by_chi = ctx.saved_tensors
        return (None, None) if gradient is None else (gradient * by_psi1, gradient * by_chi)


def rebound(psi1, chi):
    """Return psi2; psi1 and chi broadcast."""
    return Rebound.apply(*torch.broadcast_tensors(psi1, chi))[0]


if __name__ == "__main__":
    psi1 = torch.tensor([0.5, 1.2, 7.0], dtype=torch.float64, requires_grad=True)
    psi2 = rebound(psi1, torch.tensor(49 / 34, dtype=torch.float64))
    psi2.sum().backward()
    print(psi2.detach().numpy(), psi1.grad.numpy())
