"""Errors that `contactlab bench` prints, against true answers by programs of this file alone.

Both programs are springs of theory-elastic and theory-loss written anew, each by another method
than the true answers of the benchmark: elastic ones by steps in time, which the benchmark takes
from slip fronts; viscous ones by a Runge-Kutta method, which it takes from springs cut at each
step. Nothing of contactlab is called but what is measured.
"""

import re

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, create, rebound
from contactlab.cli.main import main
from contactlab.impact import shapes

CHI = 49 / 34  # of solid spheres with a Poisson ratio of 0.3
PSI1 = np.array([0.5, 1.2, 3.0])
STEEL = Material(young_modulus=207e9, poisson_ratio=0.3, density=7850.0)
#: A steel ball of 6.35 mm falls at 1.93 m/s; its spin of -40 rad/s lessens the slip of 0.9 m/s.
BALL = 1.4 / 1.7 * (0.9 - 40.0 * 6.35e-3) / (0.15 * 1.93)


def refined(solve, number):
    """Return answers of second order, extrapolated from half as many springs."""
    half, whole = solve(number // 2), solve(number)
    return whole + (whole - half) / 3.0


def elastic(psi1, chi, lam=0.0, eta=0.0, *, springs=400):
    """Return psi2 by springs that move with the surface and are cut to Coulomb's limit.

    Even steps in time, velocities half a step before and after the places.
    """
    psi, zeta, rate = np.array(psi1), np.zeros(len(psi1)), np.ones(len(psi1))
    step = 0.36 / springs
    squares = ((np.arange(springs) + 0.5) * 1.3 / springs) ** 2
    w, load, force = np.zeros((len(psi), springs)), 0.0 * psi, 0.0 * psi
    psi2 = np.full(len(psi), np.nan)
    while np.isnan(psi2).any():
        rate = rate - 0.625 * step * (load + lam * force)
        psi = psi - 0.625 * step * (eta * load + 2.0 * chi * force)
        before, zeta = zeta, zeta + step * rate
        limit = np.maximum(zeta[:, None] - squares, 0.0)
        entering = (before[:, None] <= squares) & (limit > 0.0)  # moves from its contact on
        part = np.where(entering, limit / np.maximum(zeta - before, 1e-300)[:, None], 1.0)
        w = np.clip(w + part * (step * psi)[:, None], -limit, limit)
        load = np.maximum(zeta, 0.0) ** 1.5
        force = load * w.sum(axis=1) / np.maximum(limit.sum(axis=1), 1e-300)
        rate = rate - 0.625 * step * (load + lam * force)
        psi = psi - 0.625 * step * (eta * load + 2.0 * chi * force)
        psi2 = np.where(np.isnan(psi2) & (zeta <= 0.0), psi, psi2)
    return psi2


def stopped(place):
    """Return the event that one of the unknowns falls to zero."""

    def event(_, y):
        return y[place]

    event.terminal, event.direction = True, -1
    return event


def approach(relaxation):
    """Return the largest radius, both lengths in x (dT = 2 b dx), and the restitution."""
    found = {"rtol": 1e-11, "atol": 1e-13, "method": "DOP853"}

    def pressing(_, y):
        return y[1], -2.5 * y[0] ** 2 * (y[0] ** 2 + 1.5 * relaxation * y[1])

    def parting(_, y):
        return y[1] - 1.25 * relaxation * y[0] ** 3, -2.5 * y[0] ** 4

    first = solve_ivp(pressing, (0, 9), [0.0, 1.0], events=stopped(1), **found)
    last = solve_ivp(parting, (0, 99), [first.y[0, -1], 0.0], events=stopped(0), **found)
    return first.y[0, -1], first.t[-1], last.t[-1], -last.y[1, -1]


def viscous(psi1, chi, e, *, springs=200):
    """Return psi2 of spheres that lose in pressure and shear alike, each spring an unknown."""
    a = brentq(lambda a: approach(a)[3] - e, 1e-6, 9.0, xtol=1e-13)
    largest, *lengths, _ = approach(a)
    places = np.linspace(0.0, largest, springs + 1)
    width = places[1]

    def rates(y, *, loading):
        b, rate, psi, w = max(y[0], 0.0), y[1], y[2], y[3:]
        excess = a * rate if loading else 0.0
        limit = np.where(places < b, b * b - places**2 + excess, 0.0)
        f = np.clip(w + a * psi, -limit, limit)
        last = min(int(b / width), springs)
        edge = (b - last * width) * (f[last] + np.clip(a * psi, -excess, excess))
        force = 1.5 * width * (f[: last + 1].sum() - 0.5 * (f[0] + f[last])) + 0.75 * edge
        out = np.empty_like(y)
        out[0] = rate if loading else rate - 1.25 * a * b**3
        out[1] = -2.5 * b * (b**3 + 1.5 * b * excess)
        out[2] = -5.0 * chi * b * force
        out[3:] = np.where(places < b, 2.0 * b * (f - w) / a, 0.0)
        return out

    psi2 = []
    for psi in psi1:
        y = np.concatenate(([0.0, 1.0, psi], np.zeros(springs + 1)))
        for loading, length in zip((True, False), lengths, strict=True):
            h = length / (4 * springs)
            for _ in range(4 * springs):
                one = rates(y, loading=loading)
                two = rates(y + 0.5 * h * one, loading=loading)
                three = rates(y + 0.5 * h * two, loading=loading)
                four = rates(y + h * three, loading=loading)
                y = y + h / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        psi2.append(y[2])
    return np.array(psi2)


def rod(angle, *, length=0.1, radius=0.005, friction=0.3, kappa=1.4 / 1.7):
    """Return chi, lam and eta of a rod with round ends, at an angle from the vertical."""
    straight = 0.5 * length - radius

    def section(z):
        return radius**2 - max(abs(z) - straight, 0.0) ** 2

    def over(weigh):
        return quad(lambda z: weigh(z) * section(z), 0.0, 0.5 * length, points=[straight])[0]

    turning = over(lambda z: z * z + 0.25 * section(z)) / over(np.ones_like)  # radius of gyration²
    # From the centre to the point of contact: along the axis, then down.
    along, down = -straight * np.sin(angle), straight * np.cos(angle) + radius
    normal = 1.0 + along * along / turning
    return (
        0.5 * kappa * (1.0 + down * down / turning) / normal,
        -friction * along * down / turning / normal,
        -kappa / friction * along * down / turning / normal,
    )


def by_springs(springs, steps, **options):
    return Simulation(
        tangential=create("tangential.springs", springs=springs),
        integrator=create("integrator.symplectic", steps=steps),
        **options,
    )


def printed(capsys, method, *words):
    """Return the rms error that the report prints in the row of a method, as text."""
    assert main(["bench", "--quick", *words]) == 0
    lines = capsys.readouterr().out.splitlines()
    (line,) = (each for each in lines if re.split(r" {2,}", each)[:2] == list(method))
    return re.split(r" {2,}", line)[2]


def equal(text, errors):
    """Whether the rms of errors is the number printed, to its last digit."""
    rms = float(np.sqrt(np.mean(np.square(errors))))
    last = 10.0 ** (np.floor(np.log10(rms)) - 1.0)
    return abs(rms - float(text)) <= 0.6 * last


def test_the_programs_of_this_file_give_the_numbers_of_the_theory():
    """Of theory §5 to its ten digits, of §15 to its six: each by programs older than this one."""
    known = [0.0478310787, -0.1805194095, -1.3796832924]
    assert refined(lambda n: elastic(PSI1, CHI, springs=n), 200) == pytest.approx(known, abs=3e-6)
    lossy = viscous([1.2], CHI, 0.836405, springs=100)
    assert lossy == pytest.approx([-0.176153], abs=3e-4)


@pytest.mark.slow
def test_errors_of_elastic_spheres(capsys):
    psi1 = np.append(PSI1, BALL)
    truth = refined(lambda n: elastic(psi1, CHI, springs=n), 800)
    springs = by_springs(25, 100)
    answers = [float(springs.run(Scene.nondimensional(psi1=each, chi=CHI)).psi2) for each in psi1]
    row = "springs / symplectic", "springs=25, steps=100"
    words = "--question", "sphere", "--tangential", "springs"
    assert equal(printed(capsys, row, *words), answers - truth)


@pytest.mark.slow
def test_errors_of_spheres_with_a_restitution(capsys):
    truth = refined(lambda n: viscous(PSI1, CHI, 0.8, springs=n), 400)
    assert rebound(PSI1, CHI, restitution=0.8) == pytest.approx(truth, abs=2e-5)
    springs = by_springs(25, 100, restitution=0.8)
    answers = [float(springs.run(Scene.nondimensional(psi1=each, chi=CHI)).psi2) for each in PSI1]
    row = "run, springs", "springs=25, steps=100"
    assert equal(printed(capsys, row, "--question", "sphere with e"), answers - truth)


@pytest.mark.slow
def test_errors_of_a_rod_in_the_plane(capsys):
    slips = np.array([0.1, 0.5])  # m/s, at 1 m/s of approach
    psi1 = 1.4 / 1.7 * slips / 0.3
    numbers = rod(0.5)
    truth = refined(lambda n: elastic(psi1, *numbers, springs=n), 800)
    down = [0.0, 0.0, -1.0]
    body, contact = shapes.rod(
        length=0.1, radius=0.005, material=STEEL, axis=[np.sin(0.5), 0.0, np.cos(0.5)], normal=down
    )
    falls = [
        Encounter(body, HalfSpace(STEEL), 0.3, normal=down, contact=contact, velocity=[v, 0, -1])
        for v in slips
    ]
    scene = falls[0].scene
    assert [scene.chi, scene.lam, scene.eta] == pytest.approx(numbers, rel=1e-9)
    springs = by_springs(12, 48)
    answers = [float(springs.run(each.scene).psi2) for each in falls]
    row = "run, springs", "springs=12, steps=48"
    assert equal(printed(capsys, row, "--question", "plane"), answers - truth)
