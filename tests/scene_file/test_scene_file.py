"""What a good scene file means."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Sphere
from contactlab.contracts import resolution_of

EXAMPLES = Path(__file__).parents[2] / "examples"

BALL = """
[sphere]
radius = 0.01
[sphere.material]
shear_modulus = 80e9
poisson_ratio = 0.3
density = 7800
[target]
kind = "half-space"
[target.material]
young_modulus = 70e9
poisson_ratio = 0.25
[impact]
friction_coefficient = 0.1
"""


@pytest.fixture
def read(tmp_path):
    def write_and_read(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return contactlab.read_scene(path)

    return write_and_read


def by_hand(**motion):
    steel = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7800.0)
    glass = Material(young_modulus=70e9, poisson_ratio=0.25)
    return Scene(Sphere(0.01, steel), HalfSpace(glass), 0.1, **motion)


def test_single_impact_is_the_scene_built_by_hand(read):
    file = read(BALL + "normal_speed = 2\ntangential_velocity = 0.5\nspin = -3.0\n")
    assert file.scene == by_hand(normal_speed=2.0, tangential_velocity=0.5, spin=-3.0)
    assert file.scene.shape == ()
    assert file.varied == {}
    assert file.measured == ()


def test_speed_and_angle_are_measured_from_the_normal(read):
    scene = read(BALL + "speed = 2.0\nangle_deg = 30.0\n").scene
    assert scene.normal_speed == pytest.approx(2.0 * np.cos(np.pi / 6))
    assert scene.tangential_velocity == pytest.approx(1.0)


def test_spin_about_the_normal_is_read_and_swept(read):
    text = BALL + "speed = 2.0\nangle_deg = 30.0\n"
    file = read(text + "normal_spin = 40.0\n[sweep]\nnormal_spin = [-1.0, 5.0]\n")
    assert file.scene.normal_spin.tolist() == [-1.0, 5.0]
    groups = "[nondimensional]\npsi1 = 1.0\nchi = 1.4\nspin = 0.5\nspin_inertia = 0.01\n"
    assert read(groups).scene == Scene.nondimensional(
        psi1=1.0, chi=1.4, spin=0.5, spin_inertia=0.01
    )
    swept = read(
        groups + "[sweep]\n'nondimensional.spin' = [0.0, 0.2]\nspin_inertia = [0.1, 0.2]\n"
    )
    assert swept.scene.w1 == pytest.approx([0.0, 0.2])
    assert swept.scene.chi_w[1] == pytest.approx(0.2)


def test_rest_is_assumed_where_tangential_motion_is_not_given(read):
    scene = read(BALL + "normal_speed = 1.0\n").scene
    assert (scene.tangential_velocity, scene.spin) == (0.0, 0.0)


def test_two_spheres(read):
    body = "radius = 0.02\n[target.material]\npoisson_ratio=0.3\nyoung_modulus=2e11\ndensity=7800\n"
    text = BALL + "normal_speed = 1.0\n"
    before, after = text.index("[target]"), text.index("[impact]")
    file = read(text[:before] + '[target]\nkind = "sphere"\n' + body + text[after:])
    assert isinstance(file.scene.target, Sphere)
    assert file.scene.pair.radius == pytest.approx(1.0 / 150.0)


def test_nondimensional(read):
    scene = read("[nondimensional]\npsi1 = 1.2\nchi = 1.5\n").scene
    assert scene == Scene.nondimensional(psi1=1.2, chi=1.5)


def test_sweep_replaces_entries(read):
    file = read(BALL + "speed = 2.0\nangle_deg = 1.0\n[sweep]\nangle_deg = [10, 20.0, -30]\n")
    assert file.scene.shape == (3,)
    assert np.degrees(np.arctan2(file.scene.tangential_velocity, file.scene.normal_speed)) == (
        pytest.approx([10.0, 20.0, -30.0])
    )
    assert list(file.varied) == ["angle_deg"]


def test_sweep_gives_entries_that_the_tables_leave_out(read):
    file = read("[sweep]\npsi1 = [1, 2]\nchi = [1.0, 3.0]\n")
    assert file.scene.psi1 == pytest.approx([1.0, 2.0])
    assert file.scene.chi == pytest.approx([1.0, 3.0])


@pytest.mark.parametrize("line", ["sphere.radius = [0.01, 0.02]", '"sphere.radius" = [0.01, 0.02]'])
def test_dotted_sweep_of_a_body(read, line):
    scene = read(BALL + f"normal_speed = 1.0\n[sweep]\n{line}\n").scene
    assert scene.shape == (2,)
    assert scene.pair.radius == pytest.approx([0.01, 0.02])
    assert scene.pair.normal_mass[1] == pytest.approx(8.0 * scene.pair.normal_mass[0])


def test_range_in_a_sweep(read):
    text = "[nondimensional]\nchi = 1\n[sweep]\npsi1 = {start = 0, stop = 2, count = 5}\n"
    assert read(text).varied["psi1"] == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])


def test_batch_of_one_stays_a_batch(read):
    file = read("[nondimensional]\nchi = 1\n[sweep]\npsi1 = [2.0]\n")
    assert file.scene.shape == (1,)


def test_laws_and_options_in_both_spellings(read):
    text = "[nondimensional]\npsi1 = 1\nchi = 1\n[simulation]\nintegrator = 'symplectic'\n"
    nested = read(text + "[simulation.options.integrator]\nsteps = 77\n")
    inline = read(text + "options.integrator.steps = 77\n")
    quoted = read(text + "[simulation.options]\n'integrator.steps' = 77\n")
    for file in (nested, inline, quoted):
        choice = file.laws.choose(tangential="coulomb")
        assert choice.simulation().integrator.steps == 77


def test_option_of_a_named_law_goes_only_to_it(read):
    text = "[nondimensional]\npsi1 = 1\nchi = 1\n[simulation]\ntangential = 'coulomb'\n"
    text += "integrator = 'paper'\n"
    laws = read(text + "options.integrator.paper.steps = 33\n").laws
    assert laws.simulation().integrator.steps == 33
    assert resolution_of(laws.choose(integrator="symplectic").simulation().integrator) == 200


def test_options_of_a_kind_stay_with_the_law_they_were_written_for(read):
    text = "[nondimensional]\npsi1 = 1\nchi = 1\n[simulation]\ntangential = 'annulus'\n"
    laws = read(text + "options.tangential.annuli = 7\n").laws
    assert laws.simulation().tangential.annuli == 7
    laws.choose(tangential="coulomb").simulation()  # would refuse the option "annuli"


def test_measured_values_as_they_stand(read):
    file = read(
        "[nondimensional]\npsi1 = 1\nchi = 1\n[[measured]]\nquantity = 'psi2'\n"
        "against = 'psi1'\nsource = 'here'\nx = [1, 2]\nvalues = [0.5, -1]\nerror = [0.1, 0]\n"
    )
    (series,) = file.measured
    assert series.values.tolist() == [0.5, -1.0]
    assert series.error.tolist() == [0.1, 0.0]
    assert series.label == "measured"


def test_readings_of_one_point_are_averaged_and_their_range_kept(read):
    file = read(
        "[nondimensional]\npsi1 = 1\nchi = 1\n[[measured]]\nquantity = 'psi2'\n"
        "against = 'psi1'\nsource = 'here'\n"
        "[[measured.readings]]\nby='a'\npoint=[1, 2]\nx=[1.0, 2.0]\nvalues=[0.0, 5.0]\n"
        "[[measured.readings]]\nby='b'\npoint=[1]\nx=[1.2]\nvalues=[1.0]\n"
    )
    (series,) = file.measured
    assert series.x == pytest.approx([1.1, 2.0])
    assert series.values == pytest.approx([0.5, 5.0])
    assert series.error == pytest.approx([0.5, np.nan], nan_ok=True)
    assert series.x_error == pytest.approx([0.1, np.nan], nan_ok=True)


def test_scene_at_leaves_the_sweep_out():
    file = contactlab.read_scene(EXAMPLES / "kharaz2001.toml")
    scene = file.scene_at(angle_deg=[5.0, 10.0])
    assert scene.shape == (2,)
    assert np.hypot(scene.normal_speed, scene.tangential_velocity) == pytest.approx([3.9, 3.9])


def test_the_experiment_is_typed_in_whole():
    file = contactlab.read_scene(EXAMPLES / "kharaz2001.toml")
    restitution, angle, spin = file.measured
    assert len(restitution.x) == 11
    assert len(angle.x) == 9
    assert len(spin.x) == 7
    assert np.nanmax(spin.error) < 0.6
    assert np.nanmax(restitution.error) < 0.002
    assert "10.1016/S0032-5910(01)00283-2" in file.citation


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_file_reads(path):
    assert contactlab.read_scene(path).title


def test_further_groups_of_a_scene_without_bodies(tmp_path):
    file = tmp_path / "coupled.toml"
    file.write_text(
        "[nondimensional]\npsi1 = 0.98\nchi = 1.4412\npoisson_ratio = 0.3\n"
        "coupling_number = 0.784\nfriction_coefficient = 0.3\n"
    )
    scene = contactlab.read_scene(file).scene
    assert scene == Scene.nondimensional(
        psi1=0.98,
        chi=1.4412,
        poisson_ratio=0.3,
        coupling_number=0.784,
        friction_coefficient=0.3,
    )
    file.write_text(
        "[nondimensional]\npsi1 = 0.98\nchi = 1.4412\n[sweep]\ncoupling_number = [0.0, 0.5]\n"
    )
    assert contactlab.read_scene(file).scene.shape == (2,)
    assert contactlab.read_scene(file).scene.pair.dundurs_beta[1] == 0.5
