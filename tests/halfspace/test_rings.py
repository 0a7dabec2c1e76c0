"""Coulomb's law at every point, mode 0 of the half-space, against what it shares no code with."""

import numpy as np
import pytest
from scipy.integrate import quad

import contactlab
from contactlab_halfspace.rings import rings, settle
from tests.halfspace import other_march
from tests.halfspace.by_rings import rebound
from tests.halfspace.other_march import motion

CHI = 49 / 34
#: psi2, theory §11, by rings of another program: normal law, e, chi, psi1.
REFERENCES = {
    ("tsuji", 0.95, CHI): {0.1: 0.01946, 0.5: 0.03099, 1: -0.10738, 2: -0.85287, 4: -1.36345},
    ("tsuji", 0.8, CHI): {0.1: 0.01251, 0.5: -0.03727, 1: -0.26905, 2: -0.91227, 4: -1.0889},
    ("tsuji", 0.5, CHI): {0.1: -0.02109, 0.5: -0.24155, 1: -0.63985, 2: -1.01771, 4: -0.2095},
    ("tsuji", 0.95, 1.0): {2: -1.27005},
    ("tsuji", 0.8, 1.0): {2: -1.1719},
    ("tsuji", 0.5, 1.0): {2: -0.7455},
    ("tsuji", 0.5, 1.8): {1.6: -0.72925},
    ("tsuji", 0.323, 2.708): {3.51: -0.93},
    ("hunt_crossley", 0.5, 1.8): {1.8: -0.8458},
    ("hunt_crossley", 0.8, 1.4412): {2: -0.8977},
}
#: Those that are looked at by default.
FEW = (("tsuji", 0.5, CHI), ("tsuji", 0.323, 2.708))


def half_space(psi1, chi, normal):
    return rebound([normal], np.zeros(len(psi1), int), psi1, chi, 48)


def other(psi1, chi, normal):
    return other_march.limit(psi1, chi, normal, counts=(48, 64, 80))


MARCHES = pytest.mark.parametrize("solve", [half_space, other])


@MARCHES
@pytest.mark.parametrize(
    ("name", "e", "chi"),
    [pytest.param(*each, marks=[pytest.mark.slow] * (each not in FEW)) for each in REFERENCES],
)
def test_references_of_another_program(name, e, chi, solve):
    """Theory §11, ±1e-4."""
    psi1, expected = map(np.array, zip(*REFERENCES[name, e, chi].items(), strict=True))
    found = solve(psi1.astype(float), np.full(len(psi1), chi), motion(name, restitution=e))
    assert found == pytest.approx(expected, abs=3e-4)


@MARCHES
def test_elastic_impacts_are_the_exact_answer(solve):
    """And gross slip, at any number of rings, the closed form psi1 - 4 chi."""
    psi1, chi = (each.ravel() for each in np.meshgrid((0.1, 0.7, 1.0, 1.5, 2.5, 4.0), (0.8, CHI)))
    found = solve(psi1, chi, motion("hertz"))
    assert found == pytest.approx(contactlab.rebound(psi1, chi), abs=3e-4)
    psi1 = np.array([4.0 * CHI, 7.0, 100.0])
    for gross in (
        rebound([motion("hertz")], np.zeros(3, int), psi1, np.full(3, CHI), 8),
        other_march.rebound(psi1, np.full(3, CHI), motion("hertz"), 8),
    ):
        assert gross == pytest.approx(psi1 - 4.0 * CHI, abs=1e-9)


def test_impacts_of_many_motions_are_those_alone():
    """Some end at a larger radius than others, and wait."""
    motions = [motion("tsuji", restitution=e) for e in (0.2, 0.6, 0.95)] + [motion("hertz")]
    psi1, chi = np.array([1.2, 0.4, 2.0, 1.5, 3.0]), np.array([1.0, 1.4, 0.3, 2.0, 4.0])
    which = np.array([0, 1, 2, 3, 0])
    found = rebound(motions, which, psi1, chi, 16)
    for k, each in enumerate(which):
        part = slice(k, k + 1)
        alone = rebound([motions[each]], np.zeros(1, int), psi1[part], chi[part], 16)
        assert found[k] == pytest.approx(alone[0], abs=1e-12)


def test_displacement_of_a_traction_by_quadrature():
    """u(r) = (2/pi) ∫ w(s)/sqrt(r² - s²) ds with w = e² - s², theory §4 and §9."""
    edges = np.array([0.0, 0.3, 0.55, 0.8, 1.0])
    table = rings(edges)
    q = np.sqrt(np.maximum(edges[2] ** 2 - edges[:-1] ** 2, 0.0))

    def displaced(r):
        end = np.arcsin(min(edges[2] / r, 1.0))
        return quad(lambda t: edges[2] ** 2 - (r * np.sin(t)) ** 2, 0.0, end)[0] * 2.0 / np.pi

    found = table.compliance @ q
    assert found[0] == pytest.approx(edges[2] ** 2, rel=1e-12)
    assert found[1:] == pytest.approx([displaced(r) for r in edges[1:-1]], rel=1e-12)
    assert table.weights @ q == pytest.approx(edges[2] ** 3, rel=1e-12)


def test_cattaneo_and_mindlin():
    """At fixed load the front stands at c, D = b² - c², and F/(mu P) = 1 - (c/b)³."""
    edges = np.sin(0.5 * np.pi * np.arange(41) / 40)
    table, front = rings(edges), edges[17]
    limit = np.sqrt(1.0 - table.points**2)
    stuck, sense = np.ones((1, 40), dtype=bool), np.zeros((1, 40))
    aim = np.full((1, 40), 1.0 - front**2)
    q = settle(table, aim, limit, stuck, sense)
    assert (q @ table.weights).item() == pytest.approx(1.0 - front**3, rel=1e-9)
    assert (np.delete(stuck[0], 17) == np.delete(table.points < front, 17)).all()


@pytest.mark.parametrize("seed", range(4))
def test_coulombs_law_at_every_point(seed):
    """At random displacements: stuck as told, or slipping along a traction at its limit."""
    draw, count = np.random.default_rng(seed), 24
    table = rings(np.sin(0.5 * np.pi * np.arange(count + 1) / count))
    limit = draw.uniform(0.2, 2.0) * np.sqrt(1.0 - table.points**2)
    aim = np.cumsum(draw.normal(0.0, 0.3, (20, count)), axis=1)
    q = settle(table, aim, limit, np.ones(aim.shape, dtype=bool), np.zeros(aim.shape))
    slip = aim - q @ table.compliance.T
    assert (np.abs(q) <= limit * (1.0 + 1e-9)).all()
    slips = np.abs(slip) > 1e-8
    assert (np.abs(q)[slips] >= np.broadcast_to(limit, q.shape)[slips] * (1.0 - 1e-9)).all()
    assert (slip[slips] * q[slips] > 0.0).all()
    assert slips.any()
    assert (~slips).any()
