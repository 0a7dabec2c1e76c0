"""A simulation: three laws composed, ready to plan, run and sweep."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, overload

import attrs
import numpy as np

from contactlab.compose import composition, eccentric, solve
from contactlab.compose.composition import Laws
from contactlab.compose.error_estimate import estimated
from contactlab.compose.planning import plan_of
from contactlab.compose.sweep import one_axis, swept
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import succeeded
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import taken
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import arguments_told
from contactlab.outcome.eccentric import EccentricResult
from contactlab.outcome.history import NO_HISTORY, EccentricHistory, History, NoHistory, Recorder
from contactlab.outcome.motion import Motion, without_failures
from contactlab.outcome.plan import Plan
from contactlab.outcome.result import ImpactResult

if TYPE_CHECKING:
    from concurrent.futures import Executor

R = TypeVar("R", ImpactResult, EccentricResult)


@arguments_told
@attrs.frozen(kw_only=True, init=False)
class Simulation:
    """A normal law, a tangential law and an integrator that fit together.

    Parameters
    ----------
    normal, tangential, integrator : str or law, optional
        A name (``"hertz"``), a class in a file (``"my_law.py:Soft"``), or an object made by
        ``contactlab.create`` or by your own class.
        The default is exact: Hertz's closed form and the slip front followed event by event.
        A law that is left out is the first in ``contactlab.compose.composition.PREFERRED`` that
        fits the others.

    Raises
    ------
    ValueError
        If a name is not installed, or the laws do not fit together (naming what would).
    """

    _remedy = "an option goes to its law: normal=create('normal.tsuji', restitution=0.9); "
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
        laws = composition.compose(normal, tangential, integrator)
        self.__attrs_init__(**laws._asdict())

    def plan(self, scene: Scene | EccentricScene, *, history: bool | str = False) -> Plan:
        """Return what ``run`` would compute for ``scene``, what it would leave out and why.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        history : bool or "fields"
            The same as in ``run``.
        """
        laws = self.laws
        if isinstance(scene, EccentricScene):
            return eccentric.plan(laws, scene)
        laws.accept(_scene(scene))
        with np.errstate(under="ignore"):
            prepared = solve.prepare(laws, scene, _history(history))
        return plan_of(laws, scene, prepared.columns, prepared.normal, history)

    @overload
    def run(
        self, scene: Scene, *, history: bool | str = False, estimate_error: bool = False
    ) -> ImpactResult: ...
    @overload
    def run(
        self, scene: EccentricScene, *, history: bool | str = False, estimate_error: bool = False
    ) -> EccentricResult: ...
    def run(
        self,
        scene: Scene | EccentricScene,
        *,
        history: bool | str = False,
        estimate_error: bool = False,
    ) -> ImpactResult | EccentricResult:
        """Run one impact, or a batch scene at once.

        Parameters
        ----------
        scene : Scene or EccentricScene
            The result of an eccentric impact is an ``EccentricResult``.
        history : bool or "fields"
            Keep the course of the impact; ``"fields"`` keeps traction and stick/slip too.
        estimate_error : bool
            Estimate the numerical error of psi2 by running the scene again at two finer
            resolutions: ``result.psi2_error_estimate``. About twenty times the work.

        Returns
        -------
        ImpactResult
            A numerical failure is a status, with the history so far; ``.check()`` raises it.

        Raises
        ------
        ValueError
            If ``scene`` is not a Scene, ``history`` is none of its three values, or the history of
            a batch is requested whose impacts have different instants.
        """
        started, laws, recorder = time.perf_counter(), self.laws, None
        if _history(history):
            recorder = Recorder(scene.shape, with_fields=history == "fields")
        if isinstance(scene, EccentricScene):
            if history == "fields":
                rule = "has no fields for bodies of any shape"
                raise refuse("history", history, rule, "history=True keeps forces and velocities")
            moved = eccentric.run(laws, scene, recorder)
            kept = NO_HISTORY if recorder is None else recorder.history(EccentricHistory)
            eccentric_result = eccentric.result_of(laws, scene, moved, started, kept)
            return self._with_estimate(eccentric_result, estimate_error)
        laws.accept(_scene(scene))
        flat = scene
        if len(scene.shape) > 1:  # laws and integrators are run over one axis
            flat = scene.take(np.ones(scene.shape, dtype=bool))
        columns, motion = solve.outcome(laws, flat, history, recorder)
        if flat is not scene:
            place = np.arange(flat.shape[0]).reshape(scene.shape)
            columns, motion = columns.take(place), taken(motion, flat.shape, place)
        plan = plan_of(laws, scene, columns, motion, history)
        kept = NO_HISTORY if recorder is None else recorder.history()
        result = _result(laws, scene, plan, motion, started, kept)
        return self._with_estimate(result, estimate_error)

    def _with_estimate(self, result: R, wanted: bool) -> R:
        """Return a result with the estimate of its numerical error, if that is wanted."""
        if not wanted:
            return result
        return attrs.evolve(result, psi2_error_estimate=estimated(self.laws, result))

    @overload
    def sweep(
        self,
        scenes: Scene | Sequence[Scene],
        *,
        progress: Callable[[int, int], object] | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: str | Path | None = None,
    ) -> ImpactResult: ...
    @overload
    def sweep(
        self,
        scenes: EccentricScene | Sequence[EccentricScene],
        *,
        progress: Callable[[int, int], object] | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: str | Path | None = None,
    ) -> EccentricResult: ...
    def sweep(
        self,
        scenes: Any,
        *,
        progress: Callable[[int, int], object] | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: str | Path | None = None,
    ) -> ImpactResult | EccentricResult:
        """Run many impacts, vectorised, a block at a time.

        The laws choose the size of a block, counted from the first impact: 16384 if nothing is
        marched, as in the exact solution up to chi = 2.5, 20 if impacts are followed one by one,
        1000 for most other laws and for eccentric impacts. Neither ``chunk`` nor ``executor``
        changes the blocks, so neither changes a bit of an answer, within one installation, one kind
        of processor and one number of BLAS threads (with NumPy 2 that number matters only to laws
        that multiply large matrices).

        Parameters
        ----------
        scenes : sequence of Scene or of EccentricScene, or a batch scene
        progress : callable, optional
            Called as ``progress(done, total)`` after each chunk.
        chunk : int, optional
            Impacts of a chunk, rounded up to whole blocks; one block by default. A chunk is what
            ``progress`` counts, ``executor`` gets and ``keep`` writes. An interruption loses
            unfinished chunks.
        executor : concurrent.futures.Executor, optional
            Solves the chunks; this process by default. Any object with a method ``submit`` that
            returns futures serves: ``ProcessPoolExecutor(4)``, dask's ``client.get_executor()``,
            an ``MPIPoolExecutor``. Workers import laws from the modules of their classes. A
            chunk that the executor loses has the status ``WORKER_DIED``.
        keep : str or Path, optional
            A folder where each chunk is written as soon as it is finished. The same sweep with the
            same folder resumes where it stopped; another scene or law is refused, and so is
            other code: contactlab, numpy and scipy by version, and every Python file of yours
            that a law imports by its text. Files of data that a law reads are not compared.

        Returns
        -------
        ImpactResult or EccentricResult
            A batch. An interruption (Ctrl-C) keeps finished chunks; the other impacts have the
            status ``INTERRUPTED``, which ``.check()`` raises.

        Raises
        ------
        ValueError
            If there are no scenes, an entry is not a Scene, or scenes with bodies stand beside
            scenes of psi1 and chi; if a law cannot be sent to ``executor``; if ``keep`` holds
            another sweep, or a law's class is in no file, as in a notebook.
        """
        started, laws = time.perf_counter(), self.laws
        options: dict[str, Any] = {"progress": progress, "chunk": chunk}
        options |= {"executor": executor, "keep": keep}
        kind: Any = EccentricScene if eccentric.are_eccentric(scenes) else Scene
        batch = scenes if isinstance(scenes, kind) else kind.stack(scenes)
        one_axis(batch.shape)
        if kind is EccentricScene:
            eccentric.accept(laws, batch)
            _, moved = swept(laws, batch, eccentric.solved, **options)
            return eccentric.result_of(laws, batch, moved, started)
        laws.accept(batch)
        columns, motion = swept(laws, batch, solve.solved, **options)
        return _result(laws, batch, plan_of(laws, batch, columns, motion), motion, started)

    def normal_motion(self, scene: Scene) -> NormalMotion:
        """Return the normal motion of ``scene``; all values are NaN if the normal law fails.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        """
        return solve.normal_or_failed(self.laws, scene)

    @property
    def laws(self) -> Laws:
        """The three laws: normal, tangential, integrator."""
        return Laws(self.normal, self.tangential, self.integrator)


def _result(
    laws: Laws,
    scene: Scene,
    plan: Plan,
    motion: Motion,
    started: float,
    history: History | NoHistory = NO_HISTORY,
) -> ImpactResult:
    """Return the result of a motion, without the numbers of impacts that failed."""
    return ImpactResult(
        scene=scene,
        plan=plan,
        motion=motion if succeeded(motion.status) else without_failures(motion),
        laws=composition.versions(*laws),
        history=history,
        run_time=time.perf_counter() - started,
    )


def _scene(scene: object) -> Scene:
    """Return ``scene``, or refuse an object of another class."""
    if not isinstance(scene, Scene):
        remedy = "make one: Scene(...)"
        if isinstance(scene, str | Path):
            remedy = "for a file use read_scene(path), whose run() runs it"
        elif type(scene).__name__ == "Encounter":
            remedy = "for bodies in space use collide(encounter, simulation), or encounter.scene"
        raise refuse("scene", scene, "must be a Scene", remedy)
    return scene


def _history(history: bool | str) -> bool | str:
    """Return ``history``, or refuse a value other than its three."""
    if history in (True, False, "fields"):
        return history
    raise refuse("history", history, "must be True, False or 'fields'")
