"""Where ``rebound`` answers from a table, and what it declares of its error."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest

from contactlab import Scene, Simulation, Sphere, collide, create, rebound
from contactlab_laws.tables.regions import LARGEST_CHI
from contactlab_laws.tables.restituted_regions import (
    BEYOND_ERROR,
    RESTITUTED_ERROR,
    WIDER_ERROR,
    bound_restitution_error,
)
from tests.collisions.test_collision import STEEL, meeting

CHI = 49.0 / 34.0
E_09 = {"restitution": 0.9}
BEYOND = math.nextafter(LARGEST_CHI, 3.0)
BLOCKED = """
import contactlab
for options in ({}, {"restitution": 0.9}):
    try:
        print(contactlab.rebound(1.2, 1.4, **options))
    except ValueError as error:
        print(error)
"""


def test_answers_in_the_table_and_beyond_are_those_of_the_exact_law():
    chi = np.array([0.5, 1.0, LARGEST_CHI, BEYOND, 3.0])
    psi1 = np.array([0.7, -1.3, 2.0, 2.0, -4.0])
    exact = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=1e-9),
    )
    expected = exact.run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    assert rebound(psi1, chi) == pytest.approx(expected, abs=4e-9)
    assert rebound(psi1, chi, tolerance=1e-9) == pytest.approx(expected, abs=4e-9)
    assert rebound(psi1[:2], chi[:2], tolerance=0.9) == pytest.approx(expected[:2], abs=2e-9)
    assert type(rebound(1, 1)) is float
    assert rebound(np.array(1.0), 1.0) == rebound(1.0, 1.0)


def test_derivatives_are_differences():
    psi1, chi, width = np.array([0.5, -2.0, 3.9]), np.array([1.0, 1.4, 2.2]), 1e-4
    psi2, by_psi1, by_chi = rebound(psi1, chi, derivatives=True)
    assert psi2 == pytest.approx(rebound(psi1, chi), abs=1e-15)
    for found, step in ((by_psi1, (width, 0.0)), (by_chi, (0.0, width))):
        ahead = rebound(psi1 + step[0], chi + step[1])
        behind = rebound(psi1 - step[0], chi - step[1])
        assert found == pytest.approx((ahead - behind) / (2.0 * width), abs=2e-5)
    alone = rebound(0.5, 1.0, derivatives=True)
    assert [type(each) for each in alone] == [float] * 3
    assert alone == pytest.approx((psi2[0], by_psi1[0], by_chi[0]), rel=1e-12)
    at_the_end = rebound(1.0, LARGEST_CHI, derivatives=True)
    assert len(at_the_end) == 3
    nothing = rebound([], 1.0, derivatives=True)
    assert [each.shape for each in nothing] == [(0,)] * 3
    assert rebound(np.empty((2, 0)), 1.0).shape == (2, 0)


@pytest.mark.slow
def test_each_restitution_of_an_array_is_its_own():
    """Over all of the table, at both ends of e, and out of the table."""
    draw = np.random.default_rng(8)
    psi1, chi, e = draw.uniform(-9, 9, 160), draw.uniform(0.3, 3.0, 160), draw.uniform(0, 1, 160)
    e[:40] = 1.0 - 10.0 ** draw.uniform(-12, -1, 40)
    e[40:48], e[48], chi[49], psi1[49] = 1.0, 0.0, 3.2, 0.6
    alone = [rebound(*one[:2], restitution=one[2]) for one in np.transpose((psi1, chi, e)).tolist()]
    assert rebound(psi1, chi, restitution=e) == pytest.approx(alone, abs=1e-11)
    few = rebound(psi1[:3], chi[:3], restitution=e[:3])
    assert few == pytest.approx(alone[:3], abs=1e-12)
    assert (rebound(-psi1, chi, restitution=e) == -rebound(psi1, chi, restitution=e)).all()
    assert rebound(psi1, CHI, restitution=e[:3, None]).shape == (3, 160)
    assert rebound(2.0, CHI, restitution=[0.9, 0.8]).shape == (2,)
    grid = rebound(psi1.reshape(40, 4), chi.reshape(40, 4), restitution=0.5)
    assert (grid.ravel() == rebound(psi1, chi, restitution=0.5)).all()


@pytest.mark.parametrize(
    ("chi", "restitution", "error"),
    [
        (0.1, 0.5, RESTITUTED_ERROR), (2.0, 0.9, RESTITUTED_ERROR), (2.01, 0.5, WIDER_ERROR),
        (3.0, 0.001, WIDER_ERROR), (12.0, 0.9, 2.0 * BEYOND_ERROR), (12.0, 0.0, 0.0),
    ],
)  # fmt: skip
def test_the_error_that_is_declared_of_a_restitution(chi, restitution, error):
    assert float(bound_restitution_error(chi, restitution)) == pytest.approx(error)
    many = bound_restitution_error(np.array([chi, 1.0]), restitution)
    assert many[0] == pytest.approx(error)


def test_the_plan_of_a_heavy_core_has_the_error_of_springs():
    """K = 1/5 makes chi = (7/17) 26 = 10.7."""
    core = Sphere(0.01, STEEL, gyration_ratio=0.2)
    target = meeting().target
    plan = collide(meeting(body=core, target=type(target)(STEEL)), restitution=0.9).plan
    assert "computed: friction: contactlab.rebound with restitution=0.9" in str(plan)
    assert plan.psi2_error == pytest.approx(BEYOND_ERROR * (182 / 17 / 3) ** 0.5)


@pytest.mark.slow
def test_blocked_laws_do_not_answer():
    """In a process of its own: what is blocked is read at the first answer."""
    laws = ["tangential.fronts", "normal.viscoelastic"]
    told = subprocess.run(
        [sys.executable, "-c", BLOCKED],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"CONTACTLAB_BLOCK_PLUGINS": " ".join(laws)},
    )
    for law, said in zip(laws, told.stdout.splitlines(), strict=True):
        assert said.startswith(f"name = '{law}': is blocked")
