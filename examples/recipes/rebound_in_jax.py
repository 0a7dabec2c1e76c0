"""contactlab.rebound as a function of JAX: jit, vmap, grad and jvp.

Run with ``pip install contactlab[recipes]``: ``python rebound_in_jax.py``.
"""

import jax
import jax.numpy as jnp
import numpy as np

import contactlab

jax.config.update("jax_enable_x64", True)  # psi2 is tabulated to 1e-9; float32 keeps 1e-7


@jax.custom_jvp
def rebound(psi1, chi):
    """Return psi2; psi1 and chi broadcast, chi from 0 to 2.5."""
    return _host(psi1, chi)[0]


@rebound.defjvp
def _rebound_jvp(primals, tangents):
    psi2, by_psi1, by_chi = _host(*primals)
    return psi2, by_psi1 * tangents[0] + by_chi * tangents[1]


def _host(psi1, chi):
    psi1, chi = jnp.broadcast_arrays(psi1, chi)
    three = (jax.ShapeDtypeStruct(psi1.shape, jnp.float64),) * 3
    call = lambda *both: tuple(  # noqa: E731
        np.asarray(each) for each in contactlab.rebound(*map(np.asarray, both), derivatives=True)
    )
    return jax.pure_callback(call, three, psi1, chi, vmap_method="expand_dims")


if __name__ == "__main__":
    slope = jax.jit(jax.vmap(jax.grad(rebound), in_axes=(0, None)))
    print(rebound(1.2, 49 / 34), slope(jnp.array([0.5, 1.2, 7.0]), 49 / 34))
