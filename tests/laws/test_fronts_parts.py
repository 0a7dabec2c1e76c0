"""Parts of the path of fronts: memory seen from both sides, and paths that are given up."""

import numpy as np
import pytest

from contactlab import Scene, Simulation, Status, create
from contactlab.contracts import LostPathError, ScaledContact
from contactlab.numeric.lobatto import lobatto
from contactlab_laws.events.scaled import solve
from contactlab_laws.fronts import path
from contactlab_laws.fronts.memory import Drawn, Locked
from contactlab_laws.fronts.panel import GrossStretch, PanelStretch

CHI = 49 / 34


def solved(psi1, chi=CHI, tolerance=1e-10):
    simulation = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=tolerance),
    )
    return simulation.run(Scene.nondimensional(psi1=psi1, chi=chi))


SHORT = "the front is lost: Newton's method fails on short panels"


@pytest.mark.parametrize(("name", "value"), [("TRIES", 0), ("LARGEST", 0.0), ("NEWTON_CAP", 1)])
def test_a_front_that_newtons_method_does_not_find_is_lost(name, value, monkeypatch):
    monkeypatch.setattr(path, "PICARD_CAP", 0)  # leaves all edge slip to Newton's method
    monkeypatch.setattr(path, name, value)
    found = solved(0.7)
    assert found.status is Status.UNRESOLVED
    assert SHORT in found.motion.detail


def test_fewer_moves_take_shorter_panels_to_the_same_answer(monkeypatch):
    known = solved(0.7)
    monkeypatch.setattr(path, "NEWTON_CAP", 4)
    monkeypatch.setattr(path, "PICARD_CAP", 0)
    found = solved(0.7).check()
    assert found.psi2 == pytest.approx(known.psi2, abs=1e-9)
    assert found.counters["panels"] > known.counters["panels"]


@pytest.mark.parametrize("psi1", [1.2, 2.0, 3.0])
def test_each_panel_is_counted_once(psi1):
    """Where the front is followed along its memory, without a try that fails."""
    normal = Simulation().normal_motion(Scene.nondimensional(psi1=psi1, chi=CHI))
    found = solve(create("tangential.fronts", table=False), normal, 1e-9)
    panels = [each for each in found.stretches if isinstance(each, PanelStretch)]
    assert len(panels) > 1
    assert found.motion.counters["solves"] == len(panels)


@pytest.mark.parametrize(
    ("chi", "why"),
    [
        (999.0, "slip changes too often, or stick is lost within too short a time"),
        (1001.0, "at chi = 1e+03 the contact oscillates about sqrt(chi) times"),
    ],
)
def test_too_many_panels_are_told_with_the_reason(chi, why, monkeypatch):
    monkeypatch.setattr(path, "PANEL_CAP", 3)
    found = solved(0.7, chi)
    assert found.status is Status.UNRESOLVED
    assert (
        f"More than 3 panels would be needed: {why}. A law of steps, such as springs under "
        "symplectic, can go on, with the error of its steps." in found.motion.detail
    )


def impact(psi1, chi=CHI):
    normal = Simulation().normal_motion(Scene.nondimensional(psi1=psi1, chi=chi))
    return path.Impact(psi1, 2.5 * chi, normal, 1e-9)


def test_near_rest_slip_does_not_stop():
    with pytest.raises(LostPathError, match="slip stops, though psi is too small for that"):
        impact(1e-5)._stopped(0.0)


@pytest.mark.parametrize(
    ("psi1", "chi", "rest"),
    [
        (0.9e-3, CHI, 1.0),
        (1e-3, CHI, 0.0),
        (0.9e-3, 5e4, 1.0),  # 0.9e-3 sqrt(1e5) = 0.28
        (0.9e-3, 6e4, 0.0),
    ],
)
def test_small_impacts_are_held_as_departures_from_rest(psi1, chi, rest):
    made = impact(psi1, chi)
    assert (made.rest, made.free) == (rest, 1.0 - rest)
    assert made.margin == pytest.approx(-psi1 if rest else 1.0 - psi1)
    assert (made.ratio, made.drive) == pytest.approx((2.0 * chi, 1.25 * (2.0 * chi - 1.0)))
    assert made.spring == pytest.approx(3.75 * chi)
    assert made.longest == pytest.approx(min(1.4, 8.0 / np.sqrt(6.0 * chi)))


@pytest.mark.parametrize("free", [1.0, 0.0])
def test_seen_from_the_other_sign_and_back(free):
    made = impact(0.5)
    made.x, made.free = 1.1, free
    made.margin, made.lack, made.gone = 0.2, 0.05, -0.3
    now = made._now()
    made._turn()
    assert made.sign == -1
    assert made.margin == pytest.approx(2.0 * free * now.rate - 0.2)  # V + psi for V - psi
    assert made.lack == pytest.approx(4.0 / 3.0 * free * now.force - 0.05)
    assert made.gone == pytest.approx(0.3 - 2.0 * free * now.approach)
    made._turn()
    assert (made.sign, made.margin, made.lack, made.gone) == pytest.approx((1, 0.2, 0.05, -0.3))


@pytest.mark.parametrize(("left", "length"), [(1.0, 1.0), (1.3, 1.3), (1.82, 1.4), (1.9, 1.4)])
def test_a_panel_takes_what_is_left_if_that_is_little_more(left, length):
    made = impact(0.5)
    made.longest = 1.4
    assert made._length(left) == length


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


@pytest.mark.parametrize("rest", [0.0, 1.0])
def test_a_drawn_piece_is_seen_from_the_other_sign_and_back(rest):
    """m = -x², J = x³/3 and c = x/2: -m - 2c² and (4/3) c³ - J; near rest -m and -J."""
    nodes = lobatto(8)
    x = 0.2 + 0.6 * nodes.points
    rate = 0.5 * x  # of zeta = c²
    table = -(x**2), x**3 / 3.0, -2.0 * x - rest * rate, 0.5 * x
    piece = Drawn(1, (0.2, 0.6), nodes, table, rate, rest)
    piece.cut(0.8)
    other = piece.flipped()
    assert (other.frame, other.locked, other.outer) == (-1, 0, 0.8)
    at = np.array([0.2, 0.37, 0.61, 0.8])
    free = 1.0 - rest
    gone, lack, slope, c = other.curve(at)
    assert c == pytest.approx(0.5 * at)
    assert gone == pytest.approx(at**2 - 2.0 * free * c**2)
    assert lack == pytest.approx(4.0 / 3.0 * free * c**3 - at**3 / 3.0)
    assert slope == pytest.approx(2.0 * at + rest * 0.5 * at - at)
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
    piece = Drawn(1, (0.2, 0.6), nodes, (-(x**2), x**3 / 3.0, -2.0 * x, 0.5 * x), 0.5 * x, 0.0)
    piece.cut(0.8)
    lack, radius, depth, place = (
        each.item() for each in piece.front(contact(0.6), np.array([level]), np.array([0.5]))
    )
    assert place == pytest.approx(np.sqrt(-level), abs=1e-9)
    assert radius == pytest.approx(0.5 * place, abs=1e-12)
    assert lack == pytest.approx(place**3 / 3.0, abs=1e-12)
    assert depth == pytest.approx(0.36 - radius**2, abs=1e-12)


def test_gross_slip_between_its_ends():
    """psi falls by 2 chi times the fall of V, and the force is at its limit."""
    stretch = GrossStretch(-1, 0.0, 2.0, 0.7, 0.1, 1, -0.2, 3.0)
    change, force = stretch.states(contact(0.5)._replace(rate=np.array([0.3])))
    assert change == pytest.approx([0.7 - 3.0 * 0.5])
    assert force == pytest.approx([-0.125])
    assert stretch.front(contact(0.5)) == 0.0


@pytest.mark.parametrize(
    ("psi1", "phase"),
    [(0.5, "_stuck"), (1.0, "_stuck"), (1.5, "_slip"), (1e-5, "_stuck")],
)
def test_what_an_impact_begins_with(psi1, phase, monkeypatch):
    """At psi1 = 1 it sticks where the force can follow, which is where chi > 1/2."""
    begun = []
    for name in ("_stuck", "_slip"):
        monkeypatch.setattr(path.Impact, name, lambda _, name=name: begun.append(name))
    list(impact(psi1).follow())
    assert begun == [phase]
    list(impact(1.0, 0.5).follow())
    list(impact(1.0, 0.51).follow())
    assert begun[1:] == ["_slip", "_stuck"]
