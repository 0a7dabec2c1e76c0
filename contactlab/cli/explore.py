"""Write a page with sliders for psi1 and chi, for a browser: no network is needed.

Examples
--------
  contactlab explore --out explore.html
"""

from __future__ import annotations

import argparse

from contactlab.cli import arguments as shared
from contactlab.files import written


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the file."""
    parser.add_argument("--out", type=shared.file_of(".html"), required=True, metavar="FILE.html")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Write the page and print its path."""
    from contactlab.pages.explore import explore_page

    with shared.progress(arguments.progress, "page"), written(arguments.out) as stream:
        stream.write(explore_page())
    print(arguments.out)
    return shared.OK
