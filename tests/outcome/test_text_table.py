"""Tables keep to the width of a terminal."""

import pytest

from contactlab.outcome.text_table import WIDTH, table


def test_a_narrow_table_is_as_it_was_given():
    assert table(["name", "a_long_heading"], [["x", 1.5]]) == (
        "name  a_long_heading\n----  --------------\nx                1.5"
    )


def test_wide_headings_are_folded_and_nothing_is_lost():
    headings = [f"a_rather_long_heading_{number} (m/s)" for number in range(8)]
    lines = table(headings, [[1.0] * 8]).splitlines()
    assert max(map(len, lines)) <= WIDTH
    rule = next(number for number, line in enumerate(lines) if line.startswith("--"))
    assert rule > 1
    letters = "".join(sorted("".join(lines[:rule]).replace(" ", "")))
    assert letters == "".join(sorted("".join(headings).replace(" ", "")))


def test_a_long_text_goes_on_below():
    text = "word " * 60
    lines = table(["name", "sentence"], [["x", text], ["y", "short"]]).splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert " ".join(lines[2:-1]).split() == ["x", *text.split()]
    assert lines[-1] == "y     short"


def test_numbers_have_as_many_digits_as_are_asked_for():
    assert table(["a"], [[1.0 / 3.0]], digits=3).splitlines()[-1] == "0.333"
    assert table(["a"], [[1.0 / 3.0]]).splitlines()[-1] == "0.333333"


def test_short_headings_stand_on_the_line_above_the_rule():
    headings = ["short", *(f"a_rather_long_heading_{number} (m/s)" for number in range(8))]
    lines = table(headings, [["x", *[1.0] * 8]]).splitlines()
    rule = next(number for number, line in enumerate(lines) if line.startswith("--"))
    assert [line.startswith("short") for line in lines[:rule]] == [False] * (rule - 1) + [True]


@pytest.mark.parametrize(("wide", "lines"), [(95, 1), (96, 2)])
def test_headings_are_folded_beyond_a_hundred_characters(wide, lines):
    """Two blanks are counted after each column, the last one too."""
    words = "x" * 10, "y" * (wide - 11)
    text = table([" ".join(words), "z"], [[1.0, 2.0]]).splitlines()
    assert len(text) == lines + 2
    if lines == 2:
        assert [line.split() for line in text[:2]] == [[words[0]], [words[1], "z"]]


@pytest.mark.parametrize(
    ("first", "text", "lines"),
    [
        (4, ("a" * 45, "b" * 46), 1),
        (4, ("a" * 45, "b" * 47), 2),
        (80, ("c" * 14, "d" * 15), 1),
        (80, ("c" * 14, "d" * 16), 2),
    ],
)
def test_a_last_column_of_text_has_the_room_that_is_left(first, text, lines):
    """What is left of a hundred, but thirty at least."""
    rows = [["n" * first, " ".join(text)], ["m", "x" * 500]]
    body = table(["n", "t"], rows).splitlines()[2:]
    assert body[0].split() == ["n" * first, *(text if lines == 1 else text[:1])]
    assert body[1].split()[0] == ("m" if lines == 1 else text[1])


def test_a_last_column_of_numbers_is_not_wrapped():
    heading = " ".join(["w" * 60, "v" * 60])
    assert table(["n", heading], [["x", 1.5]]).splitlines()[-1].split() == ["x", "1.5"]
    assert table(["n" * 60, "v" * 60], []).splitlines()[-1] == "-" * 60 + "  " + "-" * 60


def test_a_column_is_of_text_only_if_all_of_it_is():
    rows = [["x", "a", 1.5], ["y", 2.5, "bb"], ["z", 10.0, 3.0]]
    assert table(["text", "first", "second"], rows).splitlines() == [
        "text  first  second",
        "----  -----  ------",
        "x         a     1.5",
        "y       2.5      bb",
        "z        10       3",
    ]
