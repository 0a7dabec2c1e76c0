"""contactlab.rebound in JAX: it takes arrays of JAX, under jit, vmap, grad and hessian.

Run with ``pip install ".[recipes]"`` in the clone: ``python rebound_in_jax.py``.
"""

import jax

from contactlab import rebound

jax.config.update("jax_enable_x64", True)  # psi2 is tabulated to 1e-9; float32 keeps 2e-6

if __name__ == "__main__":
    slope = jax.jit(jax.vmap(jax.grad(rebound), in_axes=(0, None)))
    psi1 = jax.numpy.array([0.5, 1.2, 7.0])
    print(rebound(psi1, 49 / 34), slope(psi1, 49 / 34))
