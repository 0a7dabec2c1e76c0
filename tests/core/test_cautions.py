"""The size that a plan gives to the elastic coupling of unlike bodies."""

import itertools
import re
from pathlib import Path

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.impact.coupling import coupling_shift

GUIDE = Path(contactlab.__file__).parent / "guide" / "theory.md"
CHI = 49.0 / 34.0
PSI1 = (0.5, 1.0, 1.5, 2.0, 3.0)
SOLID, SHELL = np.sqrt(0.4), np.sqrt(2.0 / 3.0)


def coupled(strength, psi1):
    """Return the scene of psi1 whose Lambda = kappa beta/mu is ``strength``."""
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)  # kappa = mu = 1
    return attrs.evolve(scene, pair=attrs.evolve(scene.pair, dundurs_beta=strength))


def table():
    """Return Lambda and the shifts at ``PSI1`` from the table of the guide."""
    text = GUIDE.read_text(encoding="utf-8")
    rows = re.findall(r"^\| (0\.25|0\.5|1|2) \|((?: -[\d.]+ \|){5})$", text, re.MULTILINE)
    rows = rows[:4]  # the first of the tables with a Lambda
    return {float(name): [float(word) for word in re.findall(r"[\d.]+", row)] for name, row in rows}


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_shift_is_that_of_the_table_of_the_guide(sign):
    """And of an impact from the other side, or with the bodies exchanged."""
    for strength, shifts in table().items():
        found = [float(coupling_shift(coupled(sign * strength, sign * psi1))) for psi1 in PSI1]
        assert found == pytest.approx(shifts, abs=1e-12)


def test_between_the_entries_the_shift_is_their_mean():
    assert float(coupling_shift(coupled(0.0, 1.0))) == 0.0
    edges = [0.0, 0.25, 0.5, 1.0, 2.0]
    for low, high in itertools.pairwise(edges):
        ends = [coupling_shift(coupled(strength, 1.0)) for strength in (low, high)]
        middle = coupling_shift(coupled(0.5 * (low + high), 1.0))
        assert float(middle) == pytest.approx(0.5 * float(sum(ends)), rel=1e-12)
    ends = [coupling_shift(coupled(1.0, psi1)) for psi1 in (0.5, 1.0)]
    middle = coupling_shift(coupled(1.0, 0.75))
    assert float(middle) == pytest.approx(0.5 * float(sum(ends)), rel=1e-12)


def test_the_plan_says_the_worst_of_a_batch():
    simulation = Simulation()
    alone = str(simulation.plan(coupled(0.5, 1.0)))
    assert "Lambda = kappa beta/mu = 0.5; it moves psi2 by about 0.05 (model" in alone
    batch = str(simulation.plan(coupled(0.5, np.array([2.0, 1.0, 3.0]))))
    assert "Lambda = kappa beta/mu = 0.5; it moves psi2 by up to about 0.05 (model" in batch
    assert "by at least 0.3" in str(simulation.plan(coupled(2.5, 1.0)))
    assert "unlike bodies" not in str(simulation.plan(coupled(0.02, 0.1)))
    assert "unlike bodies" not in str(simulation.plan(coupled(0.0, 1.0)))


def steel_on_rubber(psi1, *, gyration=SOLID):
    """Return a scene in SI of a steel sphere on a soft half-space of nu = 0.3."""
    steel = contactlab.Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    soft = contactlab.Material(young_modulus=2e9, poisson_ratio=0.3)
    ball = contactlab.Sphere(0.01, steel, gyration_ratio=gyration)
    scene = Scene(ball, contactlab.HalfSpace(soft), 0.2, normal_speed=0.01)
    return attrs.evolve(scene, tangential_velocity=np.asarray(psi1) / scene.psi_scale)


def cautions(scene):
    """Return what the plan says of the coupling."""
    said = [str(sentence) for sentence in Simulation().plan(scene).cautions]
    return [text for text in said if "unlike bodies" in text]


def test_the_sentence_says_what_the_table_is_for():
    (text,) = cautions(steel_on_rubber(1.0))
    assert "by a table for chi = 1.44, nu = 0.3, psi1 up to 3)" in text
    assert "rough guide" not in text
    (text,) = cautions(steel_on_rubber(1.0, gyration=SHELL))
    assert "psi1 up to 3; a rough guide at chi = 1.03)" in text
    (text,) = cautions(steel_on_rubber(3.6))
    assert "psi1 up to 3; a rough guide at psi1 = 3.6)" in text


def test_where_the_whole_contact_slips_no_size_is_claimed():
    """The table ends before gross slip, at 4 chi - 1 = 4.76; it was read beyond its end there."""
    sliding = steel_on_rubber(5.0)
    assert np.isnan(coupling_shift(sliding))
    (text,) = cautions(sliding)
    assert "second order in Lambda/psi1 = " in text
    assert "by about" not in text
    assert "by how much is not known" in text
    assert not cautions(steel_on_rubber(500.0))
    both = cautions(steel_on_rubber([1.0, 5.0]))
    assert ["table" in each for each in both] == [True, False]


def test_without_friction_there_is_no_caution():
    scene = attrs.evolve(steel_on_rubber(1.0), friction_coefficient=0.0)
    assert not cautions(scene)
    assert float(coupling_shift(scene)) == 0.0
