"""Greet somebody with a bounce.

Examples
--------
  contactlab hello Ada
  contactlab hello Ada --psi1 3
"""

from argparse import ArgumentParser, Namespace

import contactlab


@contactlab.hookimpl
def contactlab_command(parser: ArgumentParser) -> object:
    parser.add_argument("name", help="whom to greet")
    parser.add_argument("--psi1", type=float, default=1.2, help="scaled angle of incidence (1.2)")
    return greet


def greet(arguments: Namespace) -> int:
    psi2 = contactlab.rebound(arguments.psi1, 1.4412)
    print(f"Hello {arguments.name}, a ball leaves at psi2 = {psi2:.3f}")
    return 0
