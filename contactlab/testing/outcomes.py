"""Putting a law through the checks, and saying what came out."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from enum import Enum

import attrs

from contactlab.compose.registry import REGISTRY
from contactlab.contracts import Law
from contactlab.testing.check import (
    CHECKS,
    Check,
    CheckFailedError,
    CheckStoppedError,
    NotApplicableError,
)
from contactlab.testing.limits import MOST_TIMEOUTS, SECONDS


class Verdict(Enum):
    """How a check ended; the last two are not as they should be."""

    PASSED = "passed"
    EXPECTED_FAILURE = "expected failure"
    NOT_CLAIMED = "not claimed"
    NOT_APPLICABLE = "not applicable"
    FAILED = "failed"
    UNEXPECTED_PASS = "unexpected pass"

    @property
    def good(self) -> bool:
        """Whether the law is as it says it is."""
        return self not in (Verdict.FAILED, Verdict.UNEXPECTED_PASS)


@attrs.frozen
class Outcome:
    """One check of one law: its name, the verdict, a sentence, and whether time ran out."""

    check: str
    verdict: Verdict
    sentence: str
    out_of_time: bool = False


class ConformanceError(AssertionError):
    """A law fails checks that it does not expect to fail, or passes one that it does."""


def checks_for(law: Law | str) -> list[Check]:
    """Return the checks that apply to ``law``, an object or a name, in order."""
    made = made_law(law)
    return [check for check in CHECKS if isinstance(made, check.contract)]


def claimed(law: Law, check: Check) -> bool:
    """Return whether ``law`` is put through ``check``: see ``Check.claim``."""
    return check.claim is None or check.claim in law.offers or check.name in expected(law)


def expected(law: Law) -> dict[str, str]:
    """Return the checks that ``law`` says it fails, with its reasons."""
    return dict(getattr(law, "expected_failures", {}))


def outcome(law: Law, check: Check, *, seconds: float = SECONDS) -> Outcome:
    """Put ``law`` through one check.

    Parameters
    ----------
    law : Law
    check : Check
    seconds : float
        Time that the check may take.
    """
    if not claimed(law, check):
        return Outcome(check.name, Verdict.NOT_CLAIMED, f"The law does not offer {check.claim!r}.")
    reason = expected(law).get(check.name)
    try:
        check(law, seconds=seconds)
    except CheckStoppedError as stopped:
        return Outcome(check.name, Verdict.FAILED, str(stopped), out_of_time=True)
    except NotApplicableError as reason_why:
        return Outcome(check.name, Verdict.NOT_APPLICABLE, str(reason_why))
    except CheckFailedError as failure:
        sentence = str(failure)
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        sentence = f"Raised {type(error).__name__}: {error} (in {where.name}, line {where.lineno})"
    else:
        if reason is None:
            return Outcome(check.name, Verdict.PASSED, check.holds)
        return Outcome(check.name, Verdict.UNEXPECTED_PASS, f"The law says it fails: {reason}")
    if reason is None:
        return Outcome(check.name, Verdict.FAILED, sentence)
    return Outcome(check.name, Verdict.EXPECTED_FAILURE, reason)


def examine(
    law: Law | str,
    *,
    progress: Callable[[int, int], object] | None = None,
    seconds: float = SECONDS,
) -> list[Outcome]:
    """Put a law through every check that applies to it, and return what came out.

    Parameters
    ----------
    law : Law or str
        An object, or the name of an installed law, which is made with its defaults.
    progress : callable, optional
        Called as ``progress(done, total)`` after each check.
    seconds : float
        Time that each check may take. After three that ran out of it the others are not tried.
    """
    made = made_law(law)
    checks = checks_for(made)
    outcomes: list[Outcome] = []
    for done, check in enumerate(checks, 1):
        if sum(one.out_of_time for one in outcomes) >= MOST_TIMEOUTS:
            left = f"Not tried: {MOST_TIMEOUTS} checks before it ran out of time."
            outcomes.append(Outcome(check.name, Verdict.FAILED, left))
        else:
            outcomes.append(outcome(made, check, seconds=seconds))
        if progress is not None:
            progress(done, len(checks))
    return outcomes


def check_law(law: Law | str, *, seconds: float = SECONDS) -> list[Outcome]:
    """Put a law through every check that applies to it, and refuse it if it is not as it says.

    Parameters
    ----------
    law : Law or str
        An object, or the name of an installed law, which is made with its defaults.
    seconds : float
        Time that each check may take: a law that hangs is told so.

    Raises
    ------
    ConformanceError
        Naming each check failed, or passed against expectation, with its sentence.
    """
    outcomes = examine(law, seconds=seconds)
    bad = [entry for entry in outcomes if not entry.verdict.good]
    if bad:
        lines = [f"{entry.check}: {entry.verdict.value}: {entry.sentence}" for entry in bad]
        raise ConformanceError(
            f"{REGISTRY.describe(made_law(law))}: {len(bad)} of {len(outcomes)} checks\n"
            + "\n".join(lines)
        )
    return outcomes


def made_law(law: Law | str) -> Law:
    """Return the law that a name stands for, or the law itself."""
    made: Law = REGISTRY.create(law) if isinstance(law, str) else law
    return made
