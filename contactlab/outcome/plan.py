"""What a scene needs, and what is left out and why, said before anything runs."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.arrays import share, taken
from contactlab.numeric.checks import Real
from contactlab.outcome.columns import json_value

Mask = NDArray[np.bool_]


class Sentence(NamedTuple):
    """A sentence of a plan, and the impacts that it is said of."""

    text: str
    where: Mask

    def __str__(self) -> str:
        """Return the sentence with its share of a batch."""
        if not self.where.ndim or self.where.all():
            return self.text
        head, colon, tail = self.text.partition(": ")
        return f"{head} ({share(self.where)}){colon}{tail}"


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
        it is not declared. The errors of the model are not in it: see ``cautions``.
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

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the words of ``str``."""
        return f"<pre>{html.escape(str(self))}</pre>"

    def to_dict(self) -> dict[str, Any]:
        """Return the sentences as plain lists, and the declared error."""
        return {
            "computed": list(map(str, self.computed)),
            "left_out": list(map(str, self.left_out)),
            "cautions": list(map(str, self.cautions)),
            "psi2_error": json_value(self.psi2_error),
        }

    def __getitem__(self, index: Any) -> Plan:
        """Return the plan of some impacts of a batch; sentences stay those of the batch."""
        error = taken(self.psi2_error, self.marched.shape, index)
        return attrs.evolve(self, marched=self.marched[index], psi2_error=error)

    @classmethod
    def nothing(cls, shape: tuple[int, ...]) -> Plan:
        """Return the plan of impacts of which nothing is known."""
        return cls(computed=(), left_out=(), marched=np.zeros(shape, dtype=bool))

    @classmethod
    def joined(cls, plans: Sequence[Plan], shape: tuple[int, ...] = (-1,)) -> Plan:
        """Return the plan of a batch of ``shape`` from those of its parts, in order."""
        sizes = [plan.marched.size for plan in plans]
        if len(plans) == 1 and shape == (-1,) and np.shape(plans[0].psi2_error) == (*sizes,):
            return plans[0]
        errors = [
            np.broadcast_to(plan.psi2_error, size) for plan, size in zip(plans, sizes, strict=True)
        ]
        kinds = {
            kind: _together([getattr(plan, kind) for plan in plans], sizes)
            for kind in ("computed", "left_out", "cautions")
        }
        return cls(
            **kinds,
            marched=np.concatenate([np.ravel(plan.marched) for plan in plans]).reshape(shape),
            psi2_error=np.concatenate(errors).reshape(shape),
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
