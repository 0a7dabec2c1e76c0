"""List the named materials, or print one with its sources.

Examples
--------
  contactlab materials
  contactlab materials "soda-lime glass"
  contactlab materials --json
"""

from __future__ import annotations

import argparse

import attrs

from contactlab.cli import arguments as shared
from contactlab.impact import material as materials
from contactlab.outcome.text_table import table
from contactlab.registration.hooks import Execute, hookimpl


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the name and the output."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="a material; without it, the list")
    shared.add_json(parser)
    return execute


def execute(arguments: argparse.Namespace) -> int:
    """Print the list of materials, or one material with its sources."""
    single = arguments.name is not None
    entries = (materials.entry(arguments.name),) if single else materials.entries()
    if arguments.json:
        content = {
            "materials": [
                attrs.asdict(entry, filter=lambda field, _: field.name != "works")
                for entry in entries
            ]
        }
        shared.print_json(content | {"references": materials.references()})
        return shared.OK
    headings = ["material", "E (GPa)", "nu", "density (kg/m³)", "yield stress (MPa)"]
    rows = [
        [
            *(entry.name, entry.young_modulus / 1e9, entry.poisson_ratio, entry.density),
            "-" if entry.yield_stress is None else entry.yield_stress / 1e6,
        ]
        for entry in entries
    ]
    print(table(headings, rows))
    if single:
        print(_sources(entries[0]))
    else:
        print("\ncontactlab materials NAME prints a material with its sources.")
        print('In a scene file: material = "steel"; in Python: Material.named("steel").')
    return shared.OK


def _sources(entry: materials.Entry) -> str:
    """Return the sources of a material's numbers, with full references."""
    lines = [f"\nelastic constants: {entry.elastic_source}", f"density: {entry.density_source}"]
    if entry.yield_stress is not None:
        lines.append(f"yield stress: {entry.yield_stress / 1e6:.4g} MPa, {entry.yield_source}")
    for name, number in entry.properties.items():
        lines.append(f"property {name}: {number:.6g}, {entry.properties_source}".rstrip(", "))
    lines += [f"note: {entry.note}"] if entry.note else []
    works = [f"{key}: {text}" for key, text in materials.works(entry.name).items()]
    return "\n".join([*lines, "", *works])
