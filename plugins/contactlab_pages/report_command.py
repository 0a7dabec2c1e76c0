"""Write a page to send: scene, plan, results, laws and sources.

Examples
--------
  contactlab report examples/steel_ball.toml --out report.html
  contactlab report examples/kharaz2001.toml --tangential fronts,coulomb --out report.html
"""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

import attrs

from contactlab.cli import arguments as shared
from contactlab.cli.scene import add_file, with_restitution
from contactlab.outcome.files import replace_file
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registration.names import full_name, short_name
from contactlab.scene_file import read_scene
from contactlab.solve.solve import accept_scene
from contactlab.study.comparison import compare

#: Default laws to compare with the file's own.
DEFAULT_LAWS = ("fronts", "coulomb")


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scene, the laws and the file."""
    add_file(parser, needed=True)
    words = (
        "tangential laws to compare with the file's own (default: fronts and coulomb, if they fit "
        "its normal law)"
    )
    shared.add_names(parser, "--tangential", words)
    parser.add_argument("--normal", metavar="NAME", help="normal law in place of the file's own")
    parser.add_argument(
        "--integrator", metavar="NAME", help="integrator in place of the file's own"
    )
    shared.add_restitution(parser)
    shared.add_file(parser, "--out", ".html", required=True)
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the scene under the laws, write the page and print its path."""
    code = arguments.allow_code
    file = shared.scene_file(arguments, partial(read_scene, arguments.scene, allow_code=code))
    file = attrs.evolve(file, laws=with_restitution(arguments, file.laws))
    laws = file.laws.choose(normal=arguments.normal, integrator=arguments.integrator)
    own = laws.suit_to(file.scene).tangential
    simulations = {str(own): laws.simulation()}
    for name in arguments.tangential or DEFAULT_LAWS:
        name = short_name(full_name("tangential", name))
        if name in simulations:
            continue
        try:
            chosen = laws.choose(tangential=name)
            simulation = (chosen if arguments.integrator else chosen.suit()).simulation()
            accept_scene(simulation.laws, file.scene)
            simulations[name] = simulation
        except ValueError:  # a default that does not fit the file's normal law, or its bodies
            if arguments.tangential:
                raise
    with shared.working(arguments.progress, "laws") as progress:
        from contactlab_pages.report import report_page  # matplotlib only when drawing

        comparison = compare(file, simulations, history=True, progress=progress)
        page = report_page(file, simulations, comparison)

    def write(path: Path) -> None:
        with replace_file(path) as stream:
            stream.write(page)
        print(path)

    interrupted = comparison.interrupted
    saved = shared.save(
        (arguments.out, write), progress_wanted=arguments.progress, interrupted=interrupted
    )
    return shared.INTERRUPTED if interrupted else saved
