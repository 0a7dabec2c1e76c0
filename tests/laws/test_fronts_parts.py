"""Parts of the path of fronts: memory seen from both sides, and paths that are given up."""

import numpy as np
import pytest

from contactlab import Scene, Simulation, Status, create
from contactlab.contracts import ScaledContact
from contactlab.numeric.lobatto import lobatto
from contactlab_laws.fronts import path
from contactlab_laws.fronts.memory import Drawn, Locked

CHI = 49 / 34


def solved(psi1, chi=CHI, tolerance=1e-10):
    simulation = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=tolerance),
    )
    return simulation.run(Scene.nondimensional(psi1=psi1, chi=chi))


@pytest.mark.parametrize(("name", "value"), [("TRIES", 0), ("LARGEST", 0.0), ("NEWTON_CAP", 1)])
def test_a_front_that_newtons_method_does_not_find_is_lost(name, value, monkeypatch):
    monkeypatch.setattr(path, "PICARD_CAP", 0)  # leaves all edge slip to Newton's method
    monkeypatch.setattr(path, name, value)
    found = solved(0.7)
    assert found.status is Status.UNRESOLVED
    assert "front is lost" in found.motion.detail


@pytest.mark.parametrize(
    ("chi", "why"),
    [
        (999.0, "slip changes too often"),
        (1001.0, "oscillates about sqrt(chi) times"),
    ],
)
def test_too_many_panels_are_told_with_the_reason(chi, why, monkeypatch):
    monkeypatch.setattr(path, "PANEL_CAP", 3)
    found = solved(0.7, chi)
    assert found.status is Status.UNRESOLVED
    assert why in found.motion.detail


def contact(radius):
    return ScaledContact(
        *(np.array([each]) for each in (0.5, radius**2, radius, 0.3, radius**3, 1))
    )


def test_a_locked_zone_is_a_parabola_of_the_other_sign():
    """Locked at m = 0.1, J = 0.2 of the sign -1: of the other sign -m - 2c² and (4/3) c³ - J."""
    piece = Locked(-1, 0.1, 0.2, 0.3, 0.8)
    assert (piece.frame, piece.locked, piece.inner, piece.outer) == (1, -1, 0.3, 0.8)
    c = np.array([0.3, 0.5])
    gone, lack, slope, radius = piece.curve(c)
    assert gone == pytest.approx(-0.1 - 2.0 * c**2)
    assert lack == pytest.approx(4.0 / 3.0 * c**3 - 0.2)
    assert slope == pytest.approx(-4.0 * c)
    assert radius.tolist() == c.tolist()
    assert (piece.highest, piece.lowest) == pytest.approx((-0.28, -1.38))
    assert (piece.lack, piece.radius) == pytest.approx((4.0 / 3.0 * 0.512 - 0.2, 0.8))
    piece.cut(0.5)
    assert (piece.outer, piece.lowest) == pytest.approx((0.5, -0.6))
    for level, front in ((-0.42, 0.4), (-0.28, 0.3), (0.5, 0.3)):  # not beyond the inner end
        here = ScaledContact(0.5, 0.81, 0.9, 0.3, 0.729, 1.0)
        found = piece.front_at(here, level, 0.4)
        gone = -0.1 - 2.0 * front**2
        assert found == pytest.approx(
            [4.0 / 3.0 * front**3 - 0.2 - front * (level - gone), front, 0.81 - front**2, front]
        )


def test_a_drawn_piece_is_seen_from_the_other_sign_and_back():
    """m = -x², J = x³/3 and c = x/2: -m - 2c² and (4/3) c³ - J."""
    nodes = lobatto(8)
    x = 0.2 + 0.6 * nodes.points
    rate = 0.5 * x  # of zeta = c²
    table = -(x**2), x**3 / 3.0, -2.0 * x, 0.5 * x
    piece = Drawn(1, (0.2, 0.6), nodes, table, rate)
    piece.cut(0.8)
    other = piece.flipped()
    assert (other.frame, other.locked, other.outer) == (-1, 0, 0.8)
    at = np.array([0.2, 0.37, 0.61, 0.8])
    gone, lack, slope, c = other.curve(at)
    assert c == pytest.approx(0.5 * at)
    assert gone == pytest.approx(at**2 - 2.0 * c**2)
    assert lack == pytest.approx(4.0 / 3.0 * c**3 - at**3 / 3.0)
    assert slope == pytest.approx(at)
    back = other.flipped()
    for one, two in zip(back.curve(at), piece.curve(at), strict=True):
        assert one == pytest.approx(two, abs=1e-14)
    assert (back.frame, back.highest, back.lowest) == pytest.approx(
        (1, piece.highest, piece.lowest)
    )


@pytest.mark.parametrize("level", [-0.05, -0.2, -0.5])
def test_the_front_stands_where_the_curve_has_the_same_m(level):
    """On m = -x², c = x/2 between 0.2 and 0.8: at x = sqrt(-m), J carried on by -c dm."""
    nodes = lobatto(8)
    x = 0.2 + 0.6 * nodes.points
    piece = Drawn(1, (0.2, 0.6), nodes, (-(x**2), x**3 / 3.0, -2.0 * x, 0.5 * x), 0.5 * x)
    piece.cut(0.8)
    lack, radius, depth, place = (
        each.item() for each in piece.front(contact(0.6), np.array([level]), np.array([0.5]))
    )
    assert place == pytest.approx(np.sqrt(-level), abs=1e-9)
    assert radius == pytest.approx(0.5 * place, abs=1e-12)
    assert lack == pytest.approx(place**3 / 3.0, abs=1e-12)
    assert depth == pytest.approx(0.36 - radius**2, abs=1e-12)
