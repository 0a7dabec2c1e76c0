"""Measured slopes of psi2 over psi1: files, the analysis, and what it says of laws."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.plugin import Slopes, hookimpl
from contactlab.study import evidence
from contactlab.study.slopes import read_slopes, slope

SETS = {one.name: one for one in evidence.SLOPES}
ABOUT = """
[about]
title = "t"
citation = "c"
licence = "l"
how = "h"
notes = "n"
"""
PAIR = "[[pairs]]\nbody = 'a'\nrestitution = 0.9\nbeta0 = 0.4\nbeta0_error = 0.1\n"
SPEEDS = "".join(
    f"{key} = [1.0, 2.0]\n"
    for key in ("normal_speed", "slip_velocity", "rebound_normal_speed", "rebound_slip_velocity")
)
COLLISIONS = "[collisions]\nbody = 'a'\nrestitution = 1\npoisson_ratio = 0.3\n"


def test_the_slope_is_that_below_the_crossing():
    """A line -0.4 psi1 up to its crossing, then slip throughout, as hard spheres of Walton have."""
    psi1 = np.linspace(0.01, 6.0, 300)
    psi2 = np.maximum(-0.4 * psi1, psi1 - 4.0)
    beta0, error = slope(psi1, psi2, 4.0)
    assert beta0 == pytest.approx(0.4, rel=1e-12)
    assert error < 1e-12
    noise = np.random.default_rng(2).normal(0.0, 0.05, psi1.size)
    kept = psi1 < 4.0 / 1.4
    beta0, error = slope(psi1, psi2 + noise, 4.0)
    assert beta0 == pytest.approx(0.4, abs=4.0 * error)
    expected = 0.05 / np.sqrt(np.sum(psi1[kept] ** 2))  # of a known scatter
    assert error == pytest.approx(expected, rel=0.15)


def test_chi_is_that_of_the_bodies():
    """As a scene of spheres has it; a pair without a target is one of equals."""
    rows = {row.name: row for row in SETS["small-spheres"].read().rows}

    def material(poisson, shear):
        return Material(shear_modulus=shear, poisson_ratio=poisson, density=1.0)

    glass, aluminium = material(0.22, 29e9), material(0.33, 26e9)
    scene = Scene(Sphere(1e-3, glass), HalfSpace(aluminium), 0.1, 1.0)
    assert rows["glass on aluminium"].chi == pytest.approx(float(scene.chi), rel=1e-12)
    scene = Scene(Sphere(1e-3, glass), Sphere(1e-3, glass), 0.1, 1.0)
    assert rows["soda-lime glass"].chi == pytest.approx(float(scene.chi), rel=1e-12)
    shell = {row.name: row for row in SETS["eight-balls"].read().rows}["tennis ball on a plate"]
    ball = Sphere(1e-3, material(0.45, 1e6), gyration_ratio=(2 / 3) ** 0.5)
    rigid = HalfSpace(material(0.3, 1e25))
    assert shell.chi == pytest.approx(float(Scene(ball, rigid, 0.1, 1.0).chi), rel=1e-4)


def test_collisions_of_glass_are_met_by_the_exact_law_and_not_by_one_spring():
    (row,) = SETS["glass-3mm"].read().rows
    assert row.beta0 == pytest.approx(0.428, abs=5e-4)
    assert row.error == pytest.approx(0.027, abs=5e-4)
    scene = Scene.nondimensional(psi1=row.psi1, chi=row.chi)
    exact = row.slope_of(Simulation().sweep(scene).check().psi2, 1.0)
    capped = row.slope_of(Simulation(tangential="mindlin_cap").sweep(scene).check().psi2, 1.0)
    assert exact == pytest.approx(0.398, abs=1e-3)
    assert capped == pytest.approx(0.264, abs=1e-3)
    assert abs(capped - row.beta0) > 5.0 * row.error


def test_between_the_points_lines_are_near_enough():
    (row, *_) = SETS["small-spheres"].read().rows
    many = np.linspace(0.0, 4.0 * row.chi, 1001)[1:]
    found = [
        Simulation().sweep(Scene.nondimensional(psi1=psi1, chi=row.chi)).check().psi2
        for psi1 in (row.psi1, many)
    ]
    expected = slope(many, found[1], 4.0 * row.chi)[0]
    assert row.slope_of(found[0], 1.0) == pytest.approx(expected, abs=1.5e-3)


def test_no_elastic_sphere_of_steel_comes_back_as_chrome_steel_did():
    """Nor of Delrin, which is within its error: the most of -psi2/psi1 at any angle."""
    rows = {row.name: row for row in SETS["small-spheres"].read().rows}
    for name, most, unexplained in (("chrome steel", 0.463, True), ("Delrin", 0.493, False)):
        row = rows[name]
        psi1 = np.linspace(0.02, 4.0 * row.chi, 400)
        psi2 = Simulation().sweep(Scene.nondimensional(psi1=psi1, chi=row.chi)).check().psi2
        assert np.max(-psi2 / psi1) == pytest.approx(most, abs=1e-3)
        assert (row.beta0 - row.error > most) is unexplained


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (PAIR, "pairs[0].poisson_ratio: is missing"),
        (PAIR + "poisson_ratio = 0.6", "poisson_ratio = 0.6: must lie in"),
        (PAIR + "poisson_ratio = 0.3\nsize = 0.1", "pairs[0].size: unknown key"),
        (PAIR + "poisson_ratio = 0.3\nradius = 'big'", "radius = 'big': must be"),
        (PAIR.replace("0.4", "-1") + "poisson_ratio = 0.3", "beta0 = -1: must be greater than -1"),
        (PAIR.replace("0.1", "0") + "poisson_ratio = 0.3", "beta0_error = 0: must be positive"),
        (PAIR.replace("0.9", "'x'") + "poisson_ratio = 0.3", "restitution = 'x': must be"),
        ("", "give either [[pairs]] or one table [collisions]"),
        (COLLISIONS + SPEEDS, "friction_coefficient: is missing"),
        (COLLISIONS + SPEEDS.replace("[1.0, 2.0]", "[1.0]", 1), "lists of one length"),
        (COLLISIONS + SPEEDS.replace("[1.0, 2.0]", "[0.0, 2.0]", 1), "normal_speed"),
        ("pairs = 3 3", "line"),
    ],
)
def test_a_file_that_is_refused(text, words, tmp_path):
    path = tmp_path / "set.toml"
    path.write_text(ABOUT + text if text[:1] != "p" else text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"set\.toml: ") as told:
        read_slopes(path)
    assert words in str(told.value)


def test_a_set_of_a_plug_in_counts_like_ours(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(ABOUT + PAIR + "poisson_ratio = 0.3", encoding="utf-8")

    class Mine:
        @hookimpl
        def contactlab_measurements(self):
            return [Slopes(name="mine", kind="experiment", path=path)]

    name = contactlab.register(Mine())
    try:
        found = {one.name: one for one in evidence.measured_sets()}
    finally:
        contactlab.plugin_manager().unregister(name=name)
    assert found["mine"].read().rows[0].beta0 == 0.4
    assert {*SETS, "kharaz2001"} < set(found)
