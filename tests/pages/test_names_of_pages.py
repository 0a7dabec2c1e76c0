"""A page has a name of its own, or that which the user gives, in any letters."""

import os
import subprocess
import sys

import pytest

from contactlab.cli.main import main
from tests.cli.test_terminal import COMMAND


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are any bytes on Linux")
def test_a_name_of_a_file_that_is_no_text(run, tmp_path):
    scene, page = tmp_path / os.fsdecode(b"\xb5.toml"), tmp_path / os.fsdecode(b"\xe9.html")
    scene.write_text("[nondimensional]\npsi1 = 6\nchi = 1\n", encoding="utf-8")
    ran = run("report", scene, "--tangential", "coulomb", "--out", page)
    assert (ran.status, ran.err) == (0, "")
    assert b"<h1>\xb5.toml</h1>" in page.read_bytes()


@pytest.mark.slow
def test_a_name_of_a_file_that_is_not_in_the_encoding(tmp_path):
    """Under an ASCII locale the letters of a name are bytes that no encoding has."""
    folder = tmp_path / "ψ"
    folder.mkdir()
    scene, page = folder / "µ.toml", folder / "é.html"
    scene.write_text("[nondimensional]\npsi1 = 6\nchi = 1\n", encoding="utf-8")
    narrow = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    words = ["report", scene, "--tangential", "coulomb", "--out", page]
    done = subprocess.run(
        [*COMMAND, *words], capture_output=True, env=os.environ | narrow, check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert "<h1>µ.toml</h1>" in page.read_text(encoding="utf-8")


def test_the_page_to_play_with_has_a_name_of_its_own(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["explore"]) == 0
    assert capsys.readouterr().out == "explore.html\n"
    assert (tmp_path / "explore.html").exists()
