"""Write a contact step and the whole bounce, in C and JavaScript.

Examples
--------
  contactlab kernel --out kernel
"""

from __future__ import annotations

import argparse
from importlib import resources
from pathlib import Path

from contactlab.cli import arguments as shared
from contactlab.outcome.files import replace_file
from contactlab.registration.hooks import Execute, hookimpl

#: Files of ``contactlab/kernels``: springs on a doubling grid (theory §13), bounces, exact impacts,
#: bodies of any shape and marches of springs (theory §14), types, notes.
FILES = (
    "contactlab_springs.h", "contactlab_springs.mjs", "contactlab_springs.d.mts",
    "contactlab_bounce.h", "contactlab_bounce.mjs", "contactlab_bounce.d.mts",
    "contactlab_springs.d.cts", "contactlab_bounce.d.cts",
    "contactlab_impact.h", "contactlab_bodies.h", "contactlab_march.h",
    "package.json", "README.md", "LICENSE",
)  # fmt: skip


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the folder."""
    parser.add_argument(
        "--out",
        type=shared.folder_of,
        required=True,
        metavar="DIR",
        help="folder for the files, created if missing",
    )
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Write the files and print their paths."""
    folder: Path = arguments.out
    shared.make_folder(folder)
    source = resources.files("contactlab").joinpath("kernels")
    for name in FILES:
        with replace_file(folder / name) as stream:
            stream.write(source.joinpath(name).read_text("utf-8"))
        print(folder / name)
    return shared.OK
