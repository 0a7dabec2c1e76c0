"""Sweeps that are kept go on where they stopped, and only they."""

import errno
import shutil

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.runs import kept
from tests.full_disk import full_disk
from tests.runs.test_sweep import CHI, RIGID, assert_same, blocks_of, scene


@pytest.fixture(autouse=True)
def blocks(monkeypatch):
    blocks_of(monkeypatch, 40)


def interrupted(simulation, folder, *, after=80, **changed):
    def stop(done, total):
        if done >= after:
            raise KeyboardInterrupt

    asked = {"scenes": scene(), "keep": folder, "progress": stop, "return_partial": True}
    return simulation.sweep(**(asked | changed))


@pytest.mark.parametrize(("tangential", "chunk"), [("fronts", None), ("springs", 80)])
def test_a_sweep_goes_on_where_it_stopped(tmp_path, tangential, chunk):
    if tangential == "fronts":
        tangential = contactlab.create("tangential.fronts", table=False)
    simulation, folder = Simulation(tangential=tangential), tmp_path / "kept"
    whole = simulation.sweep(scene())
    with pytest.raises(KeyboardInterrupt, match=f"80 of 150 impacts are in {folder}: the same"):
        interrupted(simulation, folder, return_partial=False)
    seen = []
    again = simulation.sweep(
        scene(), keep=folder, chunk=chunk, progress=lambda *n: seen.append(n[0])
    )
    assert seen[0] == 80 + (chunk or 40) - (chunk == 80) * 10
    assert_same(again, whole)
    finished = simulation.sweep(scene(), keep=str(folder), progress=lambda *_: pytest.fail("ran"))
    assert_same(finished, whole)


def test_a_disk_that_is_full_in_the_middle_leaves_what_was_kept(tmp_path, monkeypatch):
    simulation, folder = Simulation(**RIGID), tmp_path / "kept"
    with monkeypatch.context() as patched:
        full_disk(patched, after=3)
        with pytest.raises(OSError, match="No space left on device") as caught:
            simulation.sweep(scene(), keep=folder)
    assert caught.value.errno == errno.ENOSPC
    assert f"keep = {str(folder)!r}: impacts 80 to 120 are not written" in str(caught.value)
    assert f"{folder} holds 80 of 150 impacts; the same sweep goes on" in str(caught.value)
    seen = []
    again = simulation.sweep(scene(), keep=folder, progress=lambda *n: seen.append(n[0]))
    assert seen[0] == 120
    assert_same(again, simulation.sweep(scene()))


def test_ctrl_c_needs_no_room_for_what_is_kept(tmp_path, monkeypatch):
    full_disk(monkeypatch, after=3)
    result = interrupted(Simulation(**RIGID), tmp_path / "kept")
    assert np.isfinite(result.psi2).sum() == 80


def test_a_folder_that_goes_in_the_middle_is_told(tmp_path):
    folder = tmp_path / "kept"

    def gone(done, total):
        shutil.rmtree(folder)

    with pytest.raises(
        OSError, match=r"impacts 40 to 80.*there is no folder.*holds 0 of 150.*again"
    ):
        Simulation(**RIGID).sweep(scene(), keep=folder, progress=gone)


def test_failures_are_kept_with_their_sentences(tmp_path):
    simulation = Simulation(
        tangential="springs",
        integrator=contactlab.create("integrator.symplectic", steps=5, refine=False),
    )
    whole = simulation.sweep(scene())
    assert whole.failures
    interrupted(simulation, tmp_path / "kept")
    assert_same(simulation.sweep(scene(), keep=tmp_path / "kept"), whole)


def test_another_sweep_is_refused(tmp_path):
    simulation, folder = Simulation(**RIGID), tmp_path / "kept"
    interrupted(simulation, folder)
    other = scene().psi1.copy()
    other[-1] = np.nextafter(other[-1], 10.0)
    steps = contactlab.create("integrator.symplectic", steps=7)
    for changed, scenes, words in (
        (simulation, Scene.nondimensional(psi1=other, chi=CHI), "scene was"),
        (simulation, Scene.nondimensional(psi1=other[1:], chi=CHI), "impacts was 150, is 149"),
        (attrs.evolve(simulation, integrator=steps), scene(), "integrator was .*steps=7"),
        (Simulation(tangential="frictionless"), scene(), "tangential was coulomb"),
    ):
        with pytest.raises(ValueError, match=rf"keep = .*holds another sweep: {words}"):
            changed.sweep(scenes, keep=folder)


def test_what_holds_no_sweep_is_refused_and_left_alone(tmp_path):
    simulation, folder = Simulation(**RIGID), tmp_path / "kept"
    folder.mkdir()
    (folder / "thesis.txt").write_text("mine")
    with pytest.raises(ValueError, match="holds no sweep"):
        simulation.sweep(scene(), keep=folder)
    with pytest.raises(ValueError, match="must be the path of a folder"):
        simulation.sweep(scene(), keep=3)
    with pytest.raises(ValueError, match="is a file"):
        simulation.sweep(scene(), keep=folder / "thesis.txt")
    with pytest.raises(ValueError, match=r"keep = .*: cannot be made: No such file.*; name"):
        simulation.sweep(scene(), keep=tmp_path / "none" / "kept")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="is a link to nothing"):
        simulation.sweep(scene(), keep=tmp_path / "dangling")
    (folder / "thesis.txt").rename(tmp_path / "thesis.txt")
    interrupted(simulation, folder)
    (tmp_path / "thesis.txt").rename(folder / "thesis.txt")
    kept.remove(folder)
    assert [path.name for path in folder.iterdir()] == ["thesis.txt"]


def test_damaged_files_are_refused(tmp_path):
    simulation, folder = Simulation(**RIGID), tmp_path / "kept"
    interrupted(simulation, folder)
    piece = next(folder.glob("*.npz"))
    whole = piece.read_bytes()
    for content in (b"", whole[:100], b"x" * 300):
        piece.write_bytes(content)
        with pytest.raises(ValueError, match=r"is damaged.*delete this file"):
            simulation.sweep(scene(), keep=folder)
    piece.write_bytes(whole)
    with np.load(piece) as content:
        arrays = dict(content)
    edited = arrays | {"slip_velocity_change": arrays["slip_velocity_change"] * 1.001}
    short = arrays | {"friction_work": arrays["friction_work"][:-1]}
    for changed in (edited, short):  # numbers edited by hand, a column cut off
        np.savez(piece, **changed)
        with pytest.raises(ValueError, match=rf"{piece.name}.*is damaged.*; delete this file"):
            simulation.sweep(scene(), keep=folder)
    piece.write_bytes(whole)
    piece.rename(piece.with_name("impacts-40-90.npz"))
    with pytest.raises(ValueError, match=r"not those of its name.*, or delete this file"):
        simulation.sweep(scene(), keep=folder)
    piece.with_name("impacts-40-90.npz").rename(piece.with_name("impacts-mine.npz"))
    with pytest.raises(ValueError, match=r"keep = .*impacts-mine.npz.*not the name.*; move this"):
        simulation.sweep(scene(), keep=folder)
    piece.with_name("impacts-mine.npz").unlink()
    piece.mkdir()  # a file that the disk does not give may be whole
    with pytest.raises(ValueError, match=rf"{piece.name}.*cannot be read: Is a dir.*; try again"):
        simulation.sweep(scene(), keep=folder)
    piece.rmdir()
    (folder / "sweep.json").write_text("[")
    with pytest.raises(ValueError, match="cannot be read"):
        simulation.sweep(scene(), keep=folder)


def test_pieces_in_the_wrong_place_are_refused(tmp_path):
    """Two files that changed names resumed with the answers of each other's impacts."""
    simulation, folder = Simulation(**RIGID), tmp_path / "kept"
    interrupted(simulation, folder)
    first, second = sorted(folder.glob("*.npz"))
    contents = first.read_bytes(), second.read_bytes()
    first.write_bytes(contents[1])
    second.write_bytes(contents[0])
    with pytest.raises(ValueError, match=r"impacts 40 to 80, which.*impacts-40-80\.npz"):
        simulation.sweep(scene(), keep=folder)
    first.write_bytes(contents[0])
    second.write_bytes(contents[1])
    assert_same(simulation.sweep(scene(), keep=folder), simulation.sweep(scene()))


def test_a_piece_of_another_sweep_is_refused(tmp_path):
    simulation, folder, other = Simulation(**RIGID), tmp_path / "kept", tmp_path / "other"
    interrupted(simulation, folder)
    changed = Scene.nondimensional(psi1=-scene().psi1, chi=CHI)
    interrupted(simulation, other, scenes=changed)
    piece = sorted(other.glob("*.npz"))[0]
    piece.replace(folder / piece.name)
    with pytest.raises(ValueError, match=r"holds impacts 0 to 40 of another sweep; delete"):
        simulation.sweep(scene(), keep=folder)


def test_impacts_that_were_kept_twice_count_once(tmp_path):
    simulation, folder, other = Simulation(**RIGID), tmp_path / "kept", tmp_path / "other"
    interrupted(simulation, folder)
    interrupted(simulation, other, chunk=80)
    (piece,) = other.glob("*.npz")
    piece.rename(folder / piece.name)
    assert_same(simulation.sweep(scene(), keep=folder), simulation.sweep(scene()))
