"""A simulation: three laws composed, ready to plan, run and sweep."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab import composition, faults
from contactlab.batch import filled, halves
from contactlab.checks import refuse, whole
from contactlab.contracts.integrator import Integrator, Observer, TangentialMotion
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.energy import balanced
from contactlab.error_estimate import estimated
from contactlab.history import Recorder, show
from contactlab.motion import Motion, sound
from contactlab.normal_motion import normal_motion
from contactlab.plan import Answer, Plan, answers, make_plan
from contactlab.result import ImpactResult
from contactlab.scene import Scene
from contactlab.signatures import named_arguments
from contactlab.solved_motion import FailedMotion
from contactlab.status import Status

#: So many impacts of a batch that failed are tried one by one; more are halved first.
FEW = 8
#: Friction work over the energy at the start is this many times less accurate than psi2.
WORK_ACCURACY = 10.0


class Prepared(NamedTuple):
    """What comes before the march: the normal motion, whole-impact answers, and the plan."""

    normal: NormalMotion
    known: list[Answer]
    plan: Plan


@named_arguments("Simulation(tangential='annulus', integrator='symplectic')")
@attrs.frozen(kw_only=True, init=False)
class Simulation:
    """A normal law, a tangential law and an integrator, composed.

    Parameters
    ----------
    normal, tangential, integrator : str or law, optional
        A name (``"hertz"``), or an object made by ``contactlab.create`` or by your own class.
        The default is exact: Hertz's closed form and the slip front followed event by event.
        Where one is left out the best is taken that fits those given: see
        ``contactlab.composition.PREFERRED``.

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
        normal: str | NormalLaw | None = None,
        tangential: str | TangentialLaw | None = None,
        integrator: str | Integrator | None = None,
    ) -> None:
        made: dict[str, Any] = composition.compose(normal, tangential, integrator)
        self.__attrs_init__(**made)

    def plan(self, scene: Scene, *, history: bool | str = False) -> Plan:
        """Say what ``run`` would compute for ``scene``, what it leaves out and why."""
        return self._prepared(_scene(scene), _asked(history)).plan

    def run(
        self, scene: Scene, *, history: bool | str = False, estimate_error: bool = False
    ) -> ImpactResult:
        """Run one impact, or a batch scene at once.

        Parameters
        ----------
        scene : Scene
        history : bool or "fields"
            Keep the course of the impact; ``"fields"`` keeps traction and stick/slip too.
        estimate_error : bool
            Estimate the numerical error of psi2, of any laws, by running the scene again at half
            and at twice the resolution: ``ImpactResult.psi2_error_estimate``. About four times the
            work.

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
        recorder = Recorder(_scene(scene).shape, with_fields=history == "fields")
        plan, motion = self._outcome(scene, _asked(history), recorder if history else None)
        result = ImpactResult(
            scene=scene,
            plan=plan,
            motion=motion,
            laws=composition.versions(self.normal, self.tangential, self.integrator),
            history=recorder.history() if history else None,
            run_time=time.perf_counter() - started,
        )
        if not estimate_error:
            return result
        return attrs.evolve(result, psi2_error_estimate=estimated(self, result))

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
            loses; as many as the integrator asks for: 1000 of most, 20 where they are followed
            one by one.

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
            chunk = self.integrator.chunk(self.tangential)
        size, step = batch.shape[0], whole("chunk", chunk)
        plans: list[Plan] = []
        motions: list[Motion] = []
        done = 0
        try:
            while done < size:
                part = batch.take(slice(done, min(done + step, size)))
                plan, motion = self._outcome(part, False, None)
                plans.append(plan)
                motions.append(motion)
                done += part.shape[0]
                if progress is not None:
                    progress(done, size)
        except KeyboardInterrupt:
            plans, motions = plans[: len(motions)], motions[: len(plans)]
            done = sum(np.size(motion.duration) for motion in motions)
            if done < size:
                motions.append(Motion.nothing((size - done,), Status.INTERRUPTED))
                plans.append(_no_plan(size - done))
        return ImpactResult(
            scene=batch,
            plan=Plan.joined(plans),
            motion=Motion.joined(motions, batch.shape),
            laws=composition.versions(self.normal, self.tangential, self.integrator),
            run_time=time.perf_counter() - started,
        )

    def normal_motion(self, scene: Scene) -> NormalMotion:
        """Return the normal motion of ``scene``; a law that fails gives one without an end."""
        try:
            return normal_motion(self.normal, scene)
        except faults.LawFaultError as fault:
            return FailedMotion(self.normal, scene, fault.status, fault.detail)

    def _prepared(self, scene: Scene, history: bool | str) -> Prepared:
        """Return what comes before the march.

        Raises
        ------
        LawFaultError
            If a law raises where it is asked what it knows.
        """
        with np.errstate(under="ignore"):
            normal = self.normal_motion(scene)
            with faults.blaming(self.tangential):
                known = answers(scene, normal, self.tangential, history=history)
                laws = (self.tangential, self.integrator)
                return Prepared(
                    normal, known, make_plan(scene, normal, *laws, known, history=history)
                )

    def _outcome(
        self, scene: Scene, history: bool | str, recorder: Recorder | None
    ) -> tuple[Plan, Motion]:
        """Return plan and motion; a law that raises in a batch costs those impacts only."""
        shape = scene.shape
        if history and shape and not self.integrator.common_instants:
            raise refuse(
                "history",
                history,
                f"impacts of a batch have instants of their own under {self.integrator!r}",
                "run them one by one",
            )
        try:
            normal, known, plan = self._prepared(scene, history)
        except faults.LawFaultError as fault:
            failed = Motion.nothing(shape, fault.status, fault.detail)
            return _no_plan(*shape), failed
        if isinstance(normal, FailedMotion) and shape and math.prod(shape) > 1:
            return self._by_halves(scene)
        tangential = self._tangential(scene, Prepared(normal, known, plan), recorder)
        motion = sound(Motion.along(normal, tangential))
        return plan, balanced(motion, scene, self._books_bound())

    def _by_halves(self, scene: Scene) -> tuple[Plan, Motion]:
        """Return plan and motion of a batch, half by half, down to the impacts that fail."""
        shape = scene.shape
        plans, motions = zip(
            *(self._outcome(scene.take(part), False, None) for part in halves(shape)),
            strict=True,
        )
        joined = Plan.joined(plans)
        return (
            attrs.evolve(
                joined,
                marched=joined.marched.reshape(shape),
                psi2_error=np.reshape(joined.psi2_error, shape),
            ),
            Motion.joined(motions, shape),
        )

    def _tangential(
        self, scene: Scene, prepared: Prepared, recorder: Recorder | None
    ) -> TangentialMotion:
        """Return the tangential motion: what is known as a whole, and the rest marched."""
        normal, known, plan = prepared
        shape, marched = scene.shape, plan.marched
        if marched.all():
            return self._march(normal, scene, recorder)
        if not shape:
            if recorder is not None:
                show(normal, known, recorder)
            if not known:
                return TangentialMotion.nothing((), normal.status, normal.detail)
            answer = known[0].known
            return TangentialMotion(
                slip_velocity_change=float(answer.slip_velocity_change),
                friction_work=float(answer.friction_work),
            )
        everywhere = np.ones(shape, dtype=bool)
        nothing = TangentialMotion.nothing(shape, Status.NOT_SEPARATED)
        nothing = attrs.evolve(nothing, status=normal.status, detail=normal.detail)
        parts: list[tuple[Any, TangentialMotion]] = [(everywhere, nothing)]
        for where, answer in known:
            change, work = (
                np.broadcast_to(np.asarray(entry, dtype=np.float64), shape)[where]
                for entry in (answer.slip_velocity_change, answer.friction_work)
            )
            status = filled(Status.SUCCESS, change.shape)
            parts.append(
                (
                    where,
                    TangentialMotion(
                        slip_velocity_change=change, friction_work=work, status=status
                    ),
                )
            )
        if marched.any():
            parts.append((marched, self._march(normal.take(marched), scene.take(marched), None)))
        elif recorder is not None:
            show(normal, known, recorder)
        return TangentialMotion.merged(parts, shape)

    def _books_bound(self) -> float:
        """Return what the books may miss by: the law's own bound, and the integrator's share."""
        return self.tangential.books_bound + WORK_ACCURACY * (self.integrator.accuracy or 0.0)

    def _march(
        self, normal: NormalMotion, scene: Scene, recorder: Observer | None
    ) -> TangentialMotion:
        """Return the motion; a failure within a batch is traced, by halves, to those that fail."""
        shape = scene.shape
        size = math.prod(shape)
        if shape and size == 1 and recorder is None:  # one impact is faster as plain numbers
            alone = (0,) * len(shape)
            motion, _ = self._attempt(normal.take(alone), scene.take(alone), None)
            return TangentialMotion.joined([motion], shape)
        motion, raised = self._attempt(normal, scene, recorder)
        if not shape or recorder or np.all(motion.status):
            return motion
        if self.integrator.own_statuses and not raised:
            return motion
        if size <= FEW:
            places = list(np.ndindex(shape))
            single = [self._attempt(normal.take(at), scene.take(at), None)[0] for at in places]
            return TangentialMotion.joined(single, shape)
        parts = [self._march(normal.take(part), scene.take(part), None) for part in halves(shape)]
        return TangentialMotion.joined(parts, shape)

    def _attempt(
        self, normal: NormalMotion, scene: Scene, recorder: Observer | None
    ) -> tuple[TangentialMotion, bool]:
        """Return the motion, and whether the integrator raised instead of returning one."""
        try:
            # Where a user has asked for errors of underflow: small numbers may vanish here.
            with np.errstate(under="ignore"):
                return self.integrator.integrate(normal, self.tangential, scene, recorder), False
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may not end the process
            told = faults.told(self.integrator, faults.raised(error), 1)
            return TangentialMotion.nothing(scene.shape, Status.LAW_RAISED, told), True


def _no_plan(*shape: int) -> Plan:
    """Return the plan of impacts of which nothing is known."""
    nowhere = np.zeros(shape, dtype=bool)
    return Plan(computed=(), left_out=(), marched=nowhere, psi2_error=math.nan)


def _scene(scene: object) -> Scene:
    if not isinstance(scene, Scene):
        raise refuse("scene", scene, "must be a Scene", "make one: Scene(...)")
    return scene


def _asked(history: bool | str) -> bool | str:
    if history in (True, False, "fields"):
        return history
    raise refuse("history", history, "must be True, False or 'fields'")
