"""Several laws on one scene or sweep: differences, cost, and distance from measured values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from typing import TYPE_CHECKING, overload

import attrs
import numpy as np

from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import of_kind, refuse, yes_or_no
from contactlab.numeric.names import nearest, tell_attributes
from contactlab.numeric.progress import Count, follow
from contactlab.numeric.types import AnyArray, Array, Json, Real
from contactlab.outcome.numerical_error import error_of
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sheet import Sheet
from contactlab.outcome.tabled import Tabled
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import SceneFile
from contactlab.solve.error_estimate import estimate_errors
from contactlab.study.agreement import Agreement, LawRun, values_of
from contactlab.study.side_by_side import default_quantities, describe, to_dict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.outcome.style import Width
    from contactlab.outcome.tabled import OwnAxes

#: Repeats of a short run. The least time counts, which other load of the machine disturbs least.
REPEATS = 3
#: Declared error of psi2 below which an elastic law is called exact.
EXACT = 1e-6
#: A run longer than this, in s, is not repeated: warming up takes little of its time.
LONG_RUN = 2.0


@tell_attributes
@attrs.frozen(kw_only=True, eq=False)
class Comparison(Tabled):
    """Laws side by side; the first law is the reference of the others.

    Attributes
    ----------
    scene : Scene
    varied : mapping of str to array
        Entries of a scene file that vary over the batch.
    runs : tuple of LawRun
    agreements : tuple of Agreement
        One for each measured series.
    interrupted : bool
        True if Ctrl-C left laws out.
    """

    scene: Scene
    varied: Mapping[str, Real]
    runs: tuple[LawRun, ...]
    agreements: tuple[Agreement, ...]
    interrupted: bool = False

    def __str__(self) -> str:
        """Return what ``contactlab compare`` prints, and failures, in tables and lines."""
        failures = "\n".join(f"failed: {sentence}" for sentence in self.failures())
        return "\n\n".join(filter(None, [describe(self, default_quantities(self)), failures]))

    @property
    def names(self) -> list[str]:
        """Names of the laws, the reference first."""
        return [run.name for run in self.runs]

    def only(self, laws: Iterable[str]) -> Comparison:
        """Return the comparison of the laws named; names that it does not have are ignored."""
        names = set(laws)
        agreements = tuple(
            attrs.evolve(
                agreement,
                results={law: run for law, run in agreement.results.items() if law in names},
            )
            for agreement in self.agreements
        )
        runs = tuple(run for run in self.runs if run.name in names)
        return attrs.evolve(self, runs=runs, agreements=agreements)

    def result(self, law: str) -> ImpactResult:
        """Return the result of one law."""
        return self._run(law).result

    def model(self, law: str) -> str:
        """Return what one law takes the bodies for: see ``LawRun.model``."""
        return self._run(law).model

    def _run(self, law: str) -> LawRun:
        """Return the run of a law, or refuse a name that none has."""
        for run in self.runs:
            if run.name == law:
                return run
        remedy = f"{nearest(str(law), self.names)}known: {', '.join(self.names)}"
        raise refuse("law", law, "is not in the comparison", remedy)

    def values(self, quantity: str, law: str) -> Array:
        """Return a quantity of one law over the scene or sweep; NaN where an impact failed."""
        return values_of(quantity, self.result(law))

    def difference(self, quantity: str, law: str) -> Array:
        """Return a quantity of one law less that of the first law."""
        return np.asarray(self.values(quantity, law) - self.values(quantity, self.names[0]))

    def numerical_error(self, law: str) -> Array:
        """Return the estimated numerical error of psi2, else the declared one; NaN if neither."""
        return error_of(self.result(law))

    def band(self, quantity: str, law: str) -> Array:
        """Return the error of a quantity that follows from the numerical error of psi2, or NaN."""
        result = self.result(law)
        with np.errstate(all="ignore"):
            error = self.numerical_error(law) / result.scene.psi_scale
            change = np.asarray(result.motion.slip_velocity_change)
            error = np.multiply.outer(error, np.ones(kinetics.slip_axes(result.scene)))
        moved = (
            attrs.evolve(result.motion, slip_velocity_change=change + sign * error)
            for sign in (1.0, -1.0)
        )
        ends = [values_of(quantity, attrs.evolve(result, motion=each)) for each in moved]
        return np.array(0.5 * np.abs(ends[0] - ends[1]))

    @overload
    def plot(
        self, quantity: str | None = ..., *, axes: Axes, width: Width | None = ...
    ) -> Axes: ...
    @overload
    def plot(
        self, quantity: str | None = ..., *, axes: None = ..., width: Width | None = ...
    ) -> OwnAxes: ...
    def plot(
        self,
        quantity: str | None = None,
        *,
        axes: Axes | None = None,
        width: Width | None = None,
    ) -> Axes:
        """Return axes with a curve for each law over a sweep, or with the forces of one impact.

        Parameters
        ----------
        quantity : str, optional
            Column of a written file, such as ``"tangential_restitution"``; by default the first
            measured quantity, else psi2. Measured values are drawn as points.
        axes : Axes, optional
            Axes to draw on; a new figure of ``matplotlib.pyplot`` by default.
        width : {"one", "two"}, optional
            Columns of a page that a new figure fills.

        Raises
        ------
        ValueError
            If the quantity is unknown, or is given for a single impact; or if no law has a history
            of a single impact.
        """
        from contactlab.study.comparison_figure import draw_compared  # matplotlib only when drawing

        return draw_compared(axes, self, quantity, width)

    def to_dict(self, quantities: Sequence[str] | None = None) -> dict[str, Json]:
        """Return quantities of each law, differences and agreement as plain numbers and text.

        Parameters
        ----------
        quantities : sequence of str, optional
            Columns of a written file; by default those that ``str`` shows.
        """
        return to_dict(self, default_quantities(self) if quantities is None else quantities)

    def _sheet(self) -> Sheet:
        """Return the columns of all results, with an axis of laws before those of the scene."""
        sheets = [run.result._sheet() for run in self.runs]
        shape = (len(sheets), *sheets[0].shape)
        units = {"law": ""}
        columns: dict[str, AnyArray] = {}
        for k, sheet in enumerate(sheets):
            units |= sheet.units
            for name, values in sheet.columns.items():  # options of a law are columns of its own
                kind = object if values.dtype.kind == "U" else float
                columns.setdefault(name, np.full(shape, np.nan, dtype=kind))[k] = values
        axes = {"law": np.array(self.names), **sheets[0].axes}
        return Sheet(columns, units, axes, shape)

    def failures(self) -> list[str]:
        """Return one sentence for each run with failed impacts, at measured points too."""
        sentences = [_failure(run.name, run.result) for run in self.runs]
        for agreement in self.agreements:
            where = f"at the measured values of {agreement.measured.quantity}"
            sentences += [
                _failure(f"{law}, {where}", result) for law, result in agreement.results.items()
            ]
        return [sentence for sentence in sentences if sentence]


def compare(
    scene: Scene | SceneFile,
    simulations: Mapping[str, Simulation],
    *,
    history: bool = False,
    estimate_error: bool = False,
    progress: bool | Count | None = None,
) -> Comparison:
    """Return the results of each simulation on ``scene``, and at the measured points of a file.

    Parameters
    ----------
    scene : Scene or SceneFile
        One impact or a one-dimensional batch.
    simulations : mapping of str to Simulation
        Simulations by the names shown in the comparison.
    history : bool
        Keep the history of a single impact; a sweep has none.
    estimate_error : bool
        Estimate the numerical error of psi2 of each law, from runs at finer resolutions.
    progress : True or callable, optional
        True prints share and time left on stderr; a function is called as ``progress(done, total)``
        after each run.

    Returns
    -------
    Comparison
        Failed impacts are NaN; ``failures()`` says why. Ctrl-C keeps the laws that are done, if
        there is one.

    Raises
    ------
    ValueError
        If ``scene`` is neither a scene nor a scene file, or if there are no simulations by name.
    """
    file = scene if isinstance(scene, SceneFile) else None
    single = file.scene if file else scene
    if not isinstance(single, Scene):
        raise refuse("scene", scene, "must be a Scene or a SceneFile")
    _check_simulations(simulations)
    history = yes_or_no("history", history)
    estimate_error = yes_or_no("estimate_error", estimate_error)
    series = file.measured if file else ()
    total, done = len(simulations) * (1 + len(series)), 0
    runs: list[LawRun] = []
    predicted: list[dict[str, ImpactResult]] = [{} for _ in series]
    interrupted = False
    try:
        with follow(progress, "runs") as count:
            for name, simulation in simulations.items():
                answers: list[ImpactResult] = []
                for job in (None, *series):
                    if job is None:
                        run = _time(name, simulation, single, history=history and not single.shape)
                        run = _estimate(run, simulation) if estimate_error else run
                    else:
                        assert file is not None
                        answers.append(_run(simulation, file.scene_at(**job.entries)))
                    done += 1
                    if count is not None:
                        count(done, total)
                runs.append(run)
                for results, answer in zip(predicted, answers, strict=True):
                    results[name] = answer
    except KeyboardInterrupt:
        if not runs:
            raise
        interrupted = True
    agreements = tuple(
        Agreement(measured=measured, results=results)
        for measured, results in zip(series, predicted, strict=True)
    )
    return Comparison(
        scene=single,
        varied=file.varied if file else _find_entries(single),
        runs=tuple(runs),
        agreements=agreements,
        interrupted=interrupted,
    )


def _check_simulations(simulations: object) -> None:
    """Refuse what is no mapping of names to simulations."""
    example = "such as {'exact': Simulation(), 'rigid': Simulation(tangential='coulomb')}"
    if not isinstance(simulations, Mapping) or not simulations:
        raise refuse("simulations", simulations, "must be simulations by name", example)
    for name, simulation in simulations.items():
        of_kind(f"simulations[{name!r}]", simulation, Simulation, remedy=example)


def _find_entries(scene: Scene) -> dict[str, Array]:
    """Return the entries of a scene file that vary over a batch: one entry, or a grid's axes."""
    if not scene.shape:
        return {}
    if scene.varied:
        return dict(scene.varied)
    # Several entries may vary together: the first one with different values is the abscissa.
    psi1 = kinetics.along_slip(scene, scene.psi1)
    entries: dict[str, Real] = {"psi1": psi1, "chi": scene.central.chi}
    if scene.sphere is not None:
        angle = np.degrees(np.arctan2(scene.tangential_velocity, scene.normal_speed))
        entries = {
            "angle_deg": angle, "normal_speed": scene.normal_speed, "spin": scene.spin,
            "friction_coefficient": scene.friction_coefficient, **entries,
        }  # fmt: skip
    for name, values in entries.items():
        if np.unique(values).size > 1:
            return {name: np.array(values)}
    return {"psi1": np.array(np.broadcast_to(psi1, scene.shape))}


def _estimate(run: LawRun, simulation: Simulation) -> LawRun:
    psi2, restitution = estimate_errors(simulation.laws, run.result)
    result = attrs.evolve(
        run.result, psi2_error_estimate=psi2, restitution_error_estimate=restitution
    )
    return attrs.evolve(run, result=result)


def _failure(name: str, result: ImpactResult) -> str:
    """Return a sentence on the failed impacts of a result; empty if none failed."""
    bad, shape = result.failures, result.scene.shape
    if not bad:
        return ""
    share = f" ({len(bad)} of {shape[0]})" if shape else ""
    return f"{name}{share}: {next(iter(bad.values()))}"


def _run(simulation: Simulation, scene: Scene) -> ImpactResult:
    return simulation.sweep(scene) if scene.shape else simulation.run(scene)


def _time(name: str, simulation: Simulation, scene: Scene, *, history: bool) -> LawRun:
    """Return the result of one simulation, and its least run time per impact."""
    result = _run(simulation, scene)  # the first run also imports, compiles and fills caches
    times = [result.run_time]
    if result.run_time < LONG_RUN:
        times = [_run(simulation, scene).run_time for _ in range(REPEATS)]
    if history:  # after the timing, which a history would lengthen
        result = simulation.run(scene, history=True)
    impacts = scene.shape[0] if scene.shape else 1
    return LawRun(
        name=name,
        result=result,
        run_time_per_impact=min(times) / impacts,
        model=_model(simulation.laws.capability.tangential_claims, result),
    )


def _model(offers: Set[str], result: ImpactResult) -> str:
    """Return what a law takes the bodies for, by its claims and its declared error."""
    if "partial_slip" in offers:
        # NaN, no declared error, is not below
        return "exact" if np.all(np.less(result.plan.psi2_error, EXACT)) else "elastic"
    return "rigid" if "rigid" in offers else ""
