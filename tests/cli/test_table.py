"""Tables keep to the width of a terminal."""

from contactlab.cli.table import WIDTH, table


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
