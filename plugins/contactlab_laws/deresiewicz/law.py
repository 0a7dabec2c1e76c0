"""Partial slip without places: a force, a load, and the points where the force turned."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab_laws.deresiewicz.branches import Memory, Step, followed
from contactlab_laws.jaeger.pressure import hemisphere

#: Of the energy books, over the energy at the start: what the short memory leaves out.
LARGEST_IMBALANCE = 0.1
SHORT_MEMORY = (
    "the contact remembers its force and two turning points, not its traction, which moves psi2 "
    "of solid spheres by up to about 0.15 (model, not numerical error)"
)


class State(NamedTuple):
    """Twice G* in Pa, the friction coefficient, and the memories of a batch of that shape."""

    modulus: Real
    friction_coefficient: Real
    memories: tuple[Memory, ...]
    shape: tuple[int, ...]


@attrs.frozen(kw_only=True)
class MindlinDeresiewicz(SteppedTangentialLaw):
    """Partial slip by increments: dT = 2 G* b theta dD +- (1 - theta) mu dP.

    theta, the stick radius over b, follows from the force and from two turning points, which move
    with the load, by Mindlin & Deresiewicz's curves of loading, unloading and reloading. At fixed
    load this is their theory. Under a changing one the memory of the contact is more than
    the force and two points, so that an impact is approximated.

    Where Thornton & Yin decide by the sign of dD whether the edge slips to or fro, here it
    slips while its displacement outruns the limit, which under a falling load goes on a while after
    the motion has turned; and a contact that stuck as it grew starts to slip at its edge, with
    the same share of the limit everywhere, where theirs falls to the curve of first loading.

    References
    ----------
    Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; Thornton & Yin, Powder Technol. 65
    (1991) 153-166, doi:10.1016/0032-5910(91)80178-L; Thornton, Cummins & Cleary, Powder
    Technol. 210 (2011) 189-197, doi:10.1016/j.powtec.2011.01.013.
    """

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_books": "a contact that stuck as it grew is given a traction in proportion to p",
        "impact_reference": "the memory is the force and two turning points, not the traction",
    }

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return that the memory is short, and that of a pressure that may be no hemisphere."""
        known = (*super().cautions(scene, normal), *hemisphere(normal))
        return (*known, SHORT_MEMORY)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a, of the largest contact."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)

    @property
    def books_bound(self) -> float:
        """Return what the short memory leaves out of the books."""
        return LARGEST_IMBALANCE

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return contacts without force."""
        modulus = scene.pair.tangential_stiffness(1.0)
        memories = (Memory(),) * math.prod(scene.shape)
        return State(modulus, scene.friction_coefficient, memories, scene.shape)

    def fields(self, state: State) -> Mapping[str, NDArray[Any]]:
        """Return the stick radius over the contact radius."""
        slipped = np.array([memory.slipped for memory in state.memories])
        return {"stick_radius": np.sqrt(1.0 - slipped).reshape(state.shape)}

    def advance(
        self, state: State, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, State]:
        """Return the force after the step, and the work of the slip at the edge."""
        shape = np.shape(increment.displacement)
        columns = (
            state.modulus * before.radius,
            state.modulus * after.radius,
            state.friction_coefficient * after.friction_load,
            increment.displacement,
        )
        if not shape:
            memory, work = _one(state.memories[0], *map(float, columns))
            return TangentialResponse(memory.force, work), state._replace(memories=(memory,))
        # Branches differ from impact to impact: one by one they are as fast as together.
        rows = zip(
            *(np.broadcast_to(each, shape).ravel().tolist() for each in columns), strict=True
        )
        answers = [_one(memory, *row) for memory, row in zip(state.memories, rows, strict=True)]
        memories, works = zip(*answers, strict=True)
        force = np.array([memory.force for memory in memories]).reshape(shape)
        response = TangentialResponse(force, np.array(works).reshape(shape))
        return response, state._replace(memories=memories)


def _one(
    memory: Memory, softer: float, stiffer: float, limit: float, displacement: float
) -> tuple[Memory, float]:
    """Return the memory of one contact after a step, and the friction work.

    Parameters
    ----------
    memory : Memory
    softer, stiffer : float
        Stiffness 2 G* b at the two ends of the step, in N/m.
    limit : float
        mu times the friction load at its end, in N.
    displacement : float
        In m.
    """
    ends = [(softer, memory.limit), (stiffer, limit)]
    rates = [stiffness / math.cbrt(load) for stiffness, load in ends if load > 0.0]
    total = softer + stiffer
    # The mean radius of a contact whose square changes evenly over the step.
    squares = softer * softer + softer * stiffer + stiffer * stiffer
    step = Step(
        limit=limit,
        stiffness=(2.0 / 3.0) * squares / total if total > 0.0 else 0.0,
        front_rate=(2.0 / 3.0) * sum(rates) / len(rates) if rates else 0.0,
        displacement=displacement,
    )
    if not math.isfinite(limit + total + displacement):
        return memory._replace(force=math.nan), math.nan
    return followed(memory, step)
