"""The plan of a gathering: what is computed and left out, and the doubts about each contact."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.integrator import resolution_for
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.restitution import restitution_of
from contactlab.impact.body_cautions import contact_vectors
from contactlab.impact.body_contact import spin_about
from contactlab.impact.gathering import Gathering
from contactlab.numeric.types import Array, Mask, Real
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Clause, Clauses, Plan, Words
from contactlab.registry.law_words import in_words, name_of, tell_assumptions
from contactlab.solve.coupled import Coupled
from contactlab.solve.planning import of_books, of_numbers, of_plugins
from contactlab.solve.way import ask

#: gap/deep from which contacts act one after another (theory §18).
IN_SEQUENCE = 3.0
#: Widening of a gap for ``per_micron``, in m; largest share of v1 by it, and by weight, g T/v1,
#: without a caution.
MICRON, SHARE, WEIGHT = 1e-6, 0.01, 0.01
#: Most contacts whose cautions include ``per_micron``, which solves as many gatherings.
FEW = 20
#: Contact radius over the distance of two contacts of a body, and path v1 T over the least radius,
#: from which there is a caution; change of the approach by the first (recalled: a point load on a
#: half-space).
NEAR, MOVES, ACTS = 0.05, 0.05, 0.4
#: Spin about the normal over the rates of a contact below which it is rounding.
TURNING = 1e-9


@attrs.frozen(eq=False, slots=False)
class GatheringPlan(Plan):
    """The plan of a gathering of C contacts: what is computed, what is left out, and the doubts.

    Attributes
    ----------
    gap_over_depth : array, shape (..., C)
        Gap over the depth (1.25 m v1²/K)^0.4 of the contact alone: from 3 on contacts act one after
        another, below the answer depends on the gap.
    contact_times : array, shape (..., C)
        Duration of each contact alone at v1, in s.
    steps : array, shape (...)
        Steps in the shortest contact.
    """

    gap_over_depth: Array = attrs.field(kw_only=True)
    contact_times: Array = attrs.field(kw_only=True)
    steps: Real = attrs.field(kw_only=True)
    _widened: Callable[[], Array] = attrs.field(kw_only=True, repr=False)

    @cached_property
    def per_micron(self) -> Array:
        """Largest change of a velocity if any gap were one micron wider, shape (...), in m/s.

        The first reading solves 1 + C gatherings.
        """
        return self._widened()


def gathering_plan(
    gathering: Gathering,
    way: Coupled,
    motion: Motion | None,
    history: bool | str,
    widened: Callable[[], Array],
) -> GatheringPlan:
    """Return the plan of a gathering that is answered in a ``way``; ``motion`` is that of a run.

    ``widen`` returns ``per_micron``.
    """
    scene, shape = way.scene, gathering.shape
    prepared = way.prepare(False)
    contacts = scene.shape[-1]
    normal = prepared.normal
    times = np.broadcast_to(normal.duration, scene.shape)
    depth = np.broadcast_to(normal.maximum_approach, scene.shape)
    assert scene.links is not None
    integrator = way.laws.integrator
    steps = resolution_for(integrator, scene, normal, way.laws.tangential)
    said = _Words(gathering, way, normal, motion, history)
    plan: list[GatheringPlan] = []

    def words() -> Words:
        (found,) = plan
        return said.computed(found), said.left_out(), tuple(said.cautions(found))

    columns = prepared.columns
    columns = columns._replace(
        code=np.asarray(columns.code).reshape(scene.shape)[:, 0].reshape(shape),
        psi2_error=np.full(shape, np.nan)[()],
        restitution_error=np.full(shape, np.nan)[()],
    )
    plan.append(
        GatheringPlan(
            columns,
            words,
            gap_over_depth=(scene.links.gap / depth).reshape(*shape, contacts),
            contact_times=times.reshape(*shape, contacts),
            steps=np.broadcast_to(steps, scene.shape)[:, 0].reshape(shape)[()],
            widened=widened,
        )
    )
    return plan[0]


class _Words:
    """The clauses of a plan of gatherings."""

    def __init__(
        self,
        gathering: Gathering,
        way: Coupled,
        normal: NormalMotion,
        motion: Motion | None,
        history: bool | str,
    ) -> None:
        self.gathering, self.laws, self.scene = gathering, way.laws, way.scene
        self.way, self.normal, self.motion, self.history = way, normal, motion, history
        self.speed = np.asarray(self.scene.normal_speed)[:, 0]

    def _where(self, mask: Mask) -> NDArray[np.bool_]:
        """Return a mask of gatherings in the batch shape."""
        return np.asarray(mask).reshape(self.gathering.shape)

    def _everywhere(self, text: str, *values: object) -> Clause:
        """Return a clause about all gatherings."""
        return Clause(text, np.ones(self.gathering.shape, dtype=bool), values or None)

    def _shape_numbers(self, numbers: Array) -> Real:
        """Return numbers of gatherings in the batch shape, one as a float."""
        shaped = np.asarray(numbers, dtype=float).reshape(self.gathering.shape)
        return shaped if shaped.ndim else float(shaped)

    def computed(self, plan: GatheringPlan) -> Clauses:
        """Return the clauses on what is computed."""
        links, law = self.scene.links, self.laws
        assert links is not None
        open_ = links.gap > 0.0
        said = [
            self._everywhere(f"normal motion: {self._normal()}, with the tangential motion"),
            self._everywhere(
                f"tangential motion: {in_words(law.integrator)} over {in_words(law.tangential)}"
            ),
            self._everywhere("steps: {:.0f} in the shortest contact", plan.steps * 1.0),
        ]
        able = law.capability
        if able.resolving is not None and len(able.unnamed) > 1 and not self.history:
            found = able.resolving.resolutions(self.scene, law.normal, law.integrator)
            said += [] if found is None else [self._everywhere(f"resolution: {found.reason}")]
        closed = [k for k in range(open_.shape[-1]) if not open_[:, k].any()]
        said.append(self._everywhere(f"contacts: {_name_contacts(closed)} closed at the start"))
        for k in np.flatnonzero(open_.any(axis=0)).tolist():
            share = plan.gap_over_depth[..., k]
            how = "while others are closed"
            if np.all((share == 0.0) | (share >= IN_SEQUENCE)):
                how = "one after another"
            text = f"contacts: touches[{k}] open by {{:.3g}} m, {{:.3g}} of its depth: {how}"
            gap = self._shape_numbers(links.gap[:, k])
            deep = share if np.ndim(share) else float(share)
            said.append(Clause(text, self._where(open_[:, k]), (gap, deep)))
        ratio = self._shape_numbers(self._ratio())
        said.append(self._everywhere("contact times: the longest {:.3g} of the shortest", ratio))
        if self.motion is not None and self.motion.contacts is not None:
            never = self.motion.contacts.touches == 0.0
            said += [
                Clause(f"contacts: touches[{k}] never closed", self._where(never[:, k]))
                for k in np.flatnonzero(never.any(axis=0)).tolist()
            ]
        return tuple(said)

    def _normal(self) -> str:
        """Return the normal law in words; of contacts with losses of their own the range of e."""
        e = restitution_of(self.laws.normal)
        if e is None or not np.ndim(e):
            return in_words(self.laws.normal)
        low, high = np.min(e), np.max(e)
        told = f"{low:g}" if low == high else f"{low:g} to {high:g}"
        return f"{name_of(self.laws.normal)}, e of each contact {told}"

    def _ratio(self) -> Array:
        """Return the longest contact time over the shortest, of each gathering."""
        times = np.broadcast_to(self.normal.duration, self.scene.shape)
        return np.asarray(times.max(axis=-1) / times.min(axis=-1))

    def left_out(self) -> Clauses:
        """Return the clauses on what is left out, and why."""
        said = [
            "numerical error: not declared for several contacts; twice the springs and steps "
            "show it"
        ]
        if not self.history:
            said.append("history: not asked for")
        if len(self.gathering.touches) > 1 and not self._tells_gaps():
            said.append("what a micron of gap does: not asked for (plan.per_micron)")
        return tuple(self._everywhere(text) for text in said)

    def cautions(self, plan: GatheringPlan) -> Iterator[Clause]:
        """Yield the doubts about the model, each with its contact."""
        yield from self._gaps(plan)
        yield from self._near()
        yield from self._path()
        yield from self._weights()
        yield from self._turning()
        yield from self._of_contacts()
        if self.motion is not None:
            for clause in of_books(self.laws, self.scene, self.motion):
                values = tuple(self._shape_numbers(each[:, 0]) for each in clause.values or ())
                yield clause._replace(where=self._where(clause.where[:, 0]), values=values)
        for text in tell_assumptions(self.laws.normal, self.laws.tangential):
            yield self._everywhere(text)

    def _gaps(self, plan: GatheringPlan) -> Iterator[Clause]:
        """Yield the caution of ``per_micron``, which would cost a batch too much."""
        if not self._tells_gaps():
            return
        share = float(plan.per_micron) / float(self.speed[0])
        if share > SHARE:
            text = (
                "gaps: one of a micron more moves a velocity by {:.2g} of v1; contacts that are "
                "taken as closed are known as well as their gaps (model)"
            )
            yield self._everywhere(text, share)

    def _tells_gaps(self) -> bool:
        """Return whether cautions include ``per_micron``: for one gathering of a few contacts."""
        return not self.gathering.shape and 1 < len(self.gathering.touches) <= FEW

    def _sizes(self) -> Array:
        """Return the greatest contact radius of each contact: in the run, or alone at v1."""
        told = self.normal if self.motion is None else self.motion
        return np.broadcast_to(told.maximum_radius, self.scene.shape)

    def _near(self) -> Iterator[Clause]:
        """Yield the caution of two contacts of one body that are near each other."""
        sizes = self._sizes()
        for place, reaches in enumerate(self.gathering.assembly.reaches):
            most = np.zeros(self.scene.shape[0])
            for one, first in reaches.items():
                for other, second in reaches.items():
                    if one < other:
                        parts = zip(first.arm, second.arm, strict=True)
                        apart = np.sqrt(sum((a - b) ** 2 for a, b in parts))
                        size = np.maximum(sizes[:, one], sizes[:, other])
                        most = np.fmax(most, size / np.maximum(apart, 1e-300))
            if np.any(most > NEAR):
                text = (
                    f"contacts of bodies[{self._name(place)}]: contact radius over their distance "
                    f"{{:.2g}}; they feel one another through the body, by about {ACTS:g} of that "
                    "of the approach (model)"
                )
                yield Clause(text, self._where(most > NEAR), (self._shape_numbers(most),))

    def _name(self, place: int) -> str:
        """Return name or place of a body."""
        return repr(self.gathering.names[place]) if self.gathering.names else str(place)

    def _path(self) -> Iterator[Clause]:
        """Yield the caution of bodies that move far meanwhile."""
        radius = np.asarray(self.scene.pair.radius).min(axis=-1)
        times = np.broadcast_to(self.normal.duration, self.scene.shape).max(axis=-1)
        moved = self.speed * times / radius
        if np.any(moved > MOVES):
            text = (
                "geometry: bodies move by {:.2g} of the least radius meanwhile, and normals and "
                "contacts stay fixed (model)"
            )
            yield Clause(text, self._where(moved > MOVES), (self._shape_numbers(moved),))

    def _weights(self) -> Iterator[Clause]:
        """Yield the caution of a force that no loaded contact carries."""
        touches, places = self.gathering.touches, self.gathering.places
        times = np.broadcast_to(self.normal.duration, self.scene.shape).max(axis=-1)
        held = {
            place for touch, pair in zip(touches, places, strict=True) if touch.loaded
            for place in pair
        }  # fmt: skip
        assembly = self.gathering.assembly
        for place, body in enumerate(self.gathering.bodies):
            if place in held or not body.force.any():
                continue
            force = np.linalg.norm(assembly.flat(body.force, 3), axis=-1)
            share = force / assembly.flat(body.shape.mass) * times / self.speed
            if np.any(share > WEIGHT):
                text = (
                    f"force on bodies[{self._name(place)}]: g T/v1 = {{:.2g}}, and no contact that "
                    "carries it is loaded: Touch(..., loaded=True) where the body lies (model)"
                )
                yield Clause(text, self._where(share > WEIGHT), (self._shape_numbers(share),))

    def _turning(self) -> Iterator[Clause]:
        """Yield the caution of spin about a normal, whose friction the springs leave out."""
        for k, encounter in enumerate(self.gathering.assembly.met):
            spin = spin_about(encounter, encounter.unit_normal())
            about = np.abs(spin) * np.asarray(self.scene.pair.radius)[:, k]
            turns = about > TURNING * self.speed
            if turns.any():
                text = (
                    f"spin about the normal of touches[{k}]: its friction is left out, rim speed "
                    "R omega = {:.2g} of v1 (model)"
                )
                yield Clause(text, self._where(turns), (self._shape_numbers(about / self.speed),))

    def _of_contacts(self) -> Iterator[Clause]:
        """Yield the doubts about each contact as of an encounter; the same of several are one."""
        said: dict[str, list[int]] = {}
        central = self.scene.central
        for k, encounter in enumerate(self.gathering.assembly.met):
            alone = central.take((slice(None), k))._with(encounter=encounter)
            normal = self.normal.take((slice(None), k))
            laws = self.laws.normal, self.laws.tangential
            told = of_numbers(self.laws, alone, several=True)
            told += [text for law in laws for text in ask(law, law.cautions, alone, normal)]
            told += NormalLaw.cautions(self.laws.normal, alone, normal)
            told += [*contact_vectors(encounter), *of_plugins(self.laws, alone)]
            for text in dict.fromkeys(told):
                said.setdefault(text, []).append(k)
        for text, numbers in said.items():
            yield self._everywhere(f"{_name_contacts(numbers)}: {text}")


def _name_contacts(numbers: list[int]) -> str:
    """Return contacts in words."""
    if not numbers:
        return "none"
    if len(numbers) > 3:
        return f"touches[{numbers[0]}] and {len(numbers) - 1} more"
    return ", ".join(f"touches[{k}]" for k in numbers)
