"""Partial slip with its whole history: the sum of irreducible components."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    CausalTangentialLaw,
    Increment,
    NormalContact,
    NormalMotion,
    TangentialResponse,
    count,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger.partial_slip import PartialSlip, Scales, hemisphere
from contactlab_laws.mindlin_deresiewicz.stack import EMPTY, Stack, follow_step

#: Radii over b at which the fields tell the traction.
PLACES = (np.arange(50) + 0.5) / 50
#: More components than a run can have, whose steps are at most 2,000,000.
ALL = 10_000_000
#: Fewest components that are worth a history.
FEWEST = 8


class State(NamedTuple):
    """Scales, kappa in Pa, and the stacks of a batch of shape ``shape``."""

    scales: Scales
    modulus: Real
    stacks: tuple[Stack, ...]
    shape: tuple[int, ...]


@attrs.frozen(kw_only=True)
class MindlinDeresiewicz(PartialSlip, CausalTangentialLaw):
    """Mindlin and Deresiewicz's partial slip, with every step's component kept.

    The traction is the sum of Hertz-like components, one for each step in which the contact
    grew stuck; a component overtaken by slip is merged into that of the slipping annulus. A step in
    which displacement, b² and limit change in proportion is exact, so the error is that of the
    integrator. The memory grows with the number of steps, up to one component a step.

    Maw, Barber & Fawcett left this method for their annuli because of this growth.

    Parameters
    ----------
    components : int
        Most components that are kept: beyond, those merge that move the force least. The default
        keeps all, so that the error falls as the square of the steps. 64 components move psi2 by
        less than 1e-4 at up to 12,800 steps, and save time beyond about 1,600 steps.

    References
    ----------
    Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; Jaeger, Arch. Appl. Mech. 65 (1995)
    478-487; Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    """

    api_version: ClassVar[int] = 2
    expected_failures: ClassVar[Mapping[str, str]] = {
        "coulomb_at_a_point_damped": "components are limited separately, as springs are",
    }

    components: int = count(default=ALL, least=FEWEST, most=ALL)

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, of separately limited parts, and of the pressure."""
        own = (
            *differences.choice(scene, normal),
            *differences.springs(scene, normal, part="component"),
            *hemisphere(normal),
        )
        return (*super().cautions(scene, normal), *own)

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return contacts without traction."""
        modulus = scene.pair.tangential_stiffness(1.0)
        stacks = (EMPTY,) * math.prod(scene.shape)
        return State(Scales.of(scene, normal), modulus, stacks, scene.shape)

    def fields(self, state: State) -> Mapping[str, NDArray[Any]]:
        """Return radius (m), traction (Pa), stuck and slipping at 50 radii, and the components."""
        edges = np.array([math.sqrt(stack.squares[-1]) for stack in state.stacks])
        radius = edges[:, None] * PLACES
        pairs = list(zip(state.stacks, radius, strict=True))
        shape = (*state.shape, len(PLACES))
        traction = np.reshape([stack.traction(places) for stack, places in pairs], shape)
        slipping = np.reshape([stack.slipping(places) for stack, places in pairs], shape)
        unit = np.asarray(state.scales.radius)
        strength = np.asarray(state.modulus * state.scales.metres / unit) / math.pi
        return {
            "radius": unit[..., None] * radius.reshape(shape),
            "traction": strength[..., None] * traction,
            "stuck": slipping == 0.0,
            "slipping": slipping,
            "components": np.reshape([len(one.squares) - 1 for one in state.stacks], state.shape),
        }

    def advance(
        self, state: State, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, State]:
        """Return the force after the step, and the work of the slipping annuli."""
        shape, scales = np.shape(increment.displacement), state.scales
        radius: Real = after.radius / scales.radius
        pressure = scales.pressure(radius, after.friction_load)
        columns = np.broadcast_arrays(
            increment.displacement * scales.displacement, radius, pressure
        )
        rows = zip(state.stacks, *(each.ravel().tolist() for each in columns), strict=True)
        stacks, *sums = zip(*(follow_step(*row) for row in rows), strict=True)
        stacks = tuple(stack.merge(self.components) for stack in stacks)
        # mu P is 3/2 of the integral of the limit.
        force, work = (1.5 * np.reshape(each, shape)[()] for each in sums)
        response = TangentialResponse(force * scales.force, work * scales.work)
        return response, state._replace(stacks=stacks)
