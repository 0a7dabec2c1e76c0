"""Numbers in a wrong unit and options by default are told where a user looks."""

import math
import pickle
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import (
    Encounter,
    HalfSpace,
    ImpactError,
    Material,
    Scene,
    Simulation,
    Sphere,
    collide,
    load_path,
)  # fmt: skip
from contactlab.contracts import SteppedTangentialLaw
from contactlab.numeric.names import tell_arguments

STEEL = Material.named("steel")
#: E in GPa, as a handbook lists it.
TABULAR = Material(young_modulus=208.0, poisson_ratio=0.3, density=7850.0)
BLOCK = HalfSpace(STEEL)
SLIPS = {
    "sphere.radius = 10 m": Scene(Sphere(10.0, STEEL), BLOCK, 0.2, 1.0, 0.5),
    "shear_modulus = 80 Pa": Scene(Sphere(0.01, TABULAR), HalfSpace(TABULAR), 0.2, 1.0, 0.5),
    "was this 30° in radians?": Scene.at_angle(
        Sphere(0.01, STEEL), BLOCK, 0.2, speed=3.0, angle_deg=math.radians(30.0)
    ),
}


@pytest.mark.parametrize("words", SLIPS)
def test_a_wrong_unit_is_told_by_print_and_raised_on_request(words):
    scene, simulation = SLIPS[words], Simulation()
    for result in (simulation.run(scene), simulation.sweep([scene, scene])):
        assert any(words in line for line in str(result).splitlines() if "caution: unit" in line)
        assert result.check() is result
        with pytest.raises(ImpactError, match="caution: unit"):
            result.check(cautions=True)


def test_a_result_without_cautions_passes_the_strict_check():
    scene = Scene(Sphere(0.01, STEEL), BLOCK, 0.2, 0.01, 0.005)
    result = Simulation().run(scene)
    assert result.cautions == []
    assert result.check(cautions=True) is result


def test_a_collision_tells_its_cautions_too():
    ball = Sphere(10.0, STEEL)
    made = collide(Encounter(ball, ball, 0.2, normal=[1, 0, 0], velocity=[1, 1, 0]))
    assert "caution: unit: sphere.radius = 10 m" in str(made)
    assert made.check() is made
    with pytest.raises(ImpactError, match=r"caution: unit: sphere\.radius"):
        made.check(cautions=True)
    small = Sphere(0.01, STEEL)
    fine = collide(Encounter(small, small, 0.2, normal=[1, 0, 0], velocity=[0.01, 0.01, 0]))
    assert "caution" not in str(fine)
    assert fine.check(cautions=True) is fine


#: Laws with a number that nobody can know, and what they take for it.
TAKEN = {
    "normal.tsuji": ("restitution", 0.9),
    "normal.linear": ("restitution", 0.9),
    "normal.hunt_crossley": ("restitution", 0.9),
    "normal.kuwabara_kono": ("restitution", 0.9),
    "normal.viscoelastic": ("restitution", 0.9),
    "normal.walton_braun": ("restitution", 0.9),
    "normal.thornton": ("yield_velocity", 0.1),
    "normal.jkr": ("work_of_adhesion", 0.05),
    "normal.dmt": ("work_of_adhesion", 0.05),
    "tangential.walton": ("beta0", 0.4),
}


@pytest.mark.parametrize("name", TAKEN)
def test_a_number_that_nobody_gave_is_told_until_one_is_given(name):
    """The laws differ by value: neither a copy nor an equal number changes what is told."""
    scene, (option, value) = SLIPS["sphere.radius = 10 m"], TAKEN[name]
    kind, _, short = name.partition(".")
    by_default, given = contactlab.create(name), contactlab.create(name, **{option: value})
    copied = pickle.loads(pickle.dumps(Simulation(**{kind: short})))
    words = f"no {option} given, using {value:g}"
    for laws in (Simulation(**{kind: short}), copied, Simulation(**{kind: by_default})):
        assert words in str(laws.plan(scene))
        assert words in str(laws.run(scene))
        assert laws == copied
    assert given != by_default
    assert "given, using" not in str(Simulation(**{kind: given}).plan(scene))
    assert "given, using" not in str(Simulation().plan(scene))


def test_a_number_that_nobody_gave_is_told_along_a_path_and_yields_to_its_rival():
    scene, depth = SLIPS["sphere.radius = 10 m"], np.linspace(0.0, 1e-6, 20)
    law = contactlab.create("normal.hunt_crossley")
    assert "no restitution given" in str(load_path(scene, depth, depth, normal=law).cautions)
    other = attrs.evolve(law, damping=0.1)
    assert other == contactlab.create("normal.hunt_crossley", damping=0.1)
    assert "given, using" not in str(load_path(scene, depth, depth, normal=other).cautions)


def test_a_run_without_history_says_how_to_have_one():
    scene = SLIPS["sphere.radius = 10 m"]
    result = Simulation().run(scene)
    assert not result.history
    with pytest.raises(AttributeError, match=r"history\.time: .*run\(scene, history=True\)"):
        _ = result.history.time
    again = pickle.loads(pickle.dumps(result.history))
    assert not again
    assert "history=True" in repr(again)
    assert np.size(Simulation().run(scene, history=True).history.time) > 10


@pytest.mark.parametrize("name", ["aluminum", "Aluminium", "plexiglas", "aluminium oxide"])
def test_another_name_of_a_material_leads_to_that_of_the_collection(name):
    with pytest.raises(ValueError, match=r"is listed as '.*'; write that name") as told:
        Material.named(name)
    Material.named(str(told.value).split("'")[3])


@attrs.frozen(kw_only=True)
class Unfinished(SteppedTangentialLaw):
    """A law whose author forgot an argument."""

    api_version: ClassVar[int] = 2

    def start(self, scene):
        return 0.0

    def advance(self, state, increment, before, after):
        return 0.0


def test_a_failure_is_told_by_print():
    scene, simulation = (
        Scene.nondimensional(psi1=1.2, chi=1.44),
        Simulation(tangential=Unfinished()),
    )
    one, many = simulation.run(scene), simulation.sweep([scene, scene])
    assert "failed: A law raised an error" in str(one)
    assert "start() takes 2 positional arguments but 3 were given" in str(one)
    assert "failed (impact 0; 2 in all): A law raised an error" in str(many)
    assert "failed" not in str(Simulation().run(scene))


BALL = Sphere(0.01, STEEL)
RESULT = Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44), history=True)
#: What a user writes, and a key word of the answer.
WRONG_NAMES = {
    "Simulation(normal='jkr', restitution=0.9)": r"viscoelastic takes it",
    "Simulation(law='springs')": "did you mean 'tangential'",
    "Simulation('springs')": "write arguments as name=value; arguments: normal, tangential",
    "Sphere(diameter=0.02, material=STEEL)": "did you mean 'radius', half the diameter",
    "Sphere(0.01)": "material must be given",
    "Sphere(0.01, STEEL, 0.1)": "but for radius and material",
    "Material(208e9, 0.3, 7850)": "name=value; arguments: shear_modulus",
    "Material(E=208e9, nu=0.3)": "did you mean 'young_modulus'",
    "Material(G=80e9, nu=0.3, rho=1)": "did you mean 'shear_modulus'",
    "Material.named('gold')": "no such material; known: steel",
    "Material.named('stell')": "did you mean 'steel'",
    "HalfSpace(radius=1)": "radius is not an argument; arguments: material",
    "Scene(BALL, BLOCK, mu=0.2)": "did you mean 'friction_coefficient'",
    "Scene.nondimensional(psi=1.2, chi=1)": "did you mean 'psi1'",
    "Scene.at_angle(BALL, BLOCK, 0.2, speed=1, theta=3)": "did you mean 'angle_deg'",
    "Encounter(ball=BALL)": "did you mean 'body'",
    "RESULT.rebound_velocity": "'rebound_tangential_velocity' or 'rebound_normal_velocity'",
    "RESULT.e": "did you mean 'normal_restitution'",
    "RESULT.psi_2": "did you mean 'psi2'",
    "RESULT.zzzzzz": "it has .*psi2",
    "RESULT.energy.work": "did you mean 'friction_work'",
    "RESULT.history.force": "did you mean 'normal_force' or 'tangential_force'",
    "contactlab.study.Compare": "did you mean 'compare'",
}


@pytest.mark.parametrize(("written", "words"), WRONG_NAMES.items())
def test_a_wrong_name_is_answered_by_the_right_one(written, words):
    kinds = (TypeError, AttributeError, ValueError)
    with pytest.raises(kinds, match=words) as caught:
        eval(written)
    assert "\n" not in str(caught.value)


def test_errors_from_within_and_missing_protocols_stay_what_they_are():
    with pytest.raises(TypeError, match="unorderable"):
        Broken(value=1)
    with pytest.raises(AttributeError, match=r"^'ImpactResult' object has no attribute '_ipython"):
        _ = RESULT._ipython_display_
    assert pickle.loads(pickle.dumps(RESULT)).psi2 == RESULT.psi2


@tell_arguments
class Broken:
    def __init__(self, value):
        raise TypeError("unorderable")


def test_a_comparison_prints_as_a_table():
    """Rigid spheres slip from psi1 = 4 chi on: psi2 = psi1 - 4 chi."""
    scene = Scene.nondimensional(psi1=[6.0, 7.0], chi=1.0)
    laws = {"rigid": Simulation(tangential="coulomb"), "exact": Simulation()}
    lines = str(contactlab.study.compare(scene, laws)).splitlines()
    assert lines[1].split() == ["psi1", "rigid", "exact", "exact", "-", "rigid"]
    assert [float(word) for word in lines[3].split()] == pytest.approx([6.0, 2.0, 2.0, 0.0])
    assert any(line.startswith("caution, rigid: model: rigid") for line in lines)
    assert "failed" not in "\n".join(lines)
