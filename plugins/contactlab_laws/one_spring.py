"""What laws of one spring with a cap share: a dashpot beside it, and motion in the plane."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    CausalTangentialLaw,
    Increment,
    NormalContact,
    NormalMotion,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import shape_as
from contactlab.numeric.types import Array, Real

#: Further checks that a law with a dashpot fails.
DAMPED = {
    "turning_points": "the force of a dashpot depends on the velocity, not on the path alone",
    "stiffness": "the force of a dashpot does not depend on the displacement",
}
PARTIAL_SLIP = (
    "model: one spring, so the whole contact slips at once. psi2 of solid spheres is off by up to "
    "0.7."
)


def critical_share(share: float, stiffness: Real, mass: Real) -> Real:
    """Return 2 share sqrt(stiffness mass), the constant of a dashpot in N s/m."""
    return 2.0 * share * np.sqrt(stiffness * mass)


def with_dashpot(
    spring: Real, constant: Real, increment: Increment, tangential_mass: Real, limit: Real
) -> Real:
    """Return the force of a spring and a dashpot in N, cut off at the limit mu L."""
    # The dashpot acts on the velocity in the middle of the time in which the force acts. The force
    # itself changes that velocity: solving for it keeps the march of second order.
    slowing = 0.5 * increment.duration / tangential_mass
    force = (spring + constant * increment.velocity) / (1.0 + constant * slowing)
    return cut(force, limit)


#: Displacements, velocities or forces: numbers along a line, or complex ones of a plane.
Along: TypeAlias = Real | NDArray[np.complex128]


class InPlane(NamedTuple):
    """A law's state whose displacements and forces are vectors, held as complex numbers."""

    own: object
    shape: tuple[int, ...]


def move_in_plane(
    law: SteppedTangentialLaw,
    state: InPlane,
    increment: Increment,
    before: NormalContact,
    after: NormalContact,
) -> tuple[TangentialResponse, InPlane]:
    """Return the answer to a step whose displacement and velocity have the shape (..., 2)."""
    shape = state.shape
    numbers = (np.asarray(each) for each in (increment.displacement, increment.velocity))
    moved, velocity = ((each[..., 0] + 1j * each[..., 1]).reshape(shape or 1) for each in numbers)
    step = increment._replace(displacement=moved, velocity=velocity)  # type: ignore[arg-type]
    response, own = law.advance(state.own, step, before, after)
    force = np.stack((response.force.real, response.force.imag), axis=-1).reshape(*shape, 2)
    work = np.asarray(response.friction_work)
    return TangentialResponse(force, shape_as(work, shape)), InPlane(own, shape)


@overload
def along(force: Real, slip: Real) -> Real: ...
@overload
def along(force: NDArray[np.complex128], slip: NDArray[np.complex128]) -> Array: ...
def along(force: Along, slip: Along) -> object:
    """Return force times slip: the product, or the scalar product of complex numbers."""
    if isinstance(slip, np.ndarray) and slip.dtype.kind == "c":
        return (np.conj(force) * slip).real
    return force * slip


@overload
def cut(value: Real, limit: Real) -> Real: ...
@overload
def cut(value: NDArray[np.complex128], limit: Real) -> NDArray[np.complex128]: ...
def cut(value: Along, limit: Real) -> object:
    """Return ``value`` within plus and minus ``limit``; of a complex number the length."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "c":
        size = np.abs(value)
        return value * (np.minimum(size, limit) / (size + (size == 0.0)))
    return np.minimum(np.maximum(value, -limit), limit)


class OneSpring(CausalTangentialLaw):
    """Base of laws of one spring, with a dashpot of share ``damping`` of the critical one."""

    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})

    damping: float

    def _list_failures(self) -> Mapping[str, str]:
        """Return the checks that a dashpot fails, if there is one."""
        return DAMPED if self.damping else {}

    expected_failures: ClassVar[Any] = property(lambda self: self._list_failures())

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, and one on partial slip."""
        return (*super().cautions(scene, normal), PARTIAL_SLIP)

    def begin(self, scene: Scene, normal: NormalMotion, *, vectors: bool = False) -> object:
        """Return a spring at rest, whose displacement is a vector if ``vectors``."""
        own = self.start(scene, normal)
        if not vectors:
            return own
        names = {"held", "spring", "force"} & set(own._fields)
        zero = np.zeros(scene.shape or (1,), dtype=complex)
        return InPlane(own._replace(**dict.fromkeys(names, zero)), scene.shape)
