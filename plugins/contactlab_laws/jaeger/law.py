"""The law of springs that span the largest contact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    Increment,
    NormalContact,
    NormalMotion,
    Steps,
    TangentialResponse,
    resolution_of,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat
from contactlab.numeric.types import Array, Real
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger import all_steps, step
from contactlab_laws.jaeger.bundle import bundle, spring_fields
from contactlab_laws.jaeger.partial_slip import PartialSlip, Scales, hemisphere

#: Most numbers in a table of a whole run (16 MB); longer runs go step by step.
LARGEST_RUN = 2_000_000


class State(NamedTuple):
    """Shape of a batch of contacts, their scales and their springs; never changed once made."""

    shape: tuple[int, ...]
    scales: Scales
    memory: step.SpringState


class ProfileLaw(PartialSlip, AllStepsTangentialLaw):
    """A law of independent springs; ``resolution`` is their number."""

    expected_failures: ClassVar[Mapping[str, str]] = {
        "coulomb_at_a_point_damped": "each spring is limited separately: that is Coulomb's law "
        "at a point only while the stuck part is a disc, as in elastic Hertz impacts",
    }

    @property
    def number(self) -> int:
        """The number of springs."""
        return int(resolution_of(self))

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, of separately limited springs, and of the pressure."""
        own = (
            *differences.choice(scene, normal),
            *differences.springs(scene, normal),
            *hemisphere(normal),
        )
        return (*super().cautions(scene, normal), *own)

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return contacts without traction."""
        return State(scene.shape, Scales.of(scene, normal), step.start())

    def advance(
        self,
        state: State,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, State]:
        """Return the force after the step."""
        shape, scales, memory = state
        own = bundle(self.number)
        radius = step.float_of_one(after.radius) / scales.radius
        pressure = scales.pressure(radius, step.float_of_one(after.friction_load))
        radius, pressure = step.common(radius, shape), step.common(pressure, shape)
        moved = increment.displacement * scales.displacement
        if not shape:
            force, work, memory = step.advance(own, memory, moved, radius, pressure, 1)
            response = TangentialResponse(force.item() * scales.force, work.item() * scales.work)
            return response, State(shape, scales, memory)
        items, moved = math.prod(shape), flat(moved, shape)
        force, work, memory = step.advance(own, memory, moved, radius, pressure, items)
        force, work = force.reshape(shape) * scales.force, work.reshape(shape) * scales.work
        return TangentialResponse(force, work), State(shape, scales, memory)

    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return the forces of one impact, or of a batch whose contacts differ in scale only."""
        # Batches of several axes and runs of large tables are faster step by step.
        shape, own = scene.shape, bundle(self.number)
        columns = max(self.number, math.prod(shape))
        if len(shape) > 1 or len(steps.drift) * columns > LARGEST_RUN:
            return None
        scales = Scales.of(scene, normal)
        radius = steps.contact.radius / scales.radius
        scaled = all_steps.ScaledSteps(
            radius=radius,
            pressure=np.asarray(scales.pressure(radius, steps.contact.friction_load)),
            drift=steps.drift * scales.displacement,
            kick=steps.kick * (scales.force / scene.pair.tangential_mass),
        )
        if not shape:
            force, work = all_steps.advance_all(own, scaled, float(scene.slip_velocity))
            return AllStepsResponse(force * scales.force, float(work * scales.work), True)
        if not (_alike(scaled.radius) and _alike(scaled.pressure)):
            return None
        scaled = scaled._replace(radius=scaled.radius[:, 0], pressure=scaled.pressure[:, 0])
        forces, works = all_steps.advance_batch(own, scaled, scene.slip_velocity, *shape)
        forces *= scales.force
        return AllStepsResponse(forces, works * scales.work, True)

    def fields(self, state: State) -> Mapping[str, NDArray[Any]]:
        """Return radius (m), displacement and limit (m), stuck and slipping of every spring.

        ``displacement`` is w, the tangential displacement of the spring; ``slipping`` is the sign
        of w where the spring is at its limit, 0 elsewhere.
        """
        shape, scales, memory = state
        squares = bundle(self.number).squares
        items = math.prod(shape)

        def of_all(rows: Array) -> Array:
            full = np.zeros((items, len(squares)))
            full[:, : len(rows)] = rows.T
            return full.reshape(*shape, len(squares))

        def column(value: Real) -> Array:
            return np.asarray(value)[..., None]

        deflection, limit = of_all(memory.deflection), of_all(memory.limit)
        radius = np.broadcast_to(column(scales.radius) * np.sqrt(squares), deflection.shape)
        return spring_fields(radius, deflection, limit, metres=column(scales.metres))


def _alike(rows: Array) -> bool:
    """Return whether all impacts agree, to rounding, in each row."""
    first = rows[:, :1]
    return rows.shape[1] == 1 or bool((np.abs(rows - first) <= step.ROUNDING * first).all())
