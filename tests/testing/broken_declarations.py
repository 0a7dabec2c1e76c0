"""Stepped laws that answer well, and break a clause of what is declared or of how they are made."""

from __future__ import annotations

from typing import Any, ClassVar

import attrs
from scipy.interpolate import PchipInterpolator

from contactlab.contracts import TangentialLaw
from contactlab.numeric.checks import POSITIVE, count, quantity
from tests.testing.broken_laws import Sound
from tests.testing.made import broken


class ExpectsTooMuch(Sound):
    expected_failures: ClassVar[dict] = {"units": "it says so, but it is not so"}


class OneOfThreeWays(TangentialLaw):
    """Derived from none of the contracts by which a law is run."""

    api_version: ClassVar[int] = 2


@attrs.define(kw_only=True)
class Mutable(Sound):
    def __setattr__(self, name, value):
        object.__setattr__(self, name, value)


@attrs.frozen(kw_only=True)
class CannotBePickled(Sound):
    rule: Any = attrs.field(factory=lambda: lambda value: value)


@attrs.frozen(kw_only=True)
class TakesAnything(Sound):
    extra: float = 1.0


@attrs.frozen(kw_only=True)
class TakesAnyFlag(Sound):
    flag: bool = False


@attrs.frozen(kw_only=True)
class TwoRequired(Sound):
    """Sound, with parameters that have no defaults."""

    stretch: float = quantity("m", rule=POSITIVE)
    count: int = count()


def _curve():
    """Stiffness over that of full stick, which depends on nothing."""
    return PchipInterpolator([0.0, 1.0, 2.0], [0.7, 0.7, 0.7])


@attrs.frozen(kw_only=True)
class Interpolates(Sound):
    """Sound, with an object that can be called among its attributes."""

    curve: Any = attrs.field(init=False, factory=_curve, eq=False)

    def stiffness(self, scene, normal):
        return float(self.curve(1.0)) / self.ratio * super().stiffness(scene, normal)


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (OneOfThreeWays, "contract", "The law must be derived from one of SteppedTangentialLaw"),
    (Mutable, "immutable", "ratio can be set"),
    (CannotBePickled, "copies", "CannotBePickled.<lambda>"),
    (TakesAnything, "parameters", "extra = nan: accepted without a ValueError"),
    (TakesAnyFlag, "parameters", "flag = nan: accepted without a ValueError"),
    *broken(Sound, "api_version",
        ("WrongVersion", 1, "api_version", "api_version = 1"),
    ),
    *broken(Sound, "expected_failures",
        ("ExpectsWithoutReason", {"units": ""}, "expected_failures", "'units' needs a reason"),
        ("ExpectsTheUnknown", {"unit": "there is no such check at all"},
         "expected_failures", "'unit', which is not a check"),
    ),
    *broken(Sound, "offers",
        ("OffersByParameter", property(lambda _: frozenset({"partial_slip"})),
         "contract", "offers must be a frozenset, a constant of the class; for words that"),
        ("Misspells", frozenset({"partialslip"}),
         "contract", "'partialslip' is a word that no check knows"),
    ),
    *broken(Sound, "book_bound",
        ("MisspellsMember", lambda *_: 0.1,
         "spelling", "book_bound is no member of its contracts: books_bound misspelt?"),
    ),
    *broken(Sound, "needs",
        ("NeedsTheUnknown", frozenset({"advance"}),
         "contract", "needs: 'advance' is a word that no check knows; there are: el"),
    ),
]  # fmt: skip
