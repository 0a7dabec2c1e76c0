"""Scenes, sweeps and measured values from TOML files."""

from contactlab.scene_file.laws import LawChoice
from contactlab.scene_file.measured import Measured
from contactlab.scene_file.read import SceneFile, read_scene

__all__ = ["LawChoice", "Measured", "SceneFile", "read_scene"]
