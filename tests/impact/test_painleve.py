"""A steel rod that slides on its end without approach: Painlevé's jam, the limit of slow ones."""

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, collide, shapes

STEEL = Material.named("steel")
DOWN = np.array([0.0, 0.0, -1.0])
ROD = {"length": 2.0, "radius": 0.02, "material": STEEL, "normal": DOWN, "axis": [1, 0, 1]}


def sliding(approach, friction=2.5, along=-1.0):
    body, contact = shapes.rod(**ROD)
    velocity = [along, 0, -approach]
    return Encounter(
        body, HalfSpace(STEEL), friction, normal=DOWN, velocity=velocity, contact=contact
    )


@pytest.mark.parametrize("approach", [1e-5, 1e-8, 1e-12])
def test_slow_approaches_have_one_limit(approach):
    """The energy of the end before it jams is that of the slip alone; it parts at 0.439 m/s."""
    after = collide(sliding(approach))
    at_contact = after.velocity + np.cross(after.spin, sliding(approach).contact)
    np.testing.assert_allclose(at_contact, [0.3167, 0.0, 0.4387], atol=1e-4)


def test_no_approach_is_refused_with_the_limit_named():
    with pytest.raises(ValueError, match=r"slide without approach.*lambda = -[\d.]+ below -1 \(Pa"):
        collide(sliding(0.0))


@pytest.mark.parametrize("case", [{"friction": 0.5}, {"along": 1.0}])
def test_where_friction_does_not_jam_bodies_rest(case):
    with pytest.raises(ValueError, match="bodies separate, or rest"):
        collide(sliding(0.0, **case))
