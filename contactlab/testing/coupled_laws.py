"""Stepped laws with marks, and laws that change the normal motion, on which integrators are run."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    SampledMotion,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab.testing.laws import Yield, Yielding

#: Phases at which steps of ``Marked`` end, and the change from one impact to the next.
MARKS, SPREAD = (0.41, 1.27, 1.30, 2.6), 0.11


@attrs.frozen(kw_only=True)
class Marked(Yielding):
    """``Yielding`` with marks that differ from impact to impact; it keeps what its steps get."""

    seen: list[tuple[Increment, NormalContact]] = attrs.field(factory=list, eq=False, repr=False)

    def marks(self, scene: Scene, normal: NormalMotion) -> NDArray[np.float64]:
        """Return the phases ``MARKS``, shifted by the index of each impact."""
        phases = np.reshape(MARKS, (-1, *(1,) * len(scene.shape)))
        return np.asarray(phases + SPREAD * np.asarray(scene.index))

    def advance(
        self, state: Yield, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Yield]:
        """Return the force of the spring, and keep the step."""
        self.seen.append((increment, after))
        return super().advance(state, increment, before, after)


class Coupled(NamedTuple):
    """Laws and samples of ``Exchanging``: its present displacement, time, approach and rate."""

    normal: NormalMotion
    displacement: Real
    time: Real
    approach: Real
    rate: Real
    samples: tuple[tuple[Any, ...], ...]


@attrs.frozen(kw_only=True)
class Exchanging(SteppedTangentialLaw):
    """A conservative coupling of the normal and the tangential motion.

    The energy is that of Hertz's law and ½ c z² D², z the approach and D the displacement. So
    F = c z² D, and the normal force is c z D² above Hertz's. There is no friction work.
    """

    api_version: ClassVar[int] = 2
    #: c times the square of the largest approach and of the unit of time, over M_t.
    strength: ClassVar[float] = 1.0

    def _constant(self, normal: NormalMotion) -> Real:
        """Return c, in N/m³."""
        unit = normal.maximum_approach / normal.scene.normal_speed
        scale = unit * unit * normal.maximum_approach * normal.maximum_approach
        return self.strength * normal.scene.pair.tangential_mass / scale

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return c times the square of the largest approach, in N/m."""
        return self._constant(normal) * normal.maximum_approach * normal.maximum_approach

    def start(self, scene: Scene, normal: NormalMotion) -> Coupled:
        """Return both motions at first touch."""
        zero: Real = np.zeros(scene.shape) if scene.shape else 0.0
        return Coupled(normal, zero, zero, zero, zero + scene.normal_speed, ())

    def advance(
        self, state: Coupled, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Coupled]:
        """Return the force, and both motions after the step."""
        normal, scene = state.normal, state.normal.scene
        displacement: Any = state.displacement + increment.displacement
        approach: Any = state.approach + state.rate * increment.drift
        inside: Any = approach * (approach > 0.0)
        pair, constant = scene.pair, self._constant(normal)
        hertz = (4.0 / 3.0) * pair.effective_modulus * (pair.radius * inside) ** 0.5 * inside
        pressure = hertz + constant * inside * displacement**2
        slowed = pressure * increment.duration / pair.normal_mass
        contact = NormalContact(pressure, (pair.radius * inside) ** 0.5, approach, pressure)
        time = state.time + increment.drift
        sample = (time, approach, state.rate - 0.5 * slowed, contact)
        new = Coupled(
            normal, displacement, time, approach, state.rate - slowed, (*state.samples, sample)
        )
        force = constant * inside**2 * displacement
        return TangentialResponse(force, 0.0 * force), new

    def normal_motion(self, state: Coupled) -> SampledMotion:
        """Return the motion through the samples, and the rate after the last kick."""
        scene = state.normal.scene
        shape = scene.shape
        times, depths, rates, contacts = zip(*state.samples, strict=True)

        def column(entries: Any) -> NDArray[np.float64]:
            return np.stack([np.broadcast_to(entry, shape) for entry in entries])

        rate = column(rates)
        rate[-1] = state.rate
        columns = [column(entries) for entries in zip(*contacts, strict=True)]
        return SampledMotion(
            state.normal.law,
            scene,
            time=column(times),
            approach=column(depths),
            rate=rate,
            contact=NormalContact(*columns),
        )
