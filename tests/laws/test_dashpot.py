"""Linear and Tsuji's dashpots against integration, the formula of the literature, and psi2."""

import numpy as np
import pytest

import contactlab
from contactlab import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab_laws.dashpot.oscillator import damping_of
from tests.laws.by_hand import rebound
from tests.laws.normal_impacts import psi2, scene
from tests.longer import longer

POWERS = {"linear": (1.0, 0.0), "tsuji": (1.5, 0.25)}
#: psi2 under Tsuji's law by springs, which above psi1 = 1 are not Coulomb's law, converged to 5e-7:
#: chi 1.4412 and 1.
PSI2 = {
    (1.4412, 0.95): {0.1: 0.019465, 0.5: 0.030988, 1: -0.107381, 2: -0.853004, 4: -1.363620},
    (1.4412, 0.8): {0.1: 0.012505, 0.5: -0.037273, 1: -0.269058, 2: -0.914894, 4: -1.092294},
    (1.4412, 0.5): {0.1: -0.021090, 0.5: -0.241537, 1: -0.639847, 2: -1.031719, 4: -0.209369},
    (1.0, 0.95): {2: -1.270214},
    (1.0, 0.8): {2: -1.174316},
    (1.0, 0.5): {2: -0.752322},
}


def schwager_poeschel(beta):
    """E of a linear dashpot that does not pull, as printed: two branches below critical damping."""
    w = np.sqrt(1.0 - beta**2)
    if beta < np.sqrt(0.5):
        return np.exp(-(beta / w) * (np.pi - np.arctan(2 * beta * w / (1 - 2 * beta**2))))
    return np.exp(-(beta / w) * np.arctan(-2 * beta * w / (1 - 2 * beta**2)))


@pytest.mark.parametrize("e", [0.05, 0.1, np.exp(-2.0), 0.2, 0.5, 0.9, 0.99, 1.0])
@pytest.mark.parametrize("name", POWERS)
def test_calibrated_restitution_by_integration(name, e):
    """Below exp(-2) the damping is more than critical."""
    beta, (n, m) = damping_of(float(e)), POWERS[name]

    def force(z, rate):
        inside = max(z, 0.0)
        return inside**n + 2.0 * beta * (0.5 * (n + 1.0)) ** 0.5 * inside**m * rate

    assert rebound(force) == pytest.approx(e, abs=1e-8)
    law = contactlab.create(f"normal.{name}", restitution=e)
    for speed in (1e-3, 1.0, 30.0):
        motion = normal_motion(law, scene(speed))
        assert -motion.final_rate / speed == pytest.approx(e, rel=1e-12)


@pytest.mark.parametrize("beta", [1e-3, 0.1, 0.5, 0.7, 0.72, 0.95])
def test_damping_is_that_of_the_literature(beta):
    assert damping_of(float(schwager_poeschel(beta))) == pytest.approx(beta, rel=1e-10)


@pytest.mark.parametrize("e", [0.05, 0.5, 1.0, *longer(0.135, 0.9, 0.9999)])
@pytest.mark.parametrize("name", POWERS)
def test_closed_form_is_what_respond_gives(name, e):
    """Everything that a motion says, against the solver of any normal law."""
    from contactlab.testing.normal_motions import _Stepwise

    law = contactlab.create(f"normal.{name}", restitution=e)
    given = scene()
    closed, solved = normal_motion(law, given), normal_motion(_Stepwise(law), given)
    for entry in ("duration", "final_rate", "total_load_impulse"):
        assert getattr(closed, entry) == pytest.approx(getattr(solved, entry), rel=1e-9), entry
    for entry in ("maximum_approach", "maximum_radius", "maximum_force"):
        assert getattr(closed, entry) == pytest.approx(getattr(solved, entry), rel=1e-8), entry
    shares = np.linspace(0.05, 0.95, 19)
    one, other = closed.at(closed.phase(shares)), solved.at(solved.phase(shares))
    for entry, bound in (
        ("time", 1e-9 * closed.duration), ("approach", 1e-9 * closed.maximum_approach),
        ("rate", 1e-9), ("load_impulse", 2e-8 * closed.total_load_impulse),
    ):  # fmt: skip
        assert getattr(one, entry) == pytest.approx(getattr(other, entry), abs=bound), entry
    assert one.contact.force == pytest.approx(other.contact.force, abs=1e-9 * closed.maximum_force)


def test_a_batch_and_a_part_of_it_move_as_each_alone():
    given = scene(np.array([0.1, 1.0, 7.0]))
    for name in POWERS:
        law = contactlab.create(f"normal.{name}", restitution=0.7)
        batch, alone = normal_motion(law, given), normal_motion(law, given.take(1))
        part = batch.take(np.array([1, 2]))
        for entry in ("duration", "maximum_force", "final_rate"):
            value = getattr(alone, entry)
            assert getattr(batch, entry)[1] == pytest.approx(value, rel=1e-14)
            assert getattr(part, entry)[0] == pytest.approx(value, rel=1e-14)


def test_undamped_tsuji_is_hertz():
    """Except for the word: its psi2 is not said to be that of the slip front."""
    sims = [
        Simulation(normal=normal, tangential="springs")
        for normal in ("hertz", contactlab.create("normal.tsuji", restitution=1.0))
    ]
    found = [sim.run(scene()).check().psi2 for sim in sims]
    assert found[0] == found[1]
    assert "elastic_hertz" not in sims[1].normal.offers


@pytest.mark.parametrize(("chi", "e"), PSI2)
def test_psi2_over_tsuji(chi, e):
    """200 springs and 800 steps: 7e-6; the references are printed to 5e-7."""
    psi1, expected = zip(*PSI2[chi, e].items(), strict=True)
    law = contactlab.create("normal.tsuji", restitution=e)
    assert psi2(law, psi1, chi) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(("e", "bound"), [(0.9, 1.5e-5), (0.8, 2e-4), (0.5, 0.03)])
def test_gross_slip_over_tsuji_is_reached_asymptotically(e, bound):
    """Each impact begins stuck: psi1 - 2chi(1+e) + 4 chi beta²/(psi1 - 1), theory §11."""
    chi, beta = 49 / 34, damping_of(e)
    slid = 2.0 * chi * (1.0 + e)
    psi1 = np.array([slid + 0.1, slid + 2.0, 20.0])
    law = contactlab.create("normal.tsuji", restitution=e)
    expected = psi1 - slid + 4.0 * chi * beta**2 / (psi1 - 1.0)
    off = psi2(law, psi1, chi) - expected
    assert np.abs(off).max() < bound
    assert np.abs(psi2(law, psi1, chi) - (psi1 - slid)).min() > 3.0 * abs(off[-1])


@pytest.mark.parametrize("name", POWERS)
def test_bad_options_are_refused_by_name(name):
    for wrong in (0.0, 1.01, -0.5, np.nan, "high", None, [0.5, 0.6]):
        with pytest.raises(ValueError, match=r"restitution = .*must"):
            contactlab.create(f"normal.{name}", restitution=wrong)
    with pytest.raises(ValueError, match=r"stiffness = -1.0.*N/m"):
        contactlab.create("normal.linear", stiffness=-1.0)


def test_linear_stiffness_sets_the_duration():
    law = contactlab.create("normal.linear", restitution=1.0, stiffness=1e5)
    motion = normal_motion(law, scene())
    mass = motion.scene.pair.normal_mass
    assert motion.duration == pytest.approx(np.pi * (mass / 1e5) ** 0.5, rel=1e-12)
