"""A simulation: three laws composed, ready to plan, run and sweep."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict, overload

import attrs
import numpy as np

from contactlab.contracts.integrator import Integrator
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status, succeeded
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import fill, take
from contactlab.numeric.checks import of_kind, refuse, yes_or_no
from contactlab.numeric.names import tell_arguments
from contactlab.numeric.types import Array, Each, Numbers
from contactlab.outcome.history import NO_HISTORY, History, NoHistory, Recorder
from contactlab.outcome.motion import Motion, without_failures
from contactlab.outcome.plan import Plan
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.registry.acceptance import accept
from contactlab.registry.bound import bind
from contactlab.registry.composition import Laws
from contactlab.solve import solve
from contactlab.solve.normal_motion import try_normal
from contactlab.solve.planning import plan_of
from contactlab.solve.way import Way

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from contactlab.impact.gathering import Gathering
    from contactlab.impact.grid import GridParts
    from contactlab.numeric.progress import Count
    from contactlab.outcome.sweep_folder import SweepFolder
    from contactlab.runs.pieces import Piece
    from contactlab.solve.gathering_plan import GatheringPlan

    class SweepOptions(TypedDict):
        """How a sweep is cut, where it is solved, and what an interruption leaves."""

        chunk: int | None
        executor: Executor | None
        return_partial: bool


#: Remedies for a file, and for bodies in space, in place of a scene.
FOR_FILES = "of a file: case = read_scene(path); case.laws.simulation().run(case.scene)"
FOR_BODIES = "for bodies in space use collide(encounter, simulation), or encounter.scene"


@tell_arguments
@attrs.frozen(kw_only=True, init=False)
class Simulation:
    """A normal law, a tangential law and an integrator that fit together.

    Parameters
    ----------
    normal, tangential, integrator : str or law, optional
        A name (``"hertz"``), a class in a file (``"my_law.py:Soft"``), or an object made by
        ``contactlab.create`` or by your own class.
        The default is exact: Hertz's closed form and the slip front followed event by event.
        A law that is left out is the first in ``contactlab.registry.composition.PREFERRED`` that
        fits the others; where friction changes the approach, and that law has no answer, the first
        in ``FOR_COUPLED`` stands in for it. ``attrs.evolve(simulation, tangential="springs")``
        swaps a law: of the others those that were given stay, and the rest is chosen anew.

    restitution : float or array, optional
        Coefficient of normal restitution, from 0 to 1, in place of a normal law: one loss for
        pressure and shear (``normal.viscoelastic``), 1 for elastic bodies. An array has one number
        for each impact. A normal law named beside it takes it as its own option.

    Raises
    ------
    ValueError
        If a name is not installed, or the laws do not fit together (naming what would); if a
        normal law stands beside a restitution that it does not take.
    """

    # What was given, which attrs.evolve passes on, and None for the others.
    _normal: str | NormalLaw | None = attrs.field(eq=False, repr=False)
    _tangential: str | TangentialLaw | None = attrs.field(eq=False, repr=False)
    _integrator: str | Integrator | None = attrs.field(eq=False, repr=False)
    _restitution: Numbers | None = attrs.field(eq=False, repr=False)
    normal: NormalLaw = attrs.field(init=False)
    tangential: TangentialLaw = attrs.field(init=False)
    integrator: Integrator = attrs.field(init=False)
    #: The three laws, and the kinds of those that were given.
    laws: Laws = attrs.field(init=False, eq=False, repr=False)

    def __init__(
        self,
        *,
        normal: str | NormalLaw | None = None,
        tangential: str | TangentialLaw | None = None,
        integrator: str | Integrator | None = None,
        restitution: Numbers | None = None,
    ) -> None:
        own = normal
        if restitution is not None:
            from contactlab.runs.owners import normal_of_restitution  # most simulations name laws

            own = normal_of_restitution(normal, restitution)
        self._set(composition.compose(own, tangential, integrator), normal, restitution)

    @staticmethod
    def _remedy(name: str, value: object) -> str:
        """Return where an argument belongs that a simulation does not have."""
        from contactlab.runs.owners import remedy_of  # needed for wrong arguments only

        return remedy_of(name, value)

    @classmethod
    def of(cls, laws: Laws) -> Simulation:
        """Return the simulation of laws that are composed already.

        Parameters
        ----------
        laws : Laws
        """
        simulation = cls.__new__(cls)
        simulation._set(laws)
        return simulation

    def _set(
        self, laws: Laws, normal: str | NormalLaw | None = None, restitution: Numbers | None = None
    ) -> None:
        composed = laws.by_kind()
        given = {kind: law if kind in laws.named else None for kind, law in composed.items()}
        if restitution is not None:
            given["normal"] = normal
        self.__attrs_init__(**given, restitution=restitution)
        for name, value in (*composed.items(), ("laws", laws)):
            object.__setattr__(self, name, value)

    @overload
    def plan(self, scene: Scene, *, history: bool | str = False) -> Plan: ...
    @overload
    def plan(self, scene: Gathering, *, history: bool = False) -> GatheringPlan: ...
    def plan(self, scene: Scene | Gathering, *, history: bool | str = False) -> Plan:
        """Return what ``run`` would compute for ``scene``, what it would leave out and why.

        The plan of a ``Gathering`` is that of ``collide(gathering, simulation)``.

        Parameters
        ----------
        scene : Scene or Gathering
            One impact or a batch.
        history : bool or "fields"
            The same as in ``run``.
        """
        if type(scene) is not Scene:
            from contactlab.impact.gathering import Gathering  # a scene needs none of this

            if isinstance(scene, Gathering):
                from contactlab.solve.gathering import plan_of_gathering

                return plan_of_gathering(scene, self.laws, history=history)
        laws, scene = bind(self.laws, _scene(scene))
        ways = solve.accept_scene(laws, scene, as_one=bool(_history(history)))
        columns, found = solve.prepare(ways, scene, history)
        return plan_of(laws, scene, columns, history=history, found=found)

    def run(
        self,
        scene: Scene[Each],
        *,
        history: bool | str = False,
        estimate_error: bool = False,
    ) -> ImpactResult[Each]:
        """Run one impact, or a batch scene at once.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        history : bool or "fields"
            Keep the course of the impact; ``"fields"`` keeps traction and stick/slip too.
        estimate_error : bool
            Estimate the numerical errors of psi2 and of the normal restitution by running the scene
            again at two finer resolutions: ``result.psi2_error_estimate`` and
            ``.restitution_error_estimate``. About twenty times the work.

        Returns
        -------
        ImpactResult
            A numerical failure is a status, with the history so far; ``.check()`` raises it.

        Raises
        ------
        ValueError
            If ``scene`` is not a Scene, a law has no answer to it, ``history`` is none of its three
            values, or the history of a batch is requested whose impacts have different instants.
        """
        started, recorder, laws = time.perf_counter(), None, self.laws
        if type(scene) is not Scene:
            scene = _scene(scene)
        if estimate_error is not False:
            estimate_error = yes_or_no("estimate_error", estimate_error)
        if laws.capability.reads:
            laws, scene = bind(laws, scene)
        if history is not False and _history(history):
            recorder = Recorder(scene.shape, with_fields=history == "fields")
        ways, flat = solve.accept_scene(laws, scene, as_one=bool(history)), scene
        if len(scene.shape) > 1:  # laws and integrators are run over one axis
            flat = scene.take(np.ones(scene.shape, dtype=bool))
            ways = solve.ways(laws, flat, as_one=bool(history))
        columns, motion = solve.outcome(ways, flat, history, recorder)
        if flat is not scene:
            place = np.arange(flat.shape[0]).reshape(scene.shape)
            columns, motion = columns.take(place), take(motion, flat.shape, place)
        plan = plan_of(laws, scene, columns, motion, history, estimated=estimate_error)
        kept = NO_HISTORY if recorder is None else recorder.history()
        result = _result(ways, scene, plan, motion, started, kept)
        if not estimate_error:
            return result
        from contactlab.solve.error_estimate import estimate_errors  # needed for an estimate only

        psi2, restitution = estimate_errors(laws, result)
        return attrs.evolve(
            result, psi2_error_estimate=psi2, restitution_error_estimate=restitution
        )

    @overload
    def sweep(
        self,
        scenes: Scene | Sequence[Scene],
        *,
        progress: bool | Count | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: str | Path | None = None,
        into: None = None,
        return_partial: bool = False,
    ) -> ImpactResult[Array]: ...
    @overload
    def sweep(
        self,
        scenes: Scene | GridParts | Iterable[Scene],
        *,
        progress: bool | Count | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: None = None,
        into: str | Path,
        return_partial: bool = False,
    ) -> SweepFolder: ...
    def sweep(
        self,
        scenes: Scene | GridParts | Iterable[Scene],
        *,
        progress: bool | Count | None = None,
        chunk: int | None = None,
        executor: Executor | None = None,
        keep: str | Path | None = None,
        into: str | Path | None = None,
        return_partial: bool = False,
    ) -> ImpactResult | SweepFolder:
        """Run many impacts, vectorised, a block at a time.

        The laws choose the size of a block, counted from the first impact: 16384 if nothing is
        marched, as in the exact solution up to chi = 2.5; 20 if impacts are followed one by one;
        1000 for most other laws, and where friction changes the approach. Neither ``chunk`` nor
        ``executor`` changes the blocks, so neither changes a bit of an answer, within one
        installation, one kind of processor and one number of BLAS threads (with NumPy 2 that number
        matters only to laws that multiply large matrices).

        An impact takes about 1 us where psi2 is tabulated: to 1e-9, or with a restitution to 5e-5.
        It takes 20 us by 50 springs without loss, to 2e-4, and 80 us with loss; ``contactlab
        bench`` times all.

        Parameters
        ----------
        scenes : sequence of Scene, or a batch scene; with ``into`` any iterable
            With ``into`` batches come one after another too, as from ``Scene.grid_in_parts`` or a
            generator; blocks are then counted from the first impact of each.
        progress : True or callable, optional
            True prints share and time left on stderr, as the command line does; a function is
            called as ``progress(done, total)`` after each chunk. Total is done where a generator
            does not tell it.
        chunk : int, optional
            Impacts of a chunk, rounded up to whole blocks; one block by default, with ``into``
            131072 if nothing is marched, else 1000. A chunk is what ``progress`` counts,
            ``executor`` gets, and ``keep`` and ``into`` write. An interruption loses unfinished
            chunks.
        executor : concurrent.futures.Executor, optional
            Solves the chunks; this process by default. Any object with a method ``submit`` that
            returns futures serves: ``ProcessPoolExecutor(4)``, dask's ``client.get_executor()``,
            an ``MPIPoolExecutor``. Workers import laws from the modules of their classes. A
            chunk that the executor loses is solved again, in halves down to the impact that ends
            its process, which has the status ``WORKER_DIED``; a pool of processes that broke is
            replaced by one like it. A sweep in a thread of its executor solves its chunks there.
            Laws that a table answers gain nothing: to send and join takes this process 0.7 to 2.5
            times as long as to solve.
        keep : str or Path, optional
            A folder where each chunk is written as soon as it is finished. The same sweep with the
            same folder resumes where it stopped; another scene or law is refused, and so is
            other code: contactlab, numpy and scipy by version, files of yours that hold the classes
            of a law by their text. All else that a law calls or reads is known by its work: blocks
            that are finished are computed again, one that is drawn and those with the smallest and
            largest psi1 and chi, and other bits are refused.
        into : str or Path, optional
            A folder for more impacts than memory holds, instead of a result. The columns of each
            chunk are written as soon as it is finished; memory is that of two chunks, with an
            executor of 32. The same sweep resumes as with ``keep``; each column has a checksum.
            Files are NPZ, or Parquet where
            the name of the folder ends with ``.parquet``, which needs pyarrow.
        return_partial : bool
            Whether an interruption (Ctrl-C) returns what is finished, where it is raised otherwise.
            The other impacts of a result then have the status ``INTERRUPTED``, which ``.check()``
            raises; a folder is not ``complete``.

        Returns
        -------
        ImpactResult, or with ``into`` SweepFolder
            A batch, or the folder, which reads its columns.

        Raises
        ------
        ValueError
            If there are no scenes, an entry is not a Scene, or scenes with bodies stand beside
            scenes of psi1 and chi; if a law cannot be sent to ``executor``; if ``keep`` or ``into``
            holds another sweep, other bits than are computed now, or a damaged file, or is in use
            by another sweep; if both are given.
        ImportError
            If ``into`` is a folder of Parquet, and pyarrow is not installed.
        OSError
            If a chunk cannot be written into ``keep`` or ``into``. Chunks before the failure stay
            there, and the same sweep resumes from them.
        KeyboardInterrupt
            After Ctrl-C, when finished chunks are in ``keep`` or ``into``.
        """
        from contactlab.impact.grid import GridParts
        from contactlab.numeric.progress import follow
        from contactlab.runs.sweep import one_axis, sweep_columns  # a single run needs none of this

        started = time.perf_counter()
        options: SweepOptions = {
            "chunk": chunk, "executor": executor,
            "return_partial": yes_or_no("return_partial", return_partial),
        }  # fmt: skip
        if isinstance(scenes, str | Path) or hasattr(scenes, "scene"):
            remedy = "give its .scene" if hasattr(scenes, "scene") else FOR_FILES
            raise refuse("scenes", scenes, "must be a Scene, or a sequence of them", remedy)
        if into is not None:
            with follow(progress, "impacts") as count:
                return self._into(into, keep, scenes, count, options)
        if isinstance(scenes, GridParts):
            rule = "is a grid in parts, which needs a folder"
            raise refuse("scenes", scenes, rule, "give into=folder, or Scene.grid")
        batch = scenes if isinstance(scenes, Scene) else Scene.stack(scenes)
        one_axis(batch)
        laws, batch = bind(self.laws, batch)
        ways = solve.accept_scene(laws, batch)
        with follow(progress, "impacts") as count:
            columns, motion = sweep_columns(laws, batch, keep=keep, progress=count, **options)
        return _result(ways, batch, plan_of(laws, batch, columns, motion), motion, started)

    def _into(
        self,
        into: str | Path,
        keep: object,
        scenes: Scene | GridParts | Iterable[Scene],
        progress: Count | None,
        options: SweepOptions,
    ) -> SweepFolder:
        """Return the folder of a sweep that is written as it goes."""
        from contactlab.runs.into import sweep_into  # needed with ``into`` only

        if keep is not None:
            remedy = "give one: into resumes too; keep returns the result"
            raise refuse("keep, into", (str(keep), str(into)), "write the same impacts", remedy)
        laws = self.laws
        if isinstance(scenes, Scene):
            laws, scenes = bind(laws, scenes)

        def result_of(scene: Scene, piece: Piece) -> ImpactResult:
            own, _ = bind(laws, scene)
            plan = plan_of(own, scene, piece.columns, piece.motion)
            return _result(solve.ways(own, scene), scene, plan, piece.motion, time.perf_counter())

        return sweep_into(laws, scenes, into, result_of=result_of, progress=progress, **options)

    def normal_motion(self, scene: Scene) -> NormalMotion:
        """Return the approach without friction; all values are NaN if the normal law fails.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.

        Raises
        ------
        ValueError
            If ``scene`` is not a Scene, or the law cannot run it.
        """
        laws, scene = bind(self.laws, _scene(scene))
        accept(laws.normal, scene.central)
        return try_normal(laws, scene.central)


def run_in_blocks(simulation: Simulation, scene: Scene) -> ImpactResult:
    """Return the result of a scene, by blocks if the scene has one axis."""
    return simulation.sweep(scene) if len(scene.shape) == 1 else simulation.run(scene)


def _result(
    ways: Sequence[Way],
    scene: Scene,
    plan: Plan,
    motion: Motion,
    started: float,
    history: History | NoHistory = NO_HISTORY,
) -> ImpactResult:
    """Return the result of a motion, without the numbers of impacts that failed."""
    status = motion.status
    if status is not Status.SUCCESS and not succeeded(status):
        motion = without_failures(motion)
    entries = {
        "scene": scene,
        "plan": plan,
        "motion": motion,
        "run_time": time.perf_counter() - started,
        "laws": solve.versions_of(ways),
        "history": history,
        "psi2_error_estimate": None,
        "restitution_error_estimate": None,
    }
    return fill(ImpactResult, entries)


def _scene(scene: object) -> Scene:
    """Return ``scene``, or refuse an object of another class."""
    if type(scene) is Scene:
        return scene
    from contactlab.impact.encounter import Encounter  # needed for the refusal only
    from contactlab.impact.gathering import Gathering

    meant: dict[type, str] = {str: FOR_FILES, Path: FOR_FILES, Encounter: FOR_BODIES}
    meant[Gathering] = "several contacts at once: collide(gathering, simulation)"
    found: Scene = of_kind("scene", scene, Scene, remedy="make one: Scene(...)", meant=meant)
    return found


def _history(history: bool | str) -> bool | str:
    """Return ``history``, or refuse a value other than its three."""
    if history in (True, False, "fields"):
        return history
    raise refuse("history", history, "must be True, False or 'fields'")
