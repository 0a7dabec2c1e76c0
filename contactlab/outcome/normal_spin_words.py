"""Words of a plan on spin about the normal whose friction is left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.kinetics import turns
from contactlab.impact.normal_spin import LARGEST_W, NormalSpin, normal_spin
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import some
from contactlab.numeric.types import Mask
from contactlab.outcome.plan import NORMAL_SPIN, PSI2_ERROR, WITHOUT_SPIN, Clause, Clauses, Words

ANSWERED = "spin about the normal: slip and spin share the friction"
TURNS = "spin about the normal: its friction is left out"
#: Smallest shift of psi2, and smallest loss of spin, with a caution.
LEAST_SHIFT, LEAST_LOSS = 1e-3, 1e-2


def with_normal_spin(words: Words, scene: Scene, *, answered: Mask = False) -> Words:
    """Return the words of a plan, with cautions of the changes by spin about the normal.

    ``answered`` marks impacts whose law answers spin about the normal, unless a body is off centre.
    """
    if scene.frame is None and not turns(scene):
        return words
    spin = normal_spin(scene, answered=answered)
    computed, left_out, cautions = words
    where = np.array(np.broadcast_to(answered & np.not_equal(scene.normal_spin, 0.0), scene.shape))
    if where.any():
        computed = (*computed, Clause(ANSWERED, where, code=NORMAL_SPIN))
    if spin is None:
        return computed, left_out, cautions
    acts = np.array(spin.acts)
    computed = tuple(part for clause in computed for part in _without_spin(clause, acts))
    left_out = (*left_out, Clause(TURNS, acts, code=NORMAL_SPIN))
    return computed, left_out, (*cautions, *_sizes(spin, batch=bool(scene.shape)))


def _without_spin(clause: Clause, acts: NDArray[np.bool_]) -> Clauses:
    """Return a clause; a bound of the error of psi2 is said apart where spin ``acts``."""
    if clause.code != PSI2_ERROR or clause.values is None or not some(clause.where & acts):
        return (clause,)
    said = clause._replace(text=f"{clause.text}, {WITHOUT_SPIN}", where=clause.where & acts)
    rest = clause._replace(where=clause.where & ~acts)
    return (said, rest) if some(rest.where) else (said,)


def _sizes(spin: NormalSpin, *, batch: bool) -> Clauses:
    """Return the cautions of the shift of psi2, and of a loss of spin where psi2 hardly moves."""
    about = "up to about" if batch else "about"
    size, percent, w = (np.asarray(each) for each in (abs(spin.shift), 100.0 * spin.loss, spin.w))
    number = "w = {:.2g}"
    shifts = size >= LEAST_SHIFT
    slows = ~shifts & (percent >= 100.0 * LEAST_LOSS)
    known = np.asarray(spin.known)
    beyond = (shifts | slows) & ~known
    clauses = (
        Clause(
            f"model: friction of the spin about the normal is ignored. Effect on psi2: {about} "
            f"{{:.2g}} ({number}); the spin would lose {about} {{:.2g}} %.",
            shifts & known,
            (size, w, percent),
            NORMAL_SPIN,
        ),
        Clause(
            "model: friction of the spin about the normal is ignored. Effect on psi2 and on the "
            f"spin: {OUTSIDE} ({number}, measured to {LARGEST_W:g}).",
            beyond,
            (w,),
            NORMAL_SPIN,
        ),
        Clause(
            f"model: friction of the spin about the normal is ignored. The spin would lose {about} "
            f"{{:.2g}} % ({number}); psi2 hardly changes.",
            slows & known,
            (percent, w),
            NORMAL_SPIN,
        ),
    )
    return tuple(clause for clause in clauses if some(clause.where))
