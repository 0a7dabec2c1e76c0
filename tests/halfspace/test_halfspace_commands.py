"""The commands take the law of the half-space like any other."""

import json
import math
import re

import pytest

from contactlab.study.bench_methods import Method
from contactlab.study.stability_cases import cases
from contactlab.study.stability_judge import ANSWERED, judge
from tests.cli.conftest import EXAMPLES
from tests.cli.test_normal_spin import BODIES, CAUTION, IMPACT, SWEEP

BALL, MEASURED = EXAMPLES / "steel_ball.toml", EXAMPLES / "kharaz2001.toml"


@pytest.mark.slow
def test_compare(run):
    ran = run("compare", "--psi1", "0:3:4", "--chi", 1.44, "--tangential", "fronts,halfspace")
    assert ran.status == 0
    off = [float(line.split()[-1]) for line in ran.out.splitlines() if re.match(r" *[0-3] ", line)]
    assert len(off) == 4
    assert max(map(abs, off)) < 1e-4


@pytest.mark.slow
def test_bench(run, tmp_path):
    table = tmp_path / "bench.csv"
    assert run("bench", "--quick", "--tangential", "halfspace", "--out", table).status == 0
    assert "halfspace,rings=8" in table.read_text("utf-8")


@pytest.mark.slow
def test_report(run, tmp_path):
    pytest.importorskip("contactlab_pages")
    page = tmp_path / "report.html"
    ran = run("report", BALL, "--tangential", "fronts,halfspace", "--out", page)
    assert ran.status == 0
    assert "halfspace" in page.read_text("utf-8")


@pytest.mark.slow
def test_fit(run):
    """The axisymmetric problem: the friction of the exact law."""
    pytest.importorskip("contactlab_fit")
    laws = (
        "--tangential",
        "halfspace",
        "--set",
        "tangential.angles=1",
        "--set",
        "tangential.rings=8",
    )
    ran = run("fit", MEASURED, "--quantity", "tangential_restitution", "--bootstrap", 0, *laws)
    assert ran.status == 0
    friction = float(ran.out.partition("friction_coefficient")[2].split()[0])
    assert friction == pytest.approx(0.0932, abs=5e-4)


@pytest.mark.slow
def test_stability_judges_it_by_itself_at_twice_its_resolution():
    """A fifth of the quick cases; ``contactlab stability --tangential halfspace`` has all."""
    method = Method(tangential="halfspace", integrator="events")
    found = [judge(case) for case in [*cases(method, quick=True)][::5]]
    assert {each.outcome for each in found} == {ANSWERED}
    assert sum(math.isfinite(each.error) for each in found) > 10


@pytest.mark.slow
def test_the_half_space_answers_and_nothing_is_cautioned(run, tmp_path):
    path = tmp_path / "one.toml"
    path.write_text(BODIES["sphere"] + IMPACT)
    law = ("--tangential", "halfspace", "--set", "tangential.rings=8")
    ran = run("run", path, *law)
    assert ran.status == 0
    assert "slip and spin share the friction" in ran.out
    assert CAUTION not in ran.out + ran.err
    content = json.loads(run("run", path, *law, "--json").out)
    assert content["normal_spin"] == -100.0
    assert -100.0 < content["rebound_normal_spin"] < -98.0
    (tmp_path / "sweep.toml").write_text(BODIES["sphere"] + IMPACT + SWEEP)
    swept = run("sweep", tmp_path / "sweep.toml", *law, "--out", tmp_path / "sweep.csv")
    assert swept.status == 0
    assert CAUTION not in swept.out + swept.err
    assert "rebound_normal_spin (rad/s)" in (tmp_path / "sweep.csv").read_text()
    both = run("compare", path, "--tangential", "halfspace,fronts", "--json")
    assert CAUTION in both.err
