"""One loss for pressure and shear (theory §15): against other programs, closed forms and rings."""

import re

import attrs
import numpy as np
import pytest
from scipy.integrate import trapezoid

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab_laws.dashpot.oscillator import restitution as of_damping
from contactlab_laws.viscoelastic.relaxation import restitution_of
from tests.laws.exact_laws import order
from tests.laws.normal_laws import in_si
from tests.longer import longer
from tests.solve.test_eccentric import random_in_space, random_planar, rod

PLANAR = Scene.nondimensional
CHI = 49 / 34
RIGID = Material(young_modulus=2e11, poisson_ratio=0.3, density=7800.0)
#: psi2 of three programs (theory §15), by psi1, for each a and chi: extrapolated, to 3e-6.
AT = (0.1, 0.5, 1.0, 1.2, 2.0, 3.0, 4.0)
PSI2 = {
    (0.05, 49 / 34): (.008928, .009160, -.085073, -.174580, -.724878, -1.219935, -1.256848),
    (0.05, 7 / 6): (-.017317, -.137768, -.383082, -.522071, -1.054454, -1.215194, -.461897),
    (0.1, 49 / 34): (.001063, -.018386, -.107094, -.176153, -.637783, -1.089706, -1.105620),
    (0.1, 7 / 6): (-.019273, -.134426, -.351641, -.468823, -.942747, -1.084370, -.284944),
    (0.1, 2.5): (-.007737, -.012076, .050040, .108260, .338853, .241275, -.259180),
    (0.2, 49 / 34): (-.007853, -.050955, -.136844, -.184068, -.513880, -.891083, -.859514),
    (0.2, 1.0): (-.033383, -.190251, -.425932, -.531852, -.867797, -.424765, .575235),
    (0.4, 49 / 34): (-.013432, -.071125, -.153547, -.186051, -.373254, -.639568, -.435211),
    (0.4, 1.75): (-.010535, -.052723, -.105150, -.120047, -.208623, -.450809, -.672458),
    (1.0, 49 / 34): (-.01115, -.05644, -.11454, -.13466, -.20683, -.31989, .28975),
    (3.0, 49 / 34): (-.00396, -.01989, -.03995, -.04683, -.06807, -.09356, .86458),
}  # fmt: skip
#: Springs and rings apart by 4e-7: psi1, chi, a, psi2.
BY_RINGS = (
    (0.7, 1.3, 0.15, -0.129268), (2.5, 1.6, 0.6, -0.324075), (2.6, 1.75, 0.15, -0.510490),
    (0.9, 0.7, 0.08, -0.703601),
)  # fmt: skip
#: psi1, chi, lam, eta, a, V2 and psi2, by a library's Runge-Kutta method.
BODIES = (
    (0.0, 1.302547, 0.187350, 1.714312, 0.1, -0.785470, 0.097501),
    (1.372549, 0.764706, -0.222692, -2.037707, 0.1, -0.850128, 2.582379),
)
#: Rows of other viscous laws (theory §15), to 1e-5: name, options, psi2 by psi1.
OTHERS_AT = (0.5, 1.0, 2.0, 3.0, 4.0, 8.0)
OTHERS = (
    ("tsuji", 0.2, (-.04377, -.13498, -.59223, -.99929, -.94568, 2.97295)),
    ("tsuji", 0.9, (-.06384, -.13210, -.27882, -.44378, .17026, 4.17026)),
    ("hunt_crossley", 0.2, (-.01521, -.10221, -.61957, -1.09486, -1.18397, 2.57486)),
)  # fmt: skip


def viscoelastic(e):
    return contactlab.create("normal.viscoelastic", restitution=e)


def springs(normal, parts=50, steps=200, **options):
    return Simulation(
        normal=normal,
        tangential=contactlab.create("tangential.springs", springs=parts, **options),
        integrator=contactlab.create("integrator.symplectic", steps=steps),
    )


def other(name, number):
    """Return Tsuji's or Hunt and Crossley's law by its number in scaled units."""
    if name == "tsuji":
        return contactlab.create("normal.tsuji", restitution=of_damping(0.5 * number))
    return contactlab.create("normal.hunt_crossley", damping=number)


@pytest.mark.parametrize(
    ("a", "chi"), [*list(PSI2)[3:5], *longer(*list(PSI2)[:3], *list(PSI2)[5:])]
)
def test_psi2_of_the_theory(a, chi):
    simulation = springs(viscoelastic(restitution_of(a)), 100, 800)
    result = simulation.run(PLANAR(psi1=np.array(AT), chi=chi)).check()
    assert result.psi2 == pytest.approx(PSI2[a, chi], abs=2e-4 if chi > 1.8 else 1e-4)
    assert result.normal_restitution == pytest.approx(restitution_of(a), abs=1e-9)
    assert np.abs(result.psi2 - PSI2[a, chi]).max() < 1.5 * np.max(result.plan.psi2_error)


@pytest.mark.slow
def test_psi2_of_rings():
    for psi1, chi, a, psi2 in BY_RINGS:
        result = springs(viscoelastic(restitution_of(a)), 100, 800).run(PLANAR(psi1=psi1, chi=chi))
        assert result.check().psi2 == pytest.approx(psi2, abs=1e-4)


def test_the_order_is_two():
    chi, a = 49 / 34, 0.1
    sizes = (25, 50, 100, 200)
    scene, off = PLANAR(psi1=np.array(AT), chi=chi), []
    for parts in sizes:
        result = springs(viscoelastic(restitution_of(a)), parts, 4 * parts).run(scene)
        off.append(np.sqrt(np.mean(np.square(result.psi2 - PSI2[a, chi]))))
    assert order(sizes, off) > 1.9
    assert off[1] < 1.2e-3


@pytest.mark.parametrize(("name", "number", "expected"), OTHERS)
def test_psi2_of_other_viscous_laws(name, number, expected):
    """They share their loss too, known by force, radius, approach and rate alone."""
    scene = in_si(PLANAR(psi1=np.array(OTHERS_AT), chi=CHI))
    off = [
        np.abs(springs(other(name, number), parts, 4 * parts).run(scene).psi2 - expected).max()
        for parts in (50, 100)
    ]
    assert off[0] < 6e-4
    assert off[1] < 0.4 * off[0]


def test_a_law_of_a_users_own_shares_its_loss():
    """The same as Tsuji's without the closed form: a law that says no more than ``viscous``."""
    tsuji = contactlab.create("normal.tsuji", restitution=0.7)

    @attrs.frozen(kw_only=True)
    class Own(contactlab.contracts.NormalLaw):
        api_version = 2
        offers = frozenset({"radius", "viscous"})

        def start(self, scene):
            return tsuji.start(scene)

        def respond(self, state, approach, rate):
            return tsuji.respond(state, approach, rate)

    scene = PLANAR(psi1=np.array(OTHERS_AT), chi=CHI)
    found, expected = (springs(law).run(scene).check().psi2 for law in (Own(), tsuji))
    assert found == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("grid", ["largest", "doubling"])
def test_slip_throughout_is_exact(grid):
    """From psi1 = max(1, 2 chi (1 + e) - e) on psi2 = psi1 - 2 chi (1 + e)."""
    rng = np.random.default_rng(4)
    for e in (0.3, 0.8):
        chi = rng.uniform(0.3, 3.0, 40)
        psi1 = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e) + rng.uniform(0.0, 2.0, 40) ** 2
        result = springs(viscoelastic(e), 20, 80, grid=grid).run(PLANAR(psi1=psi1, chi=chi))
        exact = psi1 - 2.0 * chi * (1.0 + result.normal_restitution)
        assert result.check().psi2 == pytest.approx(exact, abs=1e-10)
        assert result.normal_restitution == pytest.approx(e, abs=1e-10)


def test_it_sticks_from_the_start_below_psi1_of_one():
    """And the first gross slip ends at V = (2 chi - psi1)/(2 chi - 1), as without loss."""
    chi, simulation = 1.5, springs(viscoelastic(0.7), 50, 400)
    for psi1 in (0.9, 1.4):
        history = simulation.run(PLANAR(psi1=psi1, chi=chi), history="fields").history
        rate = history.normal_velocity / history.normal_velocity[0]
        stuck = np.asarray(history.fields["stuck"])[3:].any(axis=-1)
        if psi1 < 1.0:
            assert stuck[:150].all()
        else:
            first = int(np.argmax(stuck)) + 3
            assert rate[first] == pytest.approx((2 * chi - psi1) / (2 * chi - 1.0), abs=2e-2)


@pytest.mark.slow
def test_without_loss_in_shear_they_are_the_springs_of_before():
    """At ``shear_loss`` 0, at e = 1 and as the loss vanishes."""
    scene = PLANAR(psi1=np.array(AT), chi=CHI)
    elastic = springs("hertz").run(scene).psi2
    for law in ("tsuji", "viscoelastic", "hunt_crossley", "kuwabara_kono"):
        undamped = contactlab.create(f"normal.{law}", restitution=1.0)
        assert springs(undamped).run(scene).psi2 == pytest.approx(elastic, abs=1e-9)
    off = [
        np.abs(springs(viscoelastic(1.0 - gap), 200, 800).run(scene).psi2
               - springs("hertz", 200, 800).run(scene).psi2).max()
        for gap in (1e-3, 1e-4, 1e-5)
    ]  # fmt: skip
    assert off[1] < 0.2 * off[0]
    assert off[2] < 5e-5  # the springs' own errors, in other steps, are 2e-5 apart


def test_the_loss_in_shear_is_a_number():
    """-psi2/psi1 of theory §15, "Shear loss as a number"."""
    psi1 = np.array([1.0, 2.0, 3.0])
    rows = {
        0.5: (0.155, 0.376, 0.398), 1.0: (0.107, 0.319, 0.363),
        2.0: (0.094, 0.235, 0.298), 4.0: (0.105, 0.150, 0.199),
    }  # fmt: skip
    for loss, expected in rows.items():
        law = springs(viscoelastic(restitution_of(0.1)), 100, 400, shear_loss=loss)
        psi2 = law.run(PLANAR(psi1=psi1, chi=CHI)).check().psi2
        assert -psi2 / psi1 == pytest.approx(expected, abs=1.5e-3)


@pytest.mark.parametrize(
    ("psi1", "chi", "lam", "eta", "a", "rate", "psi2"), [BODIES[0], *longer(BODIES[1])]
)
def test_bodies_of_the_theory(psi1, chi, lam, eta, a, rate, psi2):
    scene = PLANAR(psi1=psi1, chi=chi, lam=lam, eta=eta)
    off = []
    for parts in (50, 100):
        result = springs(viscoelastic(restitution_of(a)), parts, 4 * parts).run(scene).check()
        off.append(max(abs(result.normal_restitution + rate), abs(result.psi2 - psi2)))
    assert off[0] < 1e-4
    assert off[-1] < 1.5e-5


def test_the_plan_says_whose_restitution_it_is():
    """That of the contact: a body's own follows, and is that of a sphere where nothing couples."""
    told = "restitution: set for a frictionless impact; that of the bodies follows from it"
    for lam, eta, own in ((0.2, 1.7, False), (0.0, 0.0, True)):
        scene = PLANAR(psi1=0.7, chi=1.3, lam=lam, eta=eta)
        result = springs(viscoelastic(0.8)).run(scene).check()
        assert (told in map(str, result.plan.computed)) is not own
        assert (abs(result.normal_restitution - 0.8) < 1e-6) is own
    coupled = PLANAR(psi1=0.7, chi=1.3, lam=0.2, eta=1.7)
    assert told not in map(str, springs(viscoelastic(1.0)).plan(coupled).computed)


@pytest.mark.slow
def test_a_dashpot_that_answers_a_rate_by_more_than_that_rate():
    """Few steps at the least restitution: 60 are off by what they declare, not by twice that."""
    scene, law = random_planar(120, 881), viscoelastic(0.01)
    exact = springs(law, 60, 240).run(scene).check().normal_restitution
    result = springs(law, 8, 60).run(scene).check()
    known = np.isfinite(result.plan.restitution_error)
    off = np.abs(result.normal_restitution - exact)
    assert (off <= 0.1 * result.plan.restitution_error)[known].all()


@pytest.mark.slow
def test_a_rod_in_space():
    """The rod of theory §14 with loss, whose slip turns: springs' own limit."""
    scene = rod(-35.0, slip=0.3, across=0.6).scene
    assert np.abs(scene.psi1) == pytest.approx((0.823529, 1.647059), abs=1e-6)
    t1 = np.sign(scene.psi1[0])
    off = []
    for parts in (50, 100, 200):
        result = springs(viscoelastic(restitution_of(0.1)), parts, 4 * parts).run(scene).check()
        off.append(max(abs(result.normal_restitution - 0.811461),
                       np.abs(result.psi2 - (t1 * 2.806270, 0.026030)).max()))  # fmt: skip
    assert off[0] < 1e-3
    assert off[-1] < 1e-4


@pytest.mark.slow
def test_vectors_of_a_sphere_are_the_sphere():
    """In space, turned by 0.7 rad: psi2 of the plane, and nothing across."""
    along = np.array([np.cos(0.7), np.sin(0.7)])
    for a in (0.1, 0.4):
        for psi1, psi2 in ((2.0, PSI2[a, CHI][4]),):
            scene = PLANAR(psi1=psi1 * along, chi=CHI * np.eye(2), lam=(1e-12, 0.0), rho=0.3)
            found = np.asarray(springs(viscoelastic(restitution_of(a))).run(scene).check().psi2)
            assert found @ along == pytest.approx(psi2, abs=4e-4)
            assert found[1] * along[0] - found[0] * along[1] == pytest.approx(0.0, abs=1e-11)


def test_books_close_to_second_order():
    """Over the whole energy 8e-5 at 50/200; planar, of spheres."""
    rng = np.random.default_rng(7)
    scene = PLANAR(psi1=rng.uniform(-6.0, 6.0, 200), chi=rng.uniform(0.3, 3.0, 200))
    sizes, worst = (25, 50, 100), []
    for parts in sizes:
        off = [
            np.abs(springs(viscoelastic(e), parts, 4 * parts).run(scene).energy.relative_imbalance)
            for e in (0.3, 0.8)
        ]
        worst.append(np.max(off))
    assert worst[1] < 8e-5
    assert order(sizes, worst) > 1.8


def test_the_loss_in_shear_of_slip_throughout():
    """w = s (zeta - r²), so that the force gives to the springs what a quadrature says."""
    e, psi1, friction = 0.6, 12.0, 0.2
    scene = PLANAR(psi1=psi1, chi=CHI, friction_coefficient=friction)
    law = attrs.evolve(springs(viscoelastic(e), 200, 2000).tangential)
    march = contactlab.create("integrator.symplectic", steps=2000)
    from contactlab.solve.normal_motion import normal_motion

    normal = normal_motion(viscoelastic(e), scene)
    motion = march.integrate(scene, normal, law, None)
    share = float(motion.shear_loss) / float(motion.friction_work + motion.shear_loss)
    phase = np.linspace(0.0, np.pi, 20001)
    sample = normal.at(phase)
    radius, rate = np.asarray(sample.contact.radius), np.asarray(sample.rate)
    # f = l and w' = V at every spring: the power taken up is mu P times V over the slip velocity
    kappa = scene.pair.stiffness_ratio
    velocity = scene.slip_velocity - friction * sample.load_impulse / scene.pair.tangential_mass
    taken = friction * sample.contact.force * friction * rate / kappa
    passed = friction * sample.contact.force * velocity
    spent = trapezoid(taken, sample.time) / trapezoid(passed, sample.time)
    assert radius.max() > 0.0
    assert share == pytest.approx(spent, rel=1e-3)


def test_the_caution_has_the_size_of_the_evidence():
    """None where it slips throughout, none at e = 1; metals and deep contacts are told."""
    rubber = Material(young_modulus=3e6, poisson_ratio=0.45, density=1000.0)
    ball = Scene(
        sphere=Sphere(radius=0.03, material=rubber), target=HalfSpace(RIGID),
        normal_speed=5.0, tangential_velocity=2.0, friction_coefficient=0.5,
    )  # fmt: skip
    plan = springs(viscoelastic(0.8)).plan(ball)
    assert any(
        "beta0" in text and "At e = 0.8" in text and "0.16" in text
        for text in map(str, plan.cautions)
    )
    assert any("deep contact" in text for text in map(str, plan.cautions))
    plan = springs(viscoelastic(0.8)).plan(
        attrs.evolve(ball, sphere=Sphere(radius=0.03, material=RIGID), tangential_velocity=2.0)
    )
    assert any("metals lose energy by yield" in text for text in map(str, plan.cautions))
    sliding = springs(viscoelastic(0.8)).plan(PLANAR(psi1=9.0, chi=CHI))
    assert not any("beta0" in text for text in map(str, sliding.cautions))
    alone = Simulation(normal=viscoelastic(0.8), tangential="annulus").plan(PLANAR(psi1=1.0, chi=1))
    assert "loss in shear: annulus has none" in map(str, alone.left_out)
    assert not any("loss in shear" in t for t in map(str, springs("hertz").plan(ball).left_out))


@pytest.mark.parametrize("e", [0.95, 0.98])
def test_the_caution_of_little_loss_has_the_size_of_what_half_and_twice_the_loss_move(e):
    """Of solid spheres, rounded up to a hundredth."""
    batch = PLANAR(psi1=np.linspace(0.2, 2.0, 10), chi=CHI)
    losses = (0.5, 1.0, 2.0)
    simulations = [springs(viscoelastic(e), 20, 200, shear_loss=loss) for loss in losses]
    less, usual, more = (-each.run(batch).check().psi2 / batch.psi1 for each in simulations)
    moved = max(np.abs(less - usual).max(), np.abs(more - usual).max())
    cautions = map(str, springs(viscoelastic(e), 20, 200).plan(batch).cautions)
    (size,) = re.findall(r"beta0 is right within (\S+), by", " ".join(cautions))
    assert moved <= float(size) < moved + 0.01


@pytest.mark.parametrize("loss", [-0.1, 8.5, "much", None, [1.0, 2.0]])
def test_a_loss_in_shear_out_of_range_is_refused(loss):
    with pytest.raises(ValueError, match=r"shear_loss = .*must"):
        contactlab.create("tangential.springs", shear_loss=loss)


def test_step_by_step_is_all_at_once():
    """Forces and both losses, also beside other impacts and in several axes."""
    simulation = springs(viscoelastic(0.5), 20, 80)
    one = PLANAR(psi1=1.2, chi=1.4)
    whole, stepped = simulation.run(one), simulation.run(one, history="fields")
    for name in ("friction_work", "shear_loss", "slip_velocity_change"):
        expected = getattr(stepped.motion, name)
        assert getattr(whole.motion, name) == pytest.approx(expected, rel=1e-12), name
    batch = simulation.run(PLANAR(psi1=[[1.2, 3.0], [0.5, 8.0]], chi=1.4))
    assert batch.psi2[0, 0] == pytest.approx(whole.psi2, abs=1e-12)


def test_a_relaxation_time_gives_each_speed_its_restitution():
    """1 - e grows as v1^(1/5) at first; a batch is each impact alone."""
    law = contactlab.create("normal.viscoelastic", relaxation_time=2e-5)
    speeds = np.array([1e-6, 3.2e-5, 1.024e-3])
    rubber = Material(young_modulus=3e6, poisson_ratio=0.45, density=1000.0)
    scene = Scene(
        sphere=Sphere(radius=0.03, material=rubber), target=HalfSpace(RIGID),
        normal_speed=speeds, tangential_velocity=0.3 * speeds, friction_coefficient=0.3,
    )  # fmt: skip
    result = springs(law, 12, 50).run(scene).check()
    lost = 1.0 - np.asarray(result.normal_restitution)
    assert lost[1:] / lost[:-1] == pytest.approx(2.0, rel=0.05)
    alone = [springs(law, 12, 50).run(scene.take(k)).psi2 for k in range(3)]
    # one impact and many take steps of their own to the tolerance of normal motions
    assert result.psi2 == pytest.approx(alone, abs=2e-8)


@pytest.mark.parametrize("count", [20, *longer(4000)])
def test_bodies_gain_no_energy(count):
    """Planar and in space, those that jam among them, at few springs and steps."""
    for e in (0.2, 0.9):
        for scene in (random_planar(count, 5), random_in_space(count, 6)):
            result = springs(viscoelastic(e), 12, 50).run(scene).check()
            assert (result.energy.end <= result.energy.start).all()
            assert np.abs(result.energy.relative_imbalance).max() < 2e-2


@pytest.mark.slow
@pytest.mark.parametrize("e", [0.05, *longer(0.01, 0.1, 0.4, 0.8)])
def test_books_of_bodies_close(e):
    """Over the whole energy, also where contacts outgrow their springs, which then merge."""
    for scene, bound in ((random_planar(60, 8), 3e-4), (random_in_space(20, 8), 3e-5)):
        result = springs(viscoelastic(e)).run(scene).check()
        assert np.abs(result.energy.relative_imbalance).max() < bound


@pytest.mark.parametrize(
    ("law", "scene"),
    [
        (viscoelastic(0.6), random_in_space(8, 62)),
        (viscoelastic(0.97), random_planar(60, 61)),
        (viscoelastic(0.1), random_planar(60, 63)),
        (viscoelastic(0.99), random_in_space(20, 65)),
        (other("tsuji", 0.3), random_planar(60, 64)),
    ],
)
@pytest.mark.slow
def test_errors_of_bodies_are_those_declared(law, scene):
    """By the extrapolation of finer springs and steps; where W is nearly singular none is."""
    middle, fine = (springs(law, parts, 4 * parts).run(scene).check() for parts in (30, 60))

    def exact(name):
        return (4.0 * np.asarray(getattr(fine, name)) - getattr(middle, name)) / 3.0

    for parts, steps in ((12, 160), (25, 100)):
        result = springs(law, parts, steps).run(scene).check()
        errors = {
            "psi2": result.plan.psi2_error,
            "normal_restitution": result.plan.restitution_error,
        }
        for name, declared in errors.items():
            off = np.abs(np.asarray(getattr(result, name)) - exact(name))
            off = np.linalg.norm(off, axis=-1) if off.ndim > 1 else off
            known = np.isfinite(declared)
            assert known.mean() > 0.85
            assert (off[known] <= declared[known]).all()
            assert np.max(off[known] / declared[known]) > 1e-3
    assert np.isnan(springs(law, shear_loss=0.5).plan(scene).psi2_error).all()
    said = [text for text in map(str, middle.plan.computed) if "of the normal restitution" in text]
    assert any("below" in text for text in said)


@pytest.mark.parametrize(
    ("sizes", "e", "psi1", "chi", "lam", "eta"),
    [
        ((25, 50), 0.05, 3.0, 1.4, 0.2, 0.4),
        *longer(
            ((25, 50, 100), 0.05, 3.0, 1.4, 0.2, 0.4),
            ((25, 50, 100), 0.05, 1.3, 1.2, 0.1, 0.5),
            ((25, 50, 100), 0.5, 1.3, 1.2, 0.1, 0.5),
        ),
    ],
)
def test_the_loss_in_shear_of_bodies_is_that_of_dashpots(sizes, e, psi1, chi, lam, eta):
    """A w'², and w² at the end: what the springs hold, without any force or work of theirs."""
    scene, off = PLANAR(psi1=psi1, chi=chi, lam=lam, eta=eta), []
    for parts in sizes:
        law = viscoelastic(e)
        result = springs(law, parts, 4 * parts).run(scene, history="fields").check()
        history, fields = result.history, result.history.fields
        places, w = fields["radius"], np.asarray(fields["relaxed"])
        assert np.array_equal(places[1], places[-1])  # no spring merged
        stiffness = 2.0 * scene.pair.effective_shear_modulus * (places[1, 1] - places[1, 0])
        before, after = (np.square(history.contact_radius)[part, None]
                         for part in (slice(None, -1), slice(1, None)))  # fmt: skip
        squares = places[1] ** 2
        share = np.where((before <= squares) & (after > squares), after - squares, 1.0)
        share /= np.where((before <= squares) & (after > squares), after - before, 1.0)
        moving = np.minimum(share, 1.0) * np.diff(history.time)[:, None]
        spent = np.sum(law.start(scene.central).time * np.diff(w, axis=0) ** 2 / moving)
        lost = stiffness * (spent + 0.5 * np.sum(w[-1] ** 2))
        off.append(abs(result.energy.shear_loss / lost - 1.0))
    assert (np.array(off) < (6e-4, 8e-5, 4e-5)[: len(off)]).all()
