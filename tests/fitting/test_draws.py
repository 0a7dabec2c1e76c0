"""Three hundred draws: intervals hold the truth, and sound measurements are not accused.

Figures before anything was mended: intervals hold the truth in 93.4 % of the 200 clean draws,
94.8 % of the 100 with outliers, 93.8 % of all (406 intervals: 95 % but for chance, whose standard
error is 1.1 %); 0.5 % of the clean draws are accused, 71 % of those with outliers. After: the same
intervals; 1.5 % and 81 %. Other seeds: 95.3 % of the intervals of 600 clean draws, 95.4 % of those
of 500 with outliers.
"""

import pytest

from tests.fitting.draws import CLEAN, draws, figures, outcome


@pytest.mark.slow
def test_intervals_hold_the_truth_and_sound_measurements_are_not_accused():
    outcomes = [outcome(one) for one in draws()]
    assert figures(outcomes)[0] >= 0.93
    assert figures(outcomes[:CLEAN])[1] <= 0.02
    assert figures(outcomes[CLEAN:])[1] >= 0.75
