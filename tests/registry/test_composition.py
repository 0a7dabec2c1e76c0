"""Which laws compose, and what the plan says of them."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Scene, Simulation, Sphere
from contactlab.contracts import (
    TangentialLaw,
)
from tests.laws.normal_laws import LinearSpring, in_si
from tests.laws.outside_laws import Tsuji
from tests.runs.test_simulation import CHI, RIGID, STEEL, Misbehaving, scene
from tests.testing.broken_laws import Sound


@attrs.frozen(kw_only=True)
class NeedsRadius(Misbehaving):
    """Needs what a spring does not offer."""

    needs: ClassVar[frozenset] = frozenset({"hertzian_pressure"})


@attrs.frozen(kw_only=True)
class Nameless(TangentialLaw):
    """A tangential law that says in no way how it is to be run."""

    api_version: ClassVar[int] = 2


def test_names_and_objects_compose_alike():
    by_name = Simulation(normal="hertz", tangential="coulomb", integrator="paper")
    by_object = Simulation(
        normal=contactlab.create("normal.hertz"),
        tangential=contactlab.create("tangential.coulomb"),
        integrator=contactlab.create("integrator.paper"),
    )
    assert by_name == by_object
    assert by_name.run(scene()).psi2 == by_object.run(scene()).psi2


def test_wrong_kind_of_law_is_refused():
    with pytest.raises(ValueError, match=r"normal = .*must be a name or a normal law"):
        Simulation(normal=contactlab.create("tangential.coulomb"))
    with pytest.raises(ValueError, match="tangential"):
        Simulation(tangential=3.0)


@pytest.mark.parametrize("version", [1, 3, "2", None])
def test_a_law_of_another_version_of_the_contracts_is_refused(version):
    law = type("Other", (Sound,), {"api_version": version})()
    words = f"Other.api_version is {version!r}, contactlab has 2; .* write api_version: ClassVar"
    with pytest.raises(ValueError, match=words):
        Simulation(tangential=law)


def test_what_is_left_out_is_the_best_that_fits():
    assert Simulation() == Simulation(normal="hertz", tangential="fronts", integrator="events")
    assert Simulation(tangential="annulus").integrator == contactlab.create("integrator.symplectic")
    assert Simulation(integrator="adaptive").tangential == contactlab.create("tangential.springs")
    with_radius, without = Simulation(normal=Tsuji()), Simulation(normal=LinearSpring())
    assert with_radius.tangential == contactlab.create("tangential.annulus")
    assert without.tangential == contactlab.create("tangential.coulomb")
    assert with_radius.run(scene()).check().normal_restitution < 1.0
    assert without.run(in_si(scene())).check().psi2 == 0.0


def test_laws_that_do_not_fit_are_refused_naming_both_and_what_would_fit():
    with pytest.raises(
        ValueError, match=r"NeedsRadius.*Hertz's pressure.*LinearSpring.*normal = hertz"
    ):
        Simulation(normal=LinearSpring(), tangential=NeedsRadius(), integrator="symplectic")
    with pytest.raises(ValueError, match=r"Nameless: must be derived from .*SteppedTangentialLaw"):
        Simulation(normal="hertz", tangential=Nameless(), integrator="symplectic")
    with pytest.raises(ValueError, match=r"events: runs laws of events, and annulus is not one"):
        Simulation(tangential="annulus", integrator="events")


def test_plan_says_what_is_left_out_and_why():
    sim = Simulation(tangential="springs", integrator="symplectic")
    assert "central impact" in str(sim.plan(scene(0.0)))
    assert "slips from start to end" in str(sim.plan(scene(7.0)))
    assert "history (not requested)" in str(sim.plan(scene()))
    assert "history" not in str(sim.plan(scene(), history="fields"))
    rigid = Simulation(**RIGID)
    for psi1 in (0.0, 1.2, 7.0):
        assert "no steps to take them from" in str(rigid.plan(scene(psi1), history="fields"))
    assert "rigid bodies: slip until it stops" in str(rigid.plan(scene()))
    assert "central impact" in str(rigid.plan(scene(0.0)))
    assert "makes no force" in str(
        Simulation(tangential="frictionless", integrator="paper").plan(scene())
    )


@pytest.mark.parametrize(("law", "digits"), [("coulomb", 1e-15), ("springs", 1e-14)])
def test_plan_says_of_a_batch_what_is_done(law, digits):
    """Of several dimensions, and with a history, which has one time axis for all."""
    psi1 = np.array([[0.0, 1.0], [3.0, 9.0]])
    batch = Scene.nondimensional(psi1=psi1, chi=CHI)
    sim = Simulation(tangential=law, integrator="symplectic")
    marches = law == "springs"
    result = sim.run(batch)
    assert result.plan.marched.tolist() == [[False, marches], [marches, False]]
    assert ("(2 of 4 impacts)" in str(result.plan)) is marches
    alone = [[sim.run(scene(value)).psi2 for value in row] for row in psi1.tolist()]
    assert result.psi2 == pytest.approx(np.array(alone), abs=digits)
    watched = sim.run(batch, history=True)
    assert watched.plan.marched.all() == watched.plan.marched.any() == marches
    assert ("stepping through" in " ".join(map(str, watched.plan.left_out))) is not marches
    assert watched.psi2.ravel()[:3] == pytest.approx(np.ravel(alone)[:3], abs=1e-12)
    assert watched.psi2[1, 1] == pytest.approx(alone[1][1], abs=1e-4 if marches else 1e-12)
    sliding = sim.run(Scene.nondimensional(psi1=[6.0, 9.0], chi=CHI), history=True).check()
    assert not sliding.plan.marched.any()
    history = sliding.history
    assert history.tangential_force == pytest.approx(history.normal_force)
    assert history.slip_velocity[-1] == pytest.approx(sliding.psi2)


@pytest.mark.parametrize("normal", ["hertz", LinearSpring()])
def test_a_law_without_force_is_never_marched(normal):
    left_out = Simulation(normal=normal, tangential="frictionless", integrator="symplectic").plan(
        in_si(scene())
    )
    assert "makes no force" in str(left_out)
    assert not left_out.marched


def test_a_word_that_only_a_closed_form_may_offer():
    @attrs.frozen(kw_only=True)
    class Boasting(LinearSpring):
        offers: ClassVar[frozenset] = frozenset({"elastic_hertz"})

    with pytest.raises(ValueError, match="ClosedFormNormalLaw"):
        Simulation(normal=Boasting(), tangential="coulomb", integrator="symplectic")


def test_plan_warns_where_hertz_is_doubtful():
    fast = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1e4, 1.0)
    assert "large contact" in str(Simulation(**RIGID).plan(fast))
    slow = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 0.01, 1.0)
    assert "large contact" not in str(Simulation(**RIGID).plan(slow))
    assert not Simulation(tangential="springs").plan(slow).cautions
