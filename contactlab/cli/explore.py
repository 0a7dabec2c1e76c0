"""Write a page with sliders for psi1 and chi, for a browser without a network.

Examples
--------
  contactlab explore --out explore.html
  contactlab explore --psi1 1.9 --chi 1.18 --out superball.html
"""

from __future__ import annotations

import argparse

from contactlab.cli import arguments as shared
from contactlab.outcome.files import written
from contactlab.pages.explore import CHI, PSI1, explore_page


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the first values of the sliders, and the file."""
    for name, axis in (("psi1", PSI1), ("chi", CHI)):
        parser.add_argument(
            f"--{name}",
            type=shared.finite,
            default=axis.first,
            help=f"first value of the slider (default: {axis.first:g})",
        )
    parser.add_argument("--out", type=shared.file_of(".html"), required=True, metavar="FILE.html")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Write the page and print its path."""
    with shared.progress(arguments.progress, "page"):
        page = explore_page(psi1=arguments.psi1, chi=arguments.chi)
    with written(arguments.out) as stream:
        stream.write(page)
    print(arguments.out)
    return shared.OK
