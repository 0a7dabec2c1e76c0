"""One step of a spring that slips aside, against the differential equation of Coulomb's law."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from contactlab_laws.springs.turning import turned


def dragged(held, move, least, most):
    """Return w at the end of a step: it sticks up to its limit, and then slips along itself."""
    growth = most - least

    def beyond(share):
        return abs(held + share * move) - (least + share * growth)

    begin = 0.0 if abs(held) == least else brentq(beyond, 0.0, 1.0)

    def pulled(_, w):
        way = (w[0] + 1j * w[1]) / np.hypot(*w)
        slip = (way.conjugate() * move).real - growth  # the spring is as long as its limit
        rate = move - slip * way
        return [rate.real, rate.imag]

    first = held + begin * move
    end = solve_ivp(pulled, (begin, 1.0), [first.real, first.imag], rtol=1e-10, atol=1e-12).y[:, -1]
    return complex(*end)


@pytest.mark.parametrize(("growth", "short"), [(0.2, 0.2), (-0.5, 0.4), (0.2, 0.0), (-0.5, 0.0)])
def test_a_step_has_a_local_error_of_third_order(growth, short):
    """The spring begins beside the pull, and reaches its limit in the step or is there before."""
    sizes, errors = np.array([0.1, 0.05, 0.025, 0.0125]), []
    for size in sizes:
        held, move = (1.0 - short * size) * (0.6 + 0.8j), 1.5 * size + 0.0j
        most = 1.0 + growth * size
        column = [np.array([[each]]) for each in (held, move, 1.0, most)]
        found, lost = turned(*column)
        assert abs(found[0, 0]) == pytest.approx(most)
        assert lost[0] > 0.0
        errors.append(abs(found[0, 0] - dragged(held, move, 1.0, most)))
    order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order > 2.7
