"""Draw the paper's Figs 1-4, with their numbers as CSV.

Examples
--------
  contactlab figures --out figures
  contactlab figures --out figures --only 2,4 --set tangential.annuli=100
  contactlab figures --out figures --format pdf --width one
"""

from __future__ import annotations

import argparse
import functools
from pathlib import Path

from contactlab.cli import arguments as shared
from contactlab.cli.scene import add_ball, compose_laws
from contactlab.outcome.files import write_table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.scene_file import LawChoice
from contactlab.study.paper_figures import CAPTIONS, SOLID, FigureData, paper_data


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the folder, the figures, their form and the laws."""
    parser.add_argument(
        "--out", required=True, type=shared.folder_of, metavar="DIR", help="folder for the files"
    )
    parser.add_argument(
        "--only",
        type=_numbers,
        default=list(paper_data()),
        metavar="1,2,...",
        help="numbers of the figures to draw (default: all)",
    )
    parser.add_argument(
        "--format",
        choices=[end[1:] for end in shared.PICTURES],
        default="png",
        help="format of the pictures",
    )
    shared.add_look(parser)
    add_ball(parser, "the paper's 0.3 by default")
    shared.add_laws(parser)
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Write the figures and print their paths."""
    simulation = compose_laws(arguments, LawChoice(tangential="annulus", integrator="paper"))
    names = ("poisson_ratio", "gyration_ratio")
    given = {name: value for name in names if (value := getattr(arguments, name)) is not None}
    ball = SOLID._replace(**given)
    chi = ball.chi  # refuses what no sphere has
    shared.make_folder(arguments.out)
    with shared.progress(arguments.progress, "figures") as progress:
        from contactlab.figures.files import save  # matplotlib only when drawing
        from contactlab.figures.paper import draw_paper

        for done, number in enumerate(arguments.only, start=1):
            data = paper_data()[number](simulation, ball)
            numbers, picture = (
                arguments.out / f"figure-{number}.{end}" for end in ("csv", arguments.format)
            )
            _write_csv(numbers, data)
            save(picture, functools.partial(draw_paper, data=data), **shared.look(arguments))
            caption = (
                [f"  Figure {number}. {CAPTIONS[number].format(chi)}"] if number in CAPTIONS else []
            )
            print(picture, numbers, *caption, sep="\n")
            if progress is not None:
                progress(done, len(arguments.only))
    return 0


def _write_csv(path: Path, data: FigureData) -> None:
    """Write the points of all curves, one row for each point."""
    rows = (
        [name, "" if parameter != parameter else parameter, x, y]
        for name, parameter, x, y in data.rows()
    )
    write_table(path, ["curve", data.parameter or "parameter", data.x, data.y], rows)


def _numbers(text: str) -> list[int]:
    """Return the numbers of figures in a list separated by commas."""
    words = [word.strip() for word in text.split(",")]
    unknown = [word for word in words if word not in map(str, paper_data())]
    if unknown:
        numbers = ", ".join(map(str, paper_data()))
        raise argparse.ArgumentTypeError(f"{unknown[0]!r}: the paper's figures are {numbers}")
    return [int(word) for word in dict.fromkeys(words)]
