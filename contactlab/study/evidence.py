"""Experiments, finite elements and the curves of other codes, with every law beside them."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from importlib import resources
from pathlib import Path

import attrs
import numpy as np

from contactlab.registration.bring import by_name
from contactlab.registration.hooks import hookimpl
from contactlab.registration.names import short_name
from contactlab.registry import composition
from contactlab.registry.composition import DEFAULT_NORMAL
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import SceneFile, read_scene
from contactlab.study.agreement import Agreement, LawRun, by_rms
from contactlab.study.comparison import Comparison
from contactlab.study.slopes import SlopeFile, read_slopes
from contactlab.study.validation import Finding


@attrs.frozen(kw_only=True)
class MeasuredSet(ABC):
    """A file of measured or computed numbers with which laws are compared.

    Attributes
    ----------
    name : str
        Name, for files and tables.
    kind : str
        Where the numbers are from: "experiment", "finite elements" or "other codes".
    path : Path, optional
        The file; by default that of the name in ``contactlab/study/measured``.
    """

    name: str
    kind: str
    path: Path | None = None

    def _place(self) -> AbstractContextManager[Path]:
        if self.path is not None:
            return nullcontext(self.path)
        place = resources.files("contactlab").joinpath("study", "measured", f"{self.name}.toml")
        return resources.as_file(place)


@attrs.frozen(kw_only=True)
class Source(MeasuredSet):
    """A file of measured or computed rebounds, the normal laws to run, and bounds.

    Attributes
    ----------
    normals : mapping of str to mapping
        Options of the normal laws, by name.
    bounds : mapping
        Bound of the rms difference by quantity and law: ``{("psi2", "fronts"): 0.06}``.
    """

    normals: Mapping[str, Mapping[str, object]] = attrs.field(factory=lambda: {DEFAULT_NORMAL: {}})
    bounds: Mapping[tuple[str, str], float] = attrs.field(factory=dict)

    def read(self) -> SceneFile:
        """Return the contents of the scene file."""
        with self._place() as path:
            return read_scene(path)


@attrs.frozen(kw_only=True)
class Slopes(MeasuredSet):
    """A file of measured slopes of psi2 over psi1, for ``contactlab validate --measured``."""

    def read(self) -> SlopeFile:
        """Return the contents of the file; see ``contactlab.study.slopes.read_slopes``."""
        with self._place() as path:
            return read_slopes(path)


E_T = "tangential_restitution"
#: Normal laws of measured sets; those with a loss take the restitution that was measured.
NORMALS = (DEFAULT_NORMAL, "tsuji", "viscoelastic")


def _damp(restitution: float) -> dict[str, dict[str, float]]:
    """Return normal laws: elastic, and damped to the loss that was measured."""
    loss = {"restitution": restitution}
    return {DEFAULT_NORMAL: {}, **dict.fromkeys(NORMALS[1:], loss)}


#: Springs share the loss of these normal laws; under them annuli lose in pressure alone.
SOURCES = (
    Source(
        name="kharaz2001",
        kind="experiment",
        normals=_damp(0.98),
        bounds={
            (E_T, "fronts"): 0.015,
            (E_T, "springs, tsuji restitution=0.98"): 0.015,
            (E_T, "springs, viscoelastic restitution=0.98"): 0.015,
        },
    ),
    Source(name="superball", kind="experiment", normals=_damp(0.9)),
    Source(name="finite-elements", kind="finite elements", bounds={("psi2", "fronts"): 0.06}),
    Source(name="codes-test4-oxide", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-test4-alloy", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-mfix", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
)
SLOPES = tuple(
    Slopes(name=name, kind="experiment")
    for name in ("small-spheres", "glass-3mm", "eight-balls", "cross2010")
)


@attrs.frozen(kw_only=True, eq=False)
class Evidence:
    """A source, and the results of every law that fits.

    Attributes
    ----------
    source : Source
    file : SceneFile
    comparison : Comparison
        Agreements with all series; with ``curves``, the laws over the file's sweep too.
    left_out : mapping of str to str
        Reasons by law, for laws that could not be composed.
    """

    source: Source
    file: SceneFile
    comparison: Comparison
    left_out: Mapping[str, str]

    @property
    def laws(self) -> list[str]:
        """Names of the laws by rms difference from the first series; failed laws come last."""
        first = self.comparison.agreements[0]
        return by_rms({name: first.rms(name) for name in first.results})

    def scatter(self, agreement: Agreement) -> float:
        """Return the rms measurement error of a series, in its unit; NaN if none is stated."""
        errors = agreement.measured.error[agreement.measured.error > 0.0]
        return float(np.sqrt(np.mean(errors**2))) if errors.size else float("nan")

    def findings(self) -> Iterator[Finding]:
        """Iterate over the bounds of the laws that are installed."""
        for agreement in self.comparison.agreements:
            quantity = agreement.measured.quantity
            for law in agreement.results:
                if (bound := self.source.bounds.get((quantity, law))) is not None:
                    yield Finding(
                        what=f"{law}: {quantity}, rms",
                        against=f"{self.source.kind}: {self.source.name}",
                        difference=agreement.rms(law),
                        bound=bound,
                    )


def gather(
    *, curves: bool = False, progress: Callable[[int, int], object] | None = None
) -> Iterator[Evidence]:
    """Iterate over the sources, each with every law that fits under its preferred integrator.

    Parameters
    ----------
    curves : bool
        Run each law over the sweep of each file too, for figures.
    progress : callable, optional
        Called as ``progress(done, total)`` after each source.
    """
    sources = [item for item in measured_sets() if isinstance(item, Source)]
    for done, source in enumerate(sources, start=1):
        yield evidence_of(source, curves=curves)
        if progress is not None:
            progress(done, len(sources))


def measured_sets() -> list[MeasuredSet]:
    """Return the measured sets of contactlab and of plug-ins."""
    return list(by_name("measurements", MeasuredSet, lambda item: item.name).values())


@hookimpl
def contactlab_measurements() -> tuple[MeasuredSet, ...]:
    """Return contactlab's own measured sets."""
    return (*SOURCES, *SLOPES)


def evidence_of(source: Source, *, curves: bool = False) -> Evidence:
    """Return a source, and the results of every law that fits."""
    file = source.read()
    simulations, left_out = simulations_over(source.normals)
    agreements = []
    for measured in file.measured:
        scene = file.scene_at(**{measured.against: measured.x})
        results = {name: simulation.sweep(scene) for name, simulation in simulations.items()}
        agreements.append(Agreement(measured=measured, results=results))
    runs = [
        LawRun(
            name=name,
            result=simulation.sweep(file.scene),
            run_time_per_impact=float("nan"),
        )
        for name, simulation in simulations.items()
        if curves
    ]
    comparison = Comparison(
        scene=file.scene, varied=file.varied, runs=tuple(runs), agreements=tuple(agreements)
    )
    return Evidence(source=source, file=file, comparison=comparison, left_out=left_out)


def simulations_over(
    normals: Mapping[str, Mapping[str, object]],
) -> tuple[dict[str, Simulation], dict[str, str]]:
    """Return simulations of every tangential law under the normal laws, and reasons for misfits.

    Both are keyed by the tangential law's name, followed by normal law and options if the normal
    law is not the default.
    """
    simulations: dict[str, Simulation] = {}
    left_out: dict[str, str] = {}
    for normal, options in normals.items():
        for full in REGISTRY.names("tangential"):
            name = short_name(full)
            if normal != DEFAULT_NORMAL:
                words = ", ".join(f"{key}={value}" for key, value in options.items())
                name += f", {normal} {words}".rstrip()
            try:
                normal_law = composition.law("normal", normal, **options)
                simulations[name] = Simulation(normal=normal_law, tangential=full)
            except (ValueError, PluginError) as error:
                left_out[name] = str(error)
    return simulations, left_out
