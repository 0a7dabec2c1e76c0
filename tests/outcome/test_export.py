"""Results as JSON, CSV and npz."""

import csv
import json
import sys
import zipfile

import numpy as np
import pytest

from contactlab import Scene, Simulation, collide, read_scene
from contactlab.outcome.columns import Column
from contactlab.outcome.export import write_csv, write_history_csv, write_json, write_npz
from tests.present import column, extra
from tests.scene_file.test_bodies_of_files import ROD

SIM = Simulation(tangential="coulomb", integrator="symplectic")
SINGLE = Scene.nondimensional(psi1=2.0, chi=1.4411764706)
BATCH = Scene.nondimensional(psi1=np.array([0.0, 2.0, 7.0]), chi=1.4411764706)


def table(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_json_round_trip(tmp_path):
    result = SIM.run(SINGLE, history=True)
    write_json(result, tmp_path / "a.json")
    content = json.loads((tmp_path / "a.json").read_text())
    assert content["psi2"] == result.psi2
    assert content["history"]["time"] == result.history.time.tolist()
    assert content["rebound_spin"] is None


def test_batch_csv_has_a_row_an_impact(tmp_path):
    result = SIM.run(BATCH)
    write_csv(result, tmp_path / "a.csv")
    rows = table(tmp_path / "a.csv")
    assert [float(row["psi2 (1)"]) for row in rows] == result.psi2.tolist()
    assert [row["status"] for row in rows] == ["SUCCESS"] * 3


@pytest.mark.parametrize("alone", [False, True])
def test_a_long_csv_gives_every_number_back(tmp_path, monkeypatch, alone):
    """By pyarrow where it is, and without; the bits of each number, and words with commas."""
    if alone:
        monkeypatch.setitem(sys.modules, "pyarrow", None)
    psi1 = np.random.default_rng(1).uniform(-6.0, 6.0, 50_001)
    psi1[:4] = 0.0, -0.0, 5e-324, 1e22
    result = Simulation().sweep(Scene.nondimensional(psi1=psi1, chi=1.4))
    words = Column("word", "", value=lambda one: np.where(one.psi1 > 0.0, 'a,"b"', "c"))
    with column(words):
        write_csv(result, tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    names, *rows = csv.reader(lines)
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    for name in ("psi1", "psi2"):
        told = np.array(columns[f"{name} (1)"], dtype=float)
        assert told.tobytes() == getattr(result, name).tobytes()
    assert columns["word"] == tuple('a,"b"' if x > 0.0 else "c" for x in psi1)
    assert set(columns["status"]) == {"SUCCESS"}
    assert set(columns["chi (1)"]) == {"1.4"}


def test_history_csv(tmp_path):
    result = SIM.run(SINGLE, history=True)
    write_history_csv(result, tmp_path / "h.csv")
    rows = table(tmp_path / "h.csv")
    assert [
        float(row["tangential_force (1)"]) for row in rows
    ] == result.history.tangential_force.tolist()
    with pytest.raises(ValueError, match="history"):
        write_history_csv(SIM.run(SINGLE), tmp_path / "no.csv")


def test_a_file_gets_the_name_asked_for_and_angles_keep_their_unit(tmp_path):
    result = Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44))
    write_npz(result, tmp_path / "a.NPZ")
    assert [path.name for path in tmp_path.iterdir()] == ["a.NPZ"]
    write_csv(result, tmp_path / "a.csv")
    headings = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "local_rebound_angle (rad)" in headings
    assert "normal_velocity (1)" in headings


def test_an_npz_compresses_what_repeats(tmp_path):
    """Random numbers hardly shrink, and compression takes longer than ten times the impacts."""
    psi1 = np.random.default_rng(1).uniform(-6.0, 6.0, 20_000)
    result = Simulation().sweep(Scene.nondimensional(psi1=psi1, chi=1.4))
    write_npz(result, tmp_path / "a.npz")
    with zipfile.ZipFile(tmp_path / "a.npz") as archive:
        sizes = {entry.filename: entry.compress_size for entry in archive.infolist()}
        assert archive.testzip() is None
    assert sizes["psi1.npy"] > 8 * psi1.size
    assert sizes["chi.npy"] < psi1.size
    assert sizes["status.npy"] < psi1.size
    with np.load(tmp_path / "a.npz") as content:
        assert content["psi1"].tobytes() == psi1.tobytes()
        assert content["psi2"].tobytes() == result.psi2.tobytes()
        assert set(content["status"]) == {"SUCCESS"}


def test_npz_round_trip(tmp_path):
    result = SIM.run(SINGLE, history=True)
    write_npz(result, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as content:
        assert content["psi2"] == result.psi2
        assert content["status"] == "SUCCESS"
        assert content["history_time"].tolist() == result.history.time.tolist()


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
