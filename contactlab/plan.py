"""What a scene needs, and what is left out and why, said before anything runs."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab import faults
from contactlab.checks import Real
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw
from contactlab.contracts.tangential import TangentialLaw, WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.declared import COARSE, range_of
from contactlab.plain import plain
from contactlab.scene import Scene
from contactlab.status import Status

Mask = NDArray[np.bool_]

#: The mask of a single impact.
ONE: Mask = np.array(True)
#: Of what is known in closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12


class Sentence(NamedTuple):
    """A sentence of a plan, and the impacts that it is said of."""

    text: str
    where: Mask

    def __str__(self) -> str:
        """Return the sentence with its share of a batch."""
        if not self.where.ndim or self.where.all():
            return self.text
        share = f" ({int(self.where.sum())} of {self.where.size} impacts)"
        head, colon, tail = self.text.partition(": ")
        return f"{head}{share}{colon}{tail}"


Sentences = tuple[Sentence, ...]


@attrs.frozen(kw_only=True, eq=False)
class Plan:
    """What will be computed, what is left out, and what to be wary of.

    Attributes
    ----------
    computed, left_out, cautions : tuple of Sentence
        ``str`` of one gives it in words. Cautions are about the model and its numbers, and say
        which of the two.
    marched : bool or array of bool
        Impacts whose tangential motion an integrator follows.
    psi2_error : float or array
        Bound of the numerical error of psi2, as the laws and the integrator declare it; NaN where
        none is declared. The errors of the model are not in it: see ``cautions``.
    """

    computed: Sentences
    left_out: Sentences
    cautions: Sentences = ()
    marched: Mask
    psi2_error: Real = math.nan

    def __str__(self) -> str:
        """Return the plan in words, a line a sentence."""
        lines = [f"computed: {sentence}" for sentence in self.computed]
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"caution:  {sentence}" for sentence in self.cautions]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the sentences as plain lists, and the declared error."""
        return {
            "computed": list(map(str, self.computed)),
            "left_out": list(map(str, self.left_out)),
            "cautions": list(map(str, self.cautions)),
            "psi2_error": plain(self.psi2_error),
        }

    def __getitem__(self, index: Any) -> Plan:
        """Return the plan of some impacts of a batch; sentences stay those of the batch."""
        error = self.psi2_error
        return attrs.evolve(
            self,
            marched=self.marched[index],
            psi2_error=error if isinstance(error, float) else _only(error[index]),
        )

    @classmethod
    def joined(cls, plans: Sequence[Plan]) -> Plan:
        """Return the plan of a one-dimensional batch from those of its parts, in order."""
        sizes = [plan.marched.size for plan in plans]
        errors = [
            np.broadcast_to(plan.psi2_error, size) for plan, size in zip(plans, sizes, strict=True)
        ]
        kinds = {
            kind: _together([getattr(plan, kind) for plan in plans], sizes)
            for kind in ("computed", "left_out", "cautions")
        }
        return cls(
            **kinds,
            marched=np.concatenate([np.atleast_1d(plan.marched) for plan in plans]),
            psi2_error=np.concatenate(errors),
        )


def _together(parts: Sequence[Sentences], sizes: Sequence[int]) -> Sentences:
    """Return sentences with the masks of all parts; those that differ in numbers are one."""
    found: dict[str, tuple[str, Mask]] = {}
    first = 0
    for sentences, size in zip(parts, sizes, strict=True):
        for sentence in sentences:
            key = re.sub(r"[\d.e+-]+", "#", sentence.text)
            entry = found.setdefault(key, (sentence.text, np.zeros(sum(sizes), dtype=bool)))
            entry[1][first : first + size] |= sentence.where
        first += size
    return tuple(Sentence(text, where) for text, where in found.values())


class Answer(NamedTuple):
    """A whole-impact answer and the impacts that it is taken for."""

    where: Mask
    known: WholeImpact


def answers(
    scene: Scene, normal: NormalMotion, tangential: TangentialLaw, *, history: bool | str
) -> list[Answer]:
    """Return the answers of ``tangential`` to whole impacts, each impact in one of them at most.

    None where a march is asked for: traction and stick/slip fields come from nothing else, and
    the impacts of a batch that keeps its history share one time axis.
    """
    shape = scene.shape
    always = isinstance(tangential, WholeImpactTangentialLaw)
    if history == "fields" and not always:
        return []
    if not shape:
        if normal.status is not Status.SUCCESS:
            return []
        for known in tangential.whole_impacts(scene, normal):
            if known.where:
                return [Answer(ONE, _sound(known, tangential, shape))]
        return _not_marched(tangential) if always else []
    left = np.asarray(np.asarray(normal.status, dtype=object) == Status.SUCCESS)
    left = np.array(np.broadcast_to(left, shape))
    found = []
    for known in tangential.whole_impacts(scene, normal):
        where = left & np.broadcast_to(known.where, shape)
        if where.any():
            found.append(Answer(where, _sound(known, tangential, shape)))
            left &= ~where
    if always and left.any():
        return _not_marched(tangential)
    if history and left.any():
        return []
    return found


def _sound(known: WholeImpact, law: TangentialLaw, shape: tuple[int, ...]) -> WholeImpact:
    """Return an answer that is made of real numbers.

    Raises
    ------
    LawFaultError
        If it is not.
    """
    for entry in (known.slip_velocity_change, known.friction_work):
        if faults.malformed(entry, shape):
            told = faults.told(law, f"the answer {faults.shown(entry)} to a whole impact", 1)
            raise faults.LawFaultError(Status.MALFORMED, told)
    return known


def _not_marched(law: TangentialLaw) -> list[Answer]:
    told = faults.told(law, "no answer to some impacts, and no other way to run them", 1)
    raise faults.LawFaultError(Status.MALFORMED, told)


def make_plan(
    scene: Scene,
    normal: NormalMotion,
    tangential: TangentialLaw,
    integrator: Integrator,
    known: Sequence[Answer],
    *,
    history: bool | str = False,
) -> Plan:
    """Say what ``scene`` needs of the three laws.

    Parameters
    ----------
    scene : Scene
    normal : NormalMotion
        Already made: it comes first.
    tangential, integrator : Law
    known : sequence of Answer
        What need not be marched.
    history : bool or "fields"
    """
    everywhere = np.ones(scene.shape, dtype=bool) if scene.shape else ONE
    parted = np.array(np.asarray(normal.status, dtype=object) == Status.SUCCESS) & everywhere
    marched = np.array(parted)
    left_out = []
    for answer in known:
        marched &= ~answer.where
        text = f"march of the tangential motion: {answer.known.reason}"
        left_out.append(Sentence(text, answer.where))
    if not parted.all():
        text = "march of the tangential motion: the normal motion came to no end"
        left_out.append(Sentence(text, ~parted))
    how = "integrated from first touch to separation"
    if isinstance(normal.law, ClosedFormNormalLaw):
        how = "in closed form"
    computed = [Sentence(f"normal motion: {type(normal.law).__name__}, {how}", everywhere)]
    cautions = []
    if parted.any():
        cautions += list(normal.law.cautions(scene, normal))
        cautions += list(tangential.cautions(scene, normal))
    error = _error(scene, normal, tangential, integrator, marched)
    if marched.any():
        text = f"tangential motion: {integrator!r} over {tangential!r}"
        computed.append(Sentence(text, marched))
        if marched.all():
            cautions += list(integrator.remarks(normal, tangential, scene))
        else:
            some = normal.take(marched), tangential, scene.take(marched)
            cautions += list(integrator.remarks(*some))
        cautions += _coarse(scene, error, marched, tangential, integrator)
    computed += _said(error, parted)
    if not history:
        left_out.append(Sentence("history: not asked for", everywhere))
    elif history != "fields":
        text = "traction and stick/slip fields: not asked for (history='fields')"
        left_out.append(Sentence(text, everywhere))
    elif not marched.any():
        text = "traction and stick/slip fields: there is no march to take them from"
        left_out.append(Sentence(text, everywhere))
    return Plan(
        computed=tuple(computed),
        left_out=tuple(left_out),
        cautions=tuple(Sentence(text, everywhere) for text in cautions),
        marched=marched,
        psi2_error=_only(error),
    )


def _error(
    scene: Scene,
    normal: NormalMotion,
    tangential: TangentialLaw,
    integrator: Integrator,
    marched: Mask,
) -> Any:
    """Return the declared numerical error of psi2, an array of the scene's shape."""
    if not scene.shape and not marched:
        alone = abs(float(scene.psi1))
        most = max(1.0, alone) if math.isfinite(alone) else 1.0
        return np.array(CLOSED_FORM * most + normal.accuracy * 4.0 * float(scene.chi))
    with np.errstate(all="ignore"):
        psi1 = np.abs(scene.psi1)
        largest = np.maximum(1.0, np.where(np.isfinite(psi1), psi1, 1.0))
        known = CLOSED_FORM * largest + normal.accuracy * 4.0 * np.asarray(scene.chi)
        declared: Any = np.nan
        if marched.any():
            declared = integrator.psi2_error(normal, tangential, scene)
        return np.array(np.where(marched, declared, known))


def _said(error: Any, parted: Mask) -> list[Sentence]:
    """Return what a plan says of the numerical error."""
    undeclared = parted & np.isnan(error)
    found = []
    if (parted & ~undeclared).any():
        most = float(np.max(error[parted & ~undeclared]))
        text = f"numerical error of psi2: at most {most:.2g}, declared"
        found.append(Sentence(text, parted & ~undeclared))
    if undeclared.any():
        text = "numerical error of psi2: none is declared for these laws"
        found.append(Sentence(text, undeclared))
    return found


def _coarse(
    scene: Scene, error: Any, marched: Mask, tangential: TangentialLaw, integrator: Integrator
) -> list[str]:
    """Return the caution of steps or parts so coarse that no digit is sure."""
    unit, width, _ = range_of(scene)
    with np.errstate(all="ignore"):
        share = np.where(marched, error * np.divide(unit, width), 0.0)
    coarse = share > COARSE
    if not coarse.any():
        return []
    of = f" for {int(coarse.sum())} of {coarse.size} impacts" if coarse.ndim else ""
    finer = " and ".join(part.resolution for part in (tangential, integrator) if part.resolution)
    return [
        f"coarse{of}: the declared numerical error is {float(np.nanmax(share)):.2g} of the range "
        f"of psi2, so that no digit is sure; finer {finer} would help"
    ]


def _only(array: Any) -> Any:
    return array if np.ndim(array) else float(array)
