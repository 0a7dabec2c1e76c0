"""Every refusal of a number, word for word, and the bounds on both of their sides."""

import attrs
import numpy as np
import pytest

from contactlab.numeric import checks
from contactlab.numeric.names import nearest

ABOVE, BELOW = np.nextafter(1.0, 2.0), np.nextafter(-1.0, -2.0)


def refusal(make, *given, **named):
    """Return the words with which a call is refused."""
    with pytest.raises(ValueError, match=" ") as caught:
        make(*given, **named)
    return str(caught.value)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (float("nan"), "nan: must be positive and finite"),
        (float("inf"), "inf: must be positive and finite"),
        (-1.0, "-1.0: must be positive and finite"),
        (0, "0: must be positive and finite"),
        (np.float32(-2.0), f"{np.float32(-2.0)!r}: must be positive and finite"),
        ("1", "'1': must be a real number"),
        (b"1", "b'1': must be a real number"),
        (True, "True: must be a real number"),
        (None, "None: must be a real number"),
        ([True], "[True]: must be a real number"),
        ([1j], "[1j]: must be a real number"),
        ([[1.0], [1.0, 2.0]], "[[1.0], [1.0, 2.0]]: must be a number or a regular array"),
        ([], "[]: must hold at least one number"),
        ([-1.0], "[-1.0]: must be positive and finite"),
        ([-1.0, -2.0], "[-1.0, -2.0]: must be positive and finite"),
        (
            [1, -1, -2],
            "[1, -1, -2]: must be positive and finite (the first of 2 has index [1])",
        ),
        (
            [[1.0, 2.0], [3.0, float("nan")]],
            "[[1.0, 2.0], [3.0, nan]]: must be positive and finite (the first of 1 has index "
            "[1, 1])",
        ),
    ],
)
def test_a_number_is_refused_with_name_value_rule_and_remedy(value, words):
    given = {"rule": checks.POSITIVE, "remedy": "give it in m"}
    assert refusal(checks.real, "radius", value, **given) == f"radius = {words}; give it in m"


def test_what_a_number_that_is_not_finite_is_told_without_a_rule():
    assert refusal(checks.real, "x", float("nan")) == "x = nan: must be a finite real number"
    masked = np.ma.masked_array([1.0, 2.0], [False, True])
    assert refusal(checks.real, "x", masked, remedy="any").endswith(
        ": must have no masked entries; fill or drop them"
    )
    assert checks.real("x", np.ma.masked_array([1.0, 2.0])).tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    ("rule", "holds", "fails"),
    [
        (checks.POSITIVE, [5e-324, 1e308], [0.0, -5e-324, np.inf]),
        (checks.NON_NEGATIVE, [0.0, 1e308], [-5e-324, np.inf]),
        (checks.POISSON, [-1.0, 0.0, 0.5], [BELOW, np.nextafter(0.5, 1.0)]),
        (checks.GYRATION, [5e-324, 1.0], [0.0, -0.5, ABOVE]),
        (checks.FINITE, [0.0, -1e308, 1e308], [np.inf, -np.inf, np.nan]),
    ],
)
def test_a_rule_holds_up_to_its_bounds(rule, holds, fails):
    for value in holds:
        assert checks.real("x", value, rule=rule) == value
        assert checks.real("x", [value, value], rule=rule).tolist() == [value, value]
    for value in map(float, fails):
        assert refusal(checks.real, "x", value, rule=rule) == f"x = {value}: {rule.sentence}"
        assert rule.sentence in refusal(checks.real, "x", [holds[0], value], rule=rule)


def test_an_array_that_is_kept_is_a_copy_and_read_only():
    mine = np.array([1.0, 2.0])
    kept, used = checks.real("x", mine), checks.real("x", mine, kept=False)
    assert used is mine
    assert used.flags.writeable
    assert not kept.flags.writeable
    mine[0] = 5.0
    assert kept.tolist() == [1.0, 2.0]
    assert checks.real("x", [1, 2]).dtype == np.float64
    for scalar in (3, np.int64(3), np.array(3.0), np.float32(3.0)):
        assert type(checks.real("x", scalar)) is float
    assert checks.real("x", [], empty=True).shape == (0,)


def test_two_quantities_of_one_shape():
    one, other = np.array([1.0, 2.0]), np.array([3.0, 4.0])
    found = checks.pair_up("psi1", "chi", (one, other))
    assert (found[0] is one, found[1] is other) == (True, True)
    plain = checks.pair_up("psi1", "chi", (1.0, 2.0))
    assert [(each.shape, float(each)) for each in plain] == [((), 1.0), ((), 2.0)]
    spread = checks.pair_up("psi1", "chi", (1.0, other))
    assert [each.tolist() for each in spread] == [[1.0, 1.0], [3.0, 4.0]]
    spread = checks.pair_up("psi1", "chi", (one[:, None], other))
    assert [each.shape for each in spread] == [(2, 2), (2, 2)]
    assert refusal(checks.pair_up, "psi1", "chi", (one, np.ones(3))) == (
        "shapes of psi1 and chi = ((2,), (3,)): must broadcast to one; one value of chi for each "
        "psi1"
    )


def test_whole_numbers_have_a_least_and_a_most():
    for value in (1, 10_000_000):
        assert checks.whole("n", value) == value
    for value in (0, 10_000_001):
        assert refusal(checks.whole, "n", value) == (
            f"n = {value}: must be a whole number from 1 to 10000000"
        )
    assert type(checks.whole("n", np.int32(0), least=0)) is int
    assert refusal(checks.whole, "n", True) == "n = True: must be a whole number from 1 to 10000000"


@attrs.frozen(kw_only=True)
class Options:
    """One option of each kind."""

    size: float = checks.quantity("m", rule=checks.POSITIVE, default=2.0)
    ratio: float | None = checks.quantity("1", default=None)
    steps: int = checks.count(default=5)
    parts: int = checks.count(default=2, least=2, most=4)
    grid: str = checks.choice("even", "largest", default="even")
    refine: bool = checks.flag(default=True)


def test_options_have_defaults_units_and_ranges():
    made = Options()
    assert attrs.astuple(made) == (2.0, None, 5, 2, "even", True)
    told = {item.name: dict(item.metadata) for item in attrs.fields(Options)}
    assert {name: each["unit"] for name, each in told.items()} == {
        "size": "m", "ratio": "1", "steps": "1", "parts": "1", "grid": "", "refine": "",
    }  # fmt: skip
    assert {name: each["range"] for name, each in told.items()} == {
        "size": "must be positive and finite",
        "ratio": "must be a finite real number",
        "steps": "must be a whole number from 1 to 10000000",
        "parts": "must be a whole number from 2 to 4",
        "grid": "must be one of 'even', 'largest'",
        "refine": "must be True or False",
    }
    assert told["grid"]["words"] == ("even", "largest")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"size": 0.0}, "size = 0.0: must be positive and finite; give it in m"),
        ({"size": None}, "size = None: must be a real number; give it in m"),
        ({"size": []}, "size = []: must hold at least one number; give it in m"),
        ({"ratio": "x"}, "ratio = 'x': must be a real number; it has no unit"),
        ({"parts": 1}, "parts = 1: must be a whole number from 2 to 4"),
        ({"parts": 5}, "parts = 5: must be a whole number from 2 to 4"),
        ({"grid": "odd"}, "grid = 'odd': must be one of 'even', 'largest'"),
        ({"refine": 1}, "refine = 1: must be True or False"),
    ],
)
def test_an_option_is_refused_by_name(given, words):
    assert refusal(Options, **given) == words


def test_arrays_are_equal_by_shape_and_numbers():
    assert Options(size=[1.0, 2.0]) == Options(size=np.array([1.0, 2.0]))
    assert Options(size=[1.0, 2.0]) != Options(size=[1.0, 3.0])
    assert Options(size=[1.0, 2.0]) != Options(size=[[1.0, 2.0]])
    assert Options(ratio=[0.0, 1.0]) == Options(ratio=[-0.0, 1.0])
    assert hash(Options(size=[1.0, 2.0])) == hash(Options(size=[1.0, 2.0]))
    assert Options(ratio=None) != Options(ratio=0.0)


def test_the_nearest_name():
    assert nearest("ab", ["ac"]) == "did you mean 'ac'? "  # alike by half
    assert nearest("ab", ["acd"]) == ""
    assert nearest("mu", ["mass", "friction_coefficient"]) == (
        "did you mean 'friction_coefficient'? "
    )
    assert nearest("v", ["speed", "velocity"]) == "did you mean 'speed' or 'velocity'? "
    assert nearest("mu", []) == ""


def test_what_cannot_be_shown_is_named_by_its_class():
    class Mute:
        def __repr__(self):
            raise RuntimeError

    assert checks.quote(Mute()) == "a Mute"
    assert checks.quote("x" * 30, most=10) == "'xxxxxx..."
    assert checks.quote("abc", most=5) == "'abc'"
    assert str(checks.refuse("x", 1, "is bad")) == "x = 1: is bad"
