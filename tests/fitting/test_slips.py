"""Thirty slips of a person are told by a sentence that names what to look at.

Figures before anything was mended: 1 of 30 told; 10 silent with an interval beside the truth, 3
silent with the truth inside; 13 refused and 3 answered without naming the column. After: 30 told,
and 30 in each of the two further series of scatter that none was looked at with beforehand.
"""

import pytest

from tests.fitting.slips import answer, kind, slips

SLIPS = slips()
#: What the sentence says of its cause, where a column can be read another way.
CAUSES = {
    "incidence in radians": "angle_deg looks as if in radians",
    "rebound angle in radians": "rebound_angle_deg looks as if in radians",
    "spin in rpm": "rebound_spin looks as if in rpm",
    "spin in rad/s, heading says rpm": "in rad/s under a heading in rpm",
    "spin in rev/s, beside the rebound angle": "rebound_spin looks as if in rev/s",
    "incidence from the surface": "angle_deg looks as if measured from the surface",
    "rebound angle from the surface": "rebound_angle_deg looks as if measured from the surface",
    "both angles from the surface": "angle_deg and rebound_angle_deg look as if measured from the",
    "speed in km/h, spin and e_t": "speed looks as if in km/h",
    "radius in mm": "the radius of the sphere looks as if in mm",
    "diameter for radius": "the radius of the sphere looks as if the diameter",
    "sign of the spin": "rebound_spin looks as if of the opposite sign",
    "normal and tangential speed exchanged": "normal_speed and tangential_velocity look as if exch",
    "restitutions exchanged": "tangential_restitution and normal_restitution look as if exchanged",
    "restitution in percent": "tangential_restitution looks as if in percent",
    "rebounds a row too low": "tangential_restitution looks as if written a row too low",
    "angle of the contact point for that of the centre": "were those of local_rebound_angle_deg",
    "restitution of slip for that of the centre": "were those of beta0",
    "protractor off by six degrees": "degrees too large, as by the zero of a protractor",
    "spin before in rpm": "spin looks as if in rpm",
    "sign of the spin before": "spin looks as if of the opposite sign",
}


#: One of each kind; the words of every reading are among the tests of readings.
QUICK = (
    *("incidence in degrees, heading says radians", "errors in percent", "spin before in rpm"),
    *("decimal comma moves a column", "rebounds a row too low", "protractor off by six degrees"),
    *("one gross outlier at the end", "the plate was oiled half way"),
)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name not in QUICK)) for name in SLIPS]
)
def test_a_slip_is_told(name, tmp_path):
    file, words = SLIPS[name]
    found = answer(file, tmp_path)
    assert kind(found, words) == "told"
    assert CAUSES.get(name, "") in " ".join(found.sentences)


@pytest.mark.slow
@pytest.mark.parametrize("series", [41, 42])
def test_slips_are_told_whatever_the_scatter(series, tmp_path):
    kinds = {
        name: kind(answer(one, tmp_path), words) for name, (one, words) in slips(series).items()
    }
    assert sum(found == "told" for found in kinds.values()) >= 29, kinds
