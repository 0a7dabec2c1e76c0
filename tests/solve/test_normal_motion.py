"""Normal motions of any law, solved before any friction: however long, short or stiff."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import NormalContact, NormalLaw
from contactlab.solve.normal_motion import normal_motion
from tests.laws.exact_laws import order
from tests.laws.normal_laws import Damped, ForceFree
from tests.laws.outside_laws import Adhesive, LinearDashpot, Plastic, RescaledSpring, Tsuji
from tests.longer import longer

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
INTEGRATORS = ("symplectic", "paper", "adaptive")


def scene(slip=2.0, *, speed=1.0, mu=0.2):
    """Return a steel sphere of 10 mm on steel."""
    return Scene(Sphere(0.005, STEEL), HalfSpace(STEEL), mu, speed, slip)


@attrs.frozen(kw_only=True)
class WidePlastic(Plastic):
    """The plastic law with the radius that a Hertz contact of its force has."""

    def start(self, scene):
        pair = scene.pair
        return super().start(scene), 0.75 * pair.radius / pair.effective_modulus

    def respond(self, state, approach, rate):
        memory, compliance = state
        contact, memory = super().respond(memory, approach, rate)
        radius = np.cbrt(compliance * contact.force)
        if np.ndim(approach) == 0:
            radius = float(radius)
        return contact._replace(radius=radius), (memory, compliance)


@attrs.frozen(kw_only=True)
class Held(NormalLaw):
    """P = k z + c z' - pull, in contact for ever: an oscillation, or creep if overdamped."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})

    damping: float = 0.0
    stiffness: float = 1e6

    def start(self, scene):
        damping = 2.0 * self.damping * (self.stiffness * scene.pair.normal_mass) ** 0.5
        # Above 1 m/s the bodies come free.
        return damping, np.where(np.asarray(scene.normal_speed) > 1.0, 0.0, 1.0)

    def respond(self, state, approach, rate):
        force = self.stiffness * approach + state[0] * rate
        overlap = np.where(state[1] > 0.0, 1.0, approach)
        if np.ndim(approach) == 0:
            return NormalContact(force, abs(approach), float(overlap)), state
        return NormalContact(force, abs(approach), overlap), state


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("stiffness", [1e5, 1e2, 1e13])
def test_contacts_however_long_or_short(integrator, stiffness):
    """Half an oscillation, pi sqrt(m/k), from a twentieth to thousands of Hertz's durations."""
    law = LinearDashpot(stiffness=stiffness, damping=0.0)
    result = Simulation(normal=law, tangential="coulomb", integrator=integrator).run(scene())
    mass = result.scene.pair.normal_mass
    assert result.check().motion.duration == pytest.approx(
        np.pi * np.sqrt(mass / stiffness), rel=1e-8
    )
    assert result.normal_restitution == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize(
    ("law", "damping"),
    [
        *((LinearDashpot, damping) for damping in (0.01, 0.1, 0.3)),
        *((Tsuji, 0.1), *longer((Tsuji, 0.01), (Tsuji, 0.3))),
    ],
)
def test_restitution_is_the_closed_form(law, damping):
    """Theory §11: one constant of damping, one restitution, at any speed."""
    for speed in (1e-3, 1.0, 20.0):
        motion = normal_motion(law(damping=damping), scene(speed=speed))
        e = -motion.final_rate / speed
        assert e == pytest.approx(Tsuji.restitution(damping), rel=1e-7)


@pytest.mark.parametrize("damping", [0.05, 0.3, 5.0])
def test_one_impact_alone_is_solved_to_the_tolerance_in_few_steps(damping):
    """Of Hunt and Crossley's law: d (1 + e) = ln((1 + d)/(1 - e d)), d = lambda v1."""
    asked = []

    class Counted(type(contactlab.create("normal.hunt_crossley"))):
        def respond(self, state, approach, rate):
            asked.append(approach)
            return super().respond(state, approach, rate)

    motion = normal_motion(Counted(damping=damping), scene(speed=1.0))
    e = -motion.final_rate
    assert np.log1p(damping) - np.log1p(-e * damping) == pytest.approx(
        damping * (1.0 + e), rel=1e-9
    )
    lost = motion.scene.pair.normal_mass * (1.0 + e)
    assert motion.total_load_impulse == pytest.approx(lost, rel=1e-9)
    assert len(asked) < 1450


@pytest.mark.parametrize("law", [Plastic, WidePlastic])
@pytest.mark.parametrize("restitution", [0.3, *longer(0.8, 1.0)])
def test_plastic_restitution_alone_and_in_a_batch(law, restitution):
    """E of Walton and Braun's law is the root of the ratio of stiffnesses."""
    speeds = np.array([0.01, 0.3, 1.0, 5.0])
    plastic = law(restitution=restitution)
    batch = normal_motion(plastic, scene(speed=speeds))
    for index, speed in enumerate(speeds.tolist()):
        alone = normal_motion(plastic, scene(speed=speed))
        assert -alone.final_rate / speed == pytest.approx(restitution, rel=1e-7)
        for name in ("duration", "final_rate", "total_load_impulse"):
            found = getattr(batch, name)[index]
            assert found == pytest.approx(getattr(alone, name), rel=1e-9), name


NAMES = ("jkr", "dmt", "thornton", "hunt_crossley", "kuwabara_kono", "walton_braun")


@pytest.mark.parametrize(
    "law",
    [
        WidePlastic(),
        *longer(LinearDashpot(), Plastic(restitution=0.3), Adhesive(pull=20.0), Tsuji()),
        *longer(*NAMES),
    ],
)
def test_what_stands_beside_an_impact_changes_no_bit(law):
    """Each impact takes steps of its own: a batch that shared them was off by 1e-9, and by 5e-5."""
    law = contactlab.create(f"normal.{law}") if isinstance(law, str) else law
    speeds = np.array([0.2, 0.5, 1.0, 5.0])
    names = ("duration", "final_rate", "total_load_impulse", "maximum_force", "maximum_radius")
    together = normal_motion(law, scene(speed=speeds))
    for index in range(4):
        for one, rel in ((speeds[index : index + 1], 0.0), (float(speeds[index]), 1e-9)):
            alone = normal_motion(law, scene(speed=one))
            for name in names:
                found = np.broadcast_to(getattr(together, name), 4)[index]
                expected = np.ravel(getattr(alone, name))[0]
                # Powers of an array and of a number may differ in the last bit.
                assert found == pytest.approx(expected, rel=rel, abs=0.0), name


@pytest.mark.parametrize("normal", [name for name in NAMES if name not in ("jkr", "dmt")])
def test_the_load_impulse_is_the_momentum_that_is_lost(normal):
    motion = Simulation(normal=normal, tangential="coulomb").normal_motion(scene(speed=0.3))
    sample = motion.at(np.linspace(0.0, np.pi, 23))
    lost = motion.scene.pair.normal_mass * (0.3 - sample.rate)
    assert sample.load_impulse == pytest.approx(lost, abs=1e-7 * motion.total_load_impulse)


@pytest.mark.parametrize("normal", ["dmt", *longer("hunt_crossley", "jkr", "thornton")])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_batch_of_linear_springs_is_what_they_are_alone(normal, integrator):
    """Its stiffness is that of the greatest approach, which differed: psi2 by 7e-7 (1.6e-6)."""
    simulation = Simulation(normal=normal, tangential="linear_spring", integrator=integrator)
    speeds, slips = np.array([0.1, 0.7, 3.0]), np.array([0.05, 0.6, 1.2])
    together = simulation.run(
        Scene(Sphere(0.005, STEEL), HalfSpace(STEEL), 0.2, speeds, slips)
    ).check()
    for index, slip in enumerate(slips.tolist()):
        alone = simulation.run(scene(slip, speed=float(speeds[index]))).check()
        # one impact and many take steps of their own to the same tolerance: 2.4e-10 under thornton
        assert together.psi2[index] == pytest.approx(alone.psi2, abs=1e-9)


@pytest.mark.parametrize(
    "law", [Held(), Held(damping=1.5), ForceFree(), Adhesive(pull=1e5, reach=1e-5)]
)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_contact_that_never_ends_is_no_answer(law, integrator):
    sim = Simulation(normal=law, tangential="coulomb", integrator=integrator)
    result = sim.run(scene(speed=0.01))
    assert result.status is Status.NOT_SEPARATED
    assert type(law).__name__ in result.motion.detail
    assert np.isnan(result.psi2)


@pytest.mark.parametrize("damping", [0.0, 1.5])
def test_in_a_batch_only_those_that_never_end(damping):
    speeds = np.array([0.5, 2.0, 0.7, 3.0])
    sim = Simulation(normal=Held(damping=0.0), tangential="coulomb")
    if damping:  # overdamped bodies that come free creep back to where they touched
        sim = Simulation(normal=Held(damping=damping), tangential="coulomb")
        assert not np.any(sim.run(scene(speed=np.array([0.5, 0.7]))).status)
        return
    result = sim.run(scene(speed=speeds))
    assert [status.name for status in result.status] == ["NOT_SEPARATED", "SUCCESS"] * 2
    for index in (1, 3):
        alone = sim.run(scene(speed=float(speeds[index]))).check()
        assert result.normal_restitution[index] == pytest.approx(1.0, rel=1e-8)
        assert result.psi2[index] == pytest.approx(alone.psi2, rel=1e-8)


def test_an_infinite_radius_is_no_answer():
    """The normal motion does not feel the radius, and its steps go on."""

    class Boundless(Tsuji):
        def respond(self, state, approach, rate):
            contact, state = super().respond(state, approach, rate)
            if approach > 1e-6:
                contact = contact._replace(radius=np.inf)
            return contact, state

    result = Simulation(normal=Boundless(), tangential="springs").run(scene())
    assert result.status is Status.NON_FINITE
    assert "Boundless" in result.motion.detail
    assert "the answer " in result.motion.detail


@pytest.mark.parametrize("bad", ["overlap", "force"])
def test_one_nan_is_not_out_of_contact(bad):
    """It compares as no overlap: an impact ended in mid-approach, and was called a success."""

    class Blind(Tsuji):
        def respond(self, state, approach, rate):
            contact, state = super().respond(state, approach, rate)
            if approach > 1e-6:
                contact = contact._replace(**{bad: np.nan})
            return contact, state

    result = Simulation(normal=Blind(), tangential="springs").run(scene())
    assert result.status is Status.NON_FINITE
    assert "Blind" in result.motion.detail


@pytest.mark.parametrize(
    ("law", "slip"),
    [
        *((WidePlastic(), slip) for slip in (0.02, 0.3, 2.0)),
        *((Plastic(), 0.02), (Plastic(), 2.0), *longer((Plastic(), 0.3))),
    ],
)
def test_laws_of_partial_slip_agree_under_a_plastic_contact(law, slip):
    """Each finds the radius and the load of its own way; the answers differ by their parts."""
    found = []
    for name, parts in (("annulus", 200), ("springs", 200)):
        tangential = contactlab.create(f"tangential.{name}")
        tangential = attrs.evolve(tangential, **{tangential.resolution: parts})
        steps = contactlab.create("integrator.symplectic", steps=2000)
        sim = Simulation(normal=law, tangential=tangential, integrator=steps)
        result = sim.run(scene(slip)).check()
        assert result.normal_restitution == pytest.approx(0.8, rel=1e-7)
        found.append(result.psi2)
    assert max(found) - min(found) < 2e-3


@pytest.mark.parametrize("law", [Plastic(), WidePlastic()])
@pytest.mark.parametrize("tangential", ["annulus", "springs", "coulomb"])
def test_gross_slip_under_a_plastic_contact(law, tangential):
    """Psi falls by 2 chi (1 + e), whatever the contact."""
    result = Simulation(normal=law, tangential=tangential).run(scene(30.0)).check()
    fallen = 2.0 * result.scene.chi * (1.0 + 0.8)
    assert result.psi_change == pytest.approx(-fallen, abs=1e-6)


SMOOTH = {
    "hertz": "hertz",
    "tsuji": Tsuji(damping=0.1),
    "plastic": Plastic(),
    "adhesive": Adhesive(),
    "damped": Damped(),
}


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
@pytest.mark.parametrize("normal", SMOOTH.values(), ids=SMOOTH)
def test_second_order_in_steps_under_any_normal_law(normal, integrator):
    """With normal laws marched in the same steps this was 1, or nothing."""

    def answer(slip, steps):
        march = contactlab.create(f"integrator.{integrator}", steps=steps)
        springs = contactlab.create("tangential.springs", springs=150)
        sim = Simulation(normal=normal, tangential=springs, integrator=march)
        return sim.run(scene(slip)).check().psi2

    steps, slips = (100, 200, 400, 800), (0.1, 0.23, 0.4)
    fine = [answer(slip, 12_800) for slip in slips]
    off = [
        np.sqrt(np.mean([(answer(slip, n) - f) ** 2 for slip, f in zip(slips, fine, strict=True)]))
        for n in steps
    ]
    assert order(steps, off) == pytest.approx(2.0, abs=0.3)


@pytest.mark.parametrize(
    "normal",
    [
        pytest.param(law, id=name, marks=[pytest.mark.slow] * (name != "damped"))
        for name, law in SMOOTH.items()
    ],
)
@pytest.mark.parametrize(
    ("law", "tolerances"),
    [
        # Of first order: the reference itself is no better than 1e-5.
        *longer((RescaledSpring(), np.logspace(-2, -4, 9))),
        ("springs", (1e-3, 1e-4, 1e-5)),
    ],
)
def test_adaptive_keeps_its_tolerance_under_any_normal_law(normal, law, tolerances):
    slips, errors = (0.1, 0.23), []

    def answer(integrator, slip):
        sim = Simulation(normal=normal, tangential=law, integrator=integrator)
        return sim.run(scene(slip)).check()

    fine = contactlab.create("integrator.symplectic", steps=12_800)
    exact = [answer(fine, slip).psi2 for slip in slips]
    for tolerance in tolerances:
        kept = contactlab.create("integrator.adaptive", tolerance=tolerance)
        found = [answer(kept, slip) for slip in slips]
        errors.append(max(abs(r.psi2 - e) / max(1.0, r.psi1)
                          for r, e in zip(found, exact, strict=True)))  # fmt: skip
        assert errors[-1] <= 2.0 * tolerance
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] >= 0.6


@pytest.mark.parametrize("law", ["springs", "annulus"])
def test_a_history_is_that_of_the_same_march(law):
    """Forces of all steps at once make the history; fields need the march step by step."""
    simulation = Simulation(
        tangential=law, integrator=contactlab.create("integrator.paper", steps=90)
    )
    for impact in (scene(0.4), scene(np.array([0.4, -1.0]))):
        plain, kept, watched = (
            simulation.run(impact, history=history) for history in (False, True, "fields")
        )
        assert np.array_equal(plain.psi2, kept.psi2)
        for name, column in watched.history.columns().items():
            scale = np.abs(column).max()
            assert kept.history.columns()[name] == pytest.approx(column, abs=1e-11 * scale)
        assert not kept.history.fields
        assert watched.history.fields
