"""Ladders of resolutions and scenes of the benchmark, written out."""

import numpy as np
import pytest

from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.study.bench_methods import ELSEWHERE, NONDIMENSIONAL, Method, methods, scenes

TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
PARTS = (2, 3, 4, 8, 12, 25, 50, 100)
STEPS = (25, 50, 100, 200, 400)


def ladder(method, *, quick=False):
    """The options of each rung, of law and integrator together."""
    rungs = Method(tangential=method[0], integrator=method[1]).resolutions(quick=quick)
    assert all(set(rung) == {"tangential", "integrator"} for rung in rungs)
    return [rung["tangential"] | rung["integrator"] for rung in rungs]


@pytest.mark.parametrize(
    ("law", "integrator", "full", "quick"),
    [
        # Steps alone.
        ("linear_spring", "symplectic", [{"steps": n} for n in STEPS], [0, 2, 4]),
        # Parts, and ten steps a part as in the paper's defaults; at least 25.
        (
            "annulus", "paper",
            [{"annuli": n, "steps": s} for n, s in zip(
                PARTS, (25, 30, 40, 80, 120, 250, 500, 1000), strict=True)],
            [3, 5, 6],
        ),
        # Four steps a part: the defaults are 200 and 50.
        (
            "springs", "symplectic",
            [{"springs": n, "steps": s} for n, s in zip(
                PARTS, (25, 25, 25, 32, 48, 100, 200, 400), strict=True)],
            [3, 5, 6],
        ),
        # A tolerance alone, which the exact method accepts up to 1e-3; all are quick.
        ("fronts", "events", [{"tolerance": value} for value in TOLERANCES[2:]], [0, 1, 2]),
        ("linear_spring", "adaptive", [{"tolerance": value} for value in TOLERANCES], [0, 1, 2]),
        # Under a tolerance the parts are a quarter of its inverse root; at least ten.
        (
            "springs", "adaptive",
            [{"springs": n, "tolerance": t} for n, t in zip(
                (10, 10, 10, 25, 250, 2500, 25000), TOLERANCES, strict=True)],
            [0, 1, 2],
        ),
        # Whole impacts: an even number of rings, at most 96, without steps; or no resolution.
        ("halfspace", "symplectic", [{"rings": n} for n in (4, 8, 12, 50)], [1, 3]),
        ("walton", "symplectic", [{}], [0]),
    ],
)  # fmt: skip
def test_a_ladder_goes_from_coarse_to_fine(law, integrator, full, quick):
    assert ladder((law, integrator)) == full
    assert ladder((law, integrator), quick=True) == [full[place] for place in quick]


def test_a_method_is_named_by_what_is_chosen():
    assert Method(tangential="springs", integrator="paper").name == "springs / paper"
    assert Method(tangential="walton", integrator="paper").name == "walton"
    damped = Method(tangential="springs", integrator="paper", normal="tsuji")
    assert damped.name == "springs / paper, tsuji"


def test_a_simulation_has_the_laws_and_options_of_its_method():
    method = Method(tangential="springs", integrator="paper", normal="thornton")
    options = {"tangential": {"springs": 7}, "integrator": {"steps": 31}}
    found = method.simulation(options)
    assert (found.tangential.springs, found.integrator.steps) == (7, 31)
    assert type(found.normal) is REGISTRY.law_class("normal.thornton")
    other = method.simulation(options, normal="jkr")
    assert type(other.normal) is REGISTRY.law_class("normal.jkr")
    assert type(other.integrator) is REGISTRY.law_class("integrator.paper")


@pytest.mark.parametrize(
    ("options", "pairs"),
    [
        ({}, NONDIMENSIONAL),
        ({"quick": True}, ((0.5, 49 / 34), (1.2, 49 / 34), (3.0, 49 / 34))),
        ({"elsewhere": True}, ELSEWHERE),
        ({"elsewhere": True, "quick": True}, ((1.2, 3.0),)),
        ({"sized": True, "quick": True}, ((0.5, 49 / 34), (1.2, 49 / 34), (3.0, 49 / 34))),
    ],
)
def test_scenes_are_those_of_the_pairs_and_a_steel_ball(options, pairs):
    found = scenes(**options)
    if "elsewhere" not in options:
        *found, steel = found
        assert (steel.sphere.radius, steel.sphere.material.density) == (6.35e-3, 7850.0)
        assert steel.sphere.material.young_modulus == steel.target.material.young_modulus == 208e9
        assert steel.sphere.material.poisson_ratio == 0.3
        assert (steel.friction_coefficient, steel.normal_speed) == (0.15, 1.93)
        assert (steel.tangential_velocity, steel.spin) == (0.9, -40.0)
    numbers = [(float(scene.psi1), float(scene.chi)) for scene in found]
    np.testing.assert_allclose(numbers, pairs, rtol=1e-12)


def test_every_regime_but_slip_throughout_is_on_three_inertias():
    """20 scenes of solid spheres with chi from 1.17 to 1.75, 7 of a shell and a dense core."""
    assert len(NONDIMENSIONAL) == 20
    assert sorted({chi for _, chi in NONDIMENSIONAL}) == [1.17, 49 / 34, 1.75]
    assert len(ELSEWHERE) == 7
    assert {chi for _, chi in ELSEWHERE} == {0.83, 3.0}
    for psi1, chi in (*NONDIMENSIONAL, *ELSEWHERE):
        assert 0.0 < psi1 < max(1.0, 4.0 * chi - 1.0)


def test_laws_are_taken_by_their_kinds():
    def names(*laws):
        return [method.name for method in methods(laws)]

    assert names("coulomb", "springs", "integrator.paper") == ["coulomb", "springs / paper"]
    assert names("frictionless") == ["frictionless"]
    assert names("normal.jkr", "springs", "integrator.paper") == ["springs / paper, jkr"]
    # Every stepped law, and no law that needs no integrator, for an integrator alone.
    assert set(names("integrator.events")) == {"fronts / events"}
    assert {name.partition(" / ")[2] for name in names("integrator.paper")} == {"paper"}
    assert {"coulomb", "walton", "stronge"}.isdisjoint(names("integrator.paper"))


@pytest.mark.parametrize(
    ("laws", "words"),
    [
        (["fronts", "paper"], "'tangential.paper'"),
        (["fronts", "integrator.paper"], "--law fronts: does not fit paper under normal.hertz"),
        (
            ["fronts", "integrator.paper", "integrator.adaptive"],
            "--law fronts: does not fit paper, adaptive under normal.hertz",
        ),
        (
            ["fronts", "normal.jkr"],
            "--law fronts: fits no installed integrator under normal.jkr",
        ),
        (
            ["normal.jkr", "integrator.events"],
            "--law jkr, events: no installed tangential law fits",
        ),
    ],
)
def test_laws_that_fit_no_other_are_refused(laws, words):
    with pytest.raises(ValueError, match=words):
        methods(laws)


def test_a_broken_law_is_left_out_unless_a_law_is_named(monkeypatch):
    """Its module cannot be imported."""
    law_class = type(REGISTRY).law_class

    def broken(self, name):
        if name == "tangential.springs":
            raise PluginError("tangential.springs: broken")
        return law_class(self, name)

    monkeypatch.setattr(type(REGISTRY), "law_class", broken)
    names = [method.name for method in methods()]
    assert "coulomb" in names
    assert not any("springs" in name for name in names)
    for named in (["springs"], ["integrator.paper"]):
        with pytest.raises(PluginError, match="broken"):
            methods(named)
