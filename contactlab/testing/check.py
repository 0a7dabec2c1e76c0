"""What a check is: a named function that a law passes, or fails with a sentence."""

from __future__ import annotations

import unittest
from collections.abc import Callable
from typing import Any, TypeAlias

import attrs
import numpy as np

from contactlab.contracts import Law
from contactlab.testing.limits import SECONDS, OutOfTimeError, limited

Function: TypeAlias = Callable[[Any], None]


class CheckFailedError(AssertionError):
    """A law does not do what its contract says; the message is one sentence."""


class CheckStoppedError(CheckFailedError):
    """A check ran out of time: the law hangs, or crawls."""


class NotApplicableError(unittest.SkipTest):
    """A check has nothing to say of this law; the message says why. Pytest skips the test."""


@attrs.frozen
class Check:
    """One thing that a law's contract says.

    Attributes
    ----------
    name : str
        Under which a law may expect to fail it.
    function : callable
        Takes the law; raises ``CheckFailedError`` (or anything else) if the law fails.
    contract : type
        Laws of this class are put through it.
    claim : str or None
        A word of ``Law.offers``: only laws that offer it are put through the check, and
        those that expect to fail it.
    """

    name: str
    function: Function
    contract: type[Law]
    claim: str | None = None

    @property
    def holds(self) -> str:
        """What it holds, in one line: the first of the function's docstring."""
        return str(self.function.__doc__).strip().splitlines()[0]

    def __call__(self, law: Law, *, seconds: float = SECONDS) -> None:
        """Put ``law`` through it; NaN and infinity are given on purpose.

        Parameters
        ----------
        law : Law
        seconds : float
            Time that the check may take; see ``contactlab.testing.limits.limited``.

        Raises
        ------
        NotApplicableError
            If it does not apply: nothing was tried, so nothing was passed.
        CheckStoppedError
            If the law hangs or crawls.
        """
        try:
            with np.errstate(all="ignore"), limited(self.name, law, seconds):
                self.function(law)
        except OutOfTimeError as stopped:
            raise CheckStoppedError(str(stopped)) from None


#: Every check, in the order in which they are run.
CHECKS: list[Check] = []


def check(contract: type[Law], *, claim: str | None = None) -> Callable[[Function], Function]:
    """Return a decorator that enters a function among the checks, under its own name."""

    def enter(function: Function) -> Function:
        CHECKS.append(Check(function.__name__, function, contract, claim))
        return function

    return enter


def hold(condition: object, sentence: str) -> None:
    """Raise ``CheckFailedError`` unless the condition is true."""
    if not condition:
        raise CheckFailedError(sentence)


def apply_if(condition: object, sentence: str) -> None:
    """Raise ``NotApplicableError`` unless the condition is true."""
    if not condition:
        raise NotApplicableError(sentence)
