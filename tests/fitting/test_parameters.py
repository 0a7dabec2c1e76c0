"""Parameters of scenes and laws: their ranges, their starts, and the laws that they change."""

import math

import attrs
import numpy as np
import pytest

from contactlab import Simulation, create
from contactlab.fitting.model import Model, scene_of
from contactlab.fitting.parameters import Setup, parameter_named
from tests.fitting.impacts import ANGLES, BODIES, scene
from tests.laws.outside_laws import Walton

TSUJI = Simulation(normal="tsuji")


def named(name, simulation=None, bodies=BODIES):
    return parameter_named(name, Setup(bodies, simulation))


def test_numbers_of_a_scene_have_ranges_and_starts():
    friction, kappa = named("friction_coefficient"), named("stiffness_ratio")
    assert (friction.least, friction.most, friction.width) == (1e-6, 10.0, math.inf)
    assert (friction.name, friction.unit, friction.batched) == ("friction_coefficient", "1", True)
    assert len(friction.starts) == 25
    assert (kappa.least, kappa.most) == pytest.approx((2.0 / 3.0, 4.0 / 3.0))
    assert kappa.width == pytest.approx(2.0 / 3.0)
    assert kappa.starts == pytest.approx(2.0 / 3.0 + np.arange(1, 16) / 24.0)
    assert kappa.batched


def test_an_option_has_the_range_of_its_rule_and_starts_where_the_table_holds():
    tabled = named("restitution", TSUJI)
    assert (tabled.name, tabled.unit, tabled.batched) == ("normal.restitution", "1", False)
    assert (tabled.least, tabled.most) == pytest.approx((0.01, 1.0))
    own = TSUJI.normal.restitution
    assert tabled.starts == pytest.approx([own, *(0.5 + np.arange(1, 16) / 32.0)])
    stepped = named("normal.restitution", attrs.evolve(TSUJI, tangential=create_law("coulomb")))
    assert stepped.starts == pytest.approx([own, *(0.01 + 0.99 * np.arange(1, 16) / 16.0)])
    free = named("beta", Simulation(tangential=Walton(beta=0.3)))
    assert (free.name, free.starts[0]) == ("tangential.beta", 0.3)


def create_law(name):
    return create(f"tangential.{name}")


def test_the_unit_of_an_option_is_that_of_its_field():
    jkr = Simulation(normal="jkr", tangential="coulomb")
    field = next(f for f in attrs.fields(type(jkr.normal)) if f.metadata.get("unit", "1") != "1")
    assert named(f"normal.{field.name}", jkr).unit == field.metadata["unit"]


def test_only_real_options_of_laws_are_fitted_not_those_of_integrators():
    simulation = Simulation(tangential="springs", integrator="adaptive")
    for name in ("integrator.tolerance", "tangential.springs", "tolerance"):
        with pytest.raises(ValueError, match="scene and laws have no such number"):
            named(name, simulation)


@pytest.mark.parametrize(
    ("name", "simulation", "words"),
    [
        ("frction", None, "did you mean 'friction_coefficient'"),
        ("tangential.restitution", TSUJI, "did you mean 'normal.restitution'"),
        ("slip_restitution", None, "it is an option of tangential.walton: choose one of them"),
    ],
)
def test_a_name_that_is_not_there_is_told_with_what_is(name, simulation, words):
    with pytest.raises(ValueError, match="scene and laws have no such number") as caught:
        named(name, simulation)
    assert words in str(caught.value)
    assert "known here: friction_coefficient, stiffness_ratio" in str(caught.value)


def test_two_options_of_one_name_need_their_kinds():
    """A short name stands for one law's option only."""

    @attrs.frozen(kw_only=True)
    class Restituting(Walton):
        restitution: float = 0.4

    both = Simulation(normal="tsuji", tangential=Restituting())
    with pytest.raises(ValueError, match="parameters = 'restitution'"):
        named("restitution", both)
    assert named("tangential.restitution", both).starts[0] == 0.4


def test_an_option_is_set_and_the_other_laws_kept():
    simulation = Simulation(normal="tsuji", tangential="coulomb", integrator="symplectic")
    setup = Setup(BODIES, simulation)
    changed = parameter_named("restitution", setup).applied(setup, 0.7)
    assert changed.scene is BODIES
    assert changed.simulation.normal.restitution == 0.7
    assert changed.simulation.tangential == simulation.tangential
    assert changed.simulation.integrator == simulation.integrator


def model(*names, simulation=None, bodies=None):
    setup = Setup(scene(0.1) if bodies is None else bodies, simulation)
    return Model(setup=setup, parameters=tuple(parameter_named(name, setup) for name in names))


def test_laws_in_words():
    friction = np.array([0.123456789])
    assert model("friction_coefficient").laws(friction) == "exact elastic law (tabulated rebound)"
    tabled = model("restitution", simulation=TSUJI)
    assert tabled.tabled
    assert tabled.laws(np.array([0.123456789])) == (
        "Tsuji(restitution=0.123457), partial slip (tabulated rebound)"
    )
    coulomb = Simulation(normal="tsuji", tangential="coulomb")
    stepped = model("restitution", simulation=coulomb)
    assert not stepped.tabled
    words = stepped.laws(np.array([0.5]))
    assert words == f"Tsuji(restitution=0.5), {coulomb.tangential!r}, {coulomb.integrator!r}"


def test_points_with_different_options_of_laws_run_apart():
    laws = Simulation(tangential=Walton())
    both = model("friction_coefficient", "beta", simulation=laws, bodies=scene(0.1, ANGLES[:3]))
    points = np.array([[0.1, 0.2], [0.3, 0.4], [0.3, 0.2]])
    many = both.predicted(points, ["psi2"])["psi2"]
    for row, (friction, beta) in zip(many, points, strict=True):
        impacts = attrs.evolve(scene(0.1, ANGLES[:3]), friction_coefficient=friction)
        alone = Simulation(tangential=Walton(beta=beta)).sweep(impacts).check().psi2
        assert row == pytest.approx(alone, abs=1e-14)


SPEEDS = {"speed": np.array([2.0, 3.0])}


@pytest.mark.parametrize(
    ("given", "normal", "along"),
    [
        ({"angle_deg": np.array([30.0, 60.0])}, [5 * 0.75**0.5, 2.5], [2.5, 5 * 0.75**0.5]),
        (SPEEDS, [1.2, 1.8], [1.6, 2.4]),
        (SPEEDS | {"angle_deg": np.array([30.0, 60.0])}, [3.0**0.5, 1.5], [1.0, 1.5 * 3.0**0.5]),
        ({"normal_speed": np.array([1.0, 2.0])}, [1.0, 2.0], [4.0, 4.0]),
        ({"tangential_velocity": np.array([1.0, 2.0])}, [3.0, 3.0], [1.0, 2.0]),
    ],
)
def test_measured_entries_take_the_place_of_those_of_a_scene(given, normal, along):
    """The scene's own: 3 m/s towards the target and 4 m/s along it."""
    own = attrs.evolve(BODIES, normal_speed=3.0, tangential_velocity=4.0)
    batch = scene_of(own, given, 2)
    assert np.broadcast_to(batch.normal_speed, 2) == pytest.approx(normal)
    assert np.broadcast_to(batch.tangential_velocity, 2) == pytest.approx(along)
    assert batch.shape == (2,)


def test_other_measured_entries_need_a_file():
    batch = scene_of(BODIES, {"spin": np.array([1.0, 2.0]), "friction_coefficient": np.ones(2)}, 2)
    assert (batch.spin.tolist(), batch.friction_coefficient.tolist()) == ([1.0, 2.0], [1.0, 1.0])
    words = "cannot be put into a Scene; give the scene as a TOML file, or velocities alone"
    with pytest.raises(ValueError, match=rf"^measurements = 'sphere\.radius': {words}$"):
        scene_of(BODIES, {"sphere.radius": np.array([0.01])}, 1)


def test_a_scene_is_one_impact_or_as_many_as_were_measured():
    assert scene_of(BODIES, {}, 3).normal_speed.tolist() == [1.0, 1.0, 1.0]
    three = attrs.evolve(BODIES, normal_speed=[1.0, 2.0, 3.0])
    assert scene_of(three, {}, 3) is three
    with pytest.raises(
        ValueError, match=r"^scene = \(3,\): must be one impact, or the 2 that were"
    ):
        scene_of(three, {}, 2)
