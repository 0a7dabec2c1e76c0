"""Every law against experiments, finite elements and the curves of other codes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib import resources
from typing import Any

import attrs
import numpy as np

from contactlab.compose.composition import DEFAULT_NORMAL
from contactlab.compose.names import full_name, short_name
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.scene_file import SceneFile, read_scene
from contactlab.study.compare import Agreement, Comparison, LawRun
from contactlab.study.interrupts import uninterrupted


@attrs.frozen(kw_only=True)
class Source:
    """A file of measured or computed rebounds, and what laws are to be held against it.

    Attributes
    ----------
    name : str
        Of the file in ``contactlab/study/measured``, without its end.
    kind : str
        What the numbers are: "experiment", "finite elements" or "other codes".
    normals : mapping of str to mapping
        Normal laws by name, and their options.
    bounds : mapping
        Bound of the rms of a quantity for a law: ``{("psi2", "fronts"): 0.06}``.
    """

    name: str
    kind: str
    normals: Mapping[str, Mapping[str, Any]] = attrs.field(factory=lambda: {DEFAULT_NORMAL: {}})
    bounds: Mapping[tuple[str, str], float] = attrs.field(factory=dict)

    def read(self) -> SceneFile:
        """Return the file."""
        place = resources.files("contactlab").joinpath("study", "measured", f"{self.name}.toml")
        with resources.as_file(place) as path:
            return read_scene(path)


#: Loss of the impacts of Kharaz et al., carried by a damped law.
DAMPED = {DEFAULT_NORMAL: {}, "tsuji": {"restitution": 0.98}}
E_T = "tangential_restitution"
SOURCES = (
    Source(
        name="kharaz2001",
        kind="experiment",
        normals=DAMPED,
        bounds={
            (E_T, "fronts"): 0.015,
            (E_T, "springs, tsuji restitution=0.98"): 0.015,
            (E_T, "sharp_annulus, tsuji restitution=0.98"): 0.015,
        },
    ),
    Source(name="finite-elements", kind="finite elements", bounds={("psi2", "fronts"): 0.06}),
    Source(name="codes-test4-oxide", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-test4-alloy", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
    Source(name="codes-mfix", kind="other codes", bounds={(E_T, "mindlin_cap"): 0.006}),
)


@attrs.frozen(kw_only=True, eq=False)
class Evidence:
    """A source and what every law that fits says of it.

    Attributes
    ----------
    source : Source
    file : SceneFile
    comparison : Comparison
        Agreements with all series, and the laws over the file's sweep if it was asked for.
    left_out : mapping of str to str
        Laws that could not be composed, and why.
    """

    source: Source
    file: SceneFile
    comparison: Comparison
    left_out: Mapping[str, str]

    @property
    def laws(self) -> list[str]:
        """Names of the laws, the nearest to the first series first; those that failed last."""
        first = self.comparison.agreements[0]
        rms = {name: first.rms(name) for name in first.results}
        return sorted(rms, key=lambda name: (np.isnan(rms[name]), rms[name]))

    def scatter(self, agreement: Agreement) -> float:
        """Return the rms error of reading of a series; NaN where none is known."""
        known = agreement.measured.error[agreement.measured.error > 0.0]
        return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")

    def bound(self, quantity: str, law: str) -> float | None:
        """Return what the rms must not exceed, if anything."""
        return self.source.bounds.get((quantity, law))


def gather(
    *, curves: bool = False, progress: Callable[[int, int], object] | None = None
) -> Iterator[Evidence]:
    """Iterate over the sources with every law that fits, each under the integrator that suits it.

    Parameters
    ----------
    curves : bool
        Run each law over the sweep of each file too, for pictures.
    progress : callable, optional
        Called as ``progress(done, total)`` after each source.
    """
    for done, source in enumerate(SOURCES, start=1):
        yield _evidence(source, curves=curves)
        if progress is not None:
            progress(done, len(SOURCES))


def _evidence(source: Source, *, curves: bool) -> Evidence:
    file = source.read()
    simulations, left_out = simulations_over(source.normals)
    agreements = []
    for measured in file.measured:
        there = file.scene_at(**{measured.against: measured.x})
        results = {
            name: uninterrupted(simulation.sweep(there)) for name, simulation in simulations.items()
        }
        agreements.append(Agreement(measured=measured, results=results))
    runs = [
        LawRun(
            name=name,
            result=uninterrupted(simulation.sweep(file.scene)),
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
    normals: Mapping[str, Mapping[str, Any]],
) -> tuple[dict[str, Simulation], dict[str, str]]:
    """Return every installed tangential law over some normal laws, and why others are left out.

    The name of a simulation is that of its tangential law, with normal law and options where
    these are not the default.
    """
    found: dict[str, Simulation] = {}
    left_out: dict[str, str] = {}
    for normal, options in normals.items():
        for full in REGISTRY.names("tangential"):
            name = short_name(full)
            if normal != DEFAULT_NORMAL:
                told = ", ".join(f"{key}={value}" for key, value in options.items())
                name += f", {normal} {told}".rstrip()
            try:
                pressing = REGISTRY.create(full_name("normal", normal), **options)
                found[name] = Simulation(normal=pressing, tangential=full)
            except (ValueError, PluginError) as error:
                left_out[name] = str(error)
    return found, left_out
