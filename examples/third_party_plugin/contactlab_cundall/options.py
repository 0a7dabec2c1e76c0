"""An option of ``contactlab compare``: where the laboratory's notebook is named."""

from argparse import ArgumentParser

from contactlab.plugin import hookimpl


@hookimpl
def contactlab_options(command: str, parser: ArgumentParser) -> None:
    """Add an option to one command."""
    if command == "compare":
        parser.add_argument("--notebook", metavar="PAGE", help="page of the notebook, for the eye")
