"""Sweeps into a folder of Parquet: what a folder of NPZ has, for programs that read Parquet."""

import sys

import pytest

from contactlab import ImpactError, Scene, Simulation, SweepFolder
from contactlab.cli.main import main
from tests.laws.ending_laws import Raising
from tests.runs.test_into import SCENES, assert_columns, parts, stopped
from tests.runs.test_sweep import CHI, RIGID, blocks_of, scene


@pytest.fixture(autouse=True)
def blocks(monkeypatch):
    blocks_of(monkeypatch, 20)


@pytest.fixture(scope="module")
def parquet():
    return pytest.importorskip(
        "pyarrow.parquet", reason="pyarrow is not installed: pip install '.[pyarrow]'"
    )


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n != "encounters")) for n in SCENES]
)
def test_a_folder_has_the_columns_of_the_result(parquet, tmp_path, name):
    law = "springs" if name == "space" else None
    simulation, target = Simulation(tangential=law), tmp_path / "swept.parquet"
    whole = simulation.sweep(SCENES[name]())
    folder = simulation.sweep(SCENES[name](), into=target, chunk=20).check()
    assert folder.impacts == 60
    assert {path.suffix for path in target.glob("impacts-*")} == {".parquet"}
    assert_columns(folder, whole)
    target.rename(tmp_path / "renamed")
    assert_columns(SweepFolder(tmp_path / "renamed"), whole)
    assert folder.cautions == SweepFolder(tmp_path / "renamed").cautions


@pytest.fixture
def swept(parquet, tmp_path):
    return Simulation(**RIGID).sweep(parts(), into=tmp_path / "swept.parquet")


def test_others_read_the_columns_in_the_order_of_the_sweep(parquet, swept):
    psi1 = scene().psi1.tolist()
    table = parquet.read_table(swept.path)
    assert table.column_names == [*swept.units]
    assert table.column("psi1").to_pylist() == psi1
    assert set(table.column("chi").to_pylist()) == {CHI}
    assert set(table.column("status").to_pylist()) == {"SUCCESS"}
    units = {field.name: field.metadata[b"unit"].decode() for field in table.schema}
    assert units == swept.units


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:The inplace keyword")  # dask's own
def test_dask_reads_the_folder(swept):
    frames = pytest.importorskip("dask.dataframe")
    frame = frames.read_parquet(swept.path)
    assert frame.npartitions == 4
    found = frame.compute(scheduler="synchronous")
    assert found["psi2"].tolist() == swept["psi2"].tolist()
    assert set(found["status"]) == {"SUCCESS"}


def test_a_sweep_goes_on_where_it_stopped(swept, tmp_path):
    simulation, target = Simulation(**RIGID), tmp_path / "stopped.parquet"
    half = simulation.sweep(parts(), into=target, progress=stopped(80), return_partial=True)
    assert (len(half), half.complete) == (80, False)
    with pytest.raises(ImpactError, match="not complete: it stopped after impact 79"):
        half.check()
    before = {path: path.stat().st_mtime_ns for path in target.glob("impacts-*")}
    assert len(before) == 2
    whole = simulation.sweep(parts(), into=target).check()
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert whole["psi2"].tobytes() == swept["psi2"].tobytes()
    changed = Scene.nondimensional(psi1=-scene().psi1[:40], chi=CHI)
    for laws, scenes, words in (
        (Simulation(tangential="frictionless"), parts(), "another sweep: tangential was"),
        (simulation, [changed], "another scene"),
        (simulation, parts(each=50), "another size"),
    ):
        with pytest.raises(ValueError, match=rf"into = .*{words}"):
            laws.sweep(scenes, into=target)


@pytest.mark.slow
def test_failures_are_those_of_the_result(parquet, tmp_path):
    raising = Simulation(tangential=Raising(), integrator="symplectic")
    whole = raising.sweep(scene())
    folder = raising.sweep(scene(), into=tmp_path / "swept.parquet")
    assert whole.failures
    assert_columns(folder, whole)
    for answer in (folder, whole):
        with pytest.raises(ImpactError, match="impact") as raised:
            answer.check()
        assert raised.value.status == whole.status[next(iter(whole.failures))]


@pytest.mark.parametrize("stride", [1997, pytest.param(61, marks=pytest.mark.slow)])
def test_no_damage_is_read_as_numbers(swept, stride):
    """A bit that flipped anywhere is told, or changes nothing that is read."""
    path = min(swept.path.glob("impacts-*"))
    sound = path.read_bytes()
    names = ("psi1", "chi", "psi2", "status")
    expected = [swept[name].tolist() for name in names]
    flips = [(place, 1 << place % 8) for place in range(0, len(sound), stride)]
    flips.append((sound.rindex(b"psi2\x15\x02") + 5, 2))  # its codec: no check sum covers it
    told = 0
    for place, bit in flips:
        bits = bytearray(sound)
        bits[place] ^= bit
        path.write_bytes(bytes(bits))
        try:
            folder = SweepFolder(swept.path)
            found = [folder[name].tolist() for name in names], folder.units, folder.statuses
        except ValueError as error:
            told += "is damaged" in str(error)
        else:
            told += found == (expected, swept.units, swept.statuses)
    assert told == len(flips)
    path.write_bytes(sound[:-100])
    with pytest.raises(ValueError, match=r"is damaged: .*; delete this file"):
        Simulation(**RIGID).sweep(parts(), into=swept.path)


def test_without_pyarrow_nothing_is_begun(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pyarrow", None)  # Python then finds none
    with pytest.raises(ImportError, match=r"needs pyarrow, .* pip install \"\.\[pyarrow\]\""):
        Simulation().sweep(scene(), into=tmp_path / "swept.parquet")
    assert not (tmp_path / "swept.parquet").exists()


def test_the_command_writes_it(parquet, tmp_path, capsys, monkeypatch):
    target = f"{tmp_path}/swept.parquet/"
    assert main(["sweep", "--psi1", "0:3:4", "--chi", "1.2", "--out", target]) == 0
    assert capsys.readouterr().out.startswith(f"SweepFolder('{target[:-1]}'; 4 impacts; 4 SUCCESS)")
    assert SweepFolder(target)["psi1"].tolist() == [0.0, 1.0, 2.0, 3.0]
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert main(["sweep", "--psi1", "0:3:4", "--chi", "1.2", "--out", target]) == 2
    assert "needs pyarrow" in capsys.readouterr().err
