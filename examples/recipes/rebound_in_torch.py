"""contactlab.rebound in PyTorch: it takes tensors, and gradients pass through it.

Run with ``pip install ".[recipes]"`` in the clone: ``python rebound_in_torch.py``.
"""

import torch

from contactlab import rebound

if __name__ == "__main__":
    psi1 = torch.tensor([0.5, 1.2, 7.0], dtype=torch.float64, requires_grad=True)
    psi2 = rebound(psi1, 49 / 34)
    psi2.sum().backward()
    print(psi2.detach().numpy(), psi1.grad.numpy())
