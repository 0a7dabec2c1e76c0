"""Pieces of sweeps: what is kept of them in files, what a worker replies, and how they are cut."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.compose import kept
from contactlab.compose.pieces import Chunk, unsolved
from contactlab.compose.workers import MODULE_REMEDY, reply
from tests.compose.test_sweep import blocks_of

COULOMB = Simulation(tangential="coulomb", integrator="symplectic")
SCENE = Scene.nondimensional(psi1=np.linspace(-3.0, 9.0, 10), chi=1.5)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return the folder of a sweep of ten impacts in blocks of four; a short path is told whole."""
    blocks_of(monkeypatch, 4)
    monkeypatch.chdir(tmp_path)
    COULOMB.sweep(SCENE, keep="kept")
    return Path("kept")


def refusal(folder, scene=SCENE):
    with pytest.raises(ValueError, match=" ") as caught:
        COULOMB.sweep(scene, keep=folder)
    return str(caught.value)


def test_a_sweep_is_kept_in_a_file_for_each_piece(folder):
    names = ["impacts-0-4.npz", "impacts-4-8.npz", "impacts-8-10.npz", "sweep.json"]
    assert sorted(path.name for path in folder.iterdir()) == names
    text = (folder / "sweep.json").read_text(encoding="utf-8")
    assert text.startswith('{\n  "normal": "hertz (contactlab ')
    assert text.endswith("}\n")
    about = json.loads(text)
    assert list(about) == [
        "normal", "tangential", "integrator", "impacts", "scene", "options", "block",
    ]  # fmt: skip
    assert (about["impacts"], about["block"]) == (10, 4)
    assert (len(about["scene"]), len(about["options"])) == (16, 16)
    assert about["integrator"].endswith("): Symplectic(steps=200, refine=True)")
    with np.load(folder / names[1], allow_pickle=False) as content:
        assert content["place"].tolist() == [4, 8]
        assert content["status"].tolist() == ["SUCCESS"] * 4
        assert content["sweep"] == kept.fingerprint(about)
        assert json.loads(str(content["counters"])) == {}
    assert kept.count(folder) == 10
    (folder / ".contactlab-0.part").touch()
    kept.remove(folder)
    assert not folder.exists()
    kept.remove(folder)


def test_refusals_of_a_folder(folder):
    start = f"keep = {str(folder)!r}: "
    remedy = "; delete the folder, or keep this sweep in another"
    about = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))
    other = kept.fingerprint(Scene.nondimensional(psi1=SCENE.psi1, chi=2.0))
    assert refusal(folder, Scene.nondimensional(psi1=SCENE.psi1, chi=2.0)) == (
        f"{start}holds another sweep: scene was {about['scene']}, is {other}{remedy}"
    )
    for text, error in (
        ("[", "Expecting value: line 1 column 2 (char 1)"),
        ("{}", "'normal'"),
        ("[1]", "list indices must be integers or slices, not str"),
    ):
        (folder / "sweep.json").write_text(text, encoding="utf-8")
        assert refusal(folder) == f"{start}sweep.json in it cannot be read: {error}{remedy}"
    (folder / "sweep.json").unlink()
    assert refusal(folder) == f"{start}is not empty, and holds no sweep; name a new folder"
    path = Path("file")
    path.touch()
    assert refusal(path) == f"keep = {str(path)!r}: is a file; name a folder"
    hidden = Path("hidden")
    hidden.mkdir()
    (hidden / ".file").touch()
    assert len(COULOMB.sweep(SCENE, keep=hidden)) == 10


def rewritten(path, **changes):
    """Write a piece with other entries."""
    with np.load(path, allow_pickle=False) as content:
        entries = {name: content[name] for name in content.files}
    entries = {name: entries[name] for name in entries if name != "checksum"} | changes
    np.savez(path, **entries, checksum=np.array(kept._checksum(entries)))


def test_refusals_of_a_piece(folder):
    path = folder / "impacts-4-8.npz"
    start = f"keep = {str(path)!r}: "
    rewritten(path, place=np.array([4, 7]))
    assert refusal(folder) == (
        f"{start}is damaged: slip_velocity_change has 4 impacts where its place has 3; delete "
        "this file"
    )
    rewritten(path, place=np.array([5, 9]))
    assert refusal(folder) == (
        f"{start}contains impacts 5 to 9, which are not those of its name; rename it to "
        "impacts-5-9.npz, or delete this file"
    )
    rewritten(path, place=np.array([4, 8]), sweep=np.array("0" * 16))
    assert refusal(folder) == f"{start}holds impacts 4 to 8 of another sweep; delete this file"
    rewritten(path, status=np.array(["SUCCESS", "SUCCESS", "SUCCESS", "WELL"]))
    assert refusal(folder).startswith(f"{start}is damaged: ")
    assert "WELL" in refusal(folder)


def test_a_piece_with_impacts_that_were_not_computed_is_not_kept(folder):
    store = kept.Kept(folder, COULOMB.laws, SCENE, 4)
    for path in folder.glob("impacts-*"):
        path.unlink()
    for status, files in ((Status.INTERRUPTED, 0), (Status.WORKER_DIED, 0), (Status.UNRESOLVED, 1)):
        store.keep(unsolved(Chunk(4, 8), status, "why"))
        assert len(list(folder.glob("impacts-*"))) == files
    (piece,) = store.pieces()
    assert piece.chunk == (4, 8)
    assert piece.motion.detail.tolist() == ["why"] * 4
    assert np.isnan(piece.motion.slip_velocity_change).all()


def test_a_worker_replies_with_a_piece_or_with_what_was_raised():
    """As in its process: from pickled laws and the pickled scene of the chunk."""
    sent, chunk = pickle.dumps(COULOMB.laws), Chunk(2, 6)
    part = pickle.dumps(SCENE.take(slice(2, 6)))
    answer = reply(sent, part, chunk, 3)
    assert answer.raised is None
    assert answer.piece.chunk == chunk
    expected = COULOMB.sweep(SCENE)[2:6]
    assert answer.piece.motion.slip_velocity_change.tolist() == (
        expected.motion.slip_velocity_change.tolist()
    )
    assert answer.versions == expected.laws
    unread = reply(b"laws", part, chunk, 3)
    assert (unread.piece, unread.versions) == (None, {})
    words = str(unread.raised)
    assert words.startswith("executor: its workers cannot load the laws: UnpicklingError: ")
    assert words.endswith(f"; install them there too, and {MODULE_REMEDY}")
    broken = reply(pickle.dumps(COULOMB.laws._replace(integrator=None)), part, chunk, 3)
    assert broken.piece is None
    assert isinstance(broken.raised, AttributeError)
