"""What contracts leave to a law: restitution and cautions at their bounds, and defaults."""

import math
from types import SimpleNamespace
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene
from contactlab.contracts.restitution import restitution, root
from contactlab.testing.laws import DampedHertz

NAN = math.nan
STEEL = contactlab.Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)


@attrs.frozen(kw_only=True)
class Restored(DampedHertz):
    restitution: Any = restitution(default=None)


@pytest.mark.parametrize("value", [0.01, 0.5, 1.0, None])
def test_a_restitution_from_a_hundredth_to_one_is_taken(value):
    assert Restored(restitution=value).restitution == value


@pytest.mark.parametrize(
    "value", [np.nextafter(0.01, 0.0), np.nextafter(1.0, 2.0), 0.0, -0.5, NAN, np.array([0.5])]
)
def test_any_other_restitution_is_refused(value):
    rule = "restitution = .*must be one number from 0.01 to 1: rebound over approach velocity|array"
    with pytest.raises(ValueError, match=rule):
        Restored(restitution=value)


def test_a_root_is_found_to_the_last_bit():
    assert root(lambda x: x * x - 2.0, 0.0, 2.0) == pytest.approx(2.0**0.5, rel=3e-16)
    assert root(lambda x: -1.0 if x < 0.3 else 0.0, 0.0, 1.0) == 0.3
    # Between neighbours the middle is the even one: below 0.3, and 0.5 itself.
    assert root(lambda x: -1.0 if x < 0.5 else 0.0, 0.0, 0.9) == 0.5
    assert root(lambda _: -1.0, 0.0, 1.0) == 1.0
    assert root(lambda _: 1.0, 0.25, 1.0) == np.nextafter(0.25, 1.0)


class Plastic(DampedHertz):
    plastic: ClassVar[bool] = True


def sized(*ratios, law=None, body=True):
    """Cautions of a law whose contact radius over R comes to these ratios."""
    ball = contactlab.Sphere(0.01, STEEL)
    impact = Scene(ball, contactlab.HalfSpace(STEEL), 0.2, 1e-3, 0.0)
    if not body:
        impact = Scene(None, None, 0.2, 1e-3, 0.0, pair=impact.pair)
    radius = impact.pair.radius * np.array(ratios) if len(ratios) > 1 else (
        impact.pair.radius * ratios[0]
    )  # fmt: skip
    return (law or DampedHertz()).cautions(impact, SimpleNamespace(maximum_radius=radius))


def test_a_contact_above_a_tenth_of_the_radius_is_doubted():
    told = (
        "C = 0.11, contact radius over R: the contact is not small against the radius, the theory "
        "of half-spaces is doubtful above 0.1"
    )
    assert sized(0.11) == (told,)
    assert sized(0.05, 0.11) == (told,)
    assert sized(0.099) == ()
    assert sized(NAN) == ()
    assert sized(0.11, body=False) == ()


def test_a_plastic_law_is_not_doubted_for_yield():
    weak = attrs.evolve(STEEL, yield_stress=1e8)
    impact = Scene(contactlab.Sphere(0.01, weak), contactlab.HalfSpace(weak), 0.2, 1.0, 0.0)
    small = SimpleNamespace(maximum_radius=1e-5)
    [caution] = DampedHertz().cautions(impact, small)
    assert "yield" in caution
    assert Plastic().cautions(impact, small) == ()
    wide = SimpleNamespace(maximum_radius=0.2 * impact.pair.radius)
    assert [told[:3] for told in DampedHertz().cautions(impact, wide)] == [caution[:3], "C ="]
