"""Tangential restitution of eight measured balls (theory §15): the guide's table, made again."""

import re

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.cli.guide import text
from contactlab.study.evidence import SLOPES

PAGE = text("theory-loss")
ROW = re.compile(
    r"^\| ([^|]+?) \| (0\.\d\d) \| (0\.\d+) ± 0\.\d+ \|" + 4 * r" ([^|]+) \|" + "$",
    re.MULTILINE,
)
NUMBERS = re.compile(r"-?\d\.\d+")
POISSON = (0.3, 0.45)
LOSSES = (0.0, 1.0, 2.0)
PLANE = HalfSpace(Material(young_modulus=1e25, poisson_ratio=0.3))
#: Squares of the gyration ratio of a solid sphere and of a thin shell.
SOLID, SHELL = 2 / 5, 2 / 3


def chi_of(poisson_ratio, gyration):
    material = Material(young_modulus=1e7, poisson_ratio=poisson_ratio, density=1000.0)
    ball = Sphere(0.03, material, gyration_ratio=gyration**0.5)
    return float(Scene(ball, PLANE, 0.3, 1.0).chi)


def mean_over_the_grip(simulation, chi, e):
    """The mean of -psi2/psi1 from 0 to slip throughout."""
    psi1 = (np.arange(40) + 0.5) / 40 * max(1.0, 2.0 * chi * (1.0 + e) - e)
    psi2 = simulation.sweep(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    return float(np.mean(-psi2 / psi1))


def one_loss(e, share):
    return Simulation(
        normal=contactlab.create("normal.viscoelastic", restitution=e),
        tangential=contactlab.create("tangential.springs", shear_loss=share),
    )


def test_the_measured_set_is_the_table_of_the_guide():
    (balls,) = (one for one in SLOPES if one.name == "eight-balls")
    rows = [(row.restitution, row.beta0) for row in balls.read().rows]
    assert rows == [(float(row[1]), float(row[2])) for row in ROW.findall(PAGE)]


@pytest.mark.slow
def test_the_table_of_the_guide():
    rows = ROW.findall(PAGE)
    assert len(rows) == 8
    off = []
    for name, restitution, measured, *told in rows:
        e, gyration = float(restitution), SHELL if "shell" in name else SOLID
        ratios = [chi_of(poisson_ratio, gyration) for poisson_ratio in POISSON]
        found = [[mean_over_the_grip(Simulation(), chi, 1.0) for chi in ratios]]
        found += [
            [mean_over_the_grip(one_loss(e, share), chi, e) for chi in ratios] for share in LOSSES
        ]
        shown = [[float(number) for number in NUMBERS.findall(cell)] for cell in told]
        assert np.asarray(found) == pytest.approx(np.asarray(shown), abs=5.1e-3), name
        off.append(np.asarray(found) - float(measured))
    (cells,) = re.findall(r"^\| rms of the eight \| \| \| (.*) \|$", PAGE, re.MULTILINE)
    shown = [[float(number) for number in NUMBERS.findall(cell)] for cell in cells.split(" | ")]
    rms = np.sqrt(np.mean(np.square(off), axis=0))
    assert rms == pytest.approx(np.asarray(shown), abs=5.1e-3)
    constant = [0.2 - float(row[2]) for row in rows]
    assert np.sqrt(np.mean(np.square(constant))) == pytest.approx(0.17, abs=5e-3)
