"""The rebound at a given restitution: its table against rings, its range, bad input."""

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyval

import contactlab
from contactlab import Scene, Simulation
from contactlab.compose.rebound import BEYOND_ERROR, DAMPED_ERROR
from contactlab_laws.halfspace.axisymmetric import rebound as by_rings_of
from contactlab_laws.tables.damped import BORDERS, by_rings, depth, inner, rebound, section, tsuji
from contactlab_laws.tables.damped import CHI as RANGE_OF_CHI
from table_builders.damped import build
from table_builders.damped.build import by_half_space, restitution
from tests.laws.other_march import limit
from tests.laws.test_rings import REFERENCES
from tests.longer import longer

CHI = 49 / 34


@pytest.mark.parametrize("e", [0.9, *longer(0.5, 0.9999)])
def test_table_is_rings_to_its_error(e):
    """At random impacts; ``python -m table_builders damped verify`` draws more."""
    draw = np.random.default_rng(round(1e4 * e))
    psi1, chi = draw.uniform(0.0, 9.0, 12), draw.uniform(0.8, 1.8, 12)
    found = limit(psi1, chi, tsuji(e), counts=(72, 96, 120, 144))
    assert rebound(psi1, chi, e) == pytest.approx(found, abs=2e-4)


@pytest.mark.slow
def test_table_is_the_half_space():
    """At 500 random impacts, a third of them close to e = 1; by other rings than the table's."""
    draw, law = np.random.default_rng(22), contactlab.create
    friction = law("tangential.halfspace", angles=1, rings=64)
    for number in range(25):
        e = float(draw.uniform(0.5, 1.0))
        if number % 3 == 0:
            e = 1.0 - 10.0 ** float(draw.uniform(-5.0, -1.0))
        psi1, chi = draw.uniform(0.0, 9.0, 20), draw.uniform(0.8, 1.8, 20)
        simulation = Simulation(normal=law("normal.tsuji", restitution=e), tangential=friction)
        found = simulation.run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
        assert contactlab.rebound(psi1, chi, restitution=e) == pytest.approx(found, abs=2e-4)


@pytest.mark.slow
def test_table_is_another_march_to_its_error():
    """At 240 random impacts, a third of them close to e = 1; rings extrapolated from others."""
    draw = np.random.default_rng(19)
    for number in range(12):
        e = float(draw.uniform(0.5, 1.0))
        if number % 3 == 0:
            e = 1.0 - 10.0 ** float(draw.uniform(-5.0, -1.0))
        psi1, chi = draw.uniform(0.0, 9.0, 20), draw.uniform(0.8, 1.8, 20)
        other = limit(psi1, chi, tsuji(e), counts=(64, 96, 128))
        assert rebound(psi1, chi, e) == pytest.approx(other, abs=3e-4)


@pytest.mark.parametrize(("name", "e", "chi"), REFERENCES)
def test_references_of_another_program(name, e, chi):
    """Theory §11: Coulomb's law at every point, ±1e-4."""
    if name != "tsuji":
        pytest.skip("rebound follows Tsuji's law")
    psi1, expected = zip(*REFERENCES[name, e, chi].items(), strict=True)
    found = contactlab.rebound(np.array(psi1, dtype=float), chi, restitution=e)
    assert found == pytest.approx(expected, abs=2e-4)


BEYOND = [
    (0.8, 0.3),
    *longer((4.0, 0.05), (10.0, 0.95)),
]


@pytest.mark.parametrize(("largest", "e"), BEYOND)
def test_beyond_the_table_rings_answer_to_their_error(largest, e):
    draw = np.random.default_rng(5)
    psi1, chi = draw.uniform(0.0, 9.0, 8), draw.uniform(0.5 * largest, largest, 8)
    finer = limit(psi1, chi, tsuji(e), counts=(96, 128))
    found = contactlab.rebound(psi1, chi, restitution=e)
    assert found == pytest.approx(finer, abs=BEYOND_ERROR)
    assert (contactlab.rebound(-psi1, chi, restitution=e) == -found).all()


def test_table_meets_the_elastic_rebound():
    """Down to e = 1 - 1e-12 nothing jumps."""
    psi1 = np.linspace(0.0, 9.0, 400)
    for chi in (0.8, 1.2, CHI, 1.8):
        elastic = contactlab.rebound(psi1, chi)
        assert contactlab.rebound(psi1, chi, restitution=1.0 - 1e-12) == pytest.approx(
            elastic, abs=2e-4
        )
        assert (contactlab.rebound(psi1, chi, restitution=1.0) == elastic).all()


@pytest.mark.parametrize(("e", "jump"), [(0.5, 7e-4), (0.9, 5e-4)])
def test_no_jump_at_cuts(e, jump):
    """Over psi1."""
    psi1 = np.linspace(0.01, 12.0, 20_001)
    for chi in (0.8, CHI, 1.8):
        psi2 = contactlab.rebound(psi1, chi, restitution=e)
        assert np.abs(np.diff(psi2, 2)).max() < jump


def test_no_jump_where_two_pieces_meet():
    """Over e, at e = 0.9: by two polynomials, one on each side."""
    assert depth(0.9 + 1e-9) < BORDERS[1] < depth(0.9 - 1e-9)
    psi1 = np.linspace(0.01, 12.0, 5001)
    for chi in (0.8, 1.0, CHI, 1.8):
        above, below = (contactlab.rebound(psi1, chi, restitution=0.9 + d) for d in (1e-9, -1e-9))
        assert 1e-8 < np.abs(above - below).max() < 5e-4


@pytest.mark.slow
@pytest.mark.parametrize("e", [0.5, 0.503, 0.65, 0.8, 0.897, 0.9001, 0.97, 0.999])
def test_error_beside_the_cuts(e):
    """Where it is largest: on both sides of every cut, by more rings than the table's."""
    chi = np.array([0.8, 1.0, 1.25, CHI, 1.8])
    cuts = polyval(inner(chi, *RANGE_OF_CHI), section(e).cuts.T)
    offsets = np.array([-0.01, -0.003, -1e-5, 1e-5, 0.001, 0.003, 0.01])
    psi1 = (cuts[None] + offsets[:, None, None]).ravel()
    chi = np.broadcast_to(chi, (len(offsets), *cuts.shape)).ravel()
    finer = by_half_space(tsuji(e), psi1, chi, rings=128)
    assert rebound(psi1, chi, e) == pytest.approx(finer, abs=DAMPED_ERROR)


def test_odd_to_the_last_bit_and_slip_throughout():
    psi1 = np.array([0.0, 0.3, 1.2, 2.5, 9.0, 1e6, 1e16])
    psi2 = contactlab.rebound(psi1, CHI, restitution=0.8)
    assert (contactlab.rebound(-psi1, CHI, restitution=0.8) == -psi2).all()
    assert psi2[-2] == pytest.approx(1e6 - 2.0 * CHI * 1.8, abs=1e-4)
    assert np.isfinite(psi2).all()
    assert psi2[0] == 0.0


@pytest.mark.slow
def test_beyond_the_table_random_impacts_are_those_of_more_rings():
    """With a restitution each, over all psi1 up to slip throughout."""
    draw = np.random.default_rng(27)
    for low, high in ((0.01, 0.8), (0.8, 1.8), (1.8, 10.0)):
        chi = draw.uniform(low, high, 50)
        e = draw.uniform(0.01, 0.5 if low == 0.8 else 1.0, 50)
        psi1 = draw.uniform(0.0, 2.0 * chi * (1.0 + e) + 1.0)
        motions = [tsuji(each) for each in e.tolist()]
        finer = by_rings_of(motions, np.arange(50), psi1, chi, 128)
        found = contactlab.rebound(psi1, chi, restitution=e)
        assert found == pytest.approx(finer, abs=BEYOND_ERROR)


@pytest.mark.parametrize("chi", [0.001, *longer(0.5, 9.0)])
def test_no_impact_gains_slip_velocity(chi):
    """By rings psi1 = 1e-19 came back as -1.17 at e = 0.3, chi = 0.001."""
    psi1 = np.array([1e-31, 1e-19, 1e-7, 1e-3])
    for e in (0.3, 0.9):
        assert (np.abs(contactlab.rebound(psi1, chi, restitution=e)) <= psi1).all()


def test_the_same_on_both_sides_of_the_border():
    """And in one array."""
    psi1 = np.full(4, 1.3)
    chi = np.array([0.8, 0.8 - 1e-9, 1.8, 1.8 + 1e-9])
    found = contactlab.rebound(psi1, chi, restitution=0.9)
    assert found[0::2] == pytest.approx(found[1::2], abs=2e-4)
    assert found[1] == pytest.approx(by_rings(psi1[1:2], chi[1:2], np.array([0.9]))[0], abs=1e-9)
    low = contactlab.rebound(1.3, 1.0, restitution=0.4999)
    assert low == pytest.approx(contactlab.rebound(1.3, 1.0, restitution=0.5), abs=2e-4)
    assert isinstance(low, float)


@pytest.mark.parametrize("wrong", [0.0, -0.5, 1.1, np.nan, "high", None])
def test_bad_restitution_is_refused(wrong):
    with pytest.raises(ValueError, match="restitution = "):
        contactlab.rebound(1.2, CHI, restitution=wrong)


def test_derivatives_are_refused_with_a_restitution():
    with pytest.raises(ValueError, match=r"derivatives = True.*restitution"):
        contactlab.rebound(1.2, CHI, restitution=0.9, derivatives=True)


def test_an_impact_alone_is_that_of_an_array():
    draw = np.random.default_rng(6)
    psi1, chi = draw.uniform(-9.0, 9.0, 200), draw.uniform(0.8, 1.8, 200)
    for e in (0.5, 0.9, 0.97):
        together = contactlab.rebound(psi1, chi, restitution=e)
        alone = [
            contactlab.rebound(*pair, restitution=e)
            for pair in zip(psi1.tolist(), chi.tolist(), strict=True)
        ]
        assert alone == pytest.approx(together, abs=5e-14)


def test_a_restitution_is_that_of_its_coordinate():
    values = np.linspace(0.5, 1.0, 11)
    assert restitution(depth(values)) == pytest.approx(values, abs=1e-15)


@pytest.mark.parametrize("e", [0.8, *longer(0.55, 0.97)])
def test_the_cuts_are_found_again(e, monkeypatch):
    """By other numbers of rings and of impacts than the table's."""
    monkeypatch.setattr(build, "LOOKED", 29)
    chi = np.array([0.9, 1.44, 1.7])
    known = polyval(inner(chi, *RANGE_OF_CHI), section(e).cuts.T)
    assert build.cuts_at(e, chi, rings=40) == pytest.approx(known, abs=0.01)
