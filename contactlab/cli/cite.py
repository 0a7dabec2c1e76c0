"""Print the sources of a scene's data and of its laws as BibTeX.

Examples
--------
  contactlab cite examples/kharaz2001.toml
  contactlab cite --psi1 1.2 --chi 1.4412 --tangential springs
"""

from __future__ import annotations

import argparse

from contactlab.citations import bibtex, references
from contactlab.cli import arguments as shared
from contactlab.cli.scene import add_scene, given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the scene and the laws."""
    add_scene(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Print the entries, the data's first."""
    file, _, simulation = given(arguments)
    texts = []
    if file is not None:
        texts += [file.citation] if file.citation else []
        texts += [measured.source for measured in file.measured]
    for law in (simulation.normal, simulation.tangential, simulation.integrator):
        texts += references(law)
    print(bibtex(dict.fromkeys(" ".join(text.split()) for text in texts)))
    return shared.OK
