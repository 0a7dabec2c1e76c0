"""Each normal law at single instants: force, radius, friction load and overlap by hand."""

import math

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab_laws.dashpot.motion import ScaledMotion
from contactlab_laws.dashpot.oscillator import Oscillator, damping_of, half_duration, restitution
from contactlab_laws.jkr import LEAST, root_of_size

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
SCENE = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.3, 0.7, 0.15)
MASS = 7850.0 * 4.0 / 3.0 * math.pi * 0.01**3
MODULUS = 0.5 * 208e9 / (1.0 - 0.09)
STIFFNESS = 4.0 / 3.0 * MODULUS * 0.1
#: Greatest approach of Hertz's impact.
DEEPEST = (1.25 * MASS * 0.49 / STIFFNESS) ** 0.4
Z = 2e-6


def responded(name, *instants, **options):
    """Return the last contact of a law that is given (approach, rate) one after the other."""
    law = create(f"normal.{name}", **options)
    state = law.start(SCENE)
    for instant in instants:
        contact, state = law.respond(state, *instant)
    return contact


HERTZ = STIFFNESS * Z**1.5
WIDE = math.sqrt(0.01 * Z)
#: A material that yields at 1 micrometre.
PRESSURE = 2.0 * MODULUS / math.pi * math.sqrt(1e-6 / 0.01)
YIELDED = STIFFNESS * 1e-9 + math.pi * PRESSURE * 0.01 * 1e-6
SPRING = MASS * 0.49 / DEEPEST**2


@pytest.mark.parametrize(
    ("name", "options", "instants", "force", "radius"),
    [
        ("hertz", {}, [(Z, 0.5)], HERTZ, WIDE),
        ("hunt_crossley", {"damping": 0.4}, [(Z, 0.5)], HERTZ * 1.2, WIDE),
        ("hunt_crossley", {"damping": 0.4}, [(Z, -0.5)], HERTZ * 0.8, WIDE),
        ("hunt_crossley", {"damping": 0.4}, [(Z, -3.0)], 0.0, 0.0),
        (
            "kuwabara_kono",
            {"relaxation_time": 1e-6},
            [(Z, 0.5)],
            STIFFNESS * Z**0.5 * (Z + 0.75e-6),
            WIDE,
        ),
        ("kuwabara_kono", {"relaxation_time": 1e-6}, [(Z, -1.4)], 0.0, 0.0),
        ("linear", {"restitution": 1.0, "stiffness": 3e6}, [(Z, 0.5)], 6.0, WIDE),
        ("linear", {"restitution": 1.0}, [(Z, 0.5)], SPRING * Z, WIDE),
        ("tsuji", {"restitution": 1.0}, [(Z, 0.5)], HERTZ, WIDE),
        ("walton_braun", {"restitution": 0.5, "stiffness": 3e6}, [(Z, 0.5)], 6.0, WIDE),
        # from 2 to 1.8 micrometres: four times as stiff
        (
            "walton_braun",
            {"restitution": 0.5, "stiffness": 3e6},
            [(Z, 0.5), (0.9 * Z, -0.5)],
            3.6,
            math.sqrt(0.01 * 1.2e-6),
        ),
        ("walton_braun", {"restitution": 0.5}, [(Z, 0.5), (0.7 * Z, -0.5)], 0.0, 0.0),
        ("walton_braun", {"restitution": 0.5}, [(Z, 0.5)], SPRING * Z, WIDE),
        ("thornton", {"yield_pressure": 2 * PRESSURE}, [(Z, 0.5)], HERTZ, WIDE),
        ("thornton", {"yield_pressure": PRESSURE}, [(Z, 0.5)], YIELDED, WIDE),
        # flatter by z^1.5 over the greatest force: what is left of 2 micrometres is 2/flatter
        (
            "thornton",
            {"yield_pressure": PRESSURE},
            [(Z, 0.5), (Z - 1e-7, -0.5)],
            YIELDED * (1.0 - 0.05 * HERTZ / YIELDED) ** 1.5,
            WIDE * math.sqrt(1.0 - 0.05 * HERTZ / YIELDED),
        ),
        ("thornton", {"yield_pressure": PRESSURE}, [(Z, 0.5), (0.05 * Z, -0.5)], 0.0, 0.0),
    ],
)
def test_force_and_radius(name, options, instants, force, radius):
    contact = responded(name, *instants, **options)
    assert contact.force == pytest.approx(force, rel=1e-9)
    assert contact.radius == pytest.approx(radius, rel=1e-9)
    if contact.friction_load is not None:  # else the force itself
        assert contact.friction_load == pytest.approx(force, rel=1e-9)
    assert (contact.overlap > 0.0) == (force > 0.0)


@pytest.mark.parametrize(
    "name", ["hertz", "hunt_crossley", "kuwabara_kono", "linear", "tsuji", "walton_braun", "dmt"]
)
def test_apart_there_is_nothing(name):
    options = {"relaxation_time": 1e-6} if name == "kuwabara_kono" else {}
    contact = responded(name, (-1e-9, 0.5), **options)
    assert (contact.force, contact.radius, contact.friction_load or 0.0) == (0.0, 0.0, 0.0)
    assert contact.overlap < 0.0
    assert np.isnan(responded(name, (math.nan, 0.5), **options).force)


@pytest.mark.parametrize(("name", "powers"), [("linear", (1.0, 0.0)), ("tsuji", (1.5, 0.25))])
def test_the_dashpots_of_a_restitution(name, powers):
    """2 beta sqrt(M k) z', and 2 beta sqrt(5/4 M k) z^¼ z'."""
    spring = STIFFNESS if name == "tsuji" else SPRING
    beta = damping_of(0.6)
    critical = math.sqrt((1.25 if name == "tsuji" else 1.0) * MASS * spring)
    force = spring * Z ** powers[0] + 2.0 * beta * critical * Z ** powers[1] * 0.5
    assert responded(name, (Z, 0.5), restitution=0.6).force == pytest.approx(force)
    assert responded(name, (Z, -9.0), restitution=0.6).force == 0.0


@pytest.mark.parametrize("beta", [0.0, 0.3, 0.9, 1.0, 1.2, 3.0])
def test_an_oscillator_with_any_damping(beta):
    """x of any damping from the roots of its equation; the end is where x + 2 beta V = 0."""
    roots = np.roots([1.0, 2.0 * beta, 1.0]).astype(complex)
    time = np.linspace(0.0, 2.0 * half_duration(beta), 9)
    made = Oscillator(beta)
    x, rate, pull = made.at(time)
    if beta == 1.0:
        known, speed = time * np.exp(-time), (1.0 - time) * np.exp(-time)
    else:
        first, second = roots
        known = ((np.exp(first * time) - np.exp(second * time)) / (first - second)).real
        speed = (
            (first * np.exp(first * time) - second * np.exp(second * time)) / (first - second)
        ).real
    assert x == pytest.approx(np.maximum(known, 0.0), abs=1e-12)
    assert rate == pytest.approx(speed, abs=1e-12)
    assert pull == pytest.approx(np.maximum(known + 2.0 * beta * speed, 0.0), abs=1e-12)
    assert pull[-1] == pytest.approx(0.0, abs=1e-12)
    assert made.duration == time[-1]
    assert -rate[-1] == pytest.approx(made.restitution) == pytest.approx(restitution(beta))


@pytest.mark.parametrize("coefficient", [1.0, 0.9, math.exp(-2.0), 0.05])
def test_the_damping_of_a_restitution(coefficient):
    """e^-2 is critical."""
    beta = damping_of(coefficient)
    assert restitution(beta) == pytest.approx(coefficient, rel=1e-12)
    if coefficient == math.exp(-2.0):
        assert beta == pytest.approx(1.0, abs=1e-7)


@pytest.mark.parametrize("power", [1.0, 1.25])
@pytest.mark.parametrize("beta", [0.0, 0.1, 0.4, 0.5, 0.7, 1.0, 1.3, 2.0])
def test_the_greatest_force_and_approach_are_those_of_the_motion(power, beta):
    motion = ScaledMotion(beta, power)
    phases = np.linspace(0.0, math.pi, 20001)
    sample = motion.at(phases)
    assert motion.strongest == pytest.approx(sample.force.max(), rel=1e-6)
    assert motion.deepest == pytest.approx(sample.approach.max(), rel=1e-6)
    fractions = np.array([0.0, 0.1, 0.5, 0.9, 1.0])
    found = motion.phase_at(fractions)
    assert motion.time(found) / motion.duration == pytest.approx(fractions, abs=1e-9)
    rates = sample.rate[[4000, 8000, 15000]]
    assert motion.phase_at_rate(rates) == pytest.approx(phases[[4000, 8000, 15000]], abs=1e-6)


@pytest.mark.parametrize("gamma", [0.5, 20.0])
def test_adhesion_around_the_contact(gamma):
    pull = 2.0 * math.pi * gamma * 0.01
    contact = responded("dmt", (Z, 0.5), work_of_adhesion=gamma)
    assert contact.force == pytest.approx(HERTZ - pull)
    assert (contact.radius, contact.friction_load) == pytest.approx((WIDE, HERTZ))
    touch = responded("dmt", (0.0, 0.5), work_of_adhesion=gamma)
    assert touch.force == pytest.approx(-pull)
    assert touch.overlap > 0.0


@pytest.mark.parametrize("s", [4.0 ** (-1.0 / 3.0), 0.7, 1.0, 1.6])
def test_adhesion_within_the_contact(s):
    """z = (b1²/R)(s⁴ - s), P = 2 pi Gamma R ((4/3) s⁶ - 2 s³), b = b1 s², load P + 3 pi Gamma R."""
    gamma = 5.0
    pull = 2.0 * math.pi * gamma * 0.01
    size = (2.0 * math.pi * gamma * 0.01**2 / MODULUS) ** (1.0 / 3.0)
    # next to the last approach of a contact s is a root: far less accurate than the approach
    accuracy = 1e-6 if s < 0.65 else 1e-9
    assert root_of_size(s**4 - s) == pytest.approx(s, rel=accuracy)
    contact = responded(
        "jkr", ((s**4 - s) * size**2 / 0.01 * (1 - 1e-15), -0.1), work_of_adhesion=gamma
    )
    force = pull * (4.0 / 3.0 * s**6 - 2.0 * s**3)
    assert contact.force == pytest.approx(force, rel=10 * accuracy, abs=1e-9 * pull)
    assert contact.radius == pytest.approx(size * s * s, rel=10 * accuracy)
    assert contact.friction_load == pytest.approx(force + 1.5 * pull, rel=10 * accuracy)
    assert contact.overlap == pytest.approx((s**4 - s - LEAST) * size**2 / 0.01, abs=1e-20)
    gone = responded("jkr", (LEAST * 1.01 * size**2 / 0.01, -0.1), work_of_adhesion=gamma)
    assert (gone.force, gone.radius, gone.friction_load) == (0.0, 0.0, 0.0)
    assert gone.overlap < 0.0


@pytest.mark.parametrize(
    ("name", "options", "defaults"),
    [
        ("tsuji", {}, {"restitution": 0.9}),
        ("linear", {}, {"restitution": 0.9, "stiffness": None}),
        ("walton_braun", {}, {"restitution": 0.9, "stiffness": None}),
        ("hunt_crossley", {}, {"restitution": 0.9, "damping": None}),
        ("kuwabara_kono", {}, {"restitution": 0.9, "relaxation_time": None}),
        ("hunt_crossley", {"damping": 0.3}, {"restitution": None, "damping": 0.3}),
        ("thornton", {}, {"yield_velocity": 0.1, "yield_pressure": None}),
        ("thornton", {"yield_pressure": 1e9}, {"yield_velocity": None}),
        ("jkr", {}, {"work_of_adhesion": 0.05}),
        ("dmt", {}, {"work_of_adhesion": 0.05}),
    ],
)
def test_defaults(name, options, defaults):
    law = create(f"normal.{name}", **options)
    assert {key: getattr(law, key) for key in defaults} == defaults


@pytest.mark.parametrize(
    ("name", "tabor", "sentence"),
    [
        ("jkr", 5.01, None),
        ("jkr", 4.96, "model: Tabor's parameter is 5, but the theory holds above 5. Use "
         "normal.dmt."),
        ("dmt", 0.099, None),
        ("dmt", 0.12, "model: Tabor's parameter is 0.12, but the theory holds below 0.1. Use "
         "normal.jkr."),
    ],
)  # fmt: skip
def test_which_theory_of_adhesion_holds(name, tabor, sentence):
    gamma = math.sqrt((tabor * 3e-10) ** 3 / 0.01) * MODULUS
    law = create(f"normal.{name}", work_of_adhesion=gamma)
    told = law.cautions(SCENE, Simulation().normal_motion(SCENE))
    assert [text for text in told if "Tabor" in text] == ([] if sentence is None else [sentence])
