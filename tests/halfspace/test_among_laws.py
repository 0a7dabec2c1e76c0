"""The half-space beside other laws, whose referee it is, and where rooms ask what laws can."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, create
from contactlab.registry.registry import REGISTRY
from contactlab.study.model_error import model_error
from contactlab.study.stability_references import reference_for
from tests.laws.normal_laws import in_si
from tests.laws.test_adhesion import jkr
from tests.laws.test_differences import size
from tests.solve.any_scene import coupled_way
from tests.solve.test_clay import SPHERE, clay
from tests.solve.test_declared import assert_declared_alike
from tests.solve.test_registration import assert_waived
from tests.solve.test_ways import follow_all

CHI = 49.0 / 34.0


@pytest.mark.slow
def test_the_books_contain_the_energy_of_the_shear_that_is_lost_as_jkr_breaks():
    """That energy is 0.046 of the energy at the start, beside psi2 of the half-space."""
    scene = in_si(Scene.nondimensional(psi1=1.2, chi=3.0))
    truth = Simulation(normal=jkr(0.05), tangential="halfspace").run(scene).check()
    for name in ("symplectic", "paper", "adaptive"):
        result = Simulation(normal=jkr(0.05), tangential="springs", integrator=name).run(scene)
        assert result.check().energy.relative_imbalance == pytest.approx(0.0, abs=2e-3)
        assert result.energy.friction_work == pytest.approx(truth.energy.friction_work, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tsuji", "hunt_crossley", "kuwabara_kono"])
def test_the_size_bounds_the_error_of_springs_at_random(name):
    """Against tractions that are Coulomb's at every point, by the half-space law."""
    rng = np.random.default_rng(31)
    for e in rng.uniform(0.12, 0.97, 3):
        chi = np.exp(rng.uniform(np.log(0.06), np.log(9.5), 8))
        psi1 = rng.uniform(0.03, 1.0, 8) * (2.0 * chi * (1.0 + e) + 1.0)
        law = create(f"normal.{name}", restitution=float(e))
        scene = Scene.nondimensional(psi1=psi1, chi=chi, poisson_ratio=0.0)
        fine = Simulation(
            normal=law, tangential=create("tangential.springs", springs=120, shear_loss=0.0),
            integrator=create("integrator.symplectic", steps=480),
        ).run(scene)  # fmt: skip
        exact = Simulation(normal=law, tangential="halfspace").run(scene)
        for off, one, ratio in zip(np.abs(fine.psi2 - exact.psi2), psi1, chi, strict=True):
            assert off <= max(size(float(one), float(ratio), name, float(e)), 3e-3)


@pytest.mark.slow
def test_what_more_rings_change_is_no_error_of_the_model():
    """The half-space without coupling has the continuum's limit, to the error of its rings."""
    assert model_error("halfspace", (CHI, 100.0), (1.2,)) is None


def test_a_law_of_whole_impacts_is_judged_under_the_same_normal_law():
    """By itself at twice its resolution: under a damped law, not under the default one."""
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    law, twice = (contactlab.create("tangential.halfspace", rings=n) for n in (8, 16))
    for normal in (contactlab.create("normal.tsuji", restitution=0.7), None):
        laws = {} if normal is None else {"normal": normal}
        own = Simulation(tangential=twice, **laws)
        found = reference_for(law, own.normal)(scene, law)
        assert found == float(own.run(scene).check().motion.slip_velocity_change)


def test_half_space_needs_elastic_surfaces_for_two_way_coupling_only():
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    options = {"rings": 8, "extrapolate": False}
    halfspace = REGISTRY.law_class("tangential.halfspace")
    one = Simulation(normal="tsuji", tangential=halfspace(**options), integrator="symplectic")
    assert one.plan(scene)
    with pytest.raises(ValueError, match="needs elastic Hertz contact"):
        Simulation(normal="tsuji", tangential=halfspace(coupling="two_way", **options))


@pytest.mark.parametrize(
    ("options", "waived"),
    [({"coupling": "two_way"}, {"normal_spin"}),
     ({"coupling": "none", "angles": 8}, {"elastic_hertz"})],
)  # fmt: skip
def test_its_options_take_words_away(options, waived):
    assert_waived("tangential.halfspace", options, waived)


@pytest.mark.slow
def test_as_much_is_declared_for_either_sense_of_slip():
    assert_declared_alike({"tangential": "halfspace"})


@coupled_way
@pytest.mark.slow
def test_its_remedies_where_friction_changes_the_approach_work(scene):
    follow_all(scene, {"tangential": "halfspace"})


@pytest.mark.parametrize("e", [0, 0.004])
def test_a_restitution_that_no_march_follows_is_refused(e):
    with pytest.raises(ValueError, match=rf"restitution = {e}.*0.01.*under halfspace"):
        clay(e, tangential="halfspace").run(SPHERE)
