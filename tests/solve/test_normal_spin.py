"""Spin about the normal: the half-space answers it, other laws tell what they leave out."""

import math
import re

import attrs
import numpy as np
import pytest
from scipy.integrate import quad

from contactlab import (
    Encounter,
    HalfSpace,
    ImpactError,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    collide,
    create,
    rebound,
)
from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.impact.normal_spin import nodes
from contactlab.outcome.plan import NORMAL_SPIN
from tests.testing.broken_impacts import Whole
from tests.testing.broken_spin import MarchesItsSpin, Torsion

SOLID = 49.0 / 34.0
NU, MU = 0.3, 0.1
KAPPA = 2.0 * (1.0 - NU) / (2.0 - NU)
LEFT_OUT = "spin about the normal: its friction is left out"
SHAPES = ("sphere", "body")


def met(psi1, w, chi=SOLID, chi_w=0.01, *, shape="sphere", **changes):
    """Return a ball of 1 m and 1 kg that meets a half-space at 1 m/s, by four numbers."""
    gyration2 = 1.0 / (2.0 * chi / KAPPA - 1.0)
    size = math.sqrt(2.0 * chi_w * gyration2 / KAPPA)  # a/R
    young = 2.0 * (1.0 - NU**2) * 15.0 / (16.0 * size**5)
    material = Material(young_modulus=young, poisson_ratio=NU)
    given = {
        "friction_coefficient": MU, "normal": (0.0, 0.0, -1.0),
        "velocity": (psi1 * MU / KAPPA, 0.0, -1.0), "spin": (0.0, 0.0, w * MU / (KAPPA * size)),
    }  # fmt: skip
    body = Sphere(1.0, material, mass=1.0, gyration_ratio=math.sqrt(gyration2))
    if shape == "body":
        inertia = gyration2 * np.eye(3)
        body = RigidBody(mass=1.0, inertia=inertia, material=material, curvature_radius=1.0)
        given["contact"] = (0.0, 0.0, -1.0)
    return Encounter(body, HalfSpace(material), **(given | changes))


def told(collision):
    """Return the numbers of the only caution: shift of psi2 and w, and the loss of spin."""
    (clause,) = [one for one in collision.plan.cautions if one.code == NORMAL_SPIN]
    numbers = [float(np.max(each)) for each in clause.values]
    if "psi2 hardly" in clause.text:
        return 0.0, numbers[1], numbers[0] / 100.0
    return numbers[0], numbers[1], numbers[2] / 100.0


#: psi2 and w after the impact, by rings with Fourier modes and by half-space solutions that take
#: spin, both extrapolated; those beyond
#: the table by the second alone: the shift, and the loss over chi_w.
ROWS = [
    (0.5, 0.2, SOLID, 0.01, -0.0514, 0.19081),
    (1.0, 0.5, SOLID, 0.01, -0.3853, 0.48494),
    (2.0, 0.35, SOLID, 0.01, -0.9060, 0.34243),
    (0.988235, 0.399396, SOLID, 0.00242147, -0.3145, 0.39614),
    (0.8, 0.3, 1.0, 0.005, -0.5907, 0.29371),
    (3.0, 2.0, 1.75, 0.03, -0.640, 1.95694),
]
FAR = [
    (3.0, 10.0, SOLID, 2.7025, 1.9957),
    (3.0, 30.0, SOLID, 3.6706, 2.1081),
    (7.0, 10.0, SOLID, 2.1372, 1.4909),
    (10.0, 10.0, SOLID, 1.0784, 1.0299),
    (10.0, 50.0, SOLID, 4.3093, 2.0325),
    (20.0, 20.0, SOLID, 0.7553, 0.8560),
    (8.0, 5.0, 1.75, 0.8791, 0.7980),
    (8.0, 20.0, 1.0, 2.1554, 1.7995),
]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("psi1", "w", "chi", "chi_w", "psi2", "rest"), ROWS)
def test_the_sizes_are_those_of_solutions_with_spin(psi1, w, chi, chi_w, psi2, rest, shape):
    shift, number, loss = told(collide(met(psi1, w, chi, chi_w, shape=shape)))
    assert number == pytest.approx(w, rel=1e-9)
    assert 0.6 < shift / abs(psi2 - rebound(psi1, chi)) < 1.9
    assert loss == pytest.approx(1.0 - rest / w, rel=0.05)


@pytest.mark.parametrize(("psi1", "w", "chi", "shift", "loss"), FAR)
def test_beyond_the_table_the_sizes_are_those_of_solutions_too(psi1, w, chi, shift, loss):
    found, _, part = told(collide(met(psi1, w, chi, 1e-4)))
    assert 0.6 < found / shift < 1.9
    assert part == pytest.approx(1e-4 * loss / w, rel=0.2)


@pytest.mark.parametrize(("psi1", "chi"), [(7.0, SOLID), (9.0, SOLID), (9.0, 0.9), (20.0, 3.0)])
def test_slip_throughout_is_a_closed_form(psi1, chi):
    """To second order in w the friction of gross slip, with the slip of the surfaces."""

    def integral(power):
        return quad(
            lambda rate: (
                (1.0 - rate**2) ** 0.4 / (psi1 - 2.0 * chi + (2.0 * chi - 1.0) * rate) ** power
            ),
            -1.0,
            1.0,
        )[0]

    shift, _, loss = told(collide(met(psi1, 1.0, chi, 1e-4)))
    assert shift == pytest.approx(0.2 * chi * integral(2), rel=0.02)
    assert loss == pytest.approx(0.4e-4 * integral(1), rel=0.01)
    if psi1 == 7.0:
        assert (shift, 1e4 * loss) == pytest.approx((0.0334, 0.1687), rel=0.02)


#: Pure torsion by two programs, 1e-9: scaled spin and inertia ratio of torsion, and spin after.
TORSION = [(0.2, 0.05, 0.145379967), (0.5, 0.05, 0.408654101), (1.0, 0.1, 0.792230865)]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("sigma", "chi_t", "after"), TORSION)
def test_a_central_impact_loses_the_spin_of_pure_torsion(sigma, chi_t, after, shape):
    """In the unit of torsion, 1 - nu/2 times that of slip."""
    unit = 1.0 - NU / 2.0
    made = collide(met(0.0, sigma / unit, chi_w=chi_t / unit, shape=shape))
    shift, _, loss = told(made)
    assert shift == 0.0
    assert loss == pytest.approx(1.0 - after / sigma, rel=0.04)
    assert made.velocity == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
    assert "psi2 hardly changes" in str(made.plan)


STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


def unlike(**changes):
    light = Sphere(0.007, STEEL, gyration_ratio=0.7)
    given = {
        "normal": (1.0, 0.0, 0.0), "velocity": (1.0, 0.05, 0.0), "spin": (40.0, 0.0, 0.0),
        "target_velocity": (0.2, 0.0, 0.1), "target_spin": (-70.0, 5.0, 0.0),
    }  # fmt: skip
    return Encounter(Sphere(0.01, STEEL), light, 0.1, **(given | changes))


@pytest.mark.parametrize("options", [{}, {"restitution": 0.9}, {"simulation": "springs"}])
@pytest.mark.parametrize("shape", SHAPES)
def test_a_steel_ball_whose_equator_turns_as_fast_as_it_falls(shape, options):
    """Three programs: psi2 is -0.3145, -0.055 without spin, and the spin loses 0.8 %."""
    ball, given = Sphere(0.01, STEEL), {}
    if shape == "body":
        inertia = 0.4 * ball.mass * 1e-4 * np.eye(3)
        given["contact"] = (0.0, 0.0, -0.01)
        ball = RigidBody(mass=ball.mass, inertia=inertia, material=STEEL, curvature_radius=0.01)
    encounter = Encounter(
        ball, HalfSpace(STEEL), 0.1, normal=(0, 0, -1), velocity=(0.12, 0, -1), spin=(0, 0, 100),
        **given,
    )  # fmt: skip
    if "simulation" in options:
        options = {"simulation": Simulation(tangential=create("tangential.springs"))}
    made = collide(encounter, **options)
    words = str(made)
    shift, w, loss = map(
        float,
        re.search(
            r"caution: model: friction of the spin .* psi2: about (\S+) "
            r"\(w = (\S+)\); the spin would lose about (\S+) %",
            words,
        ).groups(),
    )
    assert shift == pytest.approx(0.26, abs=0.02)
    assert w == pytest.approx(0.4, abs=0.005)
    assert loss == pytest.approx(0.82, abs=0.02)
    assert LEFT_OUT in list(map(str, made.plan.left_out))
    if np.isfinite(made.plan.psi2_error):
        assert re.search(r"error of psi2: below .*, without spin about the normal", str(made.plan))
    else:
        assert options  # the answers of the default laws have a bound
    if not options:
        with pytest.raises(ImpactError, match="spin about the normal"):
            made.check(cautions=True)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_sizes_know_no_hand_and_no_direction_of_slip(shape):
    usual = told(collide(met(1.0, 0.3, shape=shape)))
    spin = met(1.0, 0.3).spin
    assert told(collide(met(1.0, 0.3, shape=shape, spin=-spin))) == usual
    assert told(collide(met(-1.0, 0.3, shape=shape))) == usual
    across = (0.0, MU / KAPPA, -1.0)
    assert told(collide(met(1.0, 0.3, shape=shape, velocity=across))) == pytest.approx(usual)


def balls(**changes):
    given = {"normal": (1.0, 0.0, 0.0), "velocity": (1.0, 0.2, 0.0)}
    return Encounter(*[Sphere(0.01, STEEL)] * 2, 0.1, **(given | changes))


def test_the_spin_of_one_body_relative_to_the_other_counts():
    alone = told(collide(balls(spin=(100.0, 0.0, 0.0))))
    assert told(collide(balls(target_spin=(100.0, 0.0, 0.0)))) == alone
    assert told(collide(balls(spin=(50.0, 0, 0), target_spin=(-50.0, 0, 0)))) == alone
    assert alone[0] > 0.01


NOT_TOLD = {
    "no spin": balls(),
    "no friction": met(1.0, 0.5, friction_coefficient=0.0),
    "no friction, body": met(1.0, 0.5, shape="body", friction_coefficient=0.0),
    "both alike": balls(spin=(100.0, 0.0, 0.0), target_spin=(100.0, 0.0, 0.0)),
    "rounding": balls(spin=(1e-11, 100.0, 0.0)),
    "across": met(1.0, 0.5, shape="body", spin=(3.0, 4.0, 0.0)),
}


@pytest.mark.parametrize("name", NOT_TOLD)
def test_nothing_is_said_where_no_spin_rubs(name):
    assert "friction of the spin" not in str(collide(NOT_TOLD[name]).plan)
    assert "friction is left out" not in str(collide(NOT_TOLD[name]).plan)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_small_shift_is_left_out_without_caution(shape):
    plan = collide(met(1.0, 0.01, chi_w=1e-4, shape=shape)).plan
    assert LEFT_OUT in list(map(str, plan.left_out))
    assert "about the normal" not in " ".join(map(str, plan.cautions))


@pytest.mark.parametrize("shape", SHAPES)
def test_a_batch_tells_the_largest_and_its_share(shape):
    rows = [(1.0, 0.5), (2.0, 0.2), (1.0, 0.0), (0.0, 0.5)]
    singles = [met(*row, chi_w=1e-3, shape=shape) for row in rows]
    vectors = {
        name: np.array([getattr(one, name) for one in singles]).reshape(2, 2, 3)
        for name in ("velocity", "spin")
    }
    made = collide(met(1.0, 0.5, chi_w=1e-3, shape=shape, **vectors))
    assert f"{LEFT_OUT[:21]} (3 of 4 impacts): its friction is left out" in str(made.plan)
    (caution,) = [one for one in made.plan.cautions if one.code == NORMAL_SPIN]
    assert str(caution).startswith(
        "model (2 of 4 impacts): friction of the spin about the normal is ignored. "
    )
    for place, one in enumerate(singles[:2]):
        size, w, percent = (np.ravel(each)[place] for each in caution.values)
        assert (size, w, percent / 100.0) == pytest.approx(told(collide(one)), rel=1e-9)
    errors = [str(one) for one in made.plan.computed if "error of psi2" in str(one)]
    assert [one.endswith("without spin about the normal") for one in errors] == [True, False]
    assert "(3 of 4 impacts)" in errors[0]
    assert "friction of the spin" not in str(made.plan[1, 0])


def test_of_pairs_some_of_which_separate_those_that_meet_are_told():
    made = collide(
        balls(velocity=[(1.0, 0.2, 0.0), (-1.0, 0.2, 0.0)], spin=(100.0, 0.0, 0.0)),
        separating="pass",
    )
    alone = collide(balls(spin=(100.0, 0.0, 0.0)))
    assert told(made) == pytest.approx(told(alone))


@pytest.mark.parametrize("slip", [(1.0, 0.0), (0.0, 1.0)])
def test_a_body_of_unequal_moments_has_the_inertia_ratios_of_the_slip_and_of_the_normal(slip):
    """Along x slip turns the body about y, along y about x: balls of that moment have that chi."""
    moments, chi_w = (0.4, 0.35, 0.5), 1e-3
    about = moments[1] if slip[0] else moments[0]
    chi = 0.5 * KAPPA * (1.0 + 1.0 / about)
    ball = met(1.0, 0.5, chi, chi_w)
    velocity = (slip[0] * MU / KAPPA, slip[1] * MU / KAPPA, -1.0)
    body = RigidBody(mass=1.0, principal=moments, material=ball.body.material, curvature_radius=1.0)
    made = collide(
        Encounter(
            body, ball.target, MU, normal=ball.normal, velocity=velocity, spin=ball.spin,
            contact=(0.0, 0.0, -1.0),
        )
    )  # fmt: skip
    shift, w, loss = told(collide(ball))
    assert told(made) == pytest.approx((shift, w, loss * about / moments[2]), rel=1e-9)


def test_the_table_is_read_when_a_plan_is():
    nodes.cache_clear()
    made = collide(met(1.0, 0.5)), collide(met(1.0, 0.5, shape="body"))
    assert nodes.cache_info().currsize == 0
    assert all(each.cautions for each in made)
    assert nodes.cache_info().currsize == 1


class TakesHalf(Torsion):
    """Friction takes half of the spin."""

    def spin_change(self, scene):
        return -0.5 * np.asarray(scene.normal_spin)


def test_a_law_with_the_word_that_is_marched_is_cautioned_of():
    """No step takes spin: the word holds for whole-impact answers."""
    made = collide(met(1.0, 0.5), Simulation(tangential=MarchesItsSpin())).check()
    assert made.spin[2] == met(1.0, 0.5).spin[2]
    assert "Effect on psi2: about 0.33" in str(made)
    assert "share the friction" not in str(made.plan)


@attrs.frozen(kw_only=True)
class LosesWork(Whole):
    """A tenth more friction work than the slip loses, against a declared 0.01 of the energy."""

    def books_bound(self, scene):
        return 0.01

    def told(self, known, scene):
        work = known.friction_work + 0.1 * scene.pair.tangential_mass * scene.slip_velocity**2
        return attrs.evolve(known, friction_work=work)


@pytest.mark.parametrize("count", [1, 3])
def test_a_spin_that_nothing_changes_hides_no_energy_that_is_lost(count):
    """Of one impact and of a batch alike."""
    given = of_groups(psi1=np.full(count, 2.0), spin=1e3, spin_inertia=0.01)
    scene = given if count > 1 else given.take((0,))
    result = Simulation(tangential=LosesWork()).run(scene)
    assert (np.asarray(result.status) == Status.UNBALANCED).all()


def test_an_elliptic_contact_keeps_the_caution():
    ball = met(1.0, 0.5)
    body = RigidBody(
        mass=1.0, inertia=0.4 * np.eye(3), material=ball.body.material, curvature_radius=1.0,
        cross_radius=1.5, curvature_axis=(1.0, 0.0, 0.0),
    )  # fmt: skip
    scene = Encounter(
        body, ball.target, MU, normal=ball.normal, velocity=ball.velocity, spin=ball.spin,
        contact=(0.0, 0.0, -1.0),
    ).scene  # fmt: skip
    assert scene.normal_spin == 0.0
    assert "spin about the normal is ignored" in " ".join(Simulation().run(scene).cautions)


def test_a_law_of_ones_own_with_the_word_turns_both_bodies():
    """Half of the spin, in a batch, beside impacts without it."""
    law = Simulation(tangential=TakesHalf())
    made = collide(unlike(spin=[(40.0, 0.0, 0.0), (-70.0, 0.0, 3.0)]), law).check()
    assert made.spin[0, 0] - made.target_spin[0, 0] == pytest.approx(55.0, rel=1e-12)
    assert made.spin[1, 0] == -70.0
    (cautioned,) = {"about the normal" in str(one) for one in made.plan.cautions} or {False}
    assert not cautioned
    one = collide(unlike(), law).check()
    assert one.energy.imbalance == pytest.approx(0.0, abs=1e-12 * one.energy.start)


def test_a_scene_without_vectors_is_cautioned_too():
    """By every law without the word, whatever made the scene."""
    scenes = (
        Scene.nondimensional(psi1=1.0, chi=SOLID, spin=0.5, spin_inertia=0.01, poisson_ratio=NU),
        attrs.evolve(met(1.0, 0.5).scene, encounter=None),
    )
    for scene in scenes:
        assert (abs(scene.w1), scene.chi_w) == pytest.approx((0.5, 0.01))
        for tangential in ("fronts", "springs", "coulomb"):
            result = Simulation(tangential=tangential).run(scene)
            assert result.rebound_normal_spin == scene.normal_spin
            assert result.energy.end < result.energy.start
            assert "psi2: about 0.33 (w = 0.5)" in str(result)
            assert LEFT_OUT in str(result.plan)


def of_groups(**changes):
    return Scene.nondimensional(**({"psi1": 1.0, "chi": 1.4, "spin": 0.5} | changes))


def turning(**changes):
    return attrs.evolve(met(1.0, 0.0).scene, **changes)


REFUSED = [
    (of_groups, {}, "spin_inertia = 0.0: must be positive with spin"),
    (of_groups, {"spin_inertia": -1.0}, "spin_inertia = -1.0: must"),
    (of_groups, {"spin_inertia": 0.1, "lam": 0.1, "eta": 0.1}, "spin = 0.5: needs a circular"),
    (of_groups, {"spin": math.nan}, "spin = nan: must"),
    (turning, {"normal_spin": math.inf}, "normal_spin = inf: must be a finite real number; give"),
    (turning, {"normal_spin": 1e200}, "normal_spin = 1e+200: the kinetic energy of the spin"),
    (
        turning,
        {"sphere": None, "target": None, "normal_spin": 3.0},
        "pair.inverse_spin_mass = 0.0: must be positive where the bodies spin",
    ),
]


@pytest.mark.parametrize(("make", "changes", "words"), REFUSED)
def test_spins_that_nobody_can_have_are_refused(make, changes, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        make(**changes)


MISNAMED = [
    (met, {"normal_spin": 3.0, "psi1": 1.0, "w": 0.5}, "spin"),
    (of_groups, {"w1": 0.5}, "spin"),
    (of_groups, {"chi_w": 0.5}, "spin_inertia"),
    (turning, {"side_spin": 3.0}, "normal_spin"),
]


@pytest.mark.parametrize(("make", "changes", "meant"), MISNAMED)
def test_names_that_users_try_lead_to_those_that_are(make, changes, meant):
    with pytest.raises(TypeError, match=f"did you mean '{meant}'"):
        make(**changes)


def test_scenes_with_and_without_spin_are_stacked_and_taken():
    made = [of_groups(spin=w, spin_inertia=0.01) for w in (0.5, 0.0)]
    stacked = Scene.stack(made)
    assert stacked.w1.tolist() == [0.5, 0.0]
    assert [stacked.take(k) == one for k, one in enumerate(made)] == [True, True]
    for shape in SHAPES:
        balls = Scene.stack([met(1.0, -w, shape=shape).scene for w in (0.5, 0.0)])
        assert balls.w1 == pytest.approx([0.5, 0.0])
    grid = Scene.grid(psi1=[0.5, 1.0], chi=SOLID, spin=[0.0, 0.1, 0.2], spin_inertia=0.01)
    assert grid.w1 == pytest.approx([0.0, 0.1, 0.2] * 2)
    bodies = Sphere(0.01, STEEL), HalfSpace(STEEL)
    assert kinetics.turns(Scene.at_angle(*bodies, 0.1, speed=1.0, angle_deg=5.0, normal_spin=9.0))
