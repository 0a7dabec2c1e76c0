"""JKR and DMT: their equations, the work of a cycle by quadrature, sticking, friction's load."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import contactlab
from contactlab import Encounter, HalfSpace, Material, Simulation, load_path, shapes
from contactlab.solve.normal_motion import normal_motion
from tests.laws.normal_impacts import restitution, scene

GAMMA = 0.2


def jkr(work_of_adhesion=GAMMA):
    return contactlab.create("normal.jkr", work_of_adhesion=work_of_adhesion)


def lost(law, given, least):
    """Return the work that the pull does from z = 0 to ``least``, by quadrature of the force.

    Where contact breaks the force goes as a square root: substituted.
    """
    state = law.start(given)

    def pull(share):
        z = least * (1.0 - share**2)
        return law.respond(state, z, 0.0)[0].force * 2.0 * share * least

    return quad(pull, 0.0, 1.0, epsabs=0.0, epsrel=1e-10)[0]


def least_approach(given, gamma=GAMMA):
    """Return z where JKR's contact breaks: the minimum of b²/R - sqrt(2 pi Gamma b/E*)."""
    pair = given.pair
    size = (2.0 * np.pi * gamma * pair.radius**2 / pair.effective_modulus) ** (1.0 / 3.0)
    return -0.75 * 4.0 ** (-1.0 / 3.0) * size**2 / pair.radius


def test_jkr_keeps_the_equations_of_the_paper():
    """P = 4 E* b³/(3R) - sqrt(8 pi Gamma E* b³), z = b²/R - sqrt(2 pi Gamma b/E*)."""
    given, law = scene(), jkr()
    pair, state = given.pair, law.start(given)
    depths = np.concatenate([np.linspace(0.999 * least_approach(given), 0.0, 20),
                             np.geomspace(1e-12, 1e-3, 40)])  # fmt: skip
    for z in depths.tolist():
        contact = law.respond(state, z, 0.0)[0]
        b, modulus = contact.radius, pair.effective_modulus
        pull = np.sqrt(2.0 * np.pi * GAMMA * b / modulus)
        assert b**2 / pair.radius - pull == pytest.approx(z, rel=1e-9, abs=1e-22)
        force = 4.0 * modulus * b**3 / (3.0 * pair.radius)
        force -= np.sqrt(8.0 * np.pi * GAMMA * modulus * b**3)
        scale = 1.5 * np.pi * GAMMA * pair.radius
        assert contact.force == pytest.approx(force, rel=1e-9, abs=1e-9 * scale)


def test_jkr_pulls_as_known():
    """-(8/9) P_c as contact is made, -(5/9) P_c as it breaks, -P_c at most."""
    given, law = scene(), jkr()
    state, most = law.start(given), 1.5 * np.pi * GAMMA * given.pair.radius
    least = least_approach(given)
    depths = np.linspace(least * (1 - 1e-12), -least, 4001)
    forces = [law.respond(state, z, 0.0)[0].force for z in depths.tolist()]
    assert law.respond(state, 0.0, 1.0)[0].force == pytest.approx(-8.0 / 9.0 * most, rel=1e-12)
    assert forces[0] == pytest.approx(-5.0 / 9.0 * most, rel=1e-5)
    assert min(forces) == pytest.approx(-most, rel=1e-6)
    assert law.respond(state, 1.0001 * least, 0.0)[0].force == 0.0


@pytest.mark.parametrize("ratio", [1.01, 1.5, 3.0, 30.0])
def test_jkr_restitution_is_the_work_of_its_cycle(ratio):
    given, law = scene(), jkr()
    pair = given.pair
    work = lost(law, given, least_approach(given))
    known = (GAMMA**5 * pair.radius**4 / pair.effective_modulus**2) ** (1.0 / 3.0)
    assert work == pytest.approx(7.0922 * known, abs=5e-5 * known)
    sticking = np.sqrt(2.0 * work / pair.normal_mass)
    found = restitution(law, scene(ratio * sticking))
    assert found == pytest.approx(np.sqrt(1.0 - ratio**-2), abs=1e-8)


@pytest.mark.slow
def test_jkr_bodies_that_come_too_slowly_do_not_part():
    law, given = jkr(), scene()
    sticking = np.sqrt(2.0 * lost(law, given, least_approach(given)) / given.pair.normal_mass)
    sim = Simulation(normal=law, tangential="springs")
    result = sim.run(scene(sticking * np.array([0.99, 2.0])))
    assert [status.name for status in result.status] == ["NOT_SEPARATED", "SUCCESS"]
    assert np.isnan(result.psi2).tolist() == [True, False]


SPRINGS = Simulation(
    normal=jkr(0.05), tangential=contactlab.create("tangential.springs", springs=4)
)


def tiny_rod(speed):
    """Return a tilted rod of rubber, a tenth of a millimetre long, that falls on rubber."""
    rubber, axis = Material.named("rubber"), (0.5, 0.0, np.sqrt(0.75))
    body, contact = shapes.rod(
        length=1e-4, radius=1e-5, material=rubber, normal=(0, 0, -1), axis=axis
    )
    velocity = np.multiply.outer(speed, (0.3, 0.0, -1.0))
    return Encounter(
        body, HalfSpace(rubber), 0.3, normal=(0, 0, -1), velocity=velocity, contact=contact
    ).scene  # fmt: skip


def test_jkr_bodies_of_any_shape_that_are_pulled_back_are_held():
    """They went on for 100 durations, 31,000 steps; one that parts is never pulled back."""
    alone = SPRINGS.run(tiny_rod(0.01))
    assert alone.status.name == "NOT_SEPARATED"
    assert "do not separate" in alone.motion.detail
    assert alone.counters["steps"] < 1000


@pytest.mark.slow
def test_jkr_holds_a_slow_body_beside_a_fast_one():
    result = SPRINGS.run(tiny_rod(np.array([0.01, 30.0])))
    assert [status.name for status in result.status] == ["NOT_SEPARATED", "SUCCESS"]
    assert np.isnan(result.psi2).tolist() == [True, False]
    assert result.psi2[1] == pytest.approx(SPRINGS.run(tiny_rod(30.0)).check().psi2, rel=1e-9)


def test_jkr_without_much_adhesion_is_hertz():
    given = scene()
    one, other = (
        normal_motion(law, given) for law in (jkr(1e-12), contactlab.create("normal.hertz"))
    )
    for entry in ("duration", "maximum_radius", "maximum_approach", "maximum_force"):
        assert getattr(one, entry) == pytest.approx(getattr(other, entry), rel=3e-6), entry


def test_friction_is_taken_of_load_and_adhesion():
    """JKR: P + 2 P_c; DMT: P + P_c, which is Hertz's. Never negative."""
    given = scene()
    radius = given.pair.radius
    for name, pull in (("jkr", 2.0 * 1.5), ("dmt", 2.0)):
        law = contactlab.create(f"normal.{name}", work_of_adhesion=GAMMA)
        state = law.start(given)
        for z in (0.0, 1e-9, 1e-7, 1e-5):
            contact = law.respond(state, z, 0.1)[0]
            assert contact.friction_load - contact.force == pytest.approx(
                pull * np.pi * GAMMA * radius, rel=1e-9
            )
            assert contact.friction_load >= 0.0


@pytest.mark.parametrize("speed", [1e-3, 0.1, 10.0])
def test_dmt_loses_nothing(speed):
    """Force and contact are the same forth and back; the bodies fall into contact faster."""
    law, given = contactlab.create("normal.dmt", work_of_adhesion=GAMMA), scene(speed)
    state, pair = law.start(given), given.pair
    assert restitution(law, given) == pytest.approx(1.0, abs=1e-8)
    deepest = brentq(
        lambda depth: quad(
            lambda z: law.respond(state, z, 0.0)[0].force, 0.0, depth, epsabs=0.0, epsrel=1e-11
        )[0] / (0.5 * pair.normal_mass * speed**2) - 1.0, 1e-9, 1e-3, xtol=1e-16, rtol=1e-12,
    )  # fmt: skip
    assert normal_motion(law, given).maximum_approach == pytest.approx(deepest, rel=1e-6)


def test_tabor_says_which_theory():
    """Steel balls are too stiff for DMT at millimetres; soft small ones are JKR's."""
    jkr_plan = Simulation(normal=jkr(1e-4), tangential="springs").plan(scene())
    dmt = contactlab.create("normal.dmt", work_of_adhesion=1.0)
    dmt_plan = Simulation(normal=dmt, tangential="springs").plan(scene())
    assert any("Tabor" in str(said) and "normal.dmt" in str(said) for said in jkr_plan.cautions)
    assert any("Tabor" in str(said) and "normal.jkr" in str(said) for said in dmt_plan.cautions)
    assert "Tabor" not in str(Simulation(normal=jkr(1.0), tangential="springs").plan(scene()))


def test_a_history_ends_where_jkrs_contact_breaks():
    """The pull ends at negative approach, later than the last step's force is sampled."""
    given = scene(0.3)
    result = Simulation(normal=jkr(2.0), tangential="springs").run(given, history=True).check()
    history = result.history
    assert (np.diff(history.time) > 0.0).all()
    assert history.time[-1] == pytest.approx(result.motion.duration, rel=1e-12)
    assert history.approach[-1] == pytest.approx(least_approach(given, 2.0), rel=1e-6)
    assert history.normal_velocity[-1] == pytest.approx(result.rebound_normal_velocity, rel=1e-9)
    again = load_path(given, history.approach, 0.0 * history.time, normal=jkr(2.0),
                      time=history.time)  # fmt: skip
    largest = history.normal_force.max()
    np.testing.assert_allclose(again.normal_force[:-1], history.normal_force[:-1], rtol=0.0,
                               atol=1e-5 * largest)  # fmt: skip


def test_bad_options_are_refused_by_name():
    for name in ("jkr", "dmt"):
        with pytest.raises(ValueError, match=r"work_of_adhesion = -0.1.*J/m"):
            contactlab.create(f"normal.{name}", work_of_adhesion=-0.1)
