"""Print the sources of data and laws as BibTeX.

Examples
--------
  contactlab cite examples/kharaz2001.toml
  contactlab cite --tangential fronts,coulomb,mindlin_cap > used.bib
"""

from __future__ import annotations

import argparse

from contactlab.cli import arguments as shared
from contactlab.cli.compare import own_laws, simulations
from contactlab.cli.scene import add_file, read, with_restitution
from contactlab.impact.material import works
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registry.citations import bibtex, references, software
from contactlab.scene_file import LawChoice


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scene, whose data are cited, and the laws."""
    add_file(parser)
    shared.add_laws(parser, many=True)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Print the entries: data and materials first, then laws, contactlab last."""
    file = read(arguments)
    laws = with_restitution(arguments, file.laws if file else LawChoice())
    own = [] if arguments.tangential else own_laws(arguments, laws, file.scene if file else None)
    texts = []
    if file is not None:
        texts += [file.citation] if file.citation else []
        texts += [measured.source for measured in file.measured]
        texts += [work for name in file.materials for work in works(name).values()]
    for simulation in simulations(arguments, laws, own).values():
        for law in simulation.laws:
            texts += references(law)
    print(bibtex(dict.fromkeys(" ".join(text.split()) for text in texts)), end="\n\n")
    print(software())
    return shared.OK
