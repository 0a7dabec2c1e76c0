"""Fit friction, stiffness ratio or options of laws to measured impacts, and rank laws by fit.

Examples
--------
  contactlab fit examples/kharaz2001.toml --quantity tangential_restitution
  contactlab fit impacts.csv bodies.toml --fit friction_coefficient,stiffness_ratio
  contactlab fit impacts.csv bodies.toml --laws exact,coulomb,mindlin_cap --figure fit.png
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from contactlab.cli import arguments as shared
from contactlab.cli.fit_report import describe, ranking, write_residuals
from contactlab.compose.composition import DEFAULT_NORMAL
from contactlab.compose.simulation import Simulation
from contactlab.fitting import Fit, Ranked, fit, in_order, rank, read_measurements
from contactlab.fitting.model import SOME_FRICTION
from contactlab.numeric.checks import whole
from contactlab.outcome.files import distinct
from contactlab.scene_file import LawChoice, SceneFile, read_scene

#: The name of the exact elastic laws by their table, which are no law that is installed.
EXACT = "exact"
SAMPLES = 200


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the data, the parameters, the laws and the outputs."""
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help="DATA.csv and SCENE.toml, or a SCENE.toml that holds measured values",
    )
    parser.add_argument(
        "--fit",
        type=shared.names,
        default=["friction_coefficient"],
        metavar="A,B,...",
        help="friction_coefficient (default), stiffness_ratio, or options of the laws chosen, "
        "such as normal.restitution",
    )
    parser.add_argument(
        "--laws",
        type=shared.names,
        default=[EXACT],
        metavar="A,B,...",
        help="tangential laws, the first reported and all ranked; exact (default) is the exact "
        "elastic one by its table",
    )
    shared.add_laws(parser, kinds=("normal", "integrator"))
    parser.add_argument(
        "--quantity",
        type=shared.names,
        metavar="A,B,...",
        help="measured quantities to fit (default: all)",
    )
    parser.add_argument(
        "--bootstrap",
        type=int,
        default=SAMPLES,
        metavar="SAMPLES",
        help=f"samples of the bootstrap of the first law (default {SAMPLES}; 0 for none)",
    )
    parser.add_argument(
        "--column",
        type=_column,
        action="append",
        default=[],
        metavar="HEADING=NAME",
        help="name a column of the CSV: 'impact angle [deg]=incidence_angle'; 'remark=#' leaves "
        "it unread; may be repeated",
    )
    shared.add_figure(parser, "draw measured values, laws and residuals")
    parser.add_argument(
        "--csv", type=shared.file_of(".csv"), metavar="FILE.csv", help="write the residuals"
    )
    parser.add_argument("--json", action="store_true", help="print JSON instead of tables")
    shared.add_progress(parser)


def _column(text: str) -> tuple[str, str]:
    """Return the heading and the name in ``"impact angle [deg]=incidence_angle"``."""
    heading, _, name = text.rpartition("=")
    if not heading.strip() or not name.strip():
        raise argparse.ArgumentTypeError(f"{text!r}: write HEADING=NAME")
    return heading.strip(), name.strip()


def execute(arguments: argparse.Namespace) -> int:
    """Fit and report; 1 if one of several laws could not be fitted."""
    whole("--bootstrap", arguments.bootstrap, least=0, most=100_000)
    for number, name in enumerate(arguments.files, start=1):
        distinct({f"FILE {number}": name, "--csv": arguments.csv, "--figure": arguments.figure})
    data, path = _files(arguments.files)
    impacts = read_measurements(data, columns=dict(arguments.column))
    defaults = {"friction_coefficient": SOME_FRICTION}
    file = read_scene(path, entries=impacts.given, defaults=defaults)
    simulations = _simulations(arguments, file)
    asked: dict[str, Any] = {"parameters": arguments.fit, "quantities": arguments.quantity}
    first, *others = simulations
    ranked: list[Ranked] = []
    found: Fit | None = None
    interrupted = False
    try:
        with shared.progress(arguments.progress, "searches") as progress:
            found = fit(impacts, path, simulation=simulations[first], progress=progress, **asked)
        with shared.progress(arguments.progress, "laws") as progress:
            for done, name in enumerate(others, start=1):
                if progress is not None:
                    progress(done, len(simulations))
                ranked += rank(impacts, path, {name: simulations[name]}, **asked)
        if arguments.bootstrap:
            with shared.progress(arguments.progress, "bootstrap") as progress:
                options = {"bootstrap": arguments.bootstrap, "progress": progress}
                found = fit(impacts, path, simulation=simulations[first], **asked, **options)
    except KeyboardInterrupt:  # what is done is worth telling
        if found is None:
            raise
        interrupted = True
    interrupted |= 0 < found.samples < arguments.bootstrap
    if ranked:
        ranked = in_order([*ranked, Ranked(name=first, fit=found)])
    shown = [one for one in ranked if one.fit] or [Ranked(name=first, fit=found)]
    saved = shared.save(
        (arguments.figure, lambda file: _draw(file, shown, **shared.look(arguments))),
        (arguments.csv, lambda file: write_residuals(file, shown)),
        progress_wanted=arguments.progress,
    )
    _report(found, ranked, complete=not interrupted, as_json=arguments.json)
    return shared.INTERRUPTED if interrupted else max(saved, _failures(ranked))


def _report(found: Fit, ranked: list[Ranked], *, complete: bool, as_json: bool) -> None:
    """Print the fit and the ranking.

    Parameters
    ----------
    found : Fit
    ranked : list of Ranked
        The same data under other laws, the best first; empty if not asked for.
    complete : bool
        False after an interruption.
    as_json : bool
    """
    if as_json:
        rows = [
            {"law": one.name, "refusal": one.refusal, "fit": one.fit and one.fit.to_dict()}
            for one in ranked
        ]
        content = found.to_dict() | {"ranking": rows, "complete": complete}
        print(json.dumps(content, indent=2, allow_nan=False))
        return
    print(describe(found))
    if ranked:
        print("\n" + ranking(ranked))
    if not complete:
        print("\nnot complete: interrupted")


def _failures(ranked: list[Ranked]) -> int:
    """Say which laws could not be fitted, and return the status."""
    failed = [one for one in ranked if one.fit is None]
    for one in failed:
        print(f"contactlab fit: {one.name}: {one.refusal}", file=sys.stderr)
    return shared.FAILED if failed else shared.OK


def _files(names: list[str]) -> tuple[Any, Path]:
    """Return what was measured, and the file with the bodies."""
    scenes = [name for name in names if name.lower().endswith(".toml")]
    tables = [name for name in names if name not in scenes]
    if len(scenes) != 1 or len(tables) > 1:
        raise ValueError(
            f"FILE = {' '.join(names)}: give the measured impacts as DATA.csv and the bodies as "
            "SCENE.toml; or a SCENE.toml that holds measured values"
        )
    path = Path(scenes[0])
    return (Path(tables[0]) if tables else read_scene(path)), path


def _simulations(arguments: argparse.Namespace, file: SceneFile) -> dict[str, Simulation | None]:
    """Return the laws by their names: the file's normal law, the tangential ones asked for."""
    normal = arguments.normal or file.laws.normal
    found: dict[str, Simulation | None] = {}
    for name in arguments.laws:
        if name == EXACT and normal in (None, DEFAULT_NORMAL) and not arguments.settings:
            found[name] = None
            continue
        kept = {key: value for key, value in file.laws.options.items() if key.startswith("normal")}
        choice = LawChoice(
            normal=file.laws.normal, integrator=arguments.integrator, options=kept
        ).choose(normal=arguments.normal, tangential=None if name == EXACT else name)
        found[name] = choice.set(dict(arguments.settings)).simulation()
    return found


def _draw(path: Path, shown: list[Ranked], **look: Any) -> None:
    from contactlab.figures.fitting import draw_fits  # matplotlib only when drawing

    draw_fits(path, {one.name: one.fit for one in shown if one.fit}, **look)
