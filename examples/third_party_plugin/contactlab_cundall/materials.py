"""A material of the laboratory, for ``Material.named`` and scene files."""

from contactlab.plugin import Entry, hookimpl


@hookimpl
def contactlab_materials() -> list[Entry]:
    """Return the material, in SI units, with the source of each number."""
    return [
        Entry(
            name="filled ptfe",
            young_modulus=0.5e9,
            poisson_ratio=0.46,
            density=2200.0,
            elastic_source="notebook, p. 3",
            density_source="notebook, p. 4",
            works={"notebook": "Laboratory notebook 12, 2026."},
        )
    ]
