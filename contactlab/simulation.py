"""A simulation: three laws composed, ready to plan, run and sweep."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import attrs
import numpy as np

from contactlab import composition, faults
from contactlab.checks import Real, refuse, whole
from contactlab.contracts.integrator import (
    Integrator,
    Motion,
    Problem,
    Sample,
)
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.declared import psi2_error, told
from contactlab.energy import balanced
from contactlab.history import Recorder
from contactlab.plan import Plan, make_plan
from contactlab.result import ImpactResult
from contactlab.scene import Scene
from contactlab.soundness import sound
from contactlab.status import Status

#: Impacts of a sweep advanced together: enough to hide the cost of a call, few enough that
#: an interruption loses little. Without a gain, where they are followed one by one, fewer.
CHUNK, CHUNK_ONE_BY_ONE = 1000, 20
#: So many impacts of a batch that failed are tried one by one; more are halved first.
FEW = 8
#: Friction work over the energy at the start is this many times less accurate than psi2.
WORK_ACCURACY = 10.0
#: Instants in the history of an impact that is done in closed form.
CLOSED_FORM_INSTANTS = 201


@attrs.frozen(kw_only=True, init=False)
class Simulation:
    """A normal law, a tangential law and an integrator, composed.

    Parameters
    ----------
    normal, tangential, integrator : str or law
        A name (``"hertz"``), or an object made by ``contactlab.create`` or by your own class.
        The default is exact: Hertz's closed form and the slip front followed event by event.
        Where no integrator is named ``events`` is taken, or ``symplectic`` where that does not
        fit the two laws.

    Raises
    ------
    ValueError
        If a name is not installed, or the laws do not fit together (naming what would).
    """

    normal: NormalLaw
    tangential: TangentialLaw
    integrator: Integrator

    def __init__(
        self,
        *,
        normal: str | NormalLaw = "hertz",
        tangential: str | TangentialLaw = "fronts",
        integrator: str | Integrator | None = None,
    ) -> None:
        parts = {
            "normal": composition.law("normal", normal),
            "tangential": composition.law("tangential", tangential),
        }
        chosen = composition.fitting_integrator(**parts) if integrator is None else integrator
        parts["integrator"] = composition.law("integrator", chosen)
        composition.check_fit(**parts)
        self.__attrs_init__(**parts)

    def plan(self, scene: Scene, *, history: bool | str = False) -> Plan:
        """Say what ``run`` would compute for ``scene``, what it leaves out and why."""
        plan = make_plan(
            _scene(scene), self.normal, self.tangential, self.integrator, history=_asked(history)
        )
        problem = self.problem(scene)
        error, share = psi2_error(scene, problem, self.integrator, plan.marched)
        if not plan.marched.any():
            return attrs.evolve(plan, psi2_error=error)
        said, remarks = told(error, share, problem, self.integrator)
        return attrs.evolve(
            plan,
            computed=plan.computed + said,
            cautions=plan.cautions + self.integrator.remarks(problem) + remarks,
            psi2_error=error,
        )

    def run(self, scene: Scene, *, history: bool | str = False) -> ImpactResult:
        """Run one impact, or a batch scene at once.

        Parameters
        ----------
        scene : Scene
        history : bool or "fields"
            Keep the course of the impact; ``"fields"`` keeps traction and stick/slip too.

        Returns
        -------
        ImpactResult
            A numerical failure is a status, with the history so far; ``.check()`` raises it.

        Raises
        ------
        ValueError
            If ``scene`` is no scene, ``history`` none of its three values, or a history is asked
            of a batch whose impacts have instants of their own.
        """
        started = time.perf_counter()
        plan = self.plan(scene, history=history)
        if history and scene.shape and not self.integrator.common_instants:
            raise refuse(
                "history",
                history,
                f"impacts of a batch have instants of their own under {self.integrator!r}",
                "run them one by one",
            )
        recorder = Recorder(scene.shape, with_fields=history == "fields") if history else None
        if plan.marched.all():
            motion = self._integrate(scene, recorder)
        elif not plan.marched.any():
            motion = self._closed_form(scene, plan, recorder)
        else:
            motion = self._mixed(scene, plan)
        return ImpactResult(
            scene=scene,
            plan=plan,
            motion=balanced(sound(motion), scene, self._books_bound()),
            laws=composition.versions(self.normal, self.tangential, self.integrator),
            history=recorder.history() if recorder else None,
            run_time=time.perf_counter() - started,
        )

    def sweep(
        self,
        scenes: Scene | Sequence[Scene],
        *,
        progress: Callable[[int, int], object] | None = None,
        chunk: int | None = None,
    ) -> ImpactResult:
        """Run many impacts, vectorised, a chunk at a time.

        Parameters
        ----------
        scenes : sequence of Scene, or a batch scene
        progress : callable, optional
            Called as ``progress(done, total)`` after each chunk.
        chunk : int, optional
            Impacts advanced together, which bounds the memory and what an interruption
            loses; 1000, or 20 under an integrator that follows them one by one.

        Returns
        -------
        ImpactResult
            A batch. Interrupting (Ctrl-C) keeps what is done; the rest has the status
            ``INTERRUPTED``, which ``.check()`` raises.

        Raises
        ------
        ValueError
            If the scenes are none, not alike (bodies beside psi1 and chi) or no scenes.
        """
        started = time.perf_counter()
        batch = scenes if isinstance(scenes, Scene) else Scene.stack(scenes)
        if len(batch.shape) != 1:
            raise refuse(
                "scenes",
                batch.shape,
                "must be a sequence, or a one-dimensional batch",
                "for one impact use run",
            )
        if chunk is None:
            chunk = CHUNK if self.integrator.together else CHUNK_ONE_BY_ONE
        size, step = batch.shape[0], whole("chunk", chunk)
        motions: list[Motion] = []
        done = 0
        try:
            while done < size:
                part = batch.take(slice(done, min(done + step, size)))
                motions.append(self.run(part).motion)
                done += part.shape[0]
                if progress is not None:
                    progress(done, size)
        except KeyboardInterrupt:
            done = sum(np.size(motion.duration) for motion in motions)
            if done < size:
                motions.append(Motion.nothing((size - done,), Status.INTERRUPTED))
        return ImpactResult(
            scene=batch,
            plan=self.plan(batch),
            motion=Motion.joined(motions, batch.shape),
            laws=composition.versions(self.normal, self.tangential, self.integrator),
            run_time=time.perf_counter() - started,
        )

    def problem(self, scene: Scene) -> Problem:
        """Return what the integrator will be given for ``scene``."""
        return Problem(
            normal=self.normal,
            tangential=self.tangential,
            pair=scene.pair,
            friction_coefficient=scene.friction_coefficient,
            normal_speed=scene.normal_speed,
            slip_velocity=scene.slip_velocity,
            maximum_radius=scene.maximum_radius,
            duration=scene.duration,
            shape=scene.shape,
        )

    def _books_bound(self) -> float:
        """Return what the books may miss by: the law's own bound, and the integrator's share."""
        return self.tangential.books_bound + WORK_ACCURACY * (self.integrator.accuracy or 0.0)

    def _integrate(self, scene: Scene, recorder: Recorder | None) -> Motion:
        """Return the motion; a failure within a batch is traced, by halves, to those that fail."""
        problem, shape = self.problem(scene), scene.shape
        motion, raised = self._attempt(problem, recorder)
        if not shape or recorder or np.all(motion.status):
            return motion
        if not (raised or self.integrator.together):  # each was followed by itself
            return motion
        size = math.prod(shape)
        if size <= FEW:
            alone = [self._attempt(impact, None)[0] for impact in problem.impacts()]
            return Motion.joined(alone, shape)
        first = np.arange(size).reshape(shape) < size // 2
        halves = [self._integrate(scene.take(part), None) for part in (first, ~first)]
        return Motion.joined(halves, shape)

    def _attempt(self, problem: Problem, recorder: Recorder | None) -> tuple[Motion, bool]:
        """Return the motion, and whether the integrator raised instead of returning one."""
        try:
            # Where a user has asked for errors of underflow: small numbers may vanish here.
            with np.errstate(under="ignore"):
                return self.integrator.integrate(problem, recorder), False
        except Exception as error:
            told = faults.raised(error)
            return Motion.nothing(problem.shape, Status.LAW_RAISED, told), True

    def _closed_form(self, scene: Scene, plan: Plan, recorder: Recorder | None) -> Motion:
        """Return the motion of impacts with no tangential march: none, or eq. (45)."""
        assert isinstance(self.normal, ClosedFormNormalLaw)
        pair, speed = scene.pair, scene.normal_speed
        motion = self.normal.motion(pair, speed)
        sense = np.sign(scene.slip_velocity) * plan.slipping
        friction = scene.friction_coefficient * sense
        impulse = 2.0 * pair.normal_mass * speed
        change = -friction * impulse / pair.tangential_mass
        work = friction * impulse * (scene.slip_velocity + 0.5 * change)
        if recorder is not None:
            phases = np.linspace(0.0, np.pi, CLOSED_FORM_INSTANTS)
            for phase in phases.tolist():
                instant, approach, rate, contact = motion.at(phase)
                slowed = friction * pair.normal_mass * (speed - rate) / pair.tangential_mass
                recorder(
                    Sample(
                        time=instant,
                        approach=approach,
                        normal_velocity=rate,
                        contact=contact,
                        slip_velocity=scene.slip_velocity - slowed,
                        tangential_force=friction * contact.force,
                        fields=dict,
                    )
                )
        return Motion(
            duration=_full(motion.duration, scene.shape),
            normal_velocity=_full(-speed, scene.shape),
            slip_velocity_change=_full(change, scene.shape),
            friction_work=_full(work, scene.shape),
            status=_statuses(scene.shape, Status.SUCCESS),
        )

    def _mixed(self, scene: Scene, plan: Plan) -> Motion:
        """March the impacts that need it, do the rest in closed form, and merge."""
        closed = self._closed_form(scene, plan, None)
        marched = self._integrate(scene.take(plan.marched), None)
        everywhere = np.ones(scene.shape, dtype=bool)
        return Motion.merged(((everywhere, closed), (plan.marched, marched)), scene.shape)


def _scene(scene: object) -> Scene:
    if not isinstance(scene, Scene):
        raise refuse("scene", scene, "must be a Scene", "make one: Scene(...)")
    return scene


def _asked(history: bool | str) -> bool | str:
    if history in (True, False, "fields"):
        return history
    raise refuse("history", history, "must be True, False or 'fields'")


def _full(value: Any, shape: tuple[int, ...]) -> Real:
    return float(value) if not shape else np.array(np.broadcast_to(value, shape))


def _statuses(shape: tuple[int, ...], status: Status) -> Any:
    return np.full(shape, status, dtype=object) if shape else status
