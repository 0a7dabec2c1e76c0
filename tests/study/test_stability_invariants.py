"""Bounds of the stability judge, on either side of each: invariants, errors, restitutions.

Without dimensions M_n = 1, M_t = 1/2 at chi = 1, and the unit of velocity is that of psi. At
psi1 = 1 the range is 2, the energy at the start 3/4, and the scale of the books 3/2.
"""

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.study.stability_judge import find_breaches

SPEEDS, BEYOND = "friction speeds the slip up", "|psi2| > |psi1|"
LOAD = "|psi2 - psi1| beyond what mu times the load can do"
BOOKS, WORK = "energy books do not close", "friction does work on the bodies"
COULOMB = Simulation(tangential="coulomb")


def impact(psi1, change, *, work=None, missing=0.0, **motion):
    """A rigid impact with another change; friction does the work that the slip loses, or less."""
    result = COULOMB.run(Scene.nondimensional(psi1=psi1, chi=1.0)).check()
    lost = -0.5 * change * (psi1 + 0.5 * change) - missing
    entries = {"slip_velocity_change": change, "friction_work": lost if work is None else work}
    return attrs.evolve(result, motion=attrs.evolve(result.motion, **(entries | motion)))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    ("psi1", "change", "bound", "broken"),
    [
        # The slip grows by a share of the range of 2; a tenth of it at most.
        (1.0, 0.0199, 0.01, []), (1.0, 0.0201, 0.01, [SPEEDS]),
        (1.0, 0.1999, 0.5, []), (1.0, 0.2001, 0.5, [SPEEDS]),
        (1.0, -2.0199, 0.01, []), (1.0, -2.0201, 0.01, [BEYOND]),
        (1.0, -2.1999, 0.5, []), (1.0, -2.2001, 0.5, [BEYOND]),
        # At psi1 = 9 the range is 4 chi.
        (9.0, -4.0399, 0.01, []), (9.0, -4.0401, 0.01, [LOAD]),
        # At psi1 = 2 both ranges are 4: the slip is reversed, not beyond the load.
        (2.0, -4.0401, 0.01, [BEYOND]),
    ],
)  # fmt: skip
def test_a_change_of_slip_lies_in_its_range(psi1, change, bound, broken, side):
    assert find_breaches(impact(side * psi1, side * change), bound) == broken


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("bound", "books_bound", "allowed"),
    [(1e-9, 0.0, 1e-5), (0.01, 0.0, 0.01), (0.01, 0.02, 0.02), (1e-9, 5.0, 0.1), (0.3, 0.2, 0.3)],
)
def test_books_close_to_their_bound(bound, books_bound, allowed, sign):
    for share, broken in ((0.999, []), (1.001, [BOOKS])):
        result = impact(1.0, -1.0, missing=sign * share * allowed * 1.5)
        found = find_breaches(result, bound, books_bound=books_bound)
        assert [each for each in found if each != WORK] == broken


@pytest.mark.parametrize(("bound", "allowed"), [(0.01, 0.01), (0.5, 0.1)])
def test_friction_takes_energy(bound, allowed):
    """A full reversal loses none: all that friction does is its own."""
    for share, broken in ((0.999, []), (1.001, [WORK])):
        result = impact(1.0, -2.0, work=-share * allowed * 1.5)
        assert find_breaches(result, bound, books_bound=0.1) == broken


def test_books_that_are_not_known_do_not_close():
    assert find_breaches(impact(1.0, -1.0, exchange=np.nan), 0.01) == [BOOKS]


def test_a_law_whose_model_makes_energy_is_held_to_the_load_alone():
    for psi1, change, broken in ((1.0, 0.5, []), (1.0, -2.5, []), (9.0, -4.1, [LOAD])):
        assert find_breaches(impact(psi1, change), 0.01, passive=False) == broken
    assert find_breaches(impact(1.0, -1.0, work=9.0), 0.01, passive=False) == []


def test_the_range_follows_the_impulse_of_the_load():
    """An impulse of 1 slows by mu/M_t = 2; one of 100 leaves the reversal, 18 at psi1 = 9."""
    for change, impulse, broken in (
        (-2.019, 1.0, []), (-2.021, 1.0, [LOAD]), (-18.1, 100.0, []), (-18.2, 100.0, [BEYOND]),
    ):  # fmt: skip
        found = find_breaches(impact(9.0, change), 0.01, load_impulse=impulse)
        assert [each for each in found if each != WORK] == broken


@pytest.mark.parametrize(
    "name", ["slip_velocity_change", "normal_velocity", "duration", "friction_work"]
)
@pytest.mark.parametrize("value", [np.nan, -np.inf])
def test_every_number_is_finite(name, value):
    broken = find_breaches(impact(1.0, -1.0, **{name: value}), 0.01)
    assert broken == ["a number that is not finite"]


def test_where_nothing_can_act_nothing_changes():
    assert find_breaches(impact(0.0, 0.0), 0.01) == []
    told = ["a change of velocity where nothing can act"]
    for change in (1e-300, -1e-300):
        assert find_breaches(impact(0.0, change), 0.01) == told
