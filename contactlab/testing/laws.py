"""Laws with answers known beforehand, and faulty ones, on which integrators are tried."""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.bodies import Pair
from contactlab.checks import Real
from contactlab.contracts import (
    ClosedFormMotion,
    Course,
    Increment,
    NormalContact,
    NormalLaw,
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    Problem,
    SteppedTangentialLaw,
    TangentialResponse,
)

#: What a law may be asked for in one impact before it calls a halt.
MOST_CALLS = 3_000_000


class TooManyCallsError(RuntimeError):
    """An integrator asked without end."""


class Stretch(NamedTuple):
    """Stiffness over normal force, in 1/m, and the displacement so far, in m."""

    stiffness: Real
    displacement: Real


@attrs.frozen(kw_only=True)
class PressedSpring(SteppedTangentialLaw):
    """F = c P D: smooth from first touch to separation, where it vanishes.

    It heeds no limit: a yardstick for order, not a friction law.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"advance"})
    #: c P_max times the square of the unit of time, C²R/v1, over the tangential mass.
    strength: ClassVar[float] = 1.3

    def stiffness(self, problem: Problem) -> Real:
        """Return c P_max."""
        unit = self._unit(problem)
        return self.strength * problem.pair.tangential_mass / np.square(unit)

    def start(self, problem: Problem) -> Stretch:
        """Return the spring at rest."""
        nothing: Real = np.zeros(problem.shape) if problem.shape else 0.0
        greatest = 1.25 * problem.pair.normal_mass * problem.normal_speed / self._unit(problem)
        return Stretch(self.stiffness(problem) / greatest, nothing)

    def advance(
        self,
        state: Stretch,
        increment: Increment,
        before: NormalContact,  # noqa: ARG002
        after: NormalContact,
    ) -> tuple[TangentialResponse, Stretch]:
        """Stretch the spring."""
        displacement = state.displacement + increment.displacement
        force = state.stiffness * after.force * displacement
        return TangentialResponse(force, 0.0 * force), Stretch(state.stiffness, displacement)

    @staticmethod
    def _unit(problem: Problem) -> Real:
        return problem.maximum_radius**2 / problem.pair.radius / problem.normal_speed

    @classmethod
    def rebound(cls, motion: ClosedFormMotion) -> float:
        """Return the slip velocity after an impact over that before it.

        In scaled variables v' = -strength P D, D' = v, along the phase of the normal motion.
        """
        from scipy.integrate import solve_ivp

        def slope(phase: float, state: Any) -> list[float]:
            here = motion.instant(phase)
            return [-here.pace * cls.strength * here.force * state[1], here.pace * state[0]]

        solution = solve_ivp(
            slope, (0.0, math.pi), [1.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-14
        )
        return float(solution.y[0, -1])


@attrs.frozen(kw_only=True)
class FailingSpring(SteppedTangentialLaw):
    """A spring that answers NaN, or raises, at one step; the state counts the steps.

    At the step 0, which is the start, it can only raise.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"advance"})
    at: int = 7
    raises: bool = False

    def start(self, problem: Problem) -> tuple[int, Any]:  # noqa: ARG002
        """Return that no step was taken."""
        if self.raises and self.at == 0:
            raise ArithmeticError("as it was asked to")
        return 0, 0.0

    def advance(
        self,
        state: tuple[int, Any],
        increment: Increment,
        before: NormalContact,  # noqa: ARG002
        after: NormalContact,  # noqa: ARG002
    ) -> tuple[TangentialResponse, tuple[int, Any]]:
        """Answer with no force, until it fails."""
        count = state[0] + 1
        nothing = 0.0 * increment.displacement
        if count >= self.at:
            if self.raises:
                raise ArithmeticError("as it was asked to")
            nothing = nothing + math.nan
        return TangentialResponse(nothing, nothing), (count, nothing)


@attrs.frozen(kw_only=True)
class Sliding(Phase):
    """F = P, or NaN from some phase on."""

    fails_at: float = math.inf

    def respond(self, contact: Course, slip: Any, memo: Any) -> PhaseResponse:  # noqa: ARG002
        """Return P."""
        force = np.where(contact.phase < self.fails_at, contact.force, math.nan)
        return PhaseResponse(force, None, None, ())

    def friction_power(self, contact: Course, slip: Any, velocity: Any, response: Any) -> Any:  # noqa: ARG002
        """Return force times velocity."""
        return contact.force * velocity


@attrs.frozen(kw_only=True)
class SlidingForEver(PhasedTangentialLaw):
    """Slip in one direction from start to end.

    With ``fails`` it answers NaN from x = 1 on; with ``at_once`` it raises as it begins.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"phases"})
    exact: ClassVar[bool] = True
    fails: bool = False
    at_once: bool = False

    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:  # noqa: ARG002
        """Slide."""
        if self.at_once:
            raise ArithmeticError("as it was asked to")
        return Sliding(fails_at=1.0 if self.fails else math.inf)


@attrs.frozen(kw_only=True)
class LinearPress(NormalLaw):
    """P = k u: a half period of a sine, duration pi sqrt(M/k); it may fail, or never let go.

    Attributes
    ----------
    answers : str
        "force"; or from the step ``at`` on "nan"; or "nothing": in contact without any force.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"radius"})
    stiffness: float = 1e8
    answers: str = "force"
    at: int = 7

    def start(self, pair: Pair) -> int:  # noqa: ARG002
        """Return that it was never asked."""
        return 0

    def respond(self, state: int, approach: Real, rate: Real) -> tuple[NormalContact, int]:  # noqa: ARG002
        """Return the contact."""
        if state > MOST_CALLS:
            raise TooManyCallsError(f"The normal law was asked {MOST_CALLS} times.")
        compression: Any = approach * (approach > 0.0)
        if self.answers == "nothing":
            nothing = 0.0 * compression
            return NormalContact(nothing, nothing, nothing + 1e-6), state + 1
        factor = math.nan if self.answers == "nan" and state + 1 >= self.at else 1.0
        contact = NormalContact(
            factor * self.stiffness * compression, factor * compression, factor * approach
        )
        return contact, state + 1
