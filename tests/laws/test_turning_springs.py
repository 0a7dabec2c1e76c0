"""One step of a spring that slips aside, against the differential equation of Coulomb's law."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from contactlab_laws.springs.turning import beyond, relax, turn_springs


def dragged(held, move, least, most, cross=1.0):
    """Return w at the end of a step: it sticks up to its limit, and then slips along itself."""
    growth, stretch = most - least, move.real + 1j * cross * move.imag

    def beyond(share):
        return abs(held + share * stretch) - (least + share * growth)

    begin = 0.0 if abs(held) == least else brentq(beyond, 0.0, 1.0)

    def pulled(_, w):
        way = (w[0] + 1j * w[1]) / np.hypot(*w)
        soft = way.real + 1j * cross * way.imag  # of a slip along the force
        slip = ((way.conjugate() * stretch).real - growth) / (way.conjugate() * soft).real
        rate = stretch - slip * soft
        return [rate.real, rate.imag]

    first = held + begin * stretch
    end = solve_ivp(pulled, (begin, 1.0), [first.real, first.imag], rtol=1e-10, atol=1e-12).y[:, -1]
    return complex(*end)


@pytest.mark.parametrize("cross", [1.0, 1.3, 0.6])
@pytest.mark.parametrize(
    ("growth", "short", "least"),
    [(0.2, 0.2, 1.8), (-0.5, 0.4, 1.8), (0.2, 0.0, 2.7), (-0.5, 0, 2.7)],
)
def test_a_step_has_a_local_error_of_third_order(cross, growth, short, least):
    """The spring begins beside the pull; of second order where it reaches its limit in the step."""
    sizes, errors = np.array([0.1, 0.05, 0.025, 0.0125, 0.00625]), []
    for size in sizes:
        held, move = (1.0 - short * size) * (0.6 + 0.8j), 1.5 * size + 0.0j
        most = 1.0 + growth * size
        column = [np.array([[each]]) for each in (held, move, 1.0, most)]
        found, lost = turn_springs(*column, cross=None if cross == 1.0 else np.array([cross]))
        assert abs(found[0, 0]) == pytest.approx(most)
        assert lost[0] > 0.0
        errors.append(abs(found[0, 0] - dragged(held, move, 1.0, most, cross)))
    order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order > least


def test_a_spring_slips_to_the_closest_point_of_its_limit():
    """The slip, beyond the limit over the stiffness, is along the force; for any size and ratio."""
    rng = np.random.default_rng(3)
    force = rng.normal(size=20_000) + 1j * rng.normal(size=20_000)
    force = force * 10.0 ** rng.uniform(-3.0, 6.0, force.size)
    limit, cross = (
        np.abs(force) * rng.uniform(0.0, 1.5, force.size) ** 3,
        rng.uniform(0.5, 2.0, 20_000),
    )
    over = beyond(force, limit, cross)
    kept, slips = force - over, np.abs(force) > limit
    assert not over[~slips].any()
    rounding = 4e-16 * np.abs(force[slips])
    assert (np.abs(np.abs(kept)[slips] - limit[slips]) <= 1e-9 * limit[slips] + rounding).all()
    slips &= limit > 1e-6 * np.abs(force)  # of others the difference keeps few digits
    slip = relax(over, cross)[slips]
    assert (slip.conj() * kept[slips]).real.min() > 0.0
    aside = (slip.conj() * kept[slips]).imag / (np.abs(slip) * np.abs(kept[slips]))
    assert np.abs(aside).max() < 1e-8


@pytest.mark.parametrize(("size", "limit"), [(1e-200, 1e-250), (1e150, 1e-100), (1e-5, 0.0)])
def test_a_force_far_beyond_its_limit_is_cut_without_a_warning(size, limit):
    with np.errstate(all="raise", under="ignore"):
        over = beyond(np.array([[size * (1 + 1j)]]), np.array([[limit]]), np.array([1.3]))
    assert np.abs(size * (1 + 1j) - over[0, 0]) == pytest.approx(limit, rel=1e-9)
