"""A check: a named function that a law passes, or fails with a sentence."""

from __future__ import annotations

import unittest
from collections.abc import Callable
from typing import Any, TypeAlias

import attrs
import numpy as np
from numpy.typing import ArrayLike

from contactlab.contracts import Law, TangentialMotion, claims
from contactlab.contracts.status import Status
from contactlab.testing.limits import SECONDS, OutOfTimeError, limit_time

Function: TypeAlias = Callable[[Any], None]


#: Why laws fail checks by their nature, for several checks.
CHANGES = "a stiffness that changes with the load keeps no energy books"
GROWS = "a stretch that stays as the stiffness grows with the load gives energy"
WHOLE = "one spring for the whole contact, or bodies that do not deform tangentially"


class CheckFailedError(AssertionError):
    """A law breaks its contract; the message is one sentence."""


class CheckStoppedError(CheckFailedError):
    """A check ran out of time, because the law hangs or is very slow."""


class NotApplicableError(unittest.SkipTest):
    """A check does not apply to a law; the message says why. Pytest skips the test."""


@attrs.frozen
class Check:
    """One requirement of a contract.

    Attributes
    ----------
    name : str
        Name of the check, used as key in ``Law.expected_failures``.
    function : callable
        Takes the law; raises ``CheckFailedError`` or another exception if the law fails.
    contracts : tuple of type
        The check applies to laws of these classes.
    claim : str or None
        A word of ``Law.offers``. If not None, the check applies only to laws that offer the word,
        or that expect to fail the check.
    nature : str
        Why a law may fail the check by its nature; empty if no model does.
    word : tuple of str and bool, or None
        Word of the law's class and its value, if the check applies only to such laws.
    """

    name: str
    function: Function
    contracts: tuple[type[Law], ...]
    claim: str | None = None
    nature: str = ""
    word: tuple[str, bool] | None = None

    def applies_to(self, law: Law) -> bool:
        """Return whether ``law`` has the contract of the check, and its word.

        Parameters
        ----------
        law : Law
        """
        if not isinstance(law, self.contracts):
            return False
        return self.word is None or (self.word[0] in claims(law)) == self.word[1]

    @property
    def holds(self) -> str:
        """The requirement in one line: the first line of the function's docstring."""
        return str(self.function.__doc__).strip().splitlines()[0]

    def __call__(self, law: Law, *, seconds: float = SECONDS) -> None:
        """Check ``law``; warnings on NaN and infinity are off, because checks pass them on purpose.

        Parameters
        ----------
        law : Law
        seconds : float
            Time limit of the check; see ``contactlab.testing.limits.limit_time``.

        Raises
        ------
        CheckFailedError
            If the law fails; an exception of the law itself passes through unchanged.
        NotApplicableError
            If the check does not apply to the law, and nothing was tried.
        CheckStoppedError
            If the check runs out of time.
        """
        try:
            with np.errstate(all="ignore"), limit_time(self.name, law, seconds):
                self.function(law)
        except OutOfTimeError as stopped:
            raise CheckStoppedError(str(stopped)) from None
        except CheckFailedError as failure:
            if not self.nature:
                raise
            told = f"If that is the law's nature ({self.nature}), it is named in expected_failures"
            raise CheckFailedError(f"{failure} {told}, with the reason.") from None


#: Every check, in the order in which the checks run.
CHECKS: list[Check] = []


def check(
    *contracts: type[Law],
    claim: str | None = None,
    nature: str = "",
    word: tuple[str, bool] | None = None,
) -> Callable[[Function], Function]:
    """Return a decorator that enters a function in ``CHECKS``, under the function's name."""

    def enter(function: Function) -> Function:
        CHECKS.append(Check(function.__name__, function, contracts, claim, nature, word))
        return function

    return enter


def hold(condition: object, sentence: str) -> None:
    """Raise ``CheckFailedError`` unless the condition is true."""
    if not condition:
        raise CheckFailedError(sentence)


def within(value: float, bound: float, sentence: str) -> None:
    """Raise ``CheckFailedError`` with ``sentence`` and the bound unless ``value`` is within it."""
    hold(value <= bound, f"{sentence.rstrip()} Bound: {float(bound):.2g}.")


def worst(values: ArrayLike) -> float:
    """Return the largest magnitude; infinity if a value is NaN."""
    return float(np.nan_to_num(np.max(np.abs(values)), nan=np.inf))


def hold_success(motion: TangentialMotion, words: str = "{}") -> None:
    """Hold that every impact was followed to its end; ``words`` get status and detail of one."""
    pair = (np.asarray(entry, dtype=object) for entry in (motion.status, motion.detail))
    for status, detail in np.broadcast(*pair):
        told = f"{getattr(status, 'name', status)} {detail}".strip()
        hold(status is Status.SUCCESS, words.format(told))


def apply_if(condition: object, sentence: str) -> None:
    """Raise ``NotApplicableError`` unless the condition is true."""
    if not condition:
        raise NotApplicableError(sentence)
