"""Three hundred draws: intervals hold the truth, and sound measurements are not accused.

Figures before anything was mended: intervals hold the truth in 93.4 % of the 200 clean draws,
94.8 % of the 100 with outliers, 93.8 % of all; something is said of 1.5 % of the clean ones (two
refusals of a stiffness ratio that the data do not determine among them).
"""

import pytest

from tests.fitting.draws import CLEAN, draws, figures, outcome


@pytest.mark.slow
def test_intervals_hold_the_truth_and_sound_measurements_are_not_accused():
    outcomes = [outcome(one) for one in draws()]
    assert figures(outcomes)[0] >= 0.93
    assert figures(outcomes[:CLEAN])[1] <= 0.02
