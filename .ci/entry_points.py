"""Metadata hook: gathers what each folder of contactlab and plugins plugs in."""

import tomllib
from pathlib import Path

from hatchling.metadata.plugin.interface import MetadataHookInterface


class EntryPointsHook(MetadataHookInterface):
    """Makes the entry points of the group contactlab."""

    PLUGIN_NAME = "custom"

    def update(self, metadata):
        """Add the entry points of every folder that is there."""
        found = {}
        root = Path(self.root)
        for file in sorted(root.glob("*/entry-points.toml")) + sorted(
            root.glob("plugins/*/entry-points.toml")
        ):
            entries = tomllib.loads(file.read_text("utf-8"))
            if twice := found.keys() & entries.keys():
                raise ValueError(f"{file}: {min(twice)} is offered twice")
            found |= entries
        metadata["entry-points"] = {"contactlab": found}
