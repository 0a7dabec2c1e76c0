"""Fit friction or options of laws to measured impacts, and rank laws.

Examples
--------
  contactlab fit examples/kharaz2001.toml --quantity tangential_restitution
  contactlab fit impacts.csv bodies.toml --fit friction_coefficient,stiffness_ratio
  contactlab fit impacts.csv bodies.toml --fit friction_coefficient,restitution,shear_loss
  contactlab fit impacts.csv bodies.toml --tangential exact,coulomb,mindlin_cap --figure fit.png
  contactlab fit --flight film.csv bodies.toml --fit friction_coefficient,restitution
  contactlab fit impacts.csv bodies.toml --normal viscoelastic,tsuji --fit restitution
"""

from __future__ import annotations

import argparse
import itertools
import re
import shlex
import sys
from functools import partial
from pathlib import Path
from typing import Any, Unpack

from contactlab.cli import arguments as shared
from contactlab.cli.scene import add_allow_code, with_restitution
from contactlab.numeric.checks import whole
from contactlab.outcome.files import distinct
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registry.composition import DEFAULT_NORMAL
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab_fit import Fit, Ranked, fit, in_order, rank, read_flight
from contactlab_fit.beside import as_target_sees
from contactlab_fit.csv_columns import read_text
from contactlab_fit.estimation import default_laws, parameters_of
from contactlab_fit.flight import is_film
from contactlab_fit.measurements import Measurements
from contactlab_fit.model import DEFAULTS
from contactlab_fit.options import add_columns, read_impacts, read_named
from contactlab_fit.parameters import RESTITUTION
from contactlab_fit.printed import describe, further_cautions, ranking, write_residuals
from contactlab_fit.problem import MANY
from contactlab_fit.tabulated import LOSSY

#: Name of the exact elastic laws, computed from a table; no installed law has this name.
EXACT = "exact"
#: Samples of the bootstrap, unless another number is given.
SAMPLES = 200


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the data, the parameters, the laws and the outputs."""
    parser.add_argument(
        "files",
        nargs="+",
        metavar="FILE",
        help="DATA.csv and SCENE.toml, or a SCENE.toml that holds measured values",
    )
    words = (
        "friction_coefficient (default), stiffness_ratio, restitution, shear_loss, or options of "
        "the laws chosen; each law fits those it has"
    )
    shared.add_names(parser, "--fit", words, default=["friction_coefficient"])
    words = (
        "tangential laws; the first is reported, all are ranked. exact (default): the exact "
        "elastic law, from a table"
    )
    shared.add_names(parser, "--tangential", words, default=[EXACT])
    shared.add_names(parser, "--normal", "normal laws, as --tangential; or file.py:Class")
    shared.add_restitution(parser)
    shared.add_laws(parser, kinds=("integrator",))
    add_allow_code(parser)
    shared.add_names(parser, "--quantity", "measured quantities to fit (default: all)")
    parser.add_argument(
        "--bootstrap",
        type=shared.whole_number,
        metavar="SAMPLES",
        help=f"bootstrap samples for the first law (default {SAMPLES}; none above {MANY} impacts)",
    )
    parser.add_argument(
        "--flight",
        type=Path,
        metavar="FILM.csv",
        help="in place of DATA.csv: positions t, x, y (optional z, angle) of a ball that bounces",
    )
    parser.add_argument(
        "--fps",
        type=shared.finite,
        metavar="RATE",
        help="frames a second of a film with a column frame",
    )
    add_columns(parser)
    shared.add_figure(parser, "draw measured values, laws and residuals")
    shared.add_file(parser, "--residuals", ".csv", words="also write the residuals")
    shared.add_file(parser, "--out", ".json", words="also write all that --json prints")
    shared.add_json(parser, "tables")
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Fit and report; the status is 1 if one of several laws could not be fitted."""
    if arguments.bootstrap is not None:
        whole("--bootstrap", arguments.bootstrap, least=0, most=100_000)
    for number, name in enumerate(arguments.files, start=1):
        distinct(
            {
                f"FILE {number}": name,
                "--residuals": arguments.residuals,
                "--figure": arguments.figure,
            }
        )
    data, path = _files(arguments.files, arguments.flight)
    first_fit = partial(_first_fit, path, arguments)
    if arguments.flight is None:
        try:
            impacts = read_impacts(data, arguments, first_fit)
        except ValueError as error:
            raise _tell_film(error, data, arguments) from None
    else:
        names = arguments.columns or dict(arguments.column)
        read = partial(read_flight, arguments.flight, frame_rate=arguments.fps)
        impacts = read_named(read, names, arguments, first_fit)
    impacts = as_target_sees(impacts, path)
    samples = _samples(arguments.bootstrap, len(impacts))
    file, simulations, own = _pose(impacts, path, arguments)
    shared.tell_normal_spin(file.scene, *simulations.values())
    selection: dict[str, Any] = {"quantities": arguments.quantity}
    first, *others = simulations
    reported = {"parameters": own[first], "simulation": simulations[first], **selection}
    ranked: list[Ranked] = []
    fitted: Fit | None = None
    interrupted = False
    try:
        with shared.progress(arguments.progress, "searches") as progress:
            fitted = fit(impacts, path, progress=progress, **reported)
        with shared.progress(arguments.progress, "laws") as progress:
            for done, name in enumerate(others, start=1):
                law = {name: simulations[name]}
                ranked += rank(impacts, path, law, parameters=own[name], **selection)
                if progress is not None:
                    progress(done, len(others))
        if samples:
            with shared.progress(arguments.progress, "bootstrap") as progress:
                options: dict[str, Any] = {"bootstrap": samples, "progress": progress}
                fitted = fit(impacts, path, **reported, **options)
    except KeyboardInterrupt:  # report what is done
        if fitted is None:
            raise
        interrupted = True
    interrupted |= 0 < fitted.samples < samples
    if ranked:
        ranked = in_order([*ranked, Ranked(name=first, fit=fitted)])
    shown = [law for law in ranked if law.fit] or [Ranked(name=first, fit=fitted)]
    saved = shared.save(
        (arguments.figure, lambda file: _draw(file, shown, **shared.look(arguments))),
        (arguments.residuals, lambda file: write_residuals(file, shown)),
        progress_wanted=arguments.progress,
        interrupted=interrupted,
    )
    _report(fitted, ranked, complete=not interrupted, as_json=arguments.json)
    return shared.INTERRUPTED if interrupted else max(saved, _failures(ranked))


def _pose(
    impacts: Measurements, path: Path, arguments: argparse.Namespace
) -> tuple[SceneFile, dict[str, Simulation | None], dict[str, list[str]]]:
    """Return the file of the bodies, the laws by name, and the parameters of each."""
    allow = arguments.allow_code
    file = read_scene(path, entries=impacts.given, defaults=DEFAULTS, allow_code=allow)
    simulations = _simulations(arguments, file)
    return file, simulations, parameters_of(impacts, path, simulations, arguments.fit)


def _tell_film(
    error: ValueError, data: Path | SceneFile, arguments: argparse.Namespace
) -> ValueError:
    """Return an error of a table; headings of a film add the advice to use --flight."""
    try:
        first = read_text(data).splitlines()[0] if isinstance(data, Path) else ""
    except (ValueError, IndexError):
        return error
    if not is_film(re.split(r"[,;\t]", first)):
        return error
    words = list(arguments.words)
    words.insert(words.index(str(data)), "--flight")
    said = f"{error}; if this is the film of a ball, paste: contactlab {shlex.join(words)}"
    return ValueError(said if arguments.fps or "rame" not in first else f"{said} --fps RATE")


def _first_fit(path: Path, arguments: argparse.Namespace, impacts: Measurements) -> Fit:
    """Return the fit of the first law to a reading of a table."""
    impacts = as_target_sees(impacts, path)
    _, simulations, own = _pose(impacts, path, arguments)
    first = next(iter(simulations))
    chosen: dict[str, Any] = {"parameters": own[first], "quantities": arguments.quantity}
    return fit(impacts, path, simulation=simulations[first], **chosen)


def _samples(wanted: int | None, impacts: int) -> int:
    """Return the samples of the bootstrap, and tell if a long table has none by default."""
    if wanted is not None:
        return wanted
    if impacts <= MANY:
        return SAMPLES
    print(
        f"contactlab fit: no bootstrap above {MANY} impacts by default; ask for one with "
        f"--bootstrap {SAMPLES}",
        file=sys.stderr,
    )
    return 0


def _report(fitted: Fit, ranked: list[Ranked], *, complete: bool, as_json: bool) -> None:
    """Print the fit, and the ranking unless ``ranked`` is empty."""
    if as_json:
        rows = [
            {"law": law.name, "refusal": law.refusal, "fit": law.fit and law.fit.to_dict()}
            for law in ranked
        ]
        content = fitted.to_dict() | {"ranking": rows, "complete": complete}
        shared.print_json(content)
        return
    print(describe(fitted))
    if ranked:
        print("\n\n".join(["", ranking(ranked), *further_cautions(fitted, ranked)])[1:])
    if not complete:
        print("\nnot complete: interrupted")


def _failures(ranked: list[Ranked]) -> int:
    """Report on stderr the laws that could not be fitted, and return the exit status."""
    failed = [law for law in ranked if law.fit is None]
    for law in failed:
        print(f"contactlab fit: {law.name}: {law.refusal}", file=sys.stderr)
    return shared.FAILED if failed else shared.OK


def _files(names: list[str], film: Path | None) -> tuple[Path | SceneFile, Path]:
    """Return the measured impacts, and the path of the scene file with the bodies."""
    scenes = [name for name in names if name.lower().endswith(".toml")]
    tables = [name for name in names if name not in scenes]
    if len(scenes) != 1 or len(tables) > 1:
        raise ValueError(
            f"FILE = {' '.join(names)}: give DATA.csv with the measured impacts and SCENE.toml "
            "with the bodies, or a SCENE.toml with measured values"
        )
    path = Path(scenes[0])
    if film is not None:
        if tables:
            raise ValueError(
                f"FILE = {tables[0]}: --flight gives the impacts already; leave out one"
            )
        return film, path
    return (Path(tables[0]) if tables else read_scene(path)), path


def _simulations(arguments: argparse.Namespace, file: SceneFile) -> dict[str, Simulation | None]:
    """Return a simulation for each pair of laws, None for the exact table.

    The names are those of ``--tangential``, of ``--normal`` if it is a list, or both.
    """
    normals = arguments.normal or [None]
    own = file.laws.normal
    settings = dict(arguments.settings)
    if arguments.restitution is not None:
        if RESTITUTION in arguments.fit:
            raise ValueError(f"--restitution: is fitted too, by --fit {RESTITUTION}; leave one out")
        chosen = with_restitution(arguments, file.laws)
        normals, own = [chosen.normal], None
        settings |= {f"normal.{k}": v for k, v in chosen.options.get("normal", {}).items()}
    if normals == [None] and own is None:
        given = f"normal.{RESTITUTION}" in settings
        if default_laws(arguments.fit, restituted=given) is not None:
            normals = [LOSSY]
    simulations: dict[str, Simulation | None] = {}
    for normal, name in itertools.product(normals, arguments.tangential):
        exact = name == EXACT
        told = [normal] if len(normals) > 1 else []
        told += [name] if len(arguments.tangential) > 1 or not told else []
        if exact and (normal or own) in (None, DEFAULT_NORMAL) and not settings:
            simulations[" ".join(told)] = None
            continue
        options = {k: v for k, v in file.laws.options.items() if k.startswith("normal")}
        choice = LawChoice(normal=own, integrator=arguments.integrator, options=options).choose(
            normal=normal, tangential=None if exact else name
        )
        simulations[" ".join(told)] = choice.set(settings).simulation()
    return simulations


def _draw(path: Path, shown: list[Ranked], **look: Unpack[shared.Drawing]) -> None:
    """Draw measured values, laws and residuals."""
    from contactlab_fit.figures import draw_fits  # matplotlib only when drawing

    draw_fits(path, {law.name: law.fit for law in shown if law.fit}, **look)
