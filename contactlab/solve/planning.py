"""The plan of a scene: its columns from the answers of the laws, its words when they are read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any, NamedTuple, TypeGuard

import numpy as np

from contactlab.contracts.law import claims
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import SteppedTangentialLaw
from contactlab.impact import kinetics
from contactlab.impact.cautions import (
    name_bodies,
    of_ellipse,
    rigid_bodies,
    tell_yield,
    three_numbers,
    unit_slips,
    unlikely,
)
from contactlab.impact.hertz import elongation_of
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, some, spread, take
from contactlab.numeric.types import Real
from contactlab.outcome.energy import ledger
from contactlab.outcome.motion import ENDS, Motion
from contactlab.outcome.plan import (
    PSI2_ERROR,
    TANGENTIAL_MOTION,
    Clause,
    Clauses,
    Plan,
    PlanColumns,
    Words,
)
from contactlab.registration.bring import sound
from contactlab.registry.composition import Laws
from contactlab.registry.law_words import in_words, name_of, tell_assumptions
from contactlab.solve.answers import Mask
from contactlab.solve.normal_motion import normal_motion, try_normal
from contactlab.solve.solve import ways
from contactlab.solve.way import WHOLE, Masks, Way, ask

#: Advice of a plan if the error is not declared.
ADVICE = "; run(scene, estimate_error=True) estimates the error"
#: Entry of a plan whose friction work is a difference of energies.
UNCHECKED = "energy check: friction work comes from the velocities, so energy always balances"
#: Undeclared imbalances over the energy at the start are cautioned of from here on.
BOOKS_OFF = 0.01
#: Entries of a motion by the names that a normal motion has for them.
SOURCES = {source: name for name, source in ENDS.items()}


def plan_of(
    laws: Laws,
    scene: Scene,
    columns: PlanColumns,
    motion: Motion | None = None,
    history: bool | str = False,
    *,
    estimated: bool = False,
    found: Sequence[tuple[Way, NormalMotion]] = (),
) -> Plan:
    """Return the plan of a scene, with words that are made when they are first read.

    ``motion`` is that of a run, with the numbers of impacts that failed; None before a run. Errors
    that are ``estimated`` need no advice. The words make ways and normal motions that are not yet
    ``found``.
    """
    words = partial(_words_of_ways, laws, scene, columns, motion, history, estimated, found)
    return Plan(columns, words)


def _words_of_ways(
    laws: Laws,
    scene: Scene,
    columns: PlanColumns,
    motion: Motion | None,
    history: bool | str,
    estimated: bool,
    found: Sequence[tuple[Way, NormalMotion]],
) -> Words:
    """Return the clauses of a plan; arguments as in ``plan_of``."""
    from contactlab.outcome.normal_spin_words import with_normal_spin  # only for words

    answered = ~columns.marched & (
        "normal_spin" in laws.capability.tangential_claims
    )  # a march leaves spin out
    asked_for = _Asked(history, estimated)
    solved: Sequence[tuple[Way, NormalMotion | None]] = found
    if not solved:
        solved = [(way, None) for way in ways(laws, scene, as_one=bool(history))]
    if len(solved) == 1:
        words = _words(laws, *solved[0], scene, columns, motion, asked_for)
        return with_normal_spin(words, scene, answered=answered)
    said = []
    for way, normal in solved:
        some_columns = columns.take(way.where)
        moved = None if motion is None else take(motion, scene.shape, way.where)
        part = scene.take(way.where)
        kinds = _words(laws, way, normal, part, some_columns, moved, asked_for)
        said.append((way.where, Plan(some_columns, kinds)))
    words = Plan.merge(said, scene.shape).words
    return with_normal_spin(words, scene, answered=answered)


def _words(
    laws: Laws,
    way: Way,
    normal: NormalMotion | None,
    scene: Scene,
    columns: PlanColumns,
    motion: Motion | None,
    asked_for: _Asked,
) -> Words:
    """Return the clauses on impacts of ``scene`` that are solved in one way.

    ``normal`` is their normal motion where it is known before a run.
    """
    masks = Masks.of(columns)
    if not some(masks.known):
        return (), (), ()
    used, resolution = way.laws, []
    if used.by_scene:
        from contactlab.solve.resolution import tell_resolution  # most laws have none

        used, resolution = used.asked or used, tell_resolution(used, masks.marched)
    law = f"{in_words(used.normal)}, {way.how()}"
    computed = [Clause(f"normal motion: {law}", masks.known)]
    elongation = elongation_of(way.scene.pair)
    if some(elliptic := masks.known & (elongation > 1.0)):
        text = "contact: an ellipse of semi-axes {:.3g} : 1, replaced by a circle as stiff"
        computed.append(Clause(text, elliptic, (spread(elongation, scene.shape),)))
    if in_place := _in_place(laws, used):
        computed.append(Clause(in_place, masks.known))
    if some(masks.marched):
        text = f"friction: {in_words(used.tangential)}, followed by {in_words(used.integrator)}"
        computed.append(Clause(text, masks.marched, code=TANGENTIAL_MOTION))
        computed += resolution
    alone = way.one_by_one(masks)
    if scene.shape and some(alone) and (path := used.capability.path) is not None:
        cost = path.cost(way.scene.central, used.capability.accuracy)
        if cost.one_by_one:
            computed.append(Clause(f"run time: impacts one by one, by {cost.solver}", alone))
    computed += way.remarks(masks)
    advice = "" if asked_for.estimate else ADVICE
    for what, error in way.errors(columns).items():
        computed += _error_clauses(what, error, masks.ended, advice)
    left_out = _say_why_whole(columns, masks)
    if _loses_in_pressure_alone(way):
        name = name_of(used.tangential)
        left_out.append(Clause(f"loss in shear: {name} has none", masks.known))
    words, unknown, pressure = tell_yield(scene)
    if words and "plastic" not in used.capability.normal_claims:
        left_out.append(Clause(words, masks.known & unknown, (pressure,)))
    absent = [*_absent(way), *_no_history(asked_for.history, columns, masks.marched)]
    if absent:
        left_out.append(Clause(", ".join(absent), masks.known))
    with np.errstate(under="ignore"):
        cautions = _cautions(way, normal, scene, motion, masks, asked_for.history)
        if some(masks.marched):
            error = columns.psi2_error
            from contactlab.solve.error_cautions import of_errors  # of marches only

            cautions += tuple(of_errors(way.laws, way.scene, error, masks.marched, advice))
    return tuple(computed), tuple(left_out), cautions


def _loses_in_pressure_alone(way: Way) -> bool:
    """Return whether the normal law is viscous, and the tangential law does not share its loss."""
    able = way.laws.capability
    if "viscous" not in able.normal_claims or "partial_slip" not in able.tangential_claims:
        return False
    return not able.shares_loss and kinetics.rubs(way.scene_of_cautions)


def _in_place(laws: Laws, used: Laws) -> str:
    """Return which laws stand in for unnamed ones, and why; empty if none does."""
    pairs = [
        f"{name_of(new)} for {name_of(old)}"
        for old, new in zip(laws, used, strict=True)
        if type(new) is not type(old)
    ]
    return f"laws: {', '.join(pairs)}, which cannot follow this impact" if pairs else ""


class _Asked(NamedTuple):
    """Requests beside the answer: a history, and an estimate of the error."""

    history: bool | str
    estimate: bool


def _has_fields(law: SteppedTangentialLaw | None) -> TypeGuard[SteppedTangentialLaw]:
    """Return whether a law is stepped and has arrays for a history."""
    return law is not None and type(law).fields is not SteppedTangentialLaw.fields


def _cautions(
    way: Way,
    normal: NormalMotion | None,
    scene: Scene,
    motion: Motion | None,
    masks: Masks,
    history: bool | str,
) -> Clauses:
    """Return the cautions about numbers of the scene, of the laws, and of the energy books."""
    laws, part, central, known = way.laws, way.scene, way.scene_of_cautions, masks.known
    whole = central if every(known) else central.take(known)
    said = of_numbers(laws, whole)
    of_laws: list[str] = []
    moved = way.motion_of_cautions(motion)
    normal = normal if every(known) else None
    if some(masks.ended):
        normal = _motion_of(laws, central, moved, known) if normal is None else normal
        of_laws += way.cautions_of_laws(whole, normal, known)
        said += way.cautions_of_contact(whole, normal)
    if some(masks.marched):
        marched = part if every(masks.marched) else part.take(masks.marched)
        if normal is None or not every(masks.marched):
            normal = _motion_of(laws, central, moved, masks.marched)
        remarks = laws.integrator.cautions
        of_laws += ask(laws.integrator, remarks, marched, normal, laws.tangential)
        stepped = laws.capability.stepped
        if history == "fields" and _has_fields(stepped):
            of_laws += ask(stepped, stepped.path_cautions)
    own = [text for text in dict.fromkeys(of_laws) if text not in said]
    said += [
        *own,
        *way.own_cautions(bool(own)),
        *tell_assumptions(way.laws.normal, way.laws.tangential),
    ]
    said += of_plugins(laws, whole)
    clauses = [Clause(text, known) for text in said]
    if motion is not None:
        clauses += of_books(laws, scene, motion)
    vectors = three_numbers(scene)
    return (*clauses, *(Clause(text, np.ones(scene.shape, dtype=bool)) for text in vectors))


def of_numbers(laws: Laws, scene: Scene, *, several: bool = False) -> list[str]:
    """Return what numbers of impacts raise doubts, whatever the laws say of them.

    ``several`` is that of ``unit_slips``.
    """
    said = [*unit_slips(scene, several=several), *unlikely(scene), *rigid_bodies(scene)]
    claimed = laws.capability.normal_claims, laws.capability.tangential_claims
    for law, words in zip((laws.normal, laws.tangential), claimed, strict=True):
        if "elliptic" not in words:
            said += of_ellipse(scene, name_of(law))
    return said


def of_plugins(laws: Laws, scene: Scene) -> list[str]:
    """Return what plug-ins caution of, each with who says it."""
    told = sound("cautions", str, silent=False, scene=scene, laws=laws)
    return [f"{each.item} ({each.info.distribution})" for each in told]


def _motion_of(laws: Laws, scene: Scene, motion: Motion | None, where: Mask) -> Any:
    """Return the normal motion of some impacts: by its ends after a run, else made now."""
    part = scene if every(where) else scene.take(where)
    if motion is None:
        return try_normal(laws, part)
    return _AfterRun(
        laws.normal, part, motion if every(where) else take(motion, scene.shape, where)
    )


def of_books(laws: Laws, scene: Scene, motion: Motion) -> list[Clause]:
    """Return the caution of an imbalance of the energy books for which no bound is declared."""
    undeclared = laws.tangential.books_bound(scene.central) == math.inf
    if not some(undeclared):
        return []
    books = ledger(scene, motion)
    off = np.where(books.checked, np.abs(books.relative_imbalance), 0.0)
    share = kinetics.over_contacts(scene, off)
    where = np.asarray(undeclared & (share > BOOKS_OFF) & (motion.status == Status.SUCCESS))
    if not where.any():
        return []
    text = (
        "energy balance: off by {:.2g} of the energy at the start. If more steps do not reduce "
        f"this, {name_of(laws.tangential)} is the cause."
    )
    return [Clause(text, where, (np.asarray(share),))]


class _AfterRun:
    """The normal motion of a run by its end and its maxima; other entries are made on request."""

    def __init__(self, law: NormalLaw, scene: Scene, motion: Motion) -> None:
        self.law, self.scene, self._motion = law, scene, motion
        self.claims = claims(law)

    def __getattr__(self, name: str) -> Any:
        """Return an entry of the motion, or of the normal motion made again."""
        if name in SOURCES:
            return getattr(self._motion, SOURCES[name])
        return getattr(self._course, name)

    @cached_property
    def _course(self) -> NormalMotion:
        """The normal motion, made again."""
        return normal_motion(self.law, self.scene)


def _say_why_whole(columns: PlanColumns, masks: Masks) -> list[Clause]:
    """Return why impacts are not marched, and which impacts have books that check nothing."""
    march = "stepping through the contact"
    clauses = [
        Clause(f"{march}: {reason.text}", np.asarray(columns.code == place))
        for place, reason in enumerate(columns.reasons)
    ]
    if any(reason.unchecked for reason in columns.reasons):
        clauses.append(Clause(UNCHECKED, np.asarray(columns.unchecked)))
    if some(masks.endless):
        clauses.append(Clause(f"{march}: the bodies did not separate", masks.endless))
    return clauses


def _absent(way: Way) -> list[str]:
    """Return abilities of contactlab that these impacts do not need, each with the reason."""
    scene, pair = way.scene, way.scene.pair
    absent = []
    if name_bodies(scene) and not np.any(scene.pair.dundurs_beta):
        absent.append("coupling of unlike materials (equal)")
    if "elastic_hertz" in way.laws.capability.normal_claims:
        absent.append("loss (none given)")
    if not kinetics.turns(scene):
        absent.append("spin about the normal (none)")
    if every(elongation_of(pair) == 1.0):
        absent.append("elliptic contact (round)")
    if way.both and scene.planar:
        absent.append("out-of-plane motion (planar)")
    return absent


def _no_history(history: bool | str, columns: PlanColumns, marched: Mask) -> list[str]:
    """Return the clauses on an absent history, with the reason."""
    fields = "traction and stick/slip fields"
    if not history:
        return ["history (not requested)"]
    if history != "fields":
        return [f"{fields} (not requested, history='fields')"]
    if not some(marched) and WHOLE in columns.reasons:
        return [f"{fields} (the law solves both motions together)"]
    if not (some(marched) or any(reason.fields for reason in columns.reasons)):
        return [f"{fields} (no steps to take them from)"]
    return []


def _error_clauses(what: str, error: Real, ended: Mask, advice: str) -> list[Clause]:
    """Return the clauses on a numerical error."""
    undeclared = np.asarray(ended & np.isnan(error))
    declared = np.asarray(ended & ~undeclared)
    code = PSI2_ERROR if what == "psi2" else ""
    clauses = []
    if some(declared):
        text = f"numerical error of {what}: below {{:.2g}} (bound stated by the laws)"
        clauses.append(Clause(text, declared, (error,), code))
    if some(undeclared):
        text = f"numerical error of {what}: the laws state no bound{advice}"
        clauses.append(Clause(text, undeclared, code=code))
    return clauses
