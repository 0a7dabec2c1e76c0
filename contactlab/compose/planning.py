"""The plan of a scene: its columns from the answers of the laws, its words when they are read."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose import together
from contactlab.compose.answers import Answered, Mask, separated
from contactlab.compose.composition import Laws
from contactlab.compose.normal_motion import normal_motion, normal_or_failed
from contactlab.compose.normal_spin_words import with_normal_spin
from contactlab.compose.together import WHOLE
from contactlab.contracts import faults
from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.cautions import (
    of_ellipse,
    rigid_bodies,
    three_numbers,
    unit_slips,
    unlikely,
)
from contactlab.impact.hertz import elongation_of
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, plain, some, spread, taken
from contactlab.numeric.types import Real
from contactlab.outcome.energy import ledger
from contactlab.outcome.motion import ENDS, Motion
from contactlab.outcome.plan import (
    ENDLESS,
    MARCHED,
    PSI2_ERROR,
    TANGENTIAL_MOTION,
    UNKNOWN,
    Clause,
    Clauses,
    Plan,
    PlanColumns,
    Reason,
    Words,
)

#: Error of what is known in closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12
#: Advice of a plan if the error is not declared.
ADVICE = "; run(scene, estimate_error=True) estimates it"
#: Entry of a plan whose friction work is a difference of energies.
UNCHECKED = (
    "check of the energy books: closed by construction, not checked; the friction work is the "
    "energy that the velocities lose"
)
#: Entries of a plan of impacts in which friction changes the approach.
TOGETHER = "normal and tangential motion together: friction changes the approach, or slip turns"
OF_CONTACT = (
    "restitution: of a frictionless impact on the mass 1/W_nn; that of the bodies follows from it"
)
ONE_PLANE = "second tangent: the motion stays in a plane"
OF_SPHERES = (
    "cautions of laws: their sizes were measured for spheres, where friction does not change the "
    "approach"
)
#: Undeclared imbalances over the energy at the start are cautioned of from here on.
BOOKS_OFF = 0.01
#: Entries of a motion by the names that a normal motion has for them.
SOURCES = {source: name for name, source in ENDS.items()}


def columns_of(normal: NormalMotion, laws: Laws, answered: Sequence[Answered]) -> PlanColumns:
    """Return the columns of the plan: why impacts are not marched, and the declared error."""
    shape = normal.scene.shape
    if not shape:
        code: Any = MARCHED if separated(normal) else ENDLESS
        marched: Any = code == MARCHED and not answered
        code = 0 if answered else code
    else:
        code = np.where(separated(normal), MARCHED, ENDLESS)
        for place, one in enumerate(answered):
            code[one.where] = place
        marched = code == MARCHED
    reasons = tuple(
        Reason(each.reason, each.balanced, each.fields is not None) for _, each in answered
    )
    # the load impulse of a frictionless impact is M_n v1 (1 + e), at most twice M_n v1
    restitution: Any = CLOSED_FORM + 2.0 * normal.accuracy
    for each in answered:
        if each.answer.normal is not None:
            restitution = math.nan  # the law changed the normal motion, and declares no error of it
    if shape:
        restitution = np.full(shape, restitution)
    return PlanColumns(code, _error(normal, laws, answered, marched), reasons, restitution)


def plan_of(
    laws: Laws,
    scene: Scene,
    columns: PlanColumns,
    motion: Motion | None = None,
    history: bool | str = False,
    *,
    estimated: bool = False,
) -> Plan:
    """Return the plan of a scene, with words that are made when they are first read.

    ``motion`` is that of a run, with the numbers of impacts that failed; None before a run. Errors
    that are ``estimated`` need no advice.
    """
    asked = _Asked(history, estimated)

    def words() -> Words:
        answered = ~columns.marched & laws.tangential.normal_spin  # no march takes spin
        return with_normal_spin(of_impacts(), scene, answered=answered)

    def of_impacts() -> Words:
        parts = scene.parts(as_one=bool(history))
        if len(parts) == 1:
            return _words(laws, parts[0][1], scene, columns, motion, asked)
        said = []
        for where, part in parts:
            some_columns = columns.take(where)
            moved = None if motion is None else taken(motion, scene.shape, where)
            kinds = _words(laws, part, scene.take(where), some_columns, moved, asked)
            said.append((where, Plan(some_columns, kinds)))
        return Plan.merged(said, scene.shape).words

    return Plan(columns, words)


def _words(
    laws: Laws,
    part: Scene,
    scene: Scene,
    columns: PlanColumns,
    motion: Motion | None,
    asked: _Asked,
) -> Words:
    """Return the clauses on impacts of ``scene`` that are solved alike, as those of ``part``."""
    masks = _Masks.of(columns)
    if not some(masks.known):
        return (), (), ()
    used = laws.of(part)
    coupled = part.inverse_mass is not None
    how = "integrated from first touch to separation"
    if coupled:
        how = "with the tangential motion"
    elif isinstance(used.normal, ClosedFormNormalLaw):
        how = "in closed form"
    law = f"{type(used.normal).__name__}, {how}{_defaults(used.normal)}"
    computed = [Clause(f"normal motion: {law}", masks.known)]
    elongation = elongation_of(part.pair)
    if some(elliptic := masks.known & (elongation > 1.0)):
        text = "contact: an ellipse of semi-axes {:.3g} : 1, by the circle that is as stiff"
        computed.append(Clause(text, elliptic, (spread(elongation, scene.shape),)))
    if used is not laws:
        computed.append(Clause(_in_place(laws, used), masks.known))
    if some(masks.marched):
        text = f"tangential motion: {used.integrator!r} over {used.tangential!r}"
        if coupled:
            text += together.lasting(used, part, masks.marched)
        computed.append(Clause(text, masks.marched, code=TANGENTIAL_MOTION))
    slow = used.tangential.one_by_one()
    if slow and scene.shape and (some(masks.marched) or (coupled and used.tangential.together)):
        where = masks.known if coupled else masks.marched
        computed.append(Clause(f"run time: impacts one by one, by {slow}", where))
    if coupled:
        computed.append(Clause(TOGETHER, masks.known))
        if getattr(used.normal, "restitution", None) not in (None, 1.0):
            computed.append(Clause(OF_CONTACT, masks.known))
    advice = "" if asked.estimate else ADVICE
    computed += _error_clauses("psi2", columns.psi2_error, masks.ended, advice)
    if coupled:  # of spheres it is that of the normal motion, and far smaller
        error = columns.restitution_error
        computed += _error_clauses("the normal restitution", error, masks.ended, advice)
    left_out = _not_marched(columns, masks)
    if _loses_in_pressure_alone(used, part):
        name = type(used.tangential).__name__
        left_out.append(Clause(f"loss in shear: {name} has none beside this law", masks.known))
    if coupled and part.planar:
        left_out.append(Clause(ONE_PLANE, masks.known))
    if reason := _no_history(asked.history, columns, masks.marched):
        left_out.append(Clause(reason, masks.known))
    with np.errstate(under="ignore"):
        cautions = _cautions(used, part, scene, motion, masks)
    return tuple(computed), tuple(left_out), cautions


def _loses_in_pressure_alone(laws: Laws, scene: Scene) -> bool:
    """Return whether the normal law is viscous, and the tangential law does not share its loss."""
    if not laws.normal.viscous or "partial_slip" not in laws.tangential.offers:
        return False
    if laws.tangential.shares_loss(laws.normal):
        return False
    return scene.rubs if scene.inverse_mass is None else together.at_larger_slip(scene).rubs


def _in_place(laws: Laws, used: Laws) -> str:
    """Return which laws stand in for those that nobody named, and why."""
    pairs = [
        f"{type(new).__name__} for {type(old).__name__}"
        for old, new in zip(laws, used, strict=True)
        if type(new) is not type(old)
    ]
    return f"laws: {', '.join(pairs)}, which has no answer where friction changes the approach"


class _Asked(NamedTuple):
    """What a run was asked for beside the answer: a history, and an estimate of the error."""

    history: bool | str
    estimate: bool


class _Masks(NamedTuple):
    """Impacts with a normal motion, those that the motion ends, others, and those marched."""

    known: Mask
    ended: Mask
    endless: Mask
    marched: Mask

    @classmethod
    def of(cls, columns: PlanColumns) -> _Masks:
        """Return the masks of a plan's columns."""
        code: Any = columns.code
        masks = code != UNKNOWN, code > ENDLESS, code == ENDLESS, code == MARCHED
        return cls(*map(np.asarray, masks))


def _cautions(
    laws: Laws, part: Scene, scene: Scene, motion: Motion | None, masks: _Masks
) -> Clauses:
    """Return the cautions about numbers of the scene, of the laws, and of the energy books."""
    central, coupled = part.central, part.inverse_mass is not None
    if coupled:
        central = together.at_larger_slip(part)
    known = masks.known
    whole = central if every(known) else central.take(known)
    said = [*unit_slips(whole), *unlikely(whole), *rigid_bodies(whole)]
    asked: list[str] = []
    if some(masks.ended):
        normal = _motion_of(laws.normal, central, None if coupled else motion, known)
        for law in (laws.normal, laws.tangential):
            asked += _asked(law, law.cautions, whole, normal)
        if coupled and laws.tangential.shares_loss(laws.normal):
            asked += _of_grip(laws.tangential, together.at_smaller_slip(part), known, normal)
        if coupled:  # that of yield and of a large contact hold for any bodies
            said += NormalLaw.cautions(laws.normal, whole, normal)
    if some(masks.marched):
        marched = part if every(masks.marched) else part.take(masks.marched)
        normal = _motion_of(laws.normal, central, None if coupled else motion, masks.marched)
        asked += _asked(laws.integrator, laws.integrator.remarks, normal, laws.tangential, marched)
    for law in (laws.normal, laws.tangential):
        if not law.elliptic:
            said += of_ellipse(whole, type(law).__name__)
    own = [text for text in dict.fromkeys(asked) if text not in said]
    said += own
    if coupled:
        said += [OF_SPHERES] if own else []
        said += together.cautions(laws, part)
    said += _by_default(laws.normal)
    clauses = [Clause(text, known) for text in said]
    if motion is not None:
        clauses += _books(laws, scene, motion)
    vectors = three_numbers(scene)
    return (*clauses, *(Clause(text, np.ones(scene.shape, dtype=bool)) for text in vectors))


def _of_grip(law: TangentialLaw, central: Scene, known: Mask, normal: NormalMotion) -> list[str]:
    """Return what a law that shares the loss says, beside what all say, of the smaller slip."""
    scene = central if every(known) else central.take(known)
    usual = TangentialLaw.cautions(law, scene, normal)
    return [text for text in _asked(law, law.cautions, scene, normal) if text not in usual]


def _motion_of(law: NormalLaw, scene: Scene, motion: Motion | None, where: Mask) -> Any:
    """Return the normal motion of some impacts: by its ends after a run, else made now."""
    part = scene if every(where) else scene.take(where)
    if motion is None:
        return normal_or_failed(law, part)
    return _AfterRun(law, part, motion if every(where) else taken(motion, scene.shape, where))


def _asked(law: Law, question: Callable[..., tuple[str, ...]], *about: object) -> list[str]:
    """Return what a law says; if it raises, what it raised."""
    try:
        return list(question(*about))
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # the numbers are sound without; a plug-in ends no process
        return [f"cautions of {type(law).__name__}: not known, {faults.raised(error)}"]


def _books(laws: Laws, scene: Scene, motion: Motion) -> list[Clause]:
    """Return the caution of an imbalance of the energy books for which no bound is declared."""
    undeclared: Any = laws.tangential.books_bound(scene.central) == math.inf
    if not some(undeclared):
        return []
    share: Any = np.abs(ledger(scene, motion).relative_imbalance)
    where = np.asarray(undeclared & (share > BOOKS_OFF) & (motion.status == Status.SUCCESS))
    if not where.any():
        return []
    text = (
        f"energy books: off by {{:.2g}} of the energy at the start, and "
        f"{type(laws.tangential).__name__} declares no bound (books_bound); with more steps a "
        "numerical error falls, what the law makes by its nature stays"
    )
    return [Clause(text, where, (np.asarray(share),))]


class _AfterRun:
    """The normal motion of a run by its end and its maxima; the rest is made when it is asked."""

    def __init__(self, law: NormalLaw, scene: Scene, motion: Motion) -> None:
        self.law, self.scene, self._motion = law, scene, motion
        self.offers = law.offers

    def __getattr__(self, name: str) -> Any:
        """Return an entry of the motion, or of the normal motion made again."""
        if name in SOURCES:
            return getattr(self._motion, SOURCES[name])
        return getattr(self._course, name)

    @cached_property
    def _course(self) -> NormalMotion:
        """The normal motion, made again."""
        return normal_motion(self.law, self.scene)


def _by_default(law: Law) -> tuple[str, ...]:
    """Return the caution of a restitution that nobody gave."""
    value = _kept_defaults(law).get("restitution")
    if value is None:
        return ()
    name = type(law).__name__
    return (f"restitution = {value:g} was taken by default: give {name} one of your own",)


def _defaults(law: Law) -> str:
    """Return which options of a law have their default value, with a semicolon before."""
    kept = ", ".join(f"{name} = {value:g}" for name, value in _kept_defaults(law).items())
    return f"; {kept} by default" if kept else ""


def _kept_defaults(law: Any) -> dict[str, float]:
    """Return the numbers of a law that nobody gave, by name."""
    if not (attrs.has(type(law)) and attrs.fields(type(law))):
        return {}
    try:
        usual = type(law)()
    except (TypeError, ValueError):  # it has no defaults, or not for all options
        return {}
    values = {item.name: getattr(law, item.name) for item in attrs.fields(type(law))}
    # The default is one object, which a number that somebody gave is not, even if it is equal.
    return {
        name: value
        for name, value in values.items()
        if isinstance(value, float) and value is getattr(usual, name)
    }


def _not_marched(columns: PlanColumns, masks: _Masks) -> list[Clause]:
    """Return why impacts are not marched, and whose books check nothing."""
    march = "march of the tangential motion"
    clauses = [
        Clause(f"{march}: {reason.text}", np.asarray(columns.code == place))
        for place, reason in enumerate(columns.reasons)
    ]
    if any(reason.unchecked for reason in columns.reasons):
        clauses.append(Clause(UNCHECKED, np.asarray(columns.unchecked)))
    if some(masks.endless):
        clauses.append(Clause(f"{march}: the normal motion came to no end", masks.endless))
    return clauses


def _no_history(history: bool | str, columns: PlanColumns, marched: Mask) -> str | None:
    """Return what a history leaves out, and why."""
    if not history:
        return "history: not asked for"
    if history != "fields":
        return "traction and stick/slip fields: not asked for (history='fields')"
    if not some(marched) and WHOLE in columns.reasons:
        return "traction and stick/slip fields: a law that answers both motions together has none"
    if not (some(marched) or any(reason.fields for reason in columns.reasons)):
        return "traction and stick/slip fields: there is no march to take them from"
    return None


def _error(normal: NormalMotion, laws: Laws, answered: Sequence[Answered], marched: Mask) -> Any:
    """Return the declared numerical error of psi2: of one impact a float, of a batch an array."""
    scene = normal.scene
    rounding = CLOSED_FORM * psi_magnitude(scene) + normal.accuracy * 4.0 * scene.chi
    if not (scene.shape or marched):
        return float(rounding + sum(one.answer.psi2_error for one in answered))
    error: Any = spread(rounding, scene.shape)
    for one in answered:
        error = error + np.where(one.where, one.answer.psi2_error, 0.0)
    if some(marched):
        with np.errstate(all="ignore"):
            declared = laws.integrator.psi2_error(normal, laws.tangential, scene)
            if math.isnan(normal.accuracy):
                declared = math.nan  # no better known than the motion that it follows
            error = np.where(marched, declared, error) if scene.shape else declared
    return plain(error)


def _error_clauses(what: str, error: Real, ended: Mask, advice: str) -> list[Clause]:
    """Return what a plan says of a numerical error."""
    undeclared = np.asarray(ended & np.isnan(error))
    declared = np.asarray(ended & ~undeclared)
    code = PSI2_ERROR if what == "psi2" else ""
    clauses = []
    if some(declared):
        text = f"numerical error of {what}: at most {{:.2g}}, declared"
        clauses.append(Clause(text, declared, (error,), code))
    if some(undeclared):
        text = f"numerical error of {what}: not declared{advice}"
        clauses.append(Clause(text, undeclared, code=code))
    return clauses
