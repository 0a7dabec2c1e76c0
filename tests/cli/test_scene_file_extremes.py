"""What is no scene file at all: devices, pipes, folders, giants, labyrinths, and no path."""

from __future__ import annotations

import os
import pathlib

import numpy as np
import pytest

import contactlab
from contactlab.numeric.checks import refuse, whole
from contactlab.outcome import files
from contactlab.scene_file.table import number_list


class BytesPath:
    def __fspath__(self):
        return b"scene.toml"

    def __repr__(self):
        return "BytesPath()"


@pytest.mark.parametrize(
    "path", [None, 3, 1.5, True, b"scene.toml", ["scene.toml"], BytesPath(), "a\0b"], ids=repr
)
def test_what_is_no_path_is_refused_by_name(path):
    with pytest.raises(ValueError, match="path = "):
        contactlab.read_scene(path)


def test_a_path_object_of_ones_own_is_one(tmp_path):
    class Own:
        def __fspath__(self):
            return str(tmp_path / "good.toml")

    (tmp_path / "good.toml").write_text("[nondimensional]\npsi1 = 1\nchi = 1\n")
    assert contactlab.read_scene(Own()).path == pathlib.Path(Own())


@pytest.mark.skipif(os.name == "nt", reason="POSIX files")
def test_no_regular_file(run, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    devices = [name for name in ("/dev/zero", "/dev/null", "/dev/full") if os.path.exists(name)]
    for path in (*devices, tmp_path / "pipe", tmp_path):
        ran = run("run", path)
        assert (ran.status, ran.out) == (2, "")
        assert len(ran.err.splitlines()) == 1
        assert "cannot be read: is not a regular file" in ran.err
    link = tmp_path / "link.csv"
    for target in (*devices, tmp_path / "pipe", tmp_path):
        link.unlink(missing_ok=True)
        link.symlink_to(target)
        ran = run("run", "--psi1", "1", "--chi", "1", "--out", link)
        assert ran.status == 2
        assert "not a regular file" in ran.err


def test_a_giant(run, tmp_path):
    path = tmp_path / "giant.toml"
    with path.open("wb") as stream:
        stream.truncate(1_000_000_000)
    ran = run("run", path)
    assert ran.status == 2
    assert "too large: 1000 MB" in ran.err


@pytest.mark.parametrize(
    "text",
    [
        "a = " + "[" * 1000 + "]" * 1000,
        "a = " + "{a = " * 1000 + "1" + "}" * 1000,
        "sweep" + ".a" * 1000 + " = 1",
        "simulation.options" + ".a" * 1000 + " = 1",
        "[" + ".".join("a" * 1000) + "]",
        "sweep.psi1 = " + "[" * 30 + "]" * 30,
    ],
)
def test_a_labyrinth(run, tmp_path, text):
    path = tmp_path / "deep.toml"
    path.write_text(text)
    ran = run("run", path)
    assert ran.status == 2
    assert len(ran.err.splitlines()) == 1
    assert "nested more than 20 deep" in ran.err


def test_a_number_of_many_digits(run, tmp_path):
    path = tmp_path / "digits.toml"
    for digits in ("1" * 5000, "0x" + "f" * 5000, "1" * 400):
        path.write_text(f"[nondimensional]\npsi1 = {digits}\nchi = 1\n")
        ran = run("run", path)
        assert ran.status == 2
        assert len(ran.err.splitlines()) == 1
        assert "digits.toml" in ran.err
    for value in ("[" * 1000 + "]" * 1000, "1" * 5000):
        ran = run("run", "--psi1", "1", "--chi", "1", "--set", f"tangential.annuli={value}")
        assert ran.status == 2
        assert len(ran.err.splitlines()) == 1


def test_the_limits_leave_room_for_a_sweep_of_a_million(tmp_path):
    assert len(", ".join(["-1.234567890123456789e-123"] * 1_000_000)) < files.LARGEST


def test_a_value_that_cannot_be_shown():
    assert "psi1 = a int: must" in str(refuse("psi1", 16**5000, "must be small"))


def test_arrays_of_no_dimension_are_numbers():
    assert whole("count", np.array(5)) == 5
    for value in (np.array(5.5), np.array(True), np.array([5])):
        with pytest.raises(ValueError, match="whole number"):
            whole("count", value)
    assert contactlab.Scene.nondimensional(psi1=np.array(1.2), chi=np.array(1.0)).shape == ()
    with pytest.raises(ValueError, match="list of numbers"):
        number_list("sweep.psi1", np.array(1.0), remedy="")
