"""What is printed fits the terminal, and nothing in it is obeyed by the terminal."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

import contactlab
from contactlab.cli.terminal import Printed, fit_terminal, fitting, safe
from tests.longer import longer

PACKAGE = Path(contactlab.__file__).parent
COMMAND = [sys.executable, "-m", "contactlab"]
PSI = ["run", "--psi1", "6", "--chi", "1", "--tangential", "coulomb"]
EVIL = "\x1b[31mred\x1b]0;title\x07 \x9b2J \u202e back \r over"


def test_what_a_terminal_obeys_is_written_out():
    shown = safe(EVIL)
    assert shown.isprintable()
    assert shown.startswith(r"\x1b[31mred\x1b]0;title\x07 \x9b2J \u202e")
    assert safe("a\tb\nc µ") == "a\tb\nc µ"


def test_a_stream_that_fits_texts_returns_their_length():
    screen = io.StringIO()
    assert Printed(screen).write(EVIL) == len(EVIL)
    assert screen.getvalue() == safe(EVIL)


def test_symbols_in_letters():
    text = "3 µs, μ = 0.1, ψ1 ≤ 2 m², 30°, café, ½, 漢 \udcff"
    assert fitting(text, "utf-8") == text.replace("\udcff", "?")
    assert fitting(text, "ascii") == "3 us, mu = 0.1, psi1 <= 2 m2, 30deg, cafe, 1/2, ? ?"
    assert fitting("3 µs ψ", "latin-1") == "3 µs psi"


@pytest.mark.parametrize("suffix", [".py", ".md", ".toml"])
def test_everything_that_is_printed_has_its_letters(suffix):
    """Symbols of the code, of the guide and of packaged data; none is a question mark."""
    found = [path for path in PACKAGE.rglob(f"*{suffix}") if path.parent.name != "pages"]
    texts = [path.read_text(encoding="utf-8") for path in found]
    symbols = {letter for text in texts for letter in text if not letter.isascii()}
    assert symbols
    assert [letter for letter in symbols if "?" in fitting(letter, "ascii")] == []


def test_everything_printed_goes_through_it(monkeypatch):
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="ascii", newline="") for _ in range(2))
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    with fit_terminal():
        print("ψ", EVIL)
        print("°", EVIL, file=sys.stderr)
        sys.stderr.writelines([EVIL])
        assert not sys.stdout.isatty()
    assert sys.stdout is out
    for stream, first in ((out, b"psi "), (err, b"deg ")):
        stream.flush()
        written = stream.buffer.getvalue()
        assert written.startswith(first)
        assert b"\x1b" not in written


def test_a_program_without_streams_prints_nowhere(monkeypatch):
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    with fit_terminal():
        print("out")
        print("err", file=sys.stderr)


@pytest.fixture
def evil(tmp_path):
    path = tmp_path / "evil.toml"
    escaped = EVIL.encode("unicode_escape").decode().replace(r"\x", r"\u00")
    path.write_text(
        f'[about]\ntitle = "{escaped} ψ 3 µs é"\n[nondimensional]\npsi1 = 6\nchi = 1\n'
        '[simulation]\ntangential = "coulomb"\n',
        encoding="utf-8",
    )
    return path


def test_a_title_and_a_key_cannot_move_the_cursor(run, evil):
    for words in (("run", evil), ("compare", evil, "--tangential", "coulomb")):
        ran = run(*words)
        assert ran.status == 0
        assert r"\x1b[31mred" in ran.out
        assert "\x1b" not in ran.out + ran.err
        assert "\r" not in ran.out
    text = evil.read_text(encoding="utf-8")
    for old, new in (
        ("title", r'"t\u001b[2J"'),
        ('"coulomb"', r'"c\u001b[2J"'),
        ("= 6", r'= "\u001b[2J"'),
    ):
        evil.write_text(text.replace(old, new, 1), encoding="utf-8")
        ran = run("run", evil)
        assert ran.status == 2
        assert r"\x1b[2J" in ran.err
        assert "\x1b" not in ran.err


def test_names_on_the_command_line_cannot_either(run):
    for words in (("run", "no\x1b[2J.toml"), ("r\x1b[2Jn",), ("plugins", "show", "a\x1b[2J")):
        ran = run(*words)
        assert ran.status == 2
        assert "\x1b" not in ran.err


def test_an_ascii_terminal_gets_words(evil):
    """What is told, and what is refused, of one interpreter."""
    both = (
        "import sys; from contactlab.cli.main import main; "
        "told = main(['run', sys.argv[1]]), main(['run', '--psi1', '\\u03c8', '--chi', '1']); "
        "sys.exit(told != (0, 2))"
    )
    done = subprocess.run(
        [sys.executable, "-c", both, evil],
        capture_output=True,
        env=os.environ | {"PYTHONIOENCODING": "ascii:strict", "LANG": "C"},
        check=False,
    )
    assert done.returncode == 0
    assert b"psi 3 us e" in done.stdout
    assert done.stdout.isascii()
    (refused,) = done.stderr.splitlines()
    assert b"psi" in refused.partition(b"psi1")[2]


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize(
    "words",
    [["plugins", "list"], *longer(["--version"], PSI, ["--help"], ["run", "--help"])],
)  # fmt: skip
def test_a_full_disk_behind_stdout_is_one_line_and_status_1(words):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*COMMAND, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "No space left on device" in done.stderr
