"""Three hundred draws: intervals hold the truth, and sound measurements are not accused.

Figures before anything was mended: intervals hold the truth in 93.4 % of the 200 clean draws,
94.8 % of the 100 with outliers, 93.8 % of all (406 intervals: 95 % but for chance, whose standard
error is 1.1 %); 0.5 % of the clean draws are accused, 71 % of those with outliers. After: the same
intervals; 1.5 % and 81 %. Other seeds: 95.3 % of the intervals of 600 clean draws, 95.4 % of those
of 500 with outliers.
"""

import re

import pytest

from tests.fitting.draws import CLEAN, draw, draws, figures, outcome


@pytest.mark.slow
def test_intervals_hold_the_truth_and_sound_measurements_are_not_accused():
    outcomes = [outcome(one) for one in draws()]
    assert figures(outcomes)[0] >= 0.93
    assert figures(outcomes[:CLEAN])[1] <= 0.02
    assert figures(outcomes[CLEAN:])[1] >= 0.75


@pytest.mark.slow
@pytest.mark.parametrize(
    ("flaw", "told", "silent"),
    [({"restitution": 0.85}, 0.65, 0.0), ({"tilt": 3.0}, 0.8, 0.05)],
    ids=["lost energy", "a protractor 3 degrees off"],
)
def test_intervals_beside_the_truth_are_not_silent(flaw, told, silent):
    """Of 40 draws of each flaw: the share with a note, and of misses with neither note nor caution.

    Before: 60 % of the draws that lose energy were told, 35 % were silent and wrong; with the tilt
    78 % and 18 %. After: 88 % and none; 85 % and 2 %. Of the same draws without a flaw one in 40
    is accused, before and after.
    """
    outcomes = [outcome(draw(seed, outliers=False, only=("friction_coefficient",), **flaw))
                for seed in range(40)]  # fmt: skip
    notes = [bool(one.notes) for one in outcomes]
    wrong = [not (one.notes or one.cautions or all(one.covered.values())) for one in outcomes]
    assert sum(notes) >= told * len(notes)
    assert sum(wrong) <= silent * len(wrong)


@pytest.mark.slow
def test_a_zero_of_angles_that_is_likely_but_not_certain_is_a_caution():
    """With the friction coefficient that follows, nearer to the truth; none of sound angles."""
    one = draw(33, outliers=False, only=("friction_coefficient",), tilt=3.0)
    found = outcome(one)
    (told,) = found.cautions
    assert not found.notes
    assert not all(found.covered.values())
    assert "angle_deg looks as if all numbers were 2.5 degrees too large" in told
    friction = float(re.search(r"friction_coefficient ([\d.]+)", told)[1])
    assert friction == pytest.approx(one.truth["friction_coefficient"], rel=0.04)
    sound = outcome(draw(33, outliers=False, only=("friction_coefficient",)))
    assert not any("looks as if" in text for text in sound.cautions)
