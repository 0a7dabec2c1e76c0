"""Every installed law keeps its contract, or says which part it does not keep, and why."""

import pytest

from contactlab.registry.registry import REGISTRY
from contactlab.testing import parametrize_with_checks

#: Smaller than the defaults, for speed; as fine as the checks' tolerances need.
OPTIONS = {
    "tangential.annulus": {"annuli": 40},
    "tangential.springs": {"springs": 30},
    "tangential.halfspace": {"rings": 16, "angles": 1},
}
#: Laws that an option makes another law.
FORMS = [
    ("tangential.annulus", {"annuli": 40, "displacement": "mean"}),
    ("tangential.linear_spring", {"damping": 0.3}),
    ("tangential.springs", {"springs": 100, "grid": "doubling"}),
    ("tangential.mindlin_cap", {"stiffness_factor": 2.0 / 3.0, "damping": 0.2}),
    ("tangential.mindlin_cap", {"form": "displacement_rescaled"}),
    ("tangential.mindlin_cap", {"form": "increment"}),
    ("tangential.mindlin_cap", {"form": "increment_rescaled"}),
    ("normal.linear", {"restitution": 0.1, "stiffness": 1e7}),
    ("normal.tsuji", {"restitution": 0.1}),
    ("normal.hunt_crossley", {"damping": 0.2}),
    ("normal.kuwabara_kono", {"relaxation_time": 1e-6}),
    ("normal.walton_braun", {"restitution": 0.3, "stiffness": 1e7}),
    ("normal.thornton", {"yield_pressure": 1e9}),
    ("normal.jkr", {"work_of_adhesion": 20.0}),
    ("normal.dmt", {"work_of_adhesion": 20.0}),
]
CHOSEN = [(name, OPTIONS.get(name, {})) for name in REGISTRY.names()] + FORMS
LAWS = [REGISTRY.create(name, **options) for name, options in CHOSEN]
#: Laws whose checks take longer than a few seconds, and other forms of laws that are checked.
FORMED = LAWS[-len(FORMS) :]
HEAVY = [law for law in LAWS if type(law).__name__ == "HalfSpace"] + FORMED
CLAIMING = [law for law in LAWS if "partial_slip" in law.offers]
#: Costly checks of each law that a sibling of the law passes in the default suite.
LONGER = {
    "Annulus": "all_steps answers batch books closed_cycles friction_work impact_coulomb_limit "
    "impact_units load_impulse odd_in_slip partial_unloading random_paths sliding_impulse "
    "stiffness turning_points units whole_impact_form whole_impacts coulomb_at_a_point_damped "
    "two_stiffnesses coulomb_at_a_point coulomb_limit impact_odd pure",
    "Springs": "closed_cycles impact_batch impact_books impact_bounds impact_coulomb_limit "
    "impact_odd impact_units vectors_on_a_line vectors_rotate whole_impact_form whole_impacts",
    "LinearSpring": "impact_books impact_bounds impact_coulomb_limit impact_odd impact_units",
    "WaltonBraun": "motion_batch rebounds",
    "Viscoelastic": "ends_unloaded rebounds",
    "MindlinCap": "impact_odd impact_units vectors_on_a_line vectors_rotate whole_impact_form "
    "whole_impacts",
    "MindlinDeresiewicz": "batch begin_is_start books closed_cycles impact_batch impact_books "
    "impact_bounds impact_coulomb_limit impact_odd impact_reference impact_repeatable impact_units "
    "random_paths spin stiffness units unlike_bodies whole_impacts answers coulomb_at_a_point "
    "coulomb_at_a_point_damped friction_work impact_after_another impact_central odd_in_slip "
    "partial_unloading pure sliding_impulse two_stiffnesses whole_impact_form",
    "ThorntonYin": "begin_is_start impact_bounds impact_odd impact_units unlike_bodies",
    "Coulomb": "whole_impact_form",
    "Frictionless": "whole_impact_form",
    "PaperSteps": "books_by impact_batch impact_odd spin unlike_bodies",
    "Adaptive": "impact_batch impact_odd impact_repeatable spin unlike_bodies",
    "Tsuji": "ends_unloaded rebounds",
    "HuntCrossley": "ends_unloaded motion_batch rebounds",
    "KuwabaraKono": "ends_unloaded motion_batch rebounds",
    "Thornton": "ends_unloaded motion_batch rebounds",
    "JohnsonKendallRoberts": "ends_unloaded motion_batch rebounds",
    "DerjaguinMullerToporov": "dissipation ends_unloaded motion_batch rebounds",
}


def shortened(decorator):
    """Return a decorator of ``parametrize_with_checks`` with what is ``LONGER`` marked slow."""
    names, parameters = decorator.args
    marked = []
    for parameter in parameters:
        law, check = parameter.values
        longer = check.name in LONGER.get(type(law).__name__, "").split()
        marks = [*parameter.marks, *[pytest.mark.slow] * longer]
        marked.append(pytest.param(law, check, id=parameter.id, marks=marks))
    return pytest.mark.parametrize(names, marked)


@shortened(parametrize_with_checks([law for law in LAWS if law not in HEAVY]))
def test_conformance(law, check):
    check(law)


@pytest.mark.slow
@parametrize_with_checks(HEAVY)
def test_conformance_of_heavy_laws_and_of_forms(law, check):
    check(law)


@pytest.mark.parametrize("law", CLAIMING, ids=repr)
def test_a_law_that_claims_partial_slip_expects_to_fail_under_damping_at_most(law):
    assert set(law.expected_failures) <= {"coulomb_at_a_point_damped"}


def test_the_laws_of_partial_slip_claim_it():
    names = {type(law).__name__ for law in CLAIMING}
    assert names == {"Annulus", "Fronts", "MindlinDeresiewicz", "Springs"}
