"""The references of the stability report: who judges whom, and when an answer has settled."""

import attrs
import pytest

from contactlab import Scene, create
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.study import stability_references as references
from contactlab.study.stability_references import (
    itself,
    judging_laws,
    rigid,
)

UNIT = Scene.nondimensional(psi1=9.0, chi=1.0)  # the range is 4, the tangential mass 1/2


def names(classes):
    return [each.__name__ for each in dict.fromkeys(classes)]


def test_a_law_is_judged_by_others_with_its_limit_first():
    """Rings of annuli have Coulomb's law at a point; springs and sharp annuli another limit."""
    damped = create("normal.tsuji")
    for law, judges in {
        "springs": ["SharpAnnulus", "Annulus"],
        "sharp_annulus": ["Springs", "Annulus"],
        "annulus": ["Annulus", "Springs", "SharpAnnulus"],  # by itself: no other has its limit
        "fronts": ["Annulus", "Springs", "SharpAnnulus"],
    }.items():
        assert names(judging_laws(damped, create(f"tangential.{law}"))) == judges


def test_a_broken_law_judges_nobody(monkeypatch):
    create_any = type(REGISTRY).create

    def broken(self, name, **options):
        if name.endswith("sharp_annulus"):
            raise PluginError("broken")
        return create_any(self, name, **options)

    springs, damped = create("tangential.springs"), create("normal.tsuji")
    monkeypatch.setattr(type(REGISTRY), "create", broken)
    assert names(judging_laws(damped, springs)) == ["Springs", "Annulus"]


def test_the_impulse_of_the_load_is_that_of_the_normal_law():
    """Elastic: twice the momentum of 1. A linear dashpot without damping has the same."""
    hertz, linear = create("normal.hertz"), create("normal.linear", restitution=1.0)
    for law in (hertz, linear):
        assert references.load_impulse(UNIT, law) == pytest.approx(2.0, rel=1e-9)


def test_a_rigid_body_far_beyond_slip_keeps_its_digits():
    """At psi1 = 1e7 the change is 4 chi to all digits, though psi2 holds nine of them."""
    for sign in (1.0, -1.0):
        scene = Scene.nondimensional(psi1=sign * 1e7, chi=1 / 3)
        assert rigid(scene, None) == -sign * 4 / 3
    still = attrs.evolve(UNIT, tangential_velocity=0.0)
    assert rigid(still, None) == 0.0


def test_only_a_stepped_law_is_judged_by_itself():
    assert itself(UNIT, create("tangential.walton")) is None
