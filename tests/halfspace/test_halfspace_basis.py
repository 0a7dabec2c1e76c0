"""The half-space's fields, and single contacts, against closed forms and Bessel integrals."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipk, jv

import contactlab
from contactlab import Scene
from contactlab.solve.normal_motion import normal_motion
from contactlab_halfspace.basis import basis
from contactlab_halfspace.hemispheres import displacement
from contactlab_halfspace.instants import instants
from contactlab_halfspace.march import follow
from contactlab_halfspace.modes import modes
from contactlab_halfspace.pressure import Answering, Contact, Prescribed
from contactlab_halfspace.splitting import TOLERANCE, settle
from tests.longer import longer

HERTZ = contactlab.create("normal.hertz")
MOTION = normal_motion(HERTZ, Scene.nondimensional(psi1=1.0, chi=1.0))


@pytest.mark.parametrize(
    ("order", "source", "radius", "edge"),
    [(2, 0, 0.5, 1.0), (0, 2, 1.5, 1.0), (3, 1, 0.3, 0.8), (1, 2, 0.7, 0.5), (3, 3, 0.7, 0.5)],
)
def test_displacements_are_the_bessel_integrals(order, source, radius, edge):
    def integrand(k):
        transform = np.sqrt(0.5 * np.pi) * (edge / k) ** 1.5 * jv(source + 1.5, k * edge)
        return 4.0 / np.pi * jv(order, k * radius) * transform

    pieces = np.arange(0.0, 1000.0, 20.0)
    total = sum(quad(integrand, start, start + 20.0, limit=200)[0] for start in pieces)
    assert displacement(order, source, radius, edge) == pytest.approx(total, abs=2e-7)


def test_displacement_of_a_hemisphere_within_and_beyond_it():
    """e² - r²/2 inside; outside by Abel's integral, theory §4 and §9."""
    radius, edge = np.array([0.0, 0.3, 0.55, 0.8]), 0.55
    angle = np.arcsin(edge / 0.8)
    root = edge * 0.8 * np.sqrt(1.0 - (edge / 0.8) ** 2)
    outside = (2.0 / np.pi) * ((edge**2 - 0.5 * 0.8**2) * angle + 0.5 * root)
    expected = [*(edge**2 - 0.5 * radius[:3] ** 2), outside]
    assert displacement(0, 0, radius, edge) == pytest.approx(expected, rel=1e-13)


def test_drag_of_a_hertz_pressure():
    """U_r = Lam (4/(3 pi)) (b³/rho)(1 - (1 - rho²/b²)^1.5), theory §9."""
    radius, edge = np.array([0.2, 0.5, 0.7, 0.9, 2.0]), 0.7
    inside = np.maximum(1.0 - (radius / edge) ** 2, 0.0) ** 1.5
    expected = 4.0 / (3.0 * np.pi) * edge**3 / radius * (1.0 - inside)
    assert displacement(1, 0, radius, edge) == pytest.approx(expected, rel=1e-13)


def test_cosine_of_twice_the_angle():
    """A hemisphere of traction makes nu/(2 - nu) r²/4 cos 2 theta: .0441176 at nu = .3."""
    table = modes(24, 8, 0.3, 0.0, None)
    traction = table.along * np.sqrt(1.0 - table.points**2)
    found = table.to[:2] @ table.displace(traction[None])[0]
    second = 0.5 * (found[0, 1] + found[1, 1])  # of order 1 + 1
    assert second == pytest.approx(0.3 / 1.7 * 0.25 * table.points**2, abs=1e-10)
    uniform = 0.5 * (found[0, 1] - found[1, 1])
    assert uniform == pytest.approx(1.0 - 0.5 * table.points**2, abs=1e-10)


def test_both_mirror_classes_have_the_displacements_of_a_hemisphere():
    """Along x, at the angles of spin about the normal, which are a right angle further."""
    table = modes(24, 8, 0.3, 0.0, None, True)
    angle = (np.arange(8)[:, None] + 0.5) * np.pi / 8 + 0.5 * np.pi
    radial, around = table.displace(table.along[None] * np.sqrt(1.0 - table.points**2))[0]
    ux = radial * np.cos(angle) - around * np.sin(angle)
    uy = radial * np.sin(angle) + around * np.cos(angle)
    second = 0.3 / 1.7 * 0.25 * table.points**2
    assert ux == pytest.approx(1.0 - 0.5 * table.points**2 + second * np.cos(2 * angle), abs=1e-10)
    assert uy == pytest.approx(second * np.sin(2 * angle), abs=1e-10)


def test_the_moment_of_torsion_is_its_integral():
    """3 times the integral of q r²: of a pressure all of which rubs in circles 3 pi/16."""
    table = modes(96, 4, 0.3, 0.0, None, True)
    rubbing = np.zeros((1, 2, 4, table.count))
    rubbing[:, 1] = np.sqrt(1.0 - table.points**2)
    assert table.moment(table.points * rubbing) == pytest.approx(0.4, rel=1e-12)
    assert table.moment(rubbing) == pytest.approx(3.0 * np.pi / 16.0, rel=2e-3)


def test_traction_does_as_much_work_on_pressure_as_pressure_on_traction():
    """Betti's theorem: -Lam and mu beta couple reciprocally, at every mode; exact integrals."""
    table = modes(40, 4, 0.3, 1.0, 1.0)
    draw = np.random.default_rng(5)
    smooth = np.sqrt(np.maximum(0.8 - table.points**2, 0.0))
    cosines = np.cos(np.arange(3)[:, None, None] * np.arccos(table.along[0])[None])
    shapes = table.points ** np.arange(3)[:, None, None]
    pressed, pulled = np.zeros((2, 3, 4, table.count))
    pressed[2] = smooth * np.einsum("m,maj->aj", draw.normal(size=3), cosines * shapes)
    pulled[:2] = table.along * smooth * draw.normal()
    by_pressure = table.work(pulled[None, :2], table.displace(pressed[None])[:, :2])
    lifted = table.displace(pulled[None])[0, 2]
    zero = table.to[2] @ lifted, table.to[2] @ pressed[2]
    weights = [1.0, *[0.5] * 3]
    by_traction = sum(weights[m] * zero[0][m] @ table.basis.work[m] @ zero[1][m] for m in range(4))
    assert by_pressure == pytest.approx(by_traction, rel=2e-3)


def test_force_and_work_are_exact():
    """(3/2 pi) ∫ q dA of a hemisphere is e³; the integral of a hemisphere times r² is 2/15."""
    table = basis(20, 2)
    hemisphere = np.sqrt(1.0 - table.edges[:-1] ** 2)
    assert table.force @ hemisphere == pytest.approx(1.0, rel=1e-12)
    slip = 1.0 - table.edges[:-1] ** 2  # constant beyond the last point
    last = table.edges[-2]
    rest = (1.0 - last**2) ** 1.5 / 3.0 * (1.0 - last**2) - (1.0 - last**2) ** 2.5 / 5.0
    expected = 1.0 / 3.0 - 2.0 / 15.0 + rest
    assert slip @ table.work[0] @ hemisphere == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("front", [0.2, 0.5, 0.8, 0.95])
def test_cattaneo_and_mindlin(front):
    """F/(mu P) = 1 - c³ at the displacement 1 - c², wherever the front is."""
    table = modes(32, 8, 0.0, 0.0, None)
    aim = (1.0 - front**2) * np.broadcast_to(table.along, (1, 2, 8, 32))
    contact = Contact(np.array([True]), 32, np.sqrt(1.0 - table.points[None] ** 2), 1.0)
    found = settle(table, contact, aim, np.zeros(1), np.zeros(aim.shape))
    assert found.share == pytest.approx(1.0 - front**3, abs=1e-3)
    assert found.residual < TOLERANCE


@pytest.mark.parametrize("strength", [0.6, 2.5, *longer(1.0, 1.5)])
@pytest.mark.parametrize("lift", [None, 0.01])
def test_spence(strength, lift):
    """(a/2c) ln((a+c)/(a-c)) beta/mu = K'(c/a) in normal loading of unlike bodies, to one ring."""

    def unbalanced(c):
        return 0.5 / c * np.log((1.0 + c) / (1.0 - c)) * strength - ellipk(1.0 - c * c)

    front, kappa, rings = brentq(unbalanced, 1e-6, 1.0 - 1e-12), 1.4 / 1.7, 32
    table = modes(rings, 4, 0.3, kappa * strength, None if lift is None else lift * strength)
    path = instants(MOTION, rings, 1)
    pressure = (Prescribed if lift is None else Answering)(table, path, np.array([1.25]))
    zero = np.zeros(1)
    motion = follow(pressure, zero, zero + 1.0, zero, zero, fields=True)
    traction, _, pressed = motion.fields[rings - 1]
    pressed = np.atleast_2d(pressed)[0]
    stuck = (np.hypot(*traction[:2, 0]) < (1.0 - 1e-6) * pressed) & (pressed > 0.0)
    edge = int(np.flatnonzero(stuck)[-1]) + 1
    nearest = table.basis.edges[edge - 1 : edge + 2]
    assert nearest[0] <= front <= nearest[-1]
