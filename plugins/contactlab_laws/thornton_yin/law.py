"""Partial slip without a grid: a force, a load, and the points where the force turned."""

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
)
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger.partial_slip import hemisphere
from contactlab_laws.thornton_yin.branches import ContactState, Step, follow_step

#: Bound of the imbalance of the energy books, over the energy at the start: from the short memory.
LARGEST_IMBALANCE = 0.1
SHORT_MEMORY = (
    "model: this law keeps the force and two turning points, not the whole history. psi2 is off "
    "by up to 0.15."
)


class State(NamedTuple):
    """Twice G* in Pa, the friction coefficient, and the contacts of a batch of shape ``shape``."""

    modulus: Real
    friction_coefficient: Real
    contacts: tuple[ContactState, ...]
    shape: tuple[int, ...]


@attrs.frozen(kw_only=True)
class ThorntonYin(CausalTangentialLaw):
    """Partial slip by increments: dT = 2 G* b theta dD +- (1 - theta) mu dP.

    theta, the stick radius over b, follows from the force and from two turning points, which move
    with the load, by Mindlin & Deresiewicz's curves of loading, unloading and reloading. At fixed
    load this is their theory. Under a changing load the contact has a longer memory than
    a force and two points, so that an impact is approximated.

    The law differs from Thornton & Yin's in two points. Theirs takes the direction of slip at the
    edge from the sign of dD; here the edge slips while its displacement outruns the limit, which
    under a falling load goes on a while after the motion has turned. A contact that stuck as it
    grew starts to slip at its edge, with the same share of the limit everywhere; theirs falls to
    the curve of first loading.

    References
    ----------
    Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327-344; Thornton & Yin, Powder Technol. 65
    (1991) 153-166, doi:10.1016/0032-5910(91)80178-L; Thornton, Cummins & Cleary, Powder
    Technol. 210 (2011) 189-197, doi:10.1016/j.powtec.2011.01.013.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"elliptic"})
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_books": "the traction of a contact that stuck as it grew is proportional to p",
        "impact_reference": "the memory is the force and two turning points, not the traction",
    }

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, of the pressure, and of the short memory."""
        own = (*differences.choice(scene, normal), *hemisphere(normal), SHORT_MEMORY)
        return (*super().cautions(scene, normal), *own)

    def path_cautions(self) -> tuple[str, ...]:
        """Return the caution of a memory that holds few turning points."""
        return (
            "model: short memory. Along random paths the force is off by up to 0.42 mu N, and load "
            "cycles at a held displacement lose force. springs and annulus do neither.",
        )

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a in N/m, of the largest contact."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of the imbalance that the short memory causes."""
        return LARGEST_IMBALANCE

    def start(self, scene: Scene, normal: NormalMotion) -> State:
        """Return contacts without force."""
        modulus = scene.pair.tangential_stiffness(1.0)
        contacts = (ContactState(),) * math.prod(scene.shape)
        return State(modulus, scene.friction_coefficient, contacts, scene.shape)

    def fields(self, state: State) -> Mapping[str, NDArray[Any]]:
        """Return the stick radius over the contact radius."""
        slipped = np.array([contact.slipped for contact in state.contacts])
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
            contact, work = _step_one(state.contacts[0], *map(float, columns))
            return TangentialResponse(contact.force, work), state._replace(contacts=(contact,))
        # Branches differ from impact to impact: one by one is as fast as together.
        rows = zip(
            *(np.broadcast_to(each, shape).ravel().tolist() for each in columns), strict=True
        )
        answers = [
            _step_one(contact, *row) for contact, row in zip(state.contacts, rows, strict=True)
        ]
        contacts, works = zip(*answers, strict=True)
        force = np.array([contact.force for contact in contacts]).reshape(shape)
        response = TangentialResponse(force, np.array(works).reshape(shape))
        return response, state._replace(contacts=contacts)


def _step_one(
    contact: ContactState, softer: float, stiffer: float, limit: float, displacement: float
) -> tuple[ContactState, float]:
    """Return one contact after a step, and the friction work in J."""
    # ``softer`` and ``stiffer`` are 2 G* b at the ends of the step, ``limit`` is mu L at its end.
    ends = [(softer, contact.limit), (stiffer, limit)]
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
        return contact._replace(force=math.nan), math.nan
    return follow_step(contact, step)
