"""Declared and estimated numerical errors against true ones, over 5,100 runs of a fixed seed.

``error_figures.json`` beside this file holds what was measured before the estimate was mended and
after, and the simple rules that were tried for declared errors. The true error is the distance
from the exact solution; of laws that do not converge to it, from the same law at many steps.
"""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from tests.laws.outside_laws import RescaledSpring
from tests.solve.error_scenes import groups, numbers

#: Law, integrator, and how many of the 6,000 scenes: 5,100 runs in all.
METHODS = (
    ("springs", "symplectic", 900),
    ("springs", "paper", 750),
    ("springs", "adaptive", 150),
    ("annulus", "symplectic", 300),
    ("annulus", "paper", 300),
    ("mindlin_cap", "symplectic", 900),
    ("linear_spring", "symplectic", 900),
    ("rescaled", "symplectic", 900),
)
CONTINUUM = ("springs", "annulus")
#: Steps of a law whose limit is not the exact solution.
LIMIT = 51_200
#: Below this over max(1, psi1) errors are rounding.
ROUNDING = 1e-9


def simulation(name, integrator, steps, parts):
    if name == "rescaled":
        law = RescaledSpring()
    else:
        word = {"springs": "springs"}.get(name, "annuli")
        options = {word: parts} if name in CONTINUUM else {}
        law = contactlab.create(f"tangential.{name}", **options)
    option = {"tolerance": 3.0 / steps**2} if integrator == "adaptive" else {"steps": steps}
    return Simulation(
        tangential=law, integrator=contactlab.create(f"integrator.{integrator}", **option)
    )


def true_limit(name, count):
    """Return psi2 in the limit of the law, of the first ``count`` scenes."""
    psi1, chi = numbers(count)
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    if name in CONTINUUM:
        return Simulation().run(scene).check().psi2
    return simulation(name, "symplectic", LIMIT, 1).run(scene).check().psi2


def measured(name, integrator, count):
    """Return true, estimated and declared errors of the first ``count`` scenes."""
    limit, errors = true_limit(name, count), np.empty((3, count))
    for group in groups(count):
        laws = simulation(name, integrator, group.steps, group.parts)
        result = laws.run(group.scene, estimate_error=True).check()
        true = np.abs(result.psi2 - limit[group.index])
        for row, error in enumerate((true, result.psi2_error_estimate, result.plan.psi2_error)):
            errors[row, group.index] = error
    return np.maximum(errors, ROUNDING * np.maximum(1.0, numbers(count)[0]))


def figures(name, integrator, count):
    """Return the figures of a method: shares, counts, and medians of ratios to the true error."""
    true, estimated, declared = measured(name, integrator, count)
    ratio = estimated / true
    assert np.isfinite(ratio).all()
    return {
        "runs": count,
        "estimate within a factor of three": float(np.mean(np.abs(np.log(ratio)) < np.log(3.0))),
        "estimate over ten times too small": int(np.sum(ratio < 0.1)),
        "estimate over true error, median": float(np.median(ratio)),
        "declared below true error": int(np.sum(declared < true)),
        "declared over true error, median": float(np.median(declared / true)),
    }


def whole(of_methods):
    """Return the figures of all runs together."""
    runs = [each["runs"] for each in of_methods]
    share = [each["estimate within a factor of three"] for each in of_methods]
    small = [each["estimate over ten times too small"] for each in of_methods]
    return sum(runs), float(np.average(share, weights=runs)), sum(small)


@pytest.mark.slow
def test_estimates_of_5100_runs():
    """Within a factor of three of the true error in 96 % by law, ten times too small in none."""
    found = {f"{name}, {march}": figures(name, march, count) for name, march, count in METHODS}
    runs, share, small = whole(found.values())
    assert runs == 5100
    assert small == 0, found
    assert share >= 0.96, found
    assert min(each["estimate within a factor of three"] for each in found.values()) >= 0.955, found


@pytest.mark.slow
def test_the_tolerance_of_the_adaptive_integrator_is_no_bound():
    """Of 6,000 impacts of a linear spring 141 are off by more than twice 1e-5, at most by 22e-5."""
    psi1, chi = numbers()
    adaptive = contactlab.create("integrator.adaptive", tolerance=1e-5)
    result = Simulation(tangential="linear_spring", integrator=adaptive).run(
        Scene.nondimensional(psi1=psi1, chi=chi)
    )
    off = np.abs(result.check().psi2 - true_limit("linear_spring", psi1.size))
    share = off / (1e-5 * np.maximum(1.0, psi1))
    assert np.sum(share > 2.0) == pytest.approx(141, abs=5)
    assert share.max() == pytest.approx(21.5, abs=0.5)
    assert np.isnan(result.plan.psi2_error[result.plan.marched]).all()


def test_estimates_of_120_runs():
    """A part of the set; laws without an exact limit and annuli take longer."""
    found = figures("springs", "symplectic", 120)
    assert found["estimate within a factor of three"] >= 0.96
    assert found["estimate over ten times too small"] == 0
    assert 0.9 < found["estimate over true error, median"] < 1.2


def test_the_set_is_what_it_says():
    psi1 = np.concatenate([group.scene.psi1 for group in groups()])
    chi = np.concatenate([group.scene.chi for group in groups()])
    assert psi1.size == 6000
    assert sum(count for *_, count in METHODS) == 5100
    assert psi1.min() < 0.0011
    assert ((chi > 0.25) & (chi < 0.75)).mean() > 0.3
    springs = Simulation(tangential="springs")
    assert not any(springs.plan(group.scene).left_out[1:] for group in groups(240))
