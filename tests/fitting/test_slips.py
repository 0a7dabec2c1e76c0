"""Thirty slips of a person are told by a sentence that names what to look at.

Figures before anything was mended: 1 of 30 told; 10 silent with an interval beside the truth, 3
silent with the truth inside; 13 refused and 3 answered without naming the column.
"""

import pytest

from tests.fitting.slips import answer, kind, slips

SLIPS = slips()
TOLD = ("incidence in degrees, heading says radians",)


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_told(name, tmp_path, request):
    file, words = SLIPS[name]
    if name not in TOLD:
        request.applymarker(pytest.mark.xfail(strict=True, reason="not told yet"))
    assert kind(answer(file, tmp_path), words) == "told"
