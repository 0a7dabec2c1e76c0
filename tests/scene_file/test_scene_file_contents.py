"""What stands in the parts of a scene file: encounters, sweeps, defaults, laws, materials."""

from __future__ import annotations

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, Material, Sphere
from contactlab.scene_file import LawChoice
from contactlab.scene_file.entries import ENTRIES, replaced, with_materials, without_rivals
from contactlab.scene_file.laws import same_law
from tests.scene_file.test_scene_file_refusals import GOOD, document

GROUPS = "[nondimensional]\npsi1 = 1.0\nchi = 1.0\n"


@pytest.fixture
def read(tmp_path):
    def write_and_read(text, **more):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return contactlab.read_scene(path, **more)

    return write_and_read


def test_an_encounter_in_space_is_that_of_its_vectors(read):
    lines = (
        "impact.velocity = [1.0, 0.5, -2.0]\nimpact.normal = [0.0, 0.0, -1.0]\n"
        "impact.spin = [3.0, 0.0, 0.0]\nimpact.target_velocity = [0.1, 0.0, 0.0]\n"
        "impact.target_spin = [0.0, 7.0, 0.0]\n"
    )
    ball = "target.radius = 0.02\ntarget.material.density = 7800\n"
    text = document(without=["impact.speed", "impact.angle_deg"], **{"target.kind": '"sphere"'})
    file = read(text + ball + lines)
    steel = Material(young_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    expected = Encounter(
        Sphere(0.01, steel), Sphere(0.02, steel), friction_coefficient=0.1,
        velocity=[1.0, 0.5, -2.0], normal=[0.0, 0.0, -1.0], spin=[3.0, 0.0, 0.0],
        target_velocity=[0.1, 0.0, 0.0], target_spin=[0.0, 7.0, 0.0],
    )  # fmt: skip
    assert file.scene == expected.scene
    assert file.encounter.target_spin.tolist() == [0.0, 7.0, 0.0]
    assert read(GROUPS).encounter is None
    assert read(document()).encounter is None


def test_about_is_empty_by_default(read):
    file = read(GROUPS)
    assert (file.title, file.citation, file.notes) == ("", "", "")
    file = read(f"[about]\ntitle = 'a'\ncitation = 'b'\nnotes = 'c'\n{GROUPS}")
    assert (file.title, file.citation, file.notes) == ("a", "b", "c")
    assert (dict(file.varied), file.measured, dict(file.scene.axes)) == ({}, (), {})
    assert "tables" not in repr(file)


def test_a_product_varies_the_last_entry_fastest(read):
    file = read("[sweep]\nproduct = true\nchi = [1.0, 2.0]\npsi1 = [3.0, 4.0, 5.0]\n")
    assert file.varied["chi"].tolist() == [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    assert file.varied["psi1"].tolist() == [3.0, 4.0, 5.0] * 2
    assert [(axis[0], np.asarray(axis[1]).tolist()) for axis in dict(file.scene.axes).items()] == [
        ("chi", [1.0, 2.0]),
        ("psi1", [3.0, 4.0, 5.0]),
    ]
    plain = read("[sweep]\nproduct = false\nchi = [1.0, 2.0]\npsi1 = [3.0, 4.0]\n")
    assert plain.scene.shape == (2,)
    assert not plain.scene.axes


def test_a_range_has_two_numbers_or_more(read):
    text = "[nondimensional]\nchi = 1\n[sweep]\npsi1 = {start = -1, stop = 2, count = 2}\n"
    assert read(text).varied["psi1"].tolist() == [-1.0, 2.0]


def test_entries_replace_the_sweep_and_their_rivals(read):
    text = document() + "[sweep]\nspeed = [1.0, 2.0, 3.0]\n"
    file = read(text, entries={"normal_speed": [1.0, 2.0]})
    assert file.scene.normal_speed.tolist() == [1.0, 2.0]
    assert file.scene.tangential_velocity == 0.0
    assert list(file.varied) == ["normal_speed"]
    file = read(text, entries={"angle_deg": [0.0, 60.0]})
    assert file.scene.normal_speed == pytest.approx([2.0, 1.0])
    assert read(text).scene.shape == (3,)


def test_defaults_are_for_what_the_file_leaves_out(read):
    defaults = {"friction_coefficient": 0.7}
    assert read(document(), defaults=defaults).scene.friction_coefficient == 0.1
    text = document(without=["impact.friction_coefficient"])
    assert read(text, defaults=defaults).scene.friction_coefficient == 0.7
    assert read(GROUPS, defaults=defaults).scene == read(GROUPS).scene
    impact = [key for key in GOOD if key.startswith("impact")]
    with pytest.raises(ValueError, match="impact = 3: must be a table"):
        read("impact = 3\n" + document(without=impact), defaults=defaults)


def test_replacing_copies_the_tables():
    tables = {"sphere": {"radius": 1.0, "material": {"density": 2.0}}, "impact": {"spin": 0.0}}
    found = replaced(tables, "sphere.material.density", 5.0)
    assert found["sphere"] == {"radius": 1.0, "material": {"density": 5.0}}
    assert found["impact"] == {"spin": 0.0}
    assert tables["sphere"]["material"]["density"] == 2.0
    assert replaced({}, "a.b", 1) == {"a": {"b": 1}}


def test_names_of_materials_become_their_numbers():
    glass = Material.named("soda-lime glass")
    tables = {"sphere": {"material": "steel"}, "target": {"material": "soda-lime glass"}, "x": 3}
    found = with_materials(tables)
    assert found["sphere"]["material"]["density"] == 7850.0
    assert found["target"]["material"]["poisson_ratio"] == glass.poisson_ratio
    assert found["x"] == 3
    same = {"sphere": {"material": {"density": 1.0}}, "target": 7}
    assert with_materials(same) == same
    with pytest.raises(ValueError, match=r"^target\.material: "):
        with_materials({"target": {"material": "stel"}})


@pytest.mark.parametrize(
    ("names", "kept"),
    [
        (["speed"], ["speed", "angle_deg", "spin"]),
        (["angle_deg"], ["speed", "angle_deg", "spin"]),
        (["normal_speed"], ["normal_speed", "tangential_velocity", "spin"]),
        (["tangential_velocity"], ["normal_speed", "tangential_velocity", "spin"]),
        (["spin"], ["speed", "angle_deg", "normal_speed", "tangential_velocity", "spin"]),
    ],
)
def test_a_velocity_in_one_form_replaces_the_other(names, kept):
    both = ("speed", "angle_deg", "normal_speed", "tangential_velocity", "spin")
    tables = {"impact": dict.fromkeys(both, 1.0), "sphere": {"radius": 1.0}}
    found = without_rivals(tables, names)
    assert list(found["impact"]) == kept
    assert found["sphere"] == {"radius": 1.0}
    assert without_rivals({"impact": 3}, names) == {"impact": 3}


def test_entries_that_may_vary_by_short_and_by_dotted_name():
    short = ["friction_coefficient", "speed", "angle_deg", "normal_speed", "tangential_velocity",
             "spin", "psi1", "chi", "coupling_number", "lam", "eta", "rho", "tilt_deg"]  # fmt: skip
    assert [name for name in ENTRIES if "." not in name] == short
    assert ENTRIES["spin"] == "impact.spin"
    assert ENTRIES["coupling_number"] == "nondimensional.coupling_number"
    for body in ("sphere", "target"):
        for key in (
            "radius",
            "mass",
            "gyration_ratio",
            "material.density",
            "material.yield_stress",
            "material.shear_modulus",
            "material.young_modulus",
            "material.poisson_ratio",
        ):
            assert ENTRIES[f"{body}.{key}"] == f"{body}.{key}"
        assert f"{body}.material" not in ENTRIES
    assert ENTRIES["nondimensional.poisson_ratio"] == "nondimensional.poisson_ratio"
    assert len(ENTRIES) == 13 + 13 + 2 + 2 * 8 + 2  # short, their paths, two more groups, bodies


def test_a_choice_of_laws_keeps_options_of_kinds_that_stay():
    choice = LawChoice(tangential="annulus").set(
        {"tangential.annuli": 7, "integrator.steps": 50, "tangential.annulus.annuli": 8}
    )
    assert list(choice.options) == ["tangential", "integrator", "tangential.annulus"]
    assert [list(each.values()) for each in choice.options.values()] == [[7], [50], [8]]
    same = choice.choose(tangential="tangential.annulus", normal=None)
    assert (same.tangential, same.options) == ("annulus", choice.options)
    other = choice.choose(tangential="coulomb")
    assert list(other.options) == ["integrator", "tangential.annulus"]
    assert choice.choose(integrator="paper").integrator == "paper"
    assert list(choice.choose(integrator="paper").options) == list(choice.options)


@pytest.mark.parametrize("path", ["annuli", "tangential", "spheres.x", "tangential."])
def test_an_option_has_a_kind_and_a_name(path):
    with pytest.raises(ValueError, match="is not an option of a law; write tangential"):
        LawChoice().set({path: 3})


def test_options_of_laws_that_are_not_chosen_are_checked_too():
    choice = LawChoice(tangential="coulomb").set({"tangential.annulus.annuli": -3})
    with pytest.raises(ValueError, match="annuli"):
        choice.simulation()
    good = LawChoice(tangential="coulomb").set({"tangential.annulus.annuli": 3})
    assert good.simulation().tangential == LawChoice(tangential="coulomb").simulation().tangential


def test_an_integrator_that_does_not_run_the_law_is_left_out():
    """The paper's integrator runs laws with steps, not the exact law of events."""
    stepped = LawChoice(tangential="springs", integrator="paper").set({"integrator.steps": 50})
    assert stepped.suited().resolved() == stepped.resolved()
    assert stepped.suited().integrator == "paper"
    exact = LawChoice(tangential="fronts", integrator="paper").set({"integrator.steps": 50})
    suited = exact.suited()
    assert suited.integrator != "paper"
    assert "integrator" not in suited.options
    assert suited == LawChoice(tangential="fronts").resolved()
    free = LawChoice(tangential="springs")
    assert free.suited() is free


def test_a_law_is_the_same_with_and_without_its_distribution():
    full = next(
        f"{info.distribution}:{info.name}"
        for info in contactlab.compose.registry.REGISTRY.installed()
        if info.name == "tangential.coulomb"
    )
    assert same_law("tangential.coulomb", full)
    assert same_law(full, "tangential.coulomb")
    assert same_law("tangential.none", "tangential.none")
    assert not same_law("tangential.coulomb", "tangential.annulus")
    assert not same_law("normal.hertz", "normal.jkr")
