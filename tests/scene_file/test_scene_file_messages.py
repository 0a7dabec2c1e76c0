"""Refusals of a scene file in full, each with its key, rule and remedy."""

from __future__ import annotations

import pytest

from tests.scene_file.test_scene_file_refusals import GOOD, document, refusal

ABSENT = "write friction_coefficient = ...: a number such as 0.2; `contactlab fit` finds it from "
IMPACT = (
    "friction_coefficient, speed, angle_deg, normal_speed, tangential_velocity, spin, normal_spin, "
    "psi1, chi"
)
BODY = "radius, mass, gyration_ratio, material"
MATERIAL = "shear_modulus, young_modulus, poisson_ratio, density, yield_stress, properties"
SPACE = "impact.velocity = [1.0, 0.0, -1.0]\nimpact.normal = [0.0, 0.0, 1.0]\n"


@pytest.mark.parametrize(
    ("missing", "words"),
    [
        (["impact.friction_coefficient"],
         f"impact.friction_coefficient: is missing; {ABSENT}measured rebounds"),
        (["sphere.radius"], "sphere.radius: is missing; write radius = ...: give it in m"),
        (["sphere.material.poisson_ratio"],
         "sphere.material.poisson_ratio: is missing; for example 0.3"),
        (["sphere.material.young_modulus"],
         "sphere.material: give exactly one of shear_modulus and young_modulus, in Pa; "
         "the other follows from E = 2 G (1 + nu)"),
        (["sphere.material.density"],
         "sphere: mass is unknown; give sphere.mass in kg, or sphere.material.density in kg/m³"),
        (["target.kind"], 'target.kind: is missing; give "half-space" or "sphere"'),
        ([key for key in GOOD if key.startswith("target")],
         'target: is missing; add [target] with kind = "half-space" or "sphere"'),
        ([key for key in GOOD if key.startswith("sphere")],
         f"sphere: is missing; add a table [sphere] with {BODY}"),
        ([key for key in GOOD if key.startswith("sphere.material")],
         f"sphere.material: is missing; add a table [sphere.material] with {MATERIAL}"),
        ([key for key in GOOD if key.startswith("impact")],
         "impact: is missing; add a table [impact] with friction_coefficient, speed, angle_deg, "
         "normal_speed, tangential_velocity, spin, normal_spin, velocity, normal, target_velocity, "
         "target_spin, target_normal_velocity, target_tangential_velocity"),
        (["impact.speed"], "impact.speed: is missing; write speed = ...: give speed in m/s and "
         "angle_deg in degrees from the normal"),
        (["impact.speed", "impact.angle_deg"],
         "impact.normal_speed: is missing; give it in m/s, or give speed and angle_deg"),
    ],
)  # fmt: skip
def test_what_is_missing(tmp_path, missing, words):
    assert refusal(tmp_path, document(without=missing)) == f": {words}"


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("sphere.radius", "[1.0, 2.0]",
         "sphere.radius = [1.0, 2.0]: must be one number; put lists in [sweep]"),
        ("target.kind", "3", 'target.kind = 3: must be "half-space", "sphere" or "body"'),
        ("target.kind", '"plane"', "target.kind = 'plane': must be \"half-space\", "
         '"sphere" or "body"'),
        ("sphere.density", "7800", "sphere.density: unknown key; a number of the material: "
         "write it under [sphere.material]"),
        ("sphere.raduis", "1",
         f"sphere.raduis: unknown key; did you mean 'radius'? known: {BODY}"),
        ("impact.xyz", "1", "impact.xyz: unknown key; known: friction_coefficient, speed, "
         "angle_deg, normal_speed, tangential_velocity, spin, normal_spin, velocity, normal, "
         "target_velocity, target_spin, target_normal_velocity, target_tangential_velocity"),
        ("impact.density", "1", None),
        ("about.title", "3", "about.title = 3: must be text; put it in quotes"),
        ("about.titel", "3",
         "about.titel: unknown key; did you mean 'title'? known: title, citation, notes"),
        ("sphere.material", '"stel"', None),
        ("sphere.material.yield", "1", None),
    ],
)  # fmt: skip
def test_what_is_wrong(tmp_path, key, value, words):
    without = [name for name in GOOD if name.startswith(f"{key}.")]
    told = refusal(tmp_path, document(without=without, **{key: value}))
    if words is not None:
        assert told == f": {words}"
        return
    assert told.startswith(f": {key}")
    assert "under [" not in told


def test_a_material_that_there_is_not_is_told_as_a_file_writes_it(tmp_path):
    told = refusal(
        tmp_path,
        document(
            without=[
                "sphere.material.young_modulus",
                "sphere.material.poisson_ratio",
                "sphere.material.density",
            ],
            **{"sphere.material": '"stel"'},
        ),
    )
    assert "a table [sphere.material] with young_modulus, poisson_ratio and density" in told
    assert "Material(" not in told


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (document() + "impact.normal_speed = 1.0", "impact: has both speed/angle_deg and "
         "normal_speed/tangential_velocity; leave out one pair"),
        (document() + "nondimensional.psi1 = 1.0", "nondimensional: psi1 and chi define the "
         "whole scene; leave out [sphere], or [nondimensional]"),
        (document() + SPACE, "impact: velocity and normal define the impact; leave them out, or "
         "speed"),
        (document(without=["impact.speed", "impact.angle_deg"]) + SPACE.splitlines()[0],
         "impact.normal: is missing; an impact in space needs normal = [x, y, z]"),
        (document(without=["impact.speed", "impact.angle_deg"]) + SPACE.splitlines()[1],
         "impact.velocity: is missing; an impact in space needs velocity = [x, y, z]"),
        (document(without=["impact.speed", "impact.angle_deg"]) + SPACE + "impact.spin = 3.0",
         "impact.spin = 3.0: must be a vector of three numbers; beside vectors write [x, y, z]"),
        (document() + "[sweep]\nproduct = 1\nspeed = [1.0]",
         "sweep.product = 1: must be true or false"),
        (document() + "[sweep]\nproduct = true", "sweep: varies nothing; give a list of numbers, "
         "or {start = ..., stop = ..., count = ...}"),
        (document() + "[sweep]\nspeed = [1.0]\nimpact.speed = [1.0]",
         "sweep: speed and impact.speed are the same entry; leave out one"),
        (document() + "[sweep]\nspeed = [1.0]\nspin = [1.0, 2.0]", "sweep: the lists must be of "
         "equal length; they have speed 1, spin 2; for every combination of them write product = "
         "true"),
        (document() + "[sweep]\nangel_deg = [1.0]", "sweep.angel_deg: is not an entry of a scene; "
         f"did you mean 'angle_deg'? known: {IMPACT}, or dotted ones such as sphere.radius"),
        (document() + "[sweep]\nspeed = {start = 1, stop = 2}", "sweep.speed.count: is missing; "
         "give a list of numbers, or {start = ..., stop = ..., count = ...}"),
        (document() + "[sweep]\nspeed = {start = 1, stop = 2, count = 1}",
         "sweep.speed.count = 1: must be a whole number from 2 to 1000000"),
        (document() + "[sweep]\nspeed = 3.0", "sweep.speed = 3.0: must be a list of numbers; give "
         "a list of numbers, or {start = ..., stop = ..., count = ...}"),
        (document() + "[sweep]\nspeed = [[1.0], [2.0]]", "sweep.speed = [[1.0], [2.0]]: must be a "
         "plain list of numbers; not a list of lists"),
        ("sweep = 3", "sweep = 3: must be a table; write it under [sweep]"),
        ("sphere = 3\nsweep.sphere.radius = [1.0]",
         "sphere = 3: must be a table; write it under [sphere]"),
        ("sphere.material = 3\nsweep.sphere.material.density = [1.0]",
         "sphere.material = 3: must be a table; write it under [sphere.material]"),
        ("measured = 3", "measured = 3: must be a list of tables; write [[measured]]"),
        ("simulation = 3", "simulation = 3: must be a table; write it under [simulation]"),
        ("simulation.options = 3", "simulation.options: must be a table; write tangential.annuli = "
         "50, or tangential.annulus.annuli = 50 for one law only"),
        ("simulation.options.tangental.annuli = 3", "simulation.options.tangental.annuli: is not "
         "an option of a law; write tangential.annuli = 50, or tangential.annulus.annuli = 50 for "
         "one law only; did you mean 'tangential'? known: normal, tangential, integrator"),
        ("x = " + 5000 * "1", None),
    ],
)  # fmt: skip
def test_what_is_at_odds(tmp_path, text, words):
    if not text.startswith(("sphere", "x")):
        text = f"nondimensional = {{psi1 = 1.0, chi = 1.0}}\n{text}"
    told = refusal(tmp_path, text)
    if words is None:
        assert "4300" in told
    else:
        assert told == f": {words}"
