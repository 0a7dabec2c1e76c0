"""Running the checks on a law, and their outcomes."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from enum import Enum

import attrs

from contactlab.contracts import Law, claims
from contactlab.registry.registry import REGISTRY
from contactlab.testing.check import (
    CHECKS,
    Check,
    CheckFailedError,
    CheckStoppedError,
    NotApplicableError,
)
from contactlab.testing.limits import MOST_TIMEOUTS, SECONDS, OutOfTimeError, limit_time

#: Last line of a report with failures.
REMEDY = (
    "A failure by the law's nature is named in its class with the reason: "
    'expected_failures: ClassVar = {"check": "reason"}'
)


class Verdict(Enum):
    """How a check ended; ``FAILED`` and ``UNEXPECTED_PASS`` are faults of the law."""

    PASSED = "passed"
    EXPECTED_FAILURE = "expected failure"
    NOT_CLAIMED = "not claimed"
    NOT_APPLICABLE = "not applicable"
    FAILED = "failed"
    UNEXPECTED_PASS = "unexpected pass"

    @property
    def good(self) -> bool:
        """Whether the law does what it states."""
        return self not in (Verdict.FAILED, Verdict.UNEXPECTED_PASS)


@attrs.frozen
class Outcome:
    """One check of one law: its name, the verdict, a sentence, and whether time ran out."""

    check: str
    verdict: Verdict
    sentence: str
    out_of_time: bool = False


class ConformanceError(AssertionError):
    """A law fails checks unexpectedly, or passes checks that it expects to fail."""


def checks_for(law: Law | str) -> list[Check]:
    """Return the checks of the contracts of ``law``, an object or a name, in order."""
    made = make_law(law)
    return [check for check in CHECKS if check.applies_to(made)]


def applies(law: Law, check: Check) -> bool:
    """Return whether ``check`` applies to ``law`` by its claim; see ``Check.claim``."""
    return check.claim is None or check.claim in claims(law) or check.name in expects_to_fail(law)


def expects_to_fail(law: Law) -> dict[str, str]:
    """Return the checks that ``law`` expects to fail, with its reasons."""
    return dict(getattr(law, "expected_failures", {}))


def outcome(law: Law, check: Check, *, seconds: float = SECONDS) -> Outcome:
    """Return the outcome of one check of ``law``.

    Parameters
    ----------
    law : Law
    check : Check
    seconds : float
        Time limit of the check, in s.
    """
    if not applies(law, check):
        return Outcome(check.name, Verdict.NOT_CLAIMED, f"The law does not offer {check.claim!r}.")
    reason = expects_to_fail(law).get(check.name)
    try:
        check(law, seconds=seconds)
    except CheckStoppedError as stopped:
        return Outcome(check.name, Verdict.FAILED, str(stopped), out_of_time=True)
    except NotApplicableError as inapplicable:
        return Outcome(check.name, Verdict.NOT_APPLICABLE, str(inapplicable))
    except CheckFailedError as failure:
        sentence = str(failure)
    except (Exception, SystemExit) as error:  # a law may not end the process
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
    """Return the outcomes of every check of the contracts of a law.

    Parameters
    ----------
    law : Law or str
        A law, or the name of an installed law, which is made with its defaults.
    progress : callable, optional
        Called as ``progress(done, total)`` after each check.
    seconds : float
        Time limit of each check, in s. After three checks out of time the others are not tried.

    Raises
    ------
    TimeoutError
        If the law cannot be imported and made in that time.
    """
    try:
        with limit_time("loading", law, seconds):
            made = make_law(law)
    except OutOfTimeError:
        rule = f"its module or its class did not return within {seconds:g} s of computing"
        raise TimeoutError(f"{law}: {rule}; it is imported and made before it is checked") from None
    checks = checks_for(made)
    outcomes: list[Outcome] = []
    for done, check in enumerate(checks, 1):
        if sum(entry.out_of_time for entry in outcomes) >= MOST_TIMEOUTS:
            not_tried = f"Not tried: {MOST_TIMEOUTS} checks before it ran out of time."
            outcomes.append(Outcome(check.name, Verdict.FAILED, not_tried))
        else:
            outcomes.append(outcome(made, check, seconds=seconds))
        if progress is not None:
            progress(done, len(checks))
    return outcomes


def check_law(law: Law | str, *, seconds: float = SECONDS) -> list[Outcome]:
    """Return the outcomes of every check of a law, and raise if one is a fault of the law.

    Parameters
    ----------
    law : Law or str
        A law, or the name of an installed law, which is made with its defaults.
    seconds : float
        Time limit of each check, in s.

    Raises
    ------
    ConformanceError
        If a check fails, or passes unexpectedly; the message has the sentence of each.
    """
    outcomes = examine(law, seconds=seconds)
    bad = [entry for entry in outcomes if not entry.verdict.good]
    if bad:
        lines = [f"{entry.check}: {entry.verdict.value}: {entry.sentence}" for entry in bad]
        raise ConformanceError(
            f"{REGISTRY.describe(make_law(law))}: {len(bad)} of {len(outcomes)} checks\n"
            + "\n".join([*lines, REMEDY])
        )
    return outcomes


def make_law(law: Law | str) -> Law:
    """Return the law that a name stands for, or the law itself."""
    made: Law = REGISTRY.create(law) if isinstance(law, str) else law
    return made
