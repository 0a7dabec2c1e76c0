"""`contactlab validate --measured`: laws beside the rows of measured sets."""

import json

import pytest

from contactlab.registration import bring
from contactlab.registry.registry import REGISTRY
from contactlab.study import evidence
from tests.longer import longer

QUICK, ALL = ("fronts", "springs", "mindlin_cap"), ("fronts", "springs", "annulus", "mindlin_cap")
#: Law, rms, rows within their error of eleven, chi² a row: what was found before this was written.
SAID = {
    "springs, viscoelastic": (0.075, 7, 1.4),
    "fronts": (0.101, 5, 12.3),
    "annulus, viscoelastic": (0.116, 5, 19.9),
    "mindlin_cap, viscoelastic": (0.144, 3, 8.9),
}


@pytest.fixture
def few(monkeypatch):
    """Set some laws beside the sets of slopes of some names, and beside no other."""

    def choose(laws, *names):
        names = names or [one.name for one in evidence.SLOPES]
        chosen = tuple(one for one in evidence.SLOPES if one.name in names)
        monkeypatch.setattr(bring, "_KEPT", {})
        monkeypatch.setattr(evidence, "SOURCES", ())
        monkeypatch.setattr(evidence, "SLOPES", chosen)
        monkeypatch.setattr(REGISTRY, "names", lambda kind: [f"{kind}.{law}" for law in laws])

    return choose


@pytest.mark.parametrize("laws", [QUICK, *longer((ALL,))])
def test_one_loss_is_nearest_to_small_spheres(run, few, laws):
    few(laws, "small-spheres")
    (one,) = json.loads(run("validate", "--measured", "--json").out)["sets"]
    assert len(one["rows"]) == 11
    for law, (rms, within, chi2) in SAID.items():
        if law.partition(",")[0] in laws:
            found = one["laws"][law]
            assert found["rms"] == pytest.approx(rms, abs=3e-3), law
            assert abs(found["within"] - within) <= 1, law
            assert found["chi2_a_row"] == pytest.approx(chi2, rel=0.1), law
    place = one["rows"].index("glass on aluminium")
    assert one["laws"]["springs, viscoelastic"]["values"][place] == pytest.approx(0.310, abs=2e-3)
    assert next(iter(one["laws"])).startswith("springs, ")  # under either law with a loss


@pytest.mark.slow
def test_tables_and_the_picture(run, few, tmp_path):
    few(("fronts", "mindlin_cap"))
    ran = run("validate", "--measured", "--out", tmp_path / "pictures")
    assert ran.status == 0
    assert "11" in ran.out
    assert "second hand" in ran.out
    assert "polyurethane: 0.5" in ran.out  # the worst row of the elastic law
    assert (tmp_path / "pictures" / "measured.png").read_bytes().startswith(b"\x89PNG")
