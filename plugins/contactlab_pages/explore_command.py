"""Write a page on which one throws a ball, for any browser.

Examples
--------
  contactlab explore
  contactlab explore --material rubber --angle 45 --predict --out superball.html
"""

from __future__ import annotations

import argparse
import inspect
from pathlib import Path

from contactlab.cli import arguments as shared
from contactlab.outcome.files import replace_file
from contactlab.registration.hooks import Execute, hookimpl
from contactlab_pages.explore import ARGUMENTS, RANGES, explore_page

OPTIONS = {"inertia": "inertia-ratio"}
UNITS = {
    "angle": "in degrees from the normal", "speed": "in m/s", "spin": "in rad/s",
    "radius": "in m", "inertia": "over m R²: 0.4 solid, 0.667 thin shell",
}  # fmt: skip


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the first values of the sliders, and the file."""
    defaults = inspect.signature(explore_page).parameters
    for name in RANGES:
        first = defaults[ARGUMENTS.get(name, name)].default
        words = " ".join(["first", name, UNITS.get(name, "")]).strip()
        parser.add_argument(
            f"--{OPTIONS.get(name, name)}",
            type=shared.finite,
            metavar=name.upper(),
            default=first,
            dest=ARGUMENTS.get(name, name),
            help=f"{words} (default: {first:g})",
        )
    parser.add_argument(
        "--material", default="pmma", metavar="NAME", help="material of the ball (default: pmma)"
    )
    parser.add_argument(
        "--block", metavar="NAME", help="material of the block (default: the ball's)"
    )
    parser.add_argument("--predict", action="store_true", help="ask for a prediction first")
    parser.add_argument(
        "--out", type=shared.file_of(".html"), default=Path("explore.html"), metavar="FILE.html",
        help="(default: explore.html)",
    )  # fmt: skip
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Write the page and print its path."""
    names = inspect.signature(explore_page).parameters
    page = explore_page(**{name: getattr(arguments, name) for name in names})
    with replace_file(arguments.out) as stream:
        stream.write(page)
    print(arguments.out)
    return shared.OK
