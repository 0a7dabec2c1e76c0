"""Springs with a cap, step by step by hand: forces, works, what each form says of itself."""

import pytest

from contactlab import HalfSpace, Material, Scene, Sphere, create
from contactlab.contracts import Increment, NormalContact
from contactlab_laws.mindlin import State

STEEL = Material.named("steel")
SCENE = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.3, 0.7, 0.15)


def contact(radius, load):
    return NormalContact(load, radius, radius**2, load)


def stepped(form, before, after, held, *, moved=0.2, cap=100.0, damping=0.0, spring=None):
    """Return force, work and what is held after a step of a spring of 2 N/m per metre of radius."""
    law = create("tangential.mindlin_cap", form=form, damping=damping)
    force = 2.0 * before * held if form.startswith("displacement") else held
    spring = force if spring is None else spring
    state = State(2.0, 1.0, 4.0, 0.5, held, spring, spring)
    step = Increment(moved, 0.3, 2.0 * cap, 1.0, 0.5)
    response, now = law.advance(state, step, contact(before, 1.0), contact(after, 2.0 * cap))
    assert now.force == response.force
    return response.force, response.friction_work, now.held


MEAN = 2.0 / 3.0 * 7.0 / 3.0  # of the radii 1 and 2 by even squares: 14/9


@pytest.mark.parametrize(
    ("form", "before", "after", "force", "held"),
    [
        ("displacement", 1.0, 2.0, 4.0 * 0.5, 0.5),
        ("displacement", 2.0, 1.0, 2.0 * 0.5, 0.5),
        ("displacement_rescaled", 1.0, 2.0, 4.0 * 0.5, 0.5),
        # u/b before, and dD times the mean of 1/b as the square falls evenly, 2/(b0 + b)
        ("displacement_rescaled", 2.0, 1.0, 2.0 * (0.15 + 0.2 * 2 / 3), 0.15 + 0.2 * 2 / 3),
        ("increment", 1.0, 2.0, 0.3 + 2.0 * MEAN * 0.2, 0.3 + 2.0 * MEAN * 0.2),
        ("increment", 2.0, 1.0, 0.3 + 2.0 * MEAN * 0.2, 0.3 + 2.0 * MEAN * 0.2),
        ("increment_rescaled", 1.0, 2.0, 0.3 + 2.0 * MEAN * 0.2, 0.3 + 2.0 * MEAN * 0.2),
        ("increment_rescaled", 2.0, 1.0, 0.15 + 2.0 * 0.2, 0.15 + 2.0 * 0.2),
        ("increment", 0.0, 0.0, 0.3, 0.3),
    ],
)
def test_a_step_of_each_form(form, before, after, force, held):
    found = stepped(form, before, after, 0.3)
    assert found == pytest.approx((force, 0.0, held), abs=1e-14)


@pytest.mark.parametrize(
    ("form", "force", "work", "held"),
    [
        # the trial u = 0.5 is cut to 0.4/4; the mean of the forces 0.6 and 0.4 times 0.4
        ("displacement", 0.4, 0.5 * 1.0 * 0.4, 0.1),
        ("increment", 0.4, 0.5 * 0.7 * (0.3 + 0.4 * MEAN - 0.4) / (2.0 * MEAN), 0.4),
    ],
)
def test_a_step_that_slips_at_the_cap(form, force, work, held):
    """From radius 1 to 2, where the stiffness is 4; the cap is 0.4."""
    assert stepped(form, 1.0, 2.0, 0.3, cap=0.4) == pytest.approx((force, work, held), abs=1e-14)


def test_a_dashpot_does_its_work_on_the_displacement():
    """Of constant 2 * 0.5 sqrt(4 * 1) = 2 on a velocity of 0.3: (2 + 0.6)/(1 + 2/8)."""
    force, work, held = stepped("displacement", 1.0, 2.0, 0.3, damping=0.5)
    assert force == pytest.approx(2.6 / 1.25)
    assert held == 0.5
    assert work == pytest.approx(0.5 * (2.6 / 1.25 - 2.0) * 0.2)
