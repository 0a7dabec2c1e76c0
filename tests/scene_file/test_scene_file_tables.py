"""Measured series, files and tables of a scene file that cannot be, and what is at a limit."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab.scene_file.read import _deep
from contactlab.scene_file.table import Table, flatten, number_list
from tests.scene_file.test_scene_file_messages import IMPACT
from tests.scene_file.test_scene_file_refusals import refusal

MEASURED = {"quantity": '"psi2"', "against": '"psi1"', "source": '"x"', "x": "[1, 2]",
            "values": "[1, 2]"}  # fmt: skip
READ = "{{by = 'me', point = [1], x = [1], values = {}}}"


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"quantity": None}, ".quantity: is missing; name a quantity of the result"),
        ({"against": None},
         ".against: is missing; name the entry that was varied, such as angle_deg"),
        ({"source": None}, ".source: is missing; say where the numbers come from"),
        ({"source": "3"}, ".source = 3: must be text; put it in quotes"),
        ({"x": None}, ".x: is missing; list where it was measured"),
        ({"values": None}, ".values: is missing; list the measured values"),
        ({"values": "3"}, ".values = 3: must be a list of numbers; list the measured values"),
        ({"x": "3"}, ".x = 3: must be a list of numbers; list where it was measured"),
        ({"error": "3"}, ".error = 3: must be a list of numbers; list half-widths"),
        ({"error": "[1]"},
         ": the lists must be of equal length; they have x 2, values 2, error 1"),
        ({"error": "[1, -0.1]"},
         ".error = array([ 1. , -0.1]): must be zero or positive; give half-widths"),
        ({"readings": "[]"},
         ": give either x and values, or readings, each with x and values"),
        ({"x": None, "values": None},
         ": give either x and values, or readings, each with x and values"),
        ({"x": None, "values": None, "readings": "[]"}, ".readings = []: must be a list of tables"),
        ({"x": None, "values": None, "readings": "3"}, ".readings = 3: must be a list of tables"),
        ({"x": None, "values": None, "readings": f"[{READ.format('[1]')}, {{by = 3}}]"},
         ".readings[1].by = 3: must be text; put it in quotes"),
        ({"x": None, "values": None, "readings": "[{point = [1]}]"},
         ".readings[0].by: is missing; say who read the figure"),
        ({"x": None, "values": None, "readings": "[{by = 'me'}]"},
         ".readings[0].point: is missing; list point numbers, x and values, of equal length"),
        ({"x": None, "values": None, "readings": f"[{READ.format('[1, 2]')}]"},
         ".readings[0]: the lists must be of equal length; they have point 1, x 1, values 2"),
        ({"x": None, "values": None, "readings": f"[{READ.format('3')}]"}, ".readings[0].values "
         "= 3: must be a list of numbers; list point numbers, x and values, of equal length"),
        ({"against": '"angel_deg"'}, ".against = angel_deg: is not an entry of a scene; did you "
         f"mean 'angle_deg'? known: {IMPACT}, or dotted ones such as sphere.radius"),
        ({"quantity": '"psi3"'}, None),
    ],
)  # fmt: skip
def test_measured_values_that_cannot_be(tmp_path, changed, words):
    lines = {key: value for key, value in (MEASURED | changed).items() if value is not None}
    text = "[[measured]]\n" + "\n".join(f"{key} = {value}" for key, value in lines.items())
    told = refusal(tmp_path, f"nondimensional = {{psi1 = 1.0, chi = 1.0}}\n{text}")
    if words is None:
        assert told.startswith(
            ": measured[0].quantity = 'psi3': is not a quantity of a result; did"
        )
    else:
        assert told == f": measured[0]{words}"


def nested(deep):
    return tomllib.loads("a = " + "[" * deep + "]" * deep)


def test_twenty_levels_are_not_too_deep(tmp_path):
    """A list in a table is two levels."""
    assert not _deep(nested(19))
    assert _deep(nested(20))
    assert _deep(tomllib.loads("[" + ".".join("abcdefghijklmnopqrst") + "]\n[[x]]\n"))
    told = ": is nested more than 20 deep; a scene file needs less"
    assert refusal(tmp_path, "a = " + "[" * 20 + "]" * 20) == told
    assert refusal(tmp_path, "a = " + "[" * 100_000) == told


@pytest.mark.parametrize("suffix", [".csv", ".json", ".npz", ".png"])
def test_an_output_in_place_of_the_scene_is_told(tmp_path, suffix):
    """A file that is not there; one that is no scene's suffix gets the hint."""
    for end, hint in ((suffix, "; --out or --figure name files to write"), (".toml", "")):
        path = tmp_path / f"none{end}"
        with pytest.raises(ValueError, match="no such file") as caught:
            contactlab.read_scene(path)
        assert str(caught.value) == f"{path}: no such file; give the path of a scene in TOML{hint}"


@pytest.mark.parametrize("path", [3, None, b"scene.toml"])
def test_a_path_is_text_or_a_path(path):
    words = f"path = {path!r}: must be the path of a scene file; such as 'scene.toml'"
    with pytest.raises(ValueError, match=f"^{re.escape(words)}$"):
        contactlab.read_scene(path)
    with pytest.raises(ValueError, match=r"must not hold a null character$"):
        contactlab.read_scene("a\0b")


def test_text_of_other_encodings_and_line_ends(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"[nondimensional]\r\npsi1 = 1.0\rchi = 2.0\r\n")
    assert contactlab.read_scene(path).scene.chi == 2.0
    path.write_bytes("[nondimensional]\npsi1 = 1.0\nchi = 2.0\n".encode("utf-8-sig"))
    assert contactlab.read_scene(Path(path)).scene.psi1 == 1.0
    path.write_bytes(b"# \xe9\n")
    with pytest.raises(ValueError, match="UTF-8") as caught:
        contactlab.read_scene(path)
    reason = "invalid continuation byte at byte 2"
    assert str(caught.value) == f"{path}: is not UTF-8 text ({reason}); save it as UTF-8"


def test_a_maker_that_overflows_names_its_table():
    def divide():
        return 1 / 0

    def refused():
        raise ValueError("radius: bad")

    table = Table({}, "sphere", known=())
    words = (
        "sphere: the numbers are too large or too small to compute with (division by zero); check "
        "the units"
    )
    with pytest.raises(ValueError, match=f"^{re.escape(words)}$"):
        table.make(divide)
    with pytest.raises(ValueError, match=r"^sphere\.radius: bad$"):
        table.make(int, **{}) if False else table.make(
            lambda: exec("raise ValueError('radius: bad')")
        )


def test_values_by_dotted_name_however_they_are_nested():
    content = {"a": {"b": {"c": 1}, "d": {"leaf": 2}}, "e.f": 3}
    assert flatten(content) == {"a.b.c": 1, "a.d.leaf": 2, "e.f": 3}
    found = flatten(content, leaf=lambda table: "leaf" in table)
    assert found == {"a.b.c": 1, "a.d": {"leaf": 2}, "e.f": 3}


def test_lists_of_numbers_from_a_file_or_from_code():
    assert number_list("x", [1, 2.5], remedy="").tolist() == [1.0, 2.5]
    assert number_list("x", np.array([1.0]), remedy="").tolist() == [1.0]
    for bad in (np.array(1.0), (1.0, 2.0), [1.0, True], "12"):
        with pytest.raises(ValueError, match=r": must be a list of numbers; do$"):
            number_list("x", bad, remedy="do")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "[nondimensional]\nchi = 1.4\n[sweep]\npsi1 = '0:6:7'\n",
            "sweep.psi1 = '0:6:7': is a range as on the command line; under [sweep] write "
            "{start = 0, stop = 6, count = 7}",
        ),
        ("[nondimensional]\nchi = 1.4\nchi = 1.5\n", "is a key or a table written twice?"),
        ("[law]\nnormal = 'hertz'\n", "law: unknown table; did you mean 'simulation'? known: "),
    ],
)
def test_what_stands_elsewhere_or_twice_is_told_with_its_place(tmp_path, text, told):
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape(told)):
        contactlab.read_scene(path)
