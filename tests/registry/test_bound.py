"""Options that follow from properties of materials, and options of one number an impact."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import attrs
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, create
from contactlab.contracts import (
    GEOMETRIC_MEAN,
    MEAN,
    NON_NEGATIVE,
    NormalContact,
    NormalLaw,
    number_in,
    quantity,
)
from contactlab.outcome.columns import columns
from contactlab.registry.bound import bind

#: One impact and a batch are solved by steps of their own.
SOLVED = 1e-8
RADIUS, SPEED = 0.01, 1.0
TIMES = np.array([1e-6, 2e-6, 3e-6, 5e-6])
ANGLES = np.array([10.0, 30.0, 45.0, 60.0])


def material(young=1e9, properties=None):
    return Material(young_modulus=young, poisson_ratio=0.3, density=1200.0, properties=properties)


def scene(first=None, second=None, *, moduli=(3e9, 1e9), angle_deg=30.0):
    ball = Sphere(RADIUS, material(moduli[0], first))
    wall = HalfSpace(material(moduli[1], second))
    return Scene.at_angle(ball, wall, 0.2, speed=SPEED, angle_deg=angle_deg)


def of_time(value):
    return {"relaxation_time": value}


def restitution_in_series(scene, times):
    """Return e of two Kelvin-Voigt bodies in series over one contact, by their own approaches."""
    moduli = [body.material.young_modulus / (1.0 - 0.3**2) for body in (scene.sphere, scene.target)]
    size, mass = (4.0 / 3.0) * RADIUS**0.5, scene.sphere.mass
    (e1, e2), (a1, a2) = moduli, [1.5 * time for time in times]

    def rates(_, state):
        whole, rate, own = state
        inside = max(whole, 0.0)
        own_rate = (e2 * (whole - own + a2 * rate) - e1 * own) / (e1 * a1 + e2 * a2)
        force = size * inside**0.5 * e1 * (own + a1 * own_rate)
        return [rate, -force / mass, own_rate]

    def ends(_, state):
        whole, rate, own = state
        own_rate = (e2 * (whole - own + a2 * rate) - e1 * own) / (e1 * a1 + e2 * a2)
        return own + a1 * own_rate

    ends.terminal, ends.direction = True, -1.0
    speed = float(scene.normal_speed)
    start = [1e-12, speed, 1e-12 * e2 / (e1 + e2)]
    done = solve_ivp(rates, (0.0, 1e-2), start, "Radau", events=ends, rtol=1e-9, atol=1e-16)
    return -done.y[1, -1] / speed


@pytest.mark.parametrize("times", [(1e-7, 6e-7), (8e-7, 2e-7), (0.0, 5e-7)])
def test_two_unlike_viscoelastic_bodies_lose_as_bodies_in_series(times):
    impact = scene(*map(of_time, times))
    e = Simulation(normal="kuwabara_kono").run(impact).normal_restitution
    expected = restitution_in_series(impact, times)
    assert 1.0 - e == pytest.approx(1.0 - expected, rel=0.02)


def test_like_bodies_have_the_property_of_each():
    of_materials = Simulation(normal="viscoelastic").run(scene(of_time(2e-6), of_time(2e-6)))
    law = create("normal.viscoelastic", relaxation_time=2e-6)
    assert of_materials.psi2 == Simulation(normal=law).run(scene()).psi2
    assert "relaxation_time=2e-06" in str(of_materials.plan)


@pytest.mark.parametrize(
    ("rule", "expected"), [(MEAN, 2.5), (GEOMETRIC_MEAN, 2.0)], ids=["mean", "geometric"]
)
def test_rules_by_hand(rule, expected):
    assert rule.of(1.0, 4.0, (material(), material(7e9))) == pytest.approx(expected)


@attrs.frozen(kw_only=True)
class Damped(NormalLaw):
    """Hertz's spring and a dashpot."""

    api_version = 2
    offers = frozenset({"radius"})

    damping: float = quantity("s", rule=NON_NEGATIVE, material=MEAN)
    share: float = quantity("1", rule=NON_NEGATIVE, default=1.0, per_impact=True)

    def start(self, scene):
        stiffness = (4.0 / 3.0) * scene.pair.effective_modulus * scene.pair.radius**0.5
        return stiffness, self.damping * number_in(self, "share", scene), scene.pair.radius

    def respond(self, state, approach, rate):
        stiffness, time, radius = state
        inside = approach * (approach > 0.0)
        force = stiffness * inside**1.5 + 1.5 * stiffness * time * inside**0.5 * rate
        force = force * (force > 0.0)
        return NormalContact(force, (radius * inside) ** 0.5, approach, force), state


@pytest.mark.parametrize(
    ("law", "first", "second", "words"),
    [
        (
            "viscoelastic",
            of_time(1e-6),
            None,
            "target.material: relaxation_time = None: is mis",
        ),
        ("viscoelastic", {"relaxaton_time": 1e-6}, None, "did you mean 'relaxation_time'?"),
        ("viscoelastic", of_time(1e-6), {"relaxaton_time": 1e-6}, "did you mean"),
        ("viscoelastic", {"relaxation_time (m)": 1.0}, of_time(1.0), "has the unit m, and visco"),
        (
            "viscoelastic",
            of_time(-1e-6),
            of_time(-1e-6),
            "sphere.material: relaxation_time = -1e-06: must",
        ),
        (
            create("normal.viscoelastic", relaxation_time=1e-6),
            of_time(2e-6),
            of_time(2e-6),
            "normal: relaxation_time = 1e-06: is given to the law, and sphere and target have it",
        ),
        (Damped(), None, None, "normal: damping = None: is missing: neither the law nor"),
        (Damped(), {"damping": np.array([1.0, 2.0])}, {"damping": 1.0}, "must be one number"),
    ],
)
def test_what_materials_cannot_give(law, first, second, words):
    angle = np.array([10.0, 20.0])
    with pytest.raises(ValueError, match=r"relaxa|damping") as refused:
        Simulation(normal=law).run(scene(first, second, angle_deg=angle))
    assert words in str(refused.value)


def test_a_restitution_that_is_given_stands_in_place_of_a_property():
    simulation = simulated(create("normal.viscoelastic", restitution=0.8))
    told = simulation.run(scene(of_time(2e-6), of_time(2e-6)))
    assert told.psi2 == simulation.run(scene()).psi2
    assert "restitution=0.8" in str(told.plan)
    assert simulation.run(scene(of_time(2e-6))).psi2 == told.psi2  # nor does one body need it
    taken = Simulation(normal="viscoelastic").run(scene(of_time(2e-6), of_time(2e-6)))
    assert "given, using" not in str(taken.plan)  # the property stands for 0.9


@pytest.mark.parametrize(
    ("properties", "words"),
    [
        ([1.0], "properties = [1.0]: must be numbers by name"),
        ({"relaxation time": 1.0}, "must be a name without blanks"),
        ({5: 1.0}, "properties: name = 5: must be a name"),
        ({"density": 1.0}, "properties: name = 'density': is the argument density"),
        ({"wear": 1.0, "wear (m)": 2.0}, "'wear (m)': is given twice"),
        ({"wear": "much"}, "properties['wear'] = 'much': must be a real number"),
        ({"wear": np.inf}, "properties['wear'] = inf: must be a finite real number"),
    ],
)
def test_properties_that_are_refused(properties, words):
    with pytest.raises(ValueError, match="properties") as refused:
        material(properties=properties)
    assert words in str(refused.value)


def test_properties_are_part_of_what_a_material_is():
    one, same, other = (material(properties=of_time(time)) for time in (1e-6, 1e-6, 2e-6))
    assert one == same != other
    assert hash(one) == hash(same)
    assert pickle.loads(pickle.dumps(one)) == one
    assert dict(attrs.evolve(one, density=1000.0).properties) == of_time(1e-6)


def test_properties_of_each_impact_and_of_bodies_in_space():
    each = scene(of_time(TIMES), of_time(TIMES), moduli=(1e9, 1e9), angle_deg=ANGLES)
    steps = {
        "tangential": create("tangential.springs", springs=50),
        "integrator": create("integrator.symplectic", steps=200),
    }
    together = Simulation(normal="viscoelastic", **steps).run(each)
    for place, (time, angle) in enumerate(zip(TIMES, ANGLES, strict=True)):
        alone = scene(of_time(time), of_time(time), moduli=(1e9, 1e9), angle_deg=angle)
        expected = Simulation(normal="viscoelastic", **steps).run(alone)
        assert together.psi2[place] == pytest.approx(expected.psi2, abs=SOLVED)
    ball = Sphere(RADIUS, material(properties=of_time(2e-6)))
    met = Encounter(ball, ball, 0.2, normal=[1, 0, 0], velocity=[1.0, 0.4, 0.0])
    law = create("normal.viscoelastic", relaxation_time=2e-6)
    bare = Sphere(RADIUS, material())
    plain = Encounter(bare, bare, 0.2, normal=[1, 0, 0], velocity=[1.0, 0.4, 0.0])
    found = collide(met, Simulation(normal="viscoelastic")).velocity
    assert found == pytest.approx(collide(plain, Simulation(normal=law)).velocity, abs=1e-15)


@pytest.fixture
def law():
    return create("normal.viscoelastic", relaxation_time=TIMES)


def simulated(law):
    return Simulation(normal=law, tangential="coulomb")


@pytest.fixture(scope="module")
def alone():
    laws = [create("normal.viscoelastic", relaxation_time=float(time)) for time in TIMES]
    impacts = scene(angle_deg=ANGLES)
    runs = [simulated(law).run(impacts.take(k)) for k, law in enumerate(laws)]
    return np.array([[float(run.psi2), float(run.normal_restitution)] for run in runs]).T


def test_each_impact_of_a_batch_has_its_own_number(law, alone):
    result = simulated(law).run(scene(angle_deg=ANGLES))
    assert result.psi2 == pytest.approx(alone[0], abs=SOLVED)
    assert result.normal_restitution == pytest.approx(alone[1], abs=SOLVED)
    name, unit, values = columns(result)[0]
    assert (name, unit, values.tolist()) == ("normal.relaxation_time", "s", TIMES.tolist())
    assert "relaxation_time=1e-06 to 5e-06, one an impact" in str(result.plan)


@pytest.mark.parametrize("part", [2, slice(1, 3), np.array([3, 0]), np.array([True, False] * 2)])
def test_parts_of_a_batch_keep_their_numbers(law, alone, part):
    whole = simulated(law).run(scene(angle_deg=ANGLES)).scene
    result = simulated(law).run(whole.take(part))
    assert result.psi2 == pytest.approx(alone[0][part], abs=SOLVED)


@pytest.mark.slow
def test_a_permuted_batch_of_the_same_shape_keeps_its_numbers(law, alone):
    whole = simulated(law).run(scene(angle_deg=ANGLES)).scene
    order = np.array([2, 0, 3, 1])
    assert simulated(law).run(whole.take(order)).psi2 == pytest.approx(alone[0][order])
    other = create("normal.viscoelastic", relaxation_time=TIMES[order])
    impacts = scene(angle_deg=ANGLES)
    assert simulated(other).run(whole).psi2.tolist() == (
        simulated(other).run(impacts).psi2.tolist()
    )


@pytest.mark.slow
def test_chunks_workers_and_stores_are_cut_along_it(law, alone, tmp_path):
    impacts, simulation = scene(angle_deg=ANGLES), simulated(law)
    with ThreadPoolExecutor(2) as pool:
        found = simulation.sweep(impacts, chunk=1, executor=pool)
    assert found.psi2 == pytest.approx(alone[0], abs=SOLVED)
    for _ in range(2):  # the second goes on from the first
        kept = simulation.sweep(impacts, chunk=1, keep=tmp_path / "kept")
        assert kept.psi2 == pytest.approx(alone[0], abs=SOLVED)
        folder = simulation.sweep(impacts, into=tmp_path / "into")
        assert folder["normal.relaxation_time"].tolist() == TIMES.tolist()
    other = create("normal.viscoelastic", relaxation_time=TIMES[::-1].copy())
    with pytest.raises(ValueError, match="keep"):
        simulated(other).sweep(impacts, chunk=1, keep=tmp_path / "kept")


@pytest.mark.parametrize("angle_deg", [30.0, ANGLES[:2], ANGLES.reshape(2, 2)])
def test_numbers_for_other_impacts_are_refused(law, angle_deg):
    with pytest.raises(ValueError, match=r"normal.relaxation_time = .*must be one number, or of"):
        Simulation(normal=law).run(scene(angle_deg=angle_deg))


def test_an_option_that_is_not_marked_is_one_number():
    with pytest.raises(ValueError, match="must be one number"):
        create("normal.viscoelastic", speed_loss=[0.1, 0.2])


def test_a_law_of_neither_is_bound_to_nothing():
    simulation, impacts = Simulation(), scene()
    laws, same = bind(simulation.laws, impacts)
    assert laws is simulation.laws
    assert same is impacts


def test_a_law_of_a_plugin_reads_both():
    dampings = {"damping (s)": 2e-7}, {"damping": 4e-7}
    shares = np.array([0.5, 1.0, 2.0, 4.0])
    result = Simulation(normal=Damped(share=shares)).run(scene(*dampings, angle_deg=ANGLES))
    for place, share in enumerate(shares):
        law = Damped(damping=3e-7 * share)
        alone = Simulation(normal=law).run(scene(angle_deg=float(ANGLES[place])))
        assert result.normal_restitution[place] == pytest.approx(
            alone.normal_restitution, abs=SOLVED
        )


def test_a_load_path_reads_both():
    times = np.linspace(0.0, 1e-4, 41)[:, None]
    pressed = np.full((41, 4), 1.0) * np.linspace(0.0, 1e-5, 41)[:, None]
    impacts = scene({"damping": 2e-7}, {"damping": 2e-7}, angle_deg=ANGLES)
    shares = np.array([0.5, 1.0, 2.0, 4.0])
    path = contactlab.load_path(
        impacts, pressed, 0.1 * pressed, normal=Damped(share=shares), time=times
    )
    for place, share in enumerate(shares):
        alone = contactlab.load_path(
            scene(), pressed[:, 0], 0.1 * pressed[:, 0],
            normal=Damped(damping=2e-7 * share), time=times[:, 0],
        )  # fmt: skip
        assert path.normal_force[:, place] == pytest.approx(alone.normal_force, rel=1e-12)


def test_options_tell_where_they_are_read_from():
    from contactlab.registry.options import options

    law = contactlab.registry.registry.REGISTRY.law_class("normal.viscoelastic")
    told = {option.name: option.meaning for option in options(law)}
    assert told["relaxation_time"].endswith(
        "It is one number, or one an impact, or a property of the materials: the mean weighted by "
        "(1-nu²)/E."
    )
