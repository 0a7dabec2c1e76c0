"""Files: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import csv
import json
import re

import numpy as np
import pytest

from contactlab import (
    collide,
    read_scene,
)
from contactlab.outcome.export import write_csv, write_json, write_npz
from tests.present import extra
from tests.scene_file.test_bodies_of_files import ROD
from tests.solve.any_scene import (
    EXACT,
    every_way,
)

#: A rod in space, over its tilt.
SWEPT = ROD.replace("[0.2, 0, -1.0]", "[0.2, 0.1, -1.0]") + "[sweep]\ntilt_deg = [0, 10, 30, 60]\n"


@pytest.fixture
def swept(tmp_path):
    """Return a sweep over the tilt of a rod, the encounters and a folder."""
    (tmp_path / "rod.toml").write_text(SWEPT, encoding="utf-8")
    file = read_scene(tmp_path / "rod.toml")
    return file.laws.simulation().sweep(file.scene).check(), file.encounter, tmp_path


#: Columns of a vector, and the vector of the collision that it is.
VECTORS = {
    "velocity_in_space": "velocity",
    "rebound_spin": "spin",
    "target_velocity_in_space": "target_velocity",
    "target_rebound_spin": "target_spin",
}


@pytest.mark.parametrize("suffix", ["csv", "npz", "json"])
def test_files_hold_what_was_swept_and_what_came_out(swept, suffix):
    result, encounter, folder = swept
    path = folder / f"out.{suffix}"
    {"csv": write_csv, "npz": write_npz, "json": write_json}[suffix](result, path)
    if suffix == "csv":
        with path.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        read = {name.split(" ")[0]: [row[name] for row in rows] for name in rows[0]}
        assert "tilt_deg (deg)" in rows[0]
        assert "velocity_in_space_1 (m/s)" in rows[0]
        assert "rebound_spin_1 (rad/s)" in rows[0]
    elif suffix == "npz":
        with np.load(path) as file:
            read = {name: file[name] for name in file.files}
    else:
        read = json.loads(path.read_text(encoding="utf-8"))
    assert np.asarray(read["tilt_deg"], dtype=float).tolist() == [0.0, 10.0, 30.0, 60.0]
    made = collide(encounter)
    for name, vector in VECTORS.items():
        columns = [np.asarray(read[f"{name}_{place}"], dtype=float) for place in (1, 2, 3)]
        assert np.stack(columns, axis=-1) == pytest.approx(getattr(made, vector), rel=1e-9)
    for name, values in (("psi2", result.psi2), ("psi1", result.psi1), ("lam", result.scene.lam)):
        columns = [np.asarray(read[f"{name}_{place}"], dtype=float) for place in (1, 2)]
        assert np.array_equal(np.stack(columns, axis=-1), values)
    found = np.asarray(read["normal_restitution"], dtype=float)
    assert np.array_equal(found, result.normal_restitution)
    assert list(read["status"]) == 4 * ["SUCCESS"]


@extra("pandas")
def test_frames_hold_what_was_swept(swept):
    result, encounter, _ = swept
    frame = result.to_dataframe()
    assert frame["tilt_deg"].tolist() == [0.0, 10.0, 30.0, 60.0]
    velocity = frame[[f"velocity_in_space_{place}" for place in (1, 2, 3)]].to_numpy()
    assert velocity == pytest.approx(collide(encounter).velocity, rel=1e-9)
    assert frame.attrs["units"]["velocity_in_space_1"] == "m/s"


@every_way
def test_every_result_is_written(scene, tmp_path):
    result = EXACT.run(scene)
    write_csv(result, tmp_path / "a.csv")
    write_json(result, tmp_path / "a.json")
    write_npz(result, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        psi2 = [file[name] for name in file.files if re.fullmatch(r"psi2(_\d)?", name)]
    assert np.squeeze(np.stack(psi2, axis=-1)).tolist() == np.asarray(result.psi2).tolist()
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["status"]
