"""The sizes that a plan gives to the coupling of unlike bodies and to deep contacts."""

import itertools
import re
from pathlib import Path

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.impact.cautions import DEEPEST
from contactlab.impact.coupling import coupling_shift
from contactlab.impact.hertz import hertz_scales
from contactlab.study.evidence import SOURCES

GUIDE = Path(contactlab.__file__).parent / "guide" / "theory-coupling.md"
CHI = 49.0 / 34.0
PSI1 = (0.5, 1.0, 1.5, 2.0, 3.0)
SOLID, SHELL = np.sqrt(0.4), np.sqrt(2.0 / 3.0)


def coupled(strength, psi1, *, chi=CHI):
    """Return the scene of psi1 whose Lambda = kappa beta/mu is ``strength``."""
    return Scene.nondimensional(psi1=psi1, chi=chi, poisson_ratio=0.3, coupling_number=strength)


def table():
    """Return Lambda and the shifts at ``PSI1`` from the table of the guide."""
    text = GUIDE.read_text(encoding="utf-8")
    rows = re.findall(r"^\| (0\.25|0\.5|1|2) \|((?: -[\d.]+ \|){5})$", text, re.MULTILINE)
    rows = rows[:4]  # the first of the tables with a Lambda
    assert len(rows) == 4
    return {float(name): [float(word) for word in re.findall(r"[\d.]+", row)] for name, row in rows}


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_shift_is_that_of_the_table_of_the_guide(sign):
    """Another program's; and of an impact from the other side, or with the bodies exchanged."""
    for strength, shifts in table().items():
        found = [float(coupling_shift(coupled(sign * strength, sign * psi1))) for psi1 in PSI1]
        assert found == pytest.approx(shifts, rel=0.12, abs=4e-3)


def test_at_the_entries_of_the_table_the_shift_is_theirs():
    """Read with another reader: psi1, chi, nu, then a column for each Lambda."""
    path = Path(contactlab.__file__).parent / "impact" / "coupling.csv"
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    strengths = [float(name.split("=")[1]) for name in lines[0].split(",")[3:]]
    entries = np.loadtxt(lines[1:], delimiter=",")
    psi1, chi, nu = (column[:, None] for column in entries[:, :3].T)
    scene = Scene.nondimensional(
        psi1=psi1, chi=chi, poisson_ratio=nu, coupling_number=np.array(strengths)
    )
    assert coupling_shift(scene) == pytest.approx(np.abs(entries[:, 3:]), rel=1e-9, abs=1e-12)


def test_between_the_entries_the_shift_is_their_mean():
    assert float(coupling_shift(coupled(0.0, 1.0))) == 0.0
    edges = [0.0, 0.25, 0.5, 1.0, 2.0, 4.0]
    for low, high in itertools.pairwise(edges):
        ends = [coupling_shift(coupled(strength, 1.0)) for strength in (low, high)]
        middle = coupling_shift(coupled(0.5 * (low + high), 1.0))
        assert float(middle) == pytest.approx(0.5 * float(sum(ends)), rel=1e-12)
    ends = [coupling_shift(coupled(1.0, psi1)) for psi1 in (0.5, 0.75)]
    middle = coupling_shift(coupled(1.0, 0.625))
    assert float(middle) == pytest.approx(0.5 * float(sum(ends)), rel=1e-12)


def test_the_plan_says_the_worst_of_a_batch():
    simulation = Simulation()
    alone = str(simulation.plan(coupled(0.5, 1.0)))
    assert "psi2: about 0.05 (Lambda = 0.5)" in alone
    batch = str(simulation.plan(coupled(0.5, np.array([2.0, 1.0, 3.0]))))
    assert "psi2: up to about 0.05 (Lambda = 0.5)" in batch
    for number, chi in ((4.5, 49 / 34), (0.5, 0.7), (0.5, 3.0)):
        beyond = str(simulation.plan(coupled(number, 1.0, chi=chi)))
        assert "psi2: outside the measured range" in beyond
    mixed = str(simulation.plan(coupled(np.array([0.5, 4.5]), 1.0)))
    assert "up to about 0.05, in some impacts outside" in mixed
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


def test_where_the_whole_contact_slips_the_shift_is_of_second_order():
    """Coupling turns the direction of slip; the shift does not end at 4 chi - 1 = 4.76."""
    sizes = coupling_shift(steel_on_rubber([5.0, 12.0, 24.0, 48.0]))
    assert 0.01 < sizes[0] < 0.1
    assert sizes[1] / sizes[2:] == pytest.approx([4.0, 16.0])
    assert not cautions(steel_on_rubber(500.0))
    (both,) = cautions(steel_on_rubber([1.0, 5.0]))
    assert "up to about" in both


def test_without_friction_there_is_no_caution():
    scene = attrs.evolve(steel_on_rubber(1.0), friction_coefficient=0.0)
    assert not cautions(scene)
    assert float(coupling_shift(scene)) == 0.0


def test_a_deep_contact_is_told_with_the_growth_of_its_error():
    """Theory §15: each 0.1 of z/R = C² adds 0.08 to 0.2 to beta0; C by Hertz's maximum radius."""
    soft = Material(young_modulus=1e7, poisson_ratio=0.45, density=1130.0)

    def at(speed):
        ball = Sphere(0.0214, soft)
        scene = Scene(ball, HalfSpace(Material.named("steel")), 0.3, speed, 0.1 * speed)
        result = Simulation().run(scene)
        told = next(str(each) for each in result.plan.cautions if "large contact" in str(each))
        return float(result.motion.maximum_radius) / 0.0214, told

    ratio, told = at(5.0)
    assert 0.3 < ratio < 0.4
    assert f"{0.8 * ratio**2:.2g} to {2.0 * ratio**2:.2g} higher" in told
    ratio, told = at(40.0)
    assert ratio**2 > 0.5
    assert "outside the measured range" in told


def test_the_deepest_contact_with_a_size_is_the_deepest_that_was_measured():
    file = next(each for each in SOURCES if each.name == "superball").read()
    series = file.measured[0]
    scales = hertz_scales(scene := file.scene_at(**{series.against: series.x}))
    deepest = float(np.max(scales.approach / scene.pair.radius))
    assert pytest.approx(deepest, abs=1e-3) == DEEPEST


SOFT = Material(young_modulus=3e6, poisson_ratio=0.45, density=1000.0)


def dropped(speed, *, angle_deg=20.0, mass=None):
    """Return a ball of rubber that meets steel at an angle."""
    ball = Sphere(0.03, SOFT, mass=mass)
    return Scene.at_angle(
        ball, HalfSpace(Material.named("steel")), 0.5, speed=speed, angle_deg=angle_deg
    )


def of_groups(chi):
    return Scene.nondimensional(psi1=1.0, chi=chi)


def turning(w, chi=CHI):
    return Scene.nondimensional(psi1=1.0, chi=chi, spin=w, spin_inertia=0.01)


#: Laws, a scene within the measurements of a caution's size and one beyond, and words of both.
SIZES = [
    ({"normal": ("viscoelastic", 0.8)}, dropped(3.0), dropped(30.0), "deep contact", "higher"),
    (
        {"normal": ("viscoelastic", 0.8)},
        of_groups(1.4),
        of_groups(4.0),
        "equal damping",
        "right within",
    ),
    ({"normal": ("tsuji", 0.8)}, of_groups(1.4), of_groups(4.0), "damping law", "by up to"),
    ({"normal": ("hunt_crossley", 0.5)}, of_groups(1.4), of_groups(0.5), "damping law", "up to"),
    ({"tangential": "mindlin_cap"}, of_groups(30.0), of_groups(400.0), "create energy", "% more"),
    ({}, turning(0.5), turning(100.0), "spin about the normal is ignored", "psi2: about"),
    ({}, turning(0.5), turning(0.5, chi=3.0), "spin about the normal is ignored", "psi2: about"),
]


@pytest.mark.parametrize(("laws", "inside", "outside", "about", "size"), SIZES)
def test_a_size_ends_where_its_measurements_end(laws, inside, outside, about, size):
    named = dict(laws)
    if "normal" in named:
        name, e = named["normal"]
        named["normal"] = contactlab.create(f"normal.{name}", restitution=e)

    def said(scene):
        cautions = map(str, Simulation(**named).plan(scene).cautions)
        return [text for text in cautions if about in text]

    (within,), (beyond,) = said(inside), said(outside)
    assert size in within
    assert "outside the measured range" not in within
    assert size not in beyond
    assert "outside the measured range" in beyond


@pytest.mark.parametrize("normal", ["viscoelastic", "tsuji"])
def test_below_the_measured_restitutions_e_t_has_no_size(normal):
    law = contactlab.create(f"normal.{normal}", restitution=0.05)
    told = str(Simulation(normal=law, tangential="springs").plan(of_groups(1.4)).cautions)
    assert "At e = 0.05 the error of beta0 is outside the measured range" in told
