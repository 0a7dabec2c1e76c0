"""Outcome of one case: answered, refused, raised or silently wrong."""

from __future__ import annotations

import time

import attrs
import numpy as np

from contactlab.contracts import ClosedFormNormalLaw, claims
from contactlab.contracts.status import Status
from contactlab.impact.error_model import LARGEST_SHARE, range_of
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.motion import Motion, sound
from contactlab.outcome.plan import MARCHED, Plan, PlanColumns
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.registry.registry import PluginError
from contactlab.runs.simulation import Simulation
from contactlab.solve.error_estimate import estimate_errors
from contactlab.solve.solved_motion import ACCURACY
from contactlab.study.posed import pose
from contactlab.study.stability_cases import Cell
from contactlab.study.stability_coupled import (
    RIGID_DISTANCE,
    STIFF,
    distance,
    in_space,
    refine_in_space,
)
from contactlab.study.stability_references import (
    SETTLED,
    Reference,
    itself,
    load_impulse,
    reference_for,
)

#: Outcomes. Only the last two are failures of the program.
ANSWERED, REFUSED, SKIPPED = "answered", "refused", "skipped"
WRONG, RAISED = "silently wrong", "raised"
#: Outcome of an answer without a reference: only its signs and energy books are judged.
NO_REFERENCE = "no reference"
#: Rounding, over the range of psi2.
ROUNDING = 1e-9
#: Bound, over the range, for a law that declares no error: its error, and broken invariants.
UNDECLARED = 0.01
#: Bound over the estimated error, where that exceeds ``UNDECLARED``: estimates are mostly within
#: a factor of three of the error.
ESTIMATED = 3.0
#: Bound of the imbalance of the energy books, over the energy at the start: an integrator that
#: controls its error adds up friction work less accurately than velocities.
BOOKS = 1e-5
#: Bound of energy from nothing, over the energy at the start, however coarse the method.
LARGEST_GAIN = 0.1
#: Both bounds where friction changes the approach: of the books of a law that declares none, and
#: of the gain.
BODIES_BOOKS, BODIES_GAIN = 1e-3, 1e-3
#: Bound of e - 1 under a law with a closed-form motion, and of 1 - e if elastic, however few steps.
LARGEST_NORMAL = 1e-9


@attrs.frozen(kw_only=True)
class Outcome:
    """One case judged.

    Attributes
    ----------
    error, bound : float
        Error of the change of slip velocity and its bound, over the range; NaN without an answer.
        The bound of a law that declares no error is ``UNDECLARED``, or ``ESTIMATED`` times the
        estimated error where that is larger. Where friction changes the approach, ``error`` is the
        distance from rigid bodies.
    note : str
        The status, or the sentences on what is wrong.
    """

    method: str
    family: str
    case: str
    outcome: str
    error: float = np.nan
    bound: float = np.nan
    note: str = ""
    run_time_s: float = 0.0

    @property
    def compared(self) -> bool:
        """True for an answer that was compared with a reference."""
        return self.outcome in (ANSWERED, WRONG) and not np.isnan(self.error)

    @classmethod
    def of(cls, case: Cell, outcome: str, note: str = "") -> Outcome:
        """Return the outcome of a case without an error."""
        name = case.method.name
        return cls(method=name, family=case.family, case=case.label, outcome=outcome, note=note)


def judge(case: Cell) -> Outcome:
    """Return the outcome of one case."""
    try:
        scene = case.scene.make()
        simulation = case.method.simulation(case.options, normal=case.normal)
    except (ValueError, PluginError) as error:
        return Outcome.of(case, REFUSED, f"bad input: {error}")
    return judge_run(case, simulation, scene)


def judge_run(
    case: Cell,
    simulation: Simulation,
    scene: Scene,
    reference: Reference | None = None,
) -> Outcome:
    """Return the outcome of one scene, its answer judged against ``reference``.

    Parameters
    ----------
    case : Cell
        Names the outcome; without ``planned`` the integrator marches the impact.
    simulation : Simulation
    scene : Scene
    reference : callable, optional
        Returns the exact change of slip velocity in m/s, or None if there is none; by default
        ``reference_for`` the laws.
    """
    scene = pose(scene, simulation.laws)
    before = time.perf_counter()
    try:
        with np.errstate(all="ignore"):
            result = simulation.run(scene) if case.planned else march_impact(simulation, scene)
    except Exception as error:
        # Any exception is an outcome, and the report goes on. A planned run turns an exception of
        # the integrator into a status; a march does not.
        note = f"{type(error).__name__}: {error}"
        if case.planned:
            return Outcome.of(case, RAISED, note)
        return Outcome.of(case, REFUSED, f"LAW_RAISED {note}")
    took = time.perf_counter() - before
    if result.status is not Status.SUCCESS:
        note = f"{result.status.name} {result.motion.detail}"
        return attrs.evolve(Outcome.of(case, REFUSED, note), run_time_s=took)
    try:
        with np.errstate(all="ignore"):
            if result.scene.inverse_mass is not None:
                off, bound, wrong = _of_bodies(simulation, result)
            else:
                against = reference or reference_for(simulation.tangential, simulation.normal)
                off, bound, wrong = _of_spheres(simulation, result, against)
    except Exception as error:
        note = f"its reference: {type(error).__name__}: {error}"
        return attrs.evolve(Outcome.of(case, RAISED, note), run_time_s=took)
    note = "; ".join(wrong) or (NO_REFERENCE if np.isnan(off) else "")
    outcome = Outcome.of(case, WRONG if wrong else ANSWERED, note)
    return attrs.evolve(outcome, error=off, bound=bound, run_time_s=took)


def march_impact(simulation: Simulation, scene: Scene) -> ImpactResult:
    """Return the result of an impact marched by the integrator, without whole-impact answers."""
    law, integrator = simulation.tangential, simulation.integrator
    normal = simulation.normal_motion(scene)
    tangential = integrator.integrate(scene, normal, law, None)
    code = np.full(scene.shape, MARCHED)
    plan = Plan(PlanColumns(code, integrator.errors(scene, normal, law).psi2))
    motion = sound(Motion.combine(normal, tangential))
    return ImpactResult(scene=scene, plan=plan, motion=motion, run_time=0.0, laws={})


def _of_spheres(
    simulation: Simulation, result: ImpactResult, reference: Reference
) -> tuple[float, float, list[str]]:
    """Return error and bound over the range of psi2, and what breaks."""
    unit, width, _ = map(float, range_of(result.scene))
    expected, error = reference(result.scene, simulation.tangential), np.nan
    if expected is not None:
        difference = abs(float(result.motion.slip_velocity_change) - expected)
        error = difference / width if width > 0.0 else (0.0 if difference == 0.0 else np.inf)
    excess = error - (SETTLED if reference is itself else 0.0)
    declared = float(result.plan.psi2_error) * unit
    bound = min(declared / width + ROUNDING, LARGEST_SHARE) if width > 0.0 else ROUNDING
    undeclared = np.isnan(bound)
    wrong = _wrong(simulation, result, excess, bound := UNDECLARED if undeclared else bound)
    if wrong and undeclared:
        estimate = float(np.asarray(estimate_errors(simulation.laws, result)[0])) * unit / width
        bound = min(max(bound, ESTIMATED * estimate), LARGEST_SHARE)
        wrong = _wrong(simulation, result, excess, bound)
    return float(error), bound, wrong


def _of_bodies(simulation: Simulation, result: ImpactResult) -> tuple[float, float, list[str]]:
    """Return the distance from rigid bodies, NaN of a soft contact, its bound, and what breaks."""
    law, books, wrong = simulation.tangential, result.energy, []
    numbers = (result.normal_velocity, result.psi2, books.end, books.imbalance)
    if not all(np.isfinite(number).all() for number in numbers):
        return np.nan, UNDECLARED, ["a number that is not finite"]
    if "books" not in law.expected_failures:
        start: Real = books.start
        bound = law.books_bound(result.scene.central)
        bound = max(BODIES_BOOKS, bound if np.isfinite(bound) else 0.0)
        if books.end > start * (1.0 + BODIES_GAIN):
            wrong.append(f"{float(books.end / start - 1.0):.2g} of the energy from nothing")
        if abs(books.imbalance) > bound * start:
            wrong.append("energy books do not close")
    if "partial_slip" not in claims(law):
        return np.nan, UNDECLARED, wrong
    if in_space(result.scene):
        return _of_space(simulation, result, wrong)
    if result.scene.pair.stiffness_ratio < STIFF:
        return np.nan, UNDECLARED, wrong
    rigid = Simulation(tangential=composition.RIGID["tangential"]).run(result.scene).check()
    error = float(distance(result, rigid))
    if error > RIGID_DISTANCE * float(result.scene.pair.stiffness_ratio) ** -0.5 + UNDECLARED:
        wrong.append(f"{error:.2g} of v1 from rigid bodies")
    return error, UNDECLARED, wrong


def _of_space(
    simulation: Simulation, result: ImpactResult, wrong: list[str]
) -> tuple[float, float, list[str]]:
    """Return error and bound over 2 |psi1| of a slip that turns, and what breaks."""
    expected = refine_in_space(simulation.tangential, result.scene)
    if expected is None:
        return np.nan, UNDECLARED, wrong
    width = 2.0 * float(np.linalg.norm(result.scene.psi1))
    declared = float(np.nan_to_num(np.max(result.plan.psi2_error))) / width
    error = float(np.linalg.norm(np.asarray(result.psi2) - expected)) / width
    bound = min(declared + UNDECLARED, LARGEST_SHARE)
    if error > bound:
        wrong.append(f"error {error:.2g} of the range, at most {bound:.2g} is declared")
    return error, bound, wrong


def _wrong(simulation: Simulation, result: ImpactResult, error: float, bound: float) -> list[str]:
    """Return sentences on what exceeds ``bound``; ``error`` is without its uncertainty."""
    normal, tangential = simulation.normal, simulation.tangential
    elastic = "elastic_hertz" in claims(normal)
    wrong = find_breaches(
        result,
        bound,
        passive="books" not in tangential.expected_failures,
        books_bound=float(np.max(tangential.books_bound(result.scene))),
        load_impulse=None if elastic else load_impulse(result.scene, normal),
    )
    if error > bound:
        wrong.append(
            f"error {error:.2g} of the range, at most {bound:.2g} is declared or estimated"
        )
    excess = float(np.asarray(result.normal_restitution)) - 1.0
    allowed = LARGEST_NORMAL if isinstance(normal, ClosedFormNormalLaw) else ACCURACY
    if not excess <= allowed or (elastic and not excess >= -allowed):
        wrong.append(f"e is off by {excess:.2g}")
    return wrong


def find_breaches(
    result: ImpactResult,
    bound: float,
    *,
    passive: bool = True,
    books_bound: float = 0.0,
    load_impulse: float | None = None,
) -> list[str]:
    """Return sentences on the invariants of theory §7 that a result breaks.

    Parameters
    ----------
    result : ImpactResult
    bound : float
        Declared or estimated error of psi2, over its range.
    passive : bool
        False for a law that expects its energy books not to close, because its model makes energy.
    books_bound : float
        Declared imbalance of the books, over the energy at the start.
    load_impulse : float, optional
        Impulse of the friction load, in N s; by default that of an elastic impact.
    """
    scene, motion = result.scene, result.motion
    _, width, speed = map(float, range_of(scene))
    if load_impulse is not None:
        sliding = scene.friction_coefficient * load_impulse / scene.pair.tangential_mass
        width = min(float(sliding), 2.0 * speed)
    change, rate = float(motion.slip_velocity_change), float(motion.normal_velocity)
    numbers = (change, rate, float(motion.duration), float(motion.friction_work))
    if not np.all(np.isfinite(numbers)):
        return ["a number that is not finite"]
    if width == 0.0:
        return [] if change == 0.0 else ["a change of velocity where nothing can act"]
    broken = []
    allowed = min(bound, LARGEST_GAIN)
    slowed = -change * np.sign(float(scene.slip_velocity))
    if slowed < -allowed * width and passive:
        broken.append("friction speeds the slip up")
    slides = width < 2.0 * speed  # the range is the change by slip throughout, 4 chi
    if slowed > (1.0 + allowed) * width and (passive or slides):
        broken.append(
            "|psi2 - psi1| beyond what mu times the load can do" if slides else "|psi2| > |psi1|"
        )
    if not passive:
        return broken
    books = result.energy
    scale = 0.5 * float(scene.pair.normal_mass * scene.normal_speed**2)
    scale += float(scene.pair.tangential_mass) * width * speed
    allowed_books = max(bound, BOOKS, min(books_bound, LARGEST_GAIN))
    if not abs(float(books.imbalance)) <= allowed_books * scale:
        broken.append("energy books do not close")
    if float(books.friction_work) < -allowed * scale:
        broken.append("friction does work on the bodies")
    return broken
