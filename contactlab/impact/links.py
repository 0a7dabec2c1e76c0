"""How the contacts of a gathering move one another (theory §18)."""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias

import attrs
import numpy as np

from contactlab.numeric.types import Array


class SparseMatrix(Protocol):
    """A sparse matrix of SciPy."""

    def __matmul__(self, vector: Array) -> Array: ...
    def __abs__(self) -> SparseMatrix: ...
    def diagonal(self) -> Array:
        """Return the entries on the diagonal."""


Inverse: TypeAlias = Array | SparseMatrix

#: Eigenvalues of W over the largest that are zero: W of a box on four corners has six of twelve.
RANK = 1e-12
#: Relative error of the energy of contacts where W is sparse.
TOLERANCE = 1e-10


@attrs.frozen(eq=False)
class Links:
    """The contacts of gatherings as one system; contacts are the last axis of the batch.

    Attributes
    ----------
    inverse_mass : array, shape (..., 3 C, 3 C), or a sparse matrix
        W = J M⁻¹ Jᵀ in 1/kg, symmetric and positive semidefinite; along n, t1, t2 of each contact.
    velocity : array, shape (..., C, 3)
        Approach and slip at the start, in m/s.
    gap : array, shape (..., C)
        Distance of the surfaces at the start, in m.
    pull : array, shape (..., C, 3)
        Acceleration of approach and slip by constant forces, in m/s².
    loaded : array of bool, shape (..., C)
        True of contacts that carry the constant forces at the start.
    energy : array, shape (..., 1)
        Energy of the relative motion that contacts can take, in J: ½ qᵀ W⁺ q.
    """

    inverse_mass: Any
    velocity: Array
    gap: Array
    pull: Array
    loaded: Any
    energy: Array

    def kick(self, force: Array) -> Array:
        """Return accelerations W f less those of constant forces, by forces of shape (..., C, 3).

        Parameters
        ----------
        force : array, shape (..., C, 3)
            In N, on the second body of each contact.
        """
        return times(self.inverse_mass, force) - self.pull

    def fastest(self, stiffness: Array) -> Array:
        """Return a bound of omega² in 1/s² of contacts of a stiffness (..., C, 3), shape (..., 1).

        The largest eigenvalue of W k is at most its largest row sum, and at most its trace.

        Parameters
        ----------
        stiffness : array, shape (..., C, 3)
            In N/m.
        """
        rows = times(abs(self.inverse_mass), stiffness).max(axis=(-1, -2))
        if isinstance(self.inverse_mass, np.ndarray):
            diagonal = self.inverse_mass.diagonal(axis1=-2, axis2=-1)
        else:
            diagonal = self.inverse_mass.diagonal()
        trace = (diagonal * stiffness.reshape(*stiffness.shape[:-2], -1)).sum(axis=-1)
        return np.asarray(np.minimum(rows, trace)[..., None])


def times(inverse_mass: Inverse, vectors: Array) -> Array:
    """Return W times vectors, both of shape (..., C, 3)."""
    flat = vectors.reshape(*vectors.shape[:-2], -1)
    if isinstance(inverse_mass, np.ndarray):
        product = (inverse_mass @ flat[..., None])[..., 0]
    else:  # one gathering of many contacts
        product = (inverse_mass @ flat.reshape(-1)).reshape(flat.shape)
    return np.asarray(product.reshape(vectors.shape))


def energy_of(inverse_mass: Inverse, velocity: Array) -> Array:
    """Return ½ qᵀ W⁺ q in J, shape (..., 1), of velocities q of shape (..., C, 3)."""
    flat = velocity.reshape(*velocity.shape[:-2], -1)
    if isinstance(inverse_mass, np.ndarray):
        size, along = np.linalg.eigh(inverse_mass)
        parts = np.square((flat[..., None, :] @ along)[..., 0, :])
        moves = size > RANK * size[..., -1:]
        energies = parts / np.where(moves, size, np.inf)
        return np.asarray(0.5 * energies.sum(axis=-1, keepdims=True))
    from scipy.sparse.linalg import lsqr  # only where W is sparse

    sparse: Any = inverse_mass
    found = lsqr(sparse, flat.reshape(-1), atol=TOLERANCE, btol=TOLERANCE)
    held = found[0].reshape(flat.shape)
    return np.asarray(0.5 * (flat * held).sum(axis=-1)[..., None])
