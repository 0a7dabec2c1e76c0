"""The making of a plan, from the scene, its normal motion and what the laws say of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from contactlab.compose.answers import NONE, ONE, Answer, Mask
from contactlab.compose.composition import Laws
from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.impact.unit_slips import unit_slips
from contactlab.numeric.arrays import every, some, spread
from contactlab.outcome.plan import Clause, Plan

#: Error of what is known in closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12
#: What a plan says after an error that is not declared.
ADVICE = "; run(scene, estimate_error=True) estimates it"


def make_plan(
    scene: Scene,
    normal: NormalMotion,
    laws: Laws,
    known: Sequence[Answer],
    *,
    history: bool | str = False,
) -> Plan:
    """Return what ``scene`` needs of the three laws.

    Parameters
    ----------
    scene : Scene
    normal : NormalMotion
        Already made: it comes first.
    laws : Laws
    known : sequence of Answer
        What need not be marched.
    history : bool or "fields"
        What is asked for.
    """
    everywhere = np.ones(scene.shape, dtype=bool) if scene.shape else ONE
    separated, marched = _separated_and_marched(scene, normal, known)
    error = _error(scene, normal, laws, known, marched)
    how = "integrated from first touch to separation"
    if isinstance(normal.law, ClosedFormNormalLaw):
        how = "in closed form"
    computed = [Clause(f"normal motion: {type(normal.law).__name__}, {how}", everywhere)]
    cautions = unit_slips(scene)
    if some(separated):
        cautions += laws.normal.cautions(scene, normal)
        cautions += laws.tangential.cautions(scene, normal)
    if some(marched):
        text = "tangential motion: {!r} over {!r}"
        computed.append(Clause(text, marched, (laws.integrator, laws.tangential)))
        part = (normal, scene)
        if not every(marched):
            part = normal.take(marched), scene.take(marched)
        cautions += laws.integrator.remarks(part[0], laws.tangential, part[1])
    left_out = _not_marched(known, separated)
    if reason := _no_history(history, marched):
        left_out.append(Clause(reason, everywhere))
    return Plan(
        computed=(*computed, *_error_clauses(error, separated)),
        left_out=tuple(left_out),
        cautions=tuple(Clause(text, everywhere) for text in cautions),
        marched=marched,
        psi2_error=error,
    )


def _separated_and_marched(
    scene: Scene, normal: NormalMotion, known: Sequence[Answer]
) -> tuple[Mask, Mask]:
    """Return the impacts that the normal motion ends, and those of them not known as a whole."""
    if not scene.shape:
        if normal.status is not Status.SUCCESS:
            return NONE, NONE
        return ONE, NONE if known else ONE
    separated = np.asarray(np.asarray(normal.status, dtype=object) == Status.SUCCESS)
    separated = np.array(np.broadcast_to(separated, scene.shape))
    marched = np.array(separated)
    for answer in known:
        marched &= ~answer.where
    return separated, marched


def _not_marched(known: Sequence[Answer], separated: Mask) -> list[Clause]:
    """Return why impacts are not marched."""
    march = "march of the tangential motion"
    found = [Clause(f"{march}: {answer.known.reason}", answer.where) for answer in known]
    if not every(separated):
        found.append(Clause(f"{march}: the normal motion came to no end", ~separated))
    return found


def _no_history(history: bool | str, marched: Mask) -> str | None:
    """Return what a history leaves out, and why."""
    if not history:
        return "history: not asked for"
    if history != "fields":
        return "traction and stick/slip fields: not asked for (history='fields')"
    if not some(marched):
        return "traction and stick/slip fields: there is no march to take them from"
    return None


def _error(
    scene: Scene, normal: NormalMotion, laws: Laws, known: Sequence[Answer], marched: Mask
) -> Any:
    """Return the declared numerical error of psi2: of one impact a float, of a batch an array.

    Parameters
    ----------
    scene : Scene
    normal : NormalMotion
    laws : Laws
    known : sequence of Answer
    marched : array of bool
        Impacts that no whole-impact answer is for.
    """
    rounding = CLOSED_FORM * psi_magnitude(scene) + normal.accuracy * 4.0 * scene.chi
    error: Any = spread(rounding, scene.shape)
    for answer in known:
        error = error + np.where(answer.where, answer.known.psi2_error, 0.0)
    if some(marched):
        with np.errstate(all="ignore"):
            declared = laws.integrator.psi2_error(normal, laws.tangential, scene)
            if math.isnan(normal.accuracy):
                declared = math.nan  # no better known than the motion that it follows
            error = np.where(marched, declared, error) if scene.shape else declared
    return error if scene.shape else float(error)


def _error_clauses(error: Any, separated: Mask) -> list[Clause]:
    """Return what a plan says of the numerical error."""
    if separated.ndim:
        undeclared = separated & np.isnan(error)
        declared = separated & ~undeclared
    elif math.isnan(error):
        undeclared, declared = separated, NONE
    else:
        undeclared, declared = NONE, separated
    found = []
    if some(declared):
        text = "numerical error of psi2: at most {:.2g}, declared"
        found.append(Clause(text, declared, (error,)))
    if some(undeclared):
        text = f"numerical error of psi2: not declared{ADVICE}"
        found.append(Clause(text, undeclared))
    return found
