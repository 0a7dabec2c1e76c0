"""What each law declares and says in whole: answers in order, reasons, cautions, needs."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab.compose.registry import REGISTRY
from contactlab_laws.fronts.law import Fronts
from contactlab_laws.tables.elastic import ERROR

STEEL = Material.named("steel")
#: Reasons of answers to whole impacts.
CENTRAL, SMOOTH = "central impact, no slip velocity", "friction coefficient 0"
GROSS = "the impact slips from start to end, eq. (45)"
TABULATED = "psi2 is tabulated; a history, or a tolerance below 1e-9, follows the impact"
RIGID = "rigid bodies: slip until it stops, if it does, then rolling"
HARD = "hard spheres: the lesser of gross slip and a constant slip restitution"
SPRINGS = "two springs and a slider: sines and cosines between slip and stick"


def impact(slip=0.15, friction=0.3, target=STEEL):
    return Scene(Sphere(0.01, STEEL), HalfSpace(target), friction, 0.7, slip)


def reasons(law, scene, normal="hertz"):
    motion = Simulation(normal=normal).normal_motion(scene)
    return [answer.reason for answer in law.whole_impacts(scene, motion)]


@pytest.mark.parametrize(
    ("name", "slip", "expected"),
    [
        ("coulomb", 0.15, [RIGID]),
        ("coulomb", 0.0, [CENTRAL, RIGID]),
        ("coulomb", np.array([0.0, 0.15]), [CENTRAL, RIGID]),
        ("walton", 0.15, [HARD]),
        ("walton", 0.0, [CENTRAL, HARD]),
        ("stronge", 0.15, [SPRINGS]),
        ("stronge", 0.0, [CENTRAL, SPRINGS]),
        ("frictionless", 0.15, ["the law makes no force"]),
        ("springs", 0.15, []),
        ("springs", 9.0, [GROSS]),
        ("annulus", 0.0, [CENTRAL]),
        ("linear_spring", 9.0, []),
        ("fronts", 0.15, [TABULATED]),
        ("fronts", -0.15, [TABULATED]),
        ("fronts", 9.0, [GROSS]),
        ("fronts", 0.0, [CENTRAL, TABULATED]),
    ],
)
def test_answers_to_whole_impacts_and_their_order(name, slip, expected):
    assert reasons(create(f"tangential.{name}"), impact(slip)) == expected


@pytest.mark.parametrize("name", ["coulomb", "walton", "stronge", "frictionless", "springs"])
def test_closed_forms_have_no_error(name):
    scene = impact(np.array([0.0, 9.0]))
    motion = Simulation().normal_motion(scene)
    for answer in create(f"tangential.{name}").whole_impacts(scene, motion):
        assert np.all(answer.psi2_error == 0.0)


def test_without_friction_each_law_answers_in_closed_form():
    for name in ("coulomb", "springs", "annulus", "stronge", "mindlin_cap", "fronts"):
        assert SMOOTH in reasons(create(f"tangential.{name}"), impact(friction=0.0))


@pytest.mark.parametrize(
    ("psi1", "chi", "table", "where"),
    [
        ([0.3, 9.9, 10.0, 0.3, 0.3], [1.0, 2.5, 2.5, 2.5, 2.51], True, [1, 1, 0, 1, 0]),
        ([0.3, 2.0], [1.0, 1.0], False, None),
    ],
)
def test_where_the_table_of_fronts_answers(psi1, chi, table, where):
    """Up to chi = 2.5 and psi1 = 10; its error is 1e-9 of the larger of 1 and psi1."""
    scene = Scene.nondimensional(psi1=np.array(psi1), chi=np.array(chi))
    law = Fronts(table=table)
    answers = law.whole_impacts(scene, Simulation().normal_motion(scene))
    tabulated = [each for each in answers if each.reason == TABULATED]
    assert len(tabulated) == (where is not None)
    if where is not None:
        assert tabulated[0].where.tolist() == [bool(each) for each in where]
        assert tabulated[0].psi2_error[:2] == pytest.approx([ERROR, 9.9 * ERROR])
        assert answers[-1] is tabulated[0]


@pytest.mark.parametrize(
    ("chi", "accuracy", "table", "needs_none"),
    [
        (2.5, None, True, True),
        (2.51, None, True, False),
        (1.0, 1e-9, True, True),
        (1.0, 0.9e-9, True, False),
        (1.0, None, False, False),
        (np.array([1.0, 2.6]), None, True, False),
    ],
)
def test_when_fronts_need_no_march(chi, accuracy, table, needs_none):
    scene = Scene.nondimensional(psi1=0.5, chi=chi)
    assert Fronts(table=table).needs_no_march(scene, accuracy) is needs_none


RIGID_CAUTION = (
    "rigid bodies: tangential elasticity is left out, which moves psi2 of solid spheres by up to "
    "about 1.5 where the contact sticks (model, not numerical error)"
)
HARD_CAUTION = (
    "hard spheres: one slip restitution stands for the tangential elasticity, at every angle; it "
    "moves psi2 of solid spheres by up to about 0.8 (model, not numerical error)"
)
ONE_SPRING = (
    "one spring: the whole contact slips at once, which moves psi2 of solid spheres by up to about "
    "0.7 (model, not numerical error)"
)
SHORT = (
    "the contact remembers its force and two turning points, not its traction, which moves psi2 of "
    "solid spheres by up to about 0.15 (model, not numerical error)"
)


@pytest.mark.parametrize(
    ("name", "options", "expected"),
    [
        ("coulomb", {}, (RIGID_CAUTION,)),
        ("walton", {}, (HARD_CAUTION,)),
        ("frictionless", {}, ()),
        ("linear_spring", {}, (ONE_SPRING,)),
        ("mindlin_cap", {"form": "increment_rescaled"}, (ONE_SPRING,)),
        ("mindlin_deresiewicz", {}, (SHORT,)),
        ("springs", {}, ()),
        ("annulus", {}, ()),
        ("fronts", {}, ()),
        ("halfspace", {}, ()),
    ],
)
def test_cautions_of_like_bodies(name, options, expected):
    scene = impact()
    law = create(f"tangential.{name}", **options)
    assert law.cautions(scene, Simulation().normal_motion(scene)) == expected


@pytest.mark.parametrize("name", ["linear_spring", "mindlin_cap", "mindlin_deresiewicz", "springs",
                                  "annulus", "fronts", "halfspace"])  # fmt: skip
def test_unlike_bodies_are_cautioned_of_first(name):
    rubber = Material(young_modulus=5e6, poisson_ratio=0.3, density=1100.0)
    scene = impact(target=rubber)
    told = create(f"tangential.{name}").cautions(scene, Simulation().normal_motion(scene))
    assert "coupling" in told[0]
    if name == "halfspace":
        for coupling in ("one_way", "two_way"):
            law = create("tangential.halfspace", coupling=coupling)
            assert law.cautions(scene, Simulation().normal_motion(scene)) == ()


@pytest.mark.parametrize("coupling", ["none", "one_way", "two_way"])
def test_a_half_space_that_answers_with_its_own_pressure_assumes_none(coupling):
    law = create("tangential.halfspace", coupling=coupling)
    scene = impact()
    told = law.cautions(scene, Simulation(normal="linear").normal_motion(scene))
    assert (told == ()) is (coupling == "two_way")
    assert law.refuses(create("normal.hertz")) is None
    refusal = "with two-way coupling pressure is found from elastic surfaces: give normal.hertz"
    expected = refusal if coupling == "two_way" else None
    assert law.refuses(create("normal.linear")) == expected
    assert law.refuses(create("integrator.paper")) is None


DECLARED = {
    "annulus": ({"radius"}, {"partial_slip"}, "annuli"),
    "coulomb": (set(), {"rigid"}, None),
    "fronts": ({"elastic_hertz"}, {"partial_slip"}, None),
    "frictionless": (set(), {"no_friction"}, None),
    "halfspace": ({"radius"}, set(), "rings"),
    "linear_spring": (set(), set(), None),
    "mindlin_cap": ({"radius"}, set(), None),
    "mindlin_deresiewicz": ({"radius"}, set(), None),
    "sharp_annulus": ({"radius"}, {"partial_slip"}, "annuli"),
    "springs": ({"radius"}, {"partial_slip"}, "springs"),
    "stronge": (set(), set(), None),
    "walton": (set(), set(), None),
}


@pytest.mark.parametrize("name", DECLARED)
def test_what_a_law_needs_offers_and_is_refined_by(name):
    law = REGISTRY.create(f"tangential.{name}")
    needs, offers, resolution = DECLARED[name]
    assert (set(law.needs), set(law.offers), law.resolution) == (needs, offers, resolution)


DEFAULTS = {
    "tangential.annulus": {"annuli": 50, "displacement": "midpoint"},
    "tangential.fronts": {"table": True},
    "tangential.halfspace": {"rings": 32, "angles": 8, "coupling": "none", "extrapolate": True},
    "tangential.linear_spring": {"stiffness_ratio": None, "damping": 0.0},
    "tangential.mindlin_cap": {"form": "displacement", "stiffness_factor": 1.0, "damping": 0.0},
    "tangential.sharp_annulus": {"annuli": 50},
    "tangential.springs": {"springs": 50, "grid": "largest"},
    "tangential.stronge": {"stiffness_ratio": None},
    "tangential.walton": {"slip_restitution": 0.4},
    "integrator.paper": {"steps": 500, "refine": True},
    "integrator.symplectic": {"steps": 200, "refine": True},
    "integrator.adaptive": {"tolerance": 1e-4},
    "integrator.events": {"tolerance": 1e-9},
}


@pytest.mark.parametrize("name", DEFAULTS)
def test_defaults(name):
    law = create(name)
    assert {key: getattr(law, key) for key in DEFAULTS[name]} == DEFAULTS[name]


@pytest.mark.parametrize(
    ("name", "option", "most"),
    [
        ("tangential.annulus", "annuli", 2000),
        ("tangential.sharp_annulus", "annuli", 100_000),
        ("tangential.springs", "springs", 100_000),
        ("tangential.halfspace", "angles", 32),
        ("integrator.paper", "steps", 2_000_000),
        ("integrator.symplectic", "steps", 2_000_000),
    ],
)
def test_a_number_has_a_most_and_a_least(name, option, most):
    for good in (1, most):
        assert getattr(create(name, **{option: good}), option) == good
    for bad in (0, most + 1):
        with pytest.raises(ValueError, match=option):
            create(name, **{option: bad})
