"""Laws whose parameters have units: converted by the kit, and caught where the unit is wrong."""

from typing import ClassVar

import attrs
import pytest

from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab.testing import CheckFailedError, Verdict, check_law
from contactlab.testing.units import ODD_UNITS, Units, factor, in_units
from tests.laws.normal_laws import Damped
from tests.testing.made import checked


@attrs.frozen(kw_only=True)
class Viscous(SteppedTangentialLaw):
    """A damper cut off at Coulomb's limit."""

    api_version: ClassVar[int] = 2

    damping: float = quantity("N s/m", rule=POSITIVE, default=900.0)

    def start(self, scene, normal):
        return scene.friction_coefficient

    def advance(self, state, increment, before, after):
        limit = state * after.friction_load
        trial = self.damping * increment.displacement / increment.duration
        force = min(max(trial, -limit), limit)
        return TangentialResponse(force, force * increment.displacement), state


@attrs.frozen(kw_only=True)
class WrongUnit(Damped):
    damping: float = quantity("s", default=0.2)


@attrs.frozen(kw_only=True)
class UnknownUnit(Damped):
    damping: float = quantity("furlong", default=0.2)


@pytest.mark.slow
def test_a_damped_normal_law_conforms():
    verdicts = {found.verdict for found in check_law(Damped())}
    assert verdicts <= {Verdict.PASSED, Verdict.NOT_CLAIMED, Verdict.NOT_APPLICABLE}


@pytest.mark.parametrize(("law", "name"), [(Viscous(), "units"), (Damped(), "contacts_units")])
def test_a_law_with_a_unit_is_the_same_in_any_units(law, name):
    assert checked(law, name).verdict is Verdict.PASSED


@pytest.mark.parametrize("law", [WrongUnit(), UnknownUnit()])
def test_a_wrong_unit_is_caught(law):
    found = checked(law, "contacts_units")
    assert found.verdict is Verdict.FAILED
    assert "units" in found.sentence or "furlong" in found.sentence


@pytest.mark.parametrize(
    ("unit", "number"),
    [("1", 1.0), ("m", 10.0), ("s/m", 0.2), ("N s/m", 1.5), ("N/m^1.5", 7.5 / 10**1.5)],
)
def test_factors(unit, number):
    """A metre is 10, a second 2, a kilogram 3: a newton is 3 * 10 / 2² = 7.5."""
    assert factor(unit, Units(10.0, 2.0, 3.0)) == pytest.approx(number)


def test_an_unknown_unit_is_refused_by_its_name():
    with pytest.raises(CheckFailedError, match="furlong"):
        factor("furlong/s", Units())


def test_only_what_has_a_unit_is_converted():
    law = in_units(Damped(damping=0.5), ODD_UNITS)
    assert law.damping == pytest.approx(0.5 * ODD_UNITS.time / ODD_UNITS.length)
