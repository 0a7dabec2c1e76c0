"""The normal motion of any normal law: in closed form, solved to ``TOLERANCE``, or its ends."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import attrs
import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.law import claims
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw, unfollowed_rate
from contactlab.contracts.parameters import number_in
from contactlab.contracts.restitution import restitution_of
from contactlab.contracts.status import Status
from contactlab.impact import batches
from contactlab.impact.batches import NoIndexError
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every
from contactlab.numeric.checks import quote
from contactlab.solve.failed_motion import FailedMotion, UnfollowedMotion

if TYPE_CHECKING:
    from contactlab.registry.composition import Laws
    from contactlab.solve.solved_motion import MotionTable, SolvedMotion


def normal_motion(law: NormalLaw, scene: Scene) -> NormalMotion:
    """Return the motion from first touch to separation, or raise LawFaultError for a bad law.

    Where no step can follow it, the motion is that of the ends alone.
    """
    closed = law if isinstance(law, ClosedFormNormalLaw) else None
    return _solve_closed_form(closed, scene) if closed is not None else _open(law, scene)


def try_normal(laws: Laws, scene: Scene) -> NormalMotion:
    """Return the normal motion of ``scene``; all its values are NaN if the law fails."""
    closed = laws.capability.closed
    try:
        return (
            _solve_closed_form(closed, scene) if closed is not None else _open(laws.normal, scene)
        )
    except faults.LawFaultError as fault:
        return FailedMotion(laws.normal, scene, fault.status, fault.detail)


def _solve_closed_form(law: ClosedFormNormalLaw, scene: Scene) -> NormalMotion:
    """Return the motion in closed form."""
    try:
        motion = law.motion(scene)
        if NormalMotion not in type(motion).__mro__:  # isinstance of an abstract class is slow
            raise TypeError(f"motion returned {quote(motion)}, which is no NormalMotion")
        if motion.scene is not scene:
            raise ValueError("motion returned the motion of another scene")
    except BaseException as error:
        faults.blame(law, error)
        raise
    return motion


def _open(law: NormalLaw, scene: Scene) -> NormalMotion:
    """Return the motion of a law that returns forces."""
    if (rate := unfollowed_rate(law, scene)) is not None and every(np.isfinite(rate)):
        return UnfollowedMotion(law, scene, rate)
    from contactlab.solve.solved_motion import SolvedMotion  # not for closed forms

    if "similar" in claims(law):
        one = _unit_impact()
        alone = _find_table(law, one, SIMILAR)
        if alone is not None and alone.status[0] is Status.SUCCESS:
            return SolvedMotion(law, scene, alone, one)
    if (found := _of_restitutions(law, scene)) is not None:
        return SolvedMotion(law, scene, found, _unit_impact())
    table = _common(law, scene)
    if table is not None:
        return SolvedMotion(law, scene, table)
    with np.errstate(all="ignore"):
        return _solve(law, scene)


def _solve(law: NormalLaw, scene: Scene) -> SolvedMotion:
    """Return the motion solved in steps: of one impact in plain numbers, many times as fast."""
    if scene.shape:
        from contactlab.solve.motion_solver import Solver

        return Solver(law, scene).solve()
    from contactlab.solve.motion_solver_alone import Alone

    return Alone(law, scene).solve()


def _common(law: NormalLaw, scene: Scene) -> MotionTable | None:
    """Return the table of impacts that differ in their tangential motion only, or None."""
    numbers = (*attrs.astuple(scene.pair), scene.normal_speed)
    if not all(isinstance(number, float) for number in numbers):
        return None
    single = attrs.evolve(scene, friction_coefficient=0.0, tangential_velocity=0.0, spin=0.0)
    return None if single.shape else _find_table(law, single)


@cache
def _unit_impact() -> Scene:
    """Return the impact to which motions that are alike but for their units are scaled."""
    one = Scene.nondimensional(psi1=0.0, chi=1.0)
    return attrs.evolve(one, friction_coefficient=0.0)


def _of_restitutions(law: NormalLaw, scene: Scene) -> MotionTable | None:
    """Return the joined tables of a few restitutions, each of similar impacts, or None."""
    from contactlab.solve.solved_motion import MotionTable

    e = restitution_of(law)
    if e is None or not np.ndim(e):
        return None
    few, which = np.unique(number_in(law, "restitution", scene), return_inverse=True)
    if few.size > MOST_KEPT // 2:
        return None
    tables = []
    for e in few.tolist():
        alone = attrs.evolve(law, restitution=e)  # type: ignore[misc]  # attrs classes
        table = _find_table(alone, _unit_impact(), SIMILAR) if "similar" in claims(alone) else None
        if table is None or table.status[0] is not Status.SUCCESS:
            return None
        tables.append(table)
    return MotionTable.join(tables).take(which.reshape(scene.shape))


def _find_table(law: NormalLaw, single: Scene, name: str | None = None) -> MotionTable | None:
    """Return the table of one impact without friction, or None if the law takes a batch alone.

    A ``name`` stands for the impact, which is slow to compare.
    """
    key = law, name or single
    try:
        if (kept := _TABLES.get(key)) is not None:
            return kept
    except TypeError:  # a law, or a body of a law's own, that cannot be hashed
        return None
    try:
        with np.errstate(all="ignore"):
            solved = _solve(law, batches.drop_index(single))
    except faults.LawFaultError as fault:
        if isinstance(fault.__cause__, NoIndexError):
            return None
        raise
    while len(_TABLES) >= MOST_KEPT:
        del _TABLES[next(iter(_TABLES))]
    _TABLES[key] = solved.table
    return solved.table


#: Tables of the last normal motions, by law and scene: solving takes milliseconds, and the same
#: impact is often run under several friction laws. A table takes some 50 kB.
MOST_KEPT = 16
_TABLES: dict[tuple[NormalLaw, Scene | str], MotionTable] = {}
#: Name of the impact to which similar ones are scaled.
SIMILAR = "similar"
