"""The caution of materials that yield: Hertz's peak pressure beside 1.6 times the yield stress."""

import math
import re

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.impact import material as materials
from contactlab.impact.hertz import hertz_scales, peak_pressure

YIELD = 2.0e9


def steel(yield_stress=None):
    return Material(young_modulus=208e9, poisson_ratio=0.3, density=7850, yield_stress=yield_stress)


def scene(yield_stress, *, plane=None, speed=1.0):
    """Return the first scene of the README, with yield stresses of ball and plane."""
    ball = Sphere(0.01, steel(yield_stress))
    return Scene(ball, HalfSpace(steel(plane)), 0.2, normal_speed=speed, tangential_velocity=0.5)


def said(normal, given):
    plan = Simulation(normal=normal, tangential="coulomb").plan(given)
    return [str(each) for each in plan.cautions if "yield" in str(each)]


def test_the_peak_pressure_is_the_closed_form():
    """3P/(2 pi a²) with P and a of the impact that was run, not of the formula itself."""
    given = scene(None)
    motion = Simulation().run(given).check().motion
    expected = 1.5 * motion.maximum_force / (math.pi * motion.maximum_radius**2)
    assert float(peak_pressure(given)) == pytest.approx(expected, rel=1e-9)
    assert expected == pytest.approx(3.5e9, rel=0.02)
    scales = hertz_scales(given)
    elastic = 2.0 * given.pair.effective_modulus * scales.radius / (math.pi * given.pair.radius)
    assert float(peak_pressure(given)) == pytest.approx(elastic, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "yields"),
    [("mild steel", True), ("hardened steel", True), ("pmma", True), ("nylon", True),
     ("steel", False), ("alumina", False), ("rubber", False)],
)  # fmt: skip
def test_named_materials_of_one_condition_have_the_caution(name, yields):
    """At 5 m/s; steel at large is any alloy, ceramics crack, and rubber does neither."""
    solid = Material.named(name)
    assert bool(said("hertz", Scene(Sphere(0.01, solid), HalfSpace(solid), 0.2, 5.0))) == yields


def test_without_a_yield_stress_there_is_no_caution():
    assert said("hertz", scene(None)) == []
    assert said("hertz", Scene.nondimensional(psi1=1.0, chi=1.44)) == []


ROD = {"length": 0.1, "radius": 0.01, "normal": (0, 0, -1), "axis": (0.6, 0.0, 0.8)}


@pytest.mark.parametrize(
    ("ball", "plane", "who"),
    [(YIELD, None, "the target has"), (None, YIELD, "the {} has"),
     (None, None, "the {} and the target have"), (YIELD, YIELD, "")],
)  # fmt: skip
def test_a_plan_says_whose_yield_it_does_not_check(ball, plane, who):
    """Of spheres and of bodies; a law that yields needs no stress."""
    rod, contact = contactlab.shapes.rod(material=steel(ball), **ROD)
    met = Encounter(
        rod, HalfSpace(steel(plane)), 0.2, normal=(0, 0, -1), velocity=(0, 0, -1), contact=contact
    )
    for name, given in (("sphere", scene(ball, plane=plane)), ("body", met.scene)):
        left_out = list(map(str, Simulation().plan(given).left_out))
        told = [text for text in left_out if text.startswith("yield")]
        pressure = f"Peak pressure: {peak_pressure(given) / 1e9:.2g} GPa."
        words = f"yield check: {who.format(name)} no yield_stress. {pressure}"
        assert told == ([words] if who else [])
    yields = Simulation(normal="thornton", tangential="coulomb").plan(scene(ball, plane=plane))
    assert not any(str(text).startswith("yield") for text in yields.left_out)


def test_yield_is_not_checked_for_some_impacts_of_a_batch():
    stress = np.array([YIELD, np.nan, YIELD])
    given = scene(stress, plane=YIELD, speed=np.array([1.0, 2.0, 3.0]))
    (told,) = [str(each) for each in Simulation().plan(given).left_out if "yield" in str(each)]
    assert told.startswith("yield check (1 of 3 impacts): the sphere has no yield_stress")
    assert told.endswith(f": {peak_pressure(given)[1] / 1e9:.2g} GPa.")


@pytest.mark.parametrize("normal", ["hertz", "tsuji", "hunt_crossley", "kuwabara_kono", "linear"])
def test_an_elastic_law_is_told_that_the_material_yields(normal):
    (text,) = said(normal, scene(YIELD))
    assert "3.5 GPa" in text
    assert "yield begins at 3.2 GPa" in text
    assert text.startswith("model: the sphere would yield")


@pytest.mark.parametrize("normal", ["thornton", "walton_braun"])
def test_a_law_that_yields_is_not(normal):
    assert not any("GPa" in text for text in said(normal, scene(YIELD)))


def test_the_threshold_is_the_slowest_impact_that_yields():
    """By Thornton's law with yield_pressure 1.6 Y: e is 1 below the speed, less than 1 above."""
    given = scene(YIELD)
    speed = float((1.6 * YIELD / peak_pressure(given)) ** 2.5)  # p_0 grows as v^(2/5)
    law = contactlab.create("normal.thornton", yield_pressure=1.6 * YIELD)
    for share, yields in ((0.99, False), (1.05, True)):
        slower = scene(YIELD, speed=share * speed)
        result = Simulation(normal=law, tangential="coulomb").run(slower)
        assert bool(said("hertz", slower)) == yields
        assert (float(result.normal_restitution) < 1.0 - 1e-5) == yields


def test_the_softer_body_is_named_and_the_worst_of_a_batch():
    (text,) = said("hertz", scene(YIELD, plane=1.0e9))
    assert "yield begins at 1.6 GPa" in text
    assert said("hertz", scene(5e9, plane=6e9)) == []
    batch = scene(YIELD, speed=np.array([0.01, 1.0, 2.0]))
    (text,) = said("hertz", batch)
    assert "for 2 of 3 impacts" in text
    worst = peak_pressure(scene(None, speed=2.0))
    assert f"{float(worst) / 1e9:.2g} GPa" in text

    mixed = scene(np.array([YIELD, 5e9]), plane=np.array([5e9, 1e9]))
    (text,) = said("hertz", mixed)
    assert "for 2 of 2 impacts" in text
    assert "yield begins at 1.6 GPa" in text


def test_a_yield_stress_is_a_number_of_the_material():
    assert steel().yield_stress is None
    assert attrs.evolve(scene(YIELD), normal_speed=0.5).sphere.material.yield_stress == YIELD
    with pytest.raises(ValueError, match=r"yield_stress = -1\.0"):
        steel(-1.0)


def test_a_scene_file_takes_it(tmp_path):
    path = tmp_path / "yield.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'aluminium alloy'\n[target]\nkind = 'half-space'\n"
        "[target.material]\nyoung_modulus = 208e9\npoisson_ratio = 0.3\nyield_stress = 2e9\n"
        "[impact]\nfriction_coefficient = 0.1\nnormal_speed = 1.0\n",
        encoding="utf-8",
    )
    file = contactlab.read_scene(path)
    assert file.scene.target.material.yield_stress == 2e9
    assert file.scene.sphere.material.yield_stress == 276e6
    harder = file.scene_at(**{"sphere.material.yield_stress": [1e8, 1e10]})
    assert harder.shape == (2,)
    (text,) = said("hertz", harder)
    assert "yield begins at 0.16 GPa" in text


def test_yield_stresses_of_the_collection_have_sources():
    known = [one for one in materials.entries() if one.yield_stress is not None]
    metals = {
        "mild steel", "hardened steel", "annealed stainless steel", "aluminium alloy",
        "soft brass", "soft copper", "titanium", "tungsten", "lead",
    }  # fmt: skip
    plastics = {"nylon", "pmma", "polycarbonate", "cellulose acetate"}
    assert {one.name for one in known} == metals | plastics
    without = {one.name for one in materials.entries() if "no yield stress:" in one.note}
    alloys = {"steel", "stainless steel", "brass", "copper", "magnesium alloy"}
    assert without == alloys | {"phenolic resin", "polyethylene"}
    for one in materials.entries():
        assert (one.yield_stress is None) == (one.yield_source == "")
    for one in known:
        assert 1e6 < one.yield_stress < 1e10
        assert one.yield_source.partition(",")[0] in materials.references()
        for low, high in re.findall(r"range ([\d.]+) to ([\d.]+) MPa", one.yield_source):
            assert one.yield_stress == pytest.approx(0.5e6 * (float(low) + float(high)), rel=0.01)
        assert one.material().yield_stress == one.yield_stress
