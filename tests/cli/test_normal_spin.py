"""Spin about the normal in scene files: every command tells what its friction would change."""

import json

import pytest

from tests.longer import longer
from tests.present import of_commands
from tests.short_animations import shorten

BODIES = {
    "sphere": '[sphere]\nradius = 0.01\nmaterial = "steel"\n',
    "body": (
        '[body]\nmass = 0.033\ncurvature_radius = 0.01\nmaterial = "steel"\n'
        "inertia = [[2e-6, 0, 0], [0, 1.3e-6, 0], [0, 0, 1.3e-6]]\n"
    ),
}
IMPACT = """[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.1
normal = [0, 0, -1]
velocity = [0.12, 0, -1]
spin = [0, 0, 100]
"""
CONTACT = "contact = [0.002, 0, -0.01]\n"
SWEEP = "[sweep]\nfriction_coefficient = [0.1, 0.2, 10]\n"
CAUTION = "friction of the spin about the normal is ignored"


@pytest.fixture(params=BODIES)
def files(request, tmp_path):
    """Return the paths of one impact and of a sweep."""
    impact = BODIES[request.param] + IMPACT + (CONTACT if request.param == "body" else "")
    paths = tmp_path / "one.toml", tmp_path / "sweep.toml"
    for path, text in zip(paths, (impact, impact + SWEEP), strict=True):
        path.write_text(text)
    return request.param, *paths


def test_run_tells_in_words_json_and_files(run, files, tmp_path):
    _, one, sweep = files
    words = run("run", one, "--out", tmp_path / "one.json")
    assert words.status == 0
    assert CAUTION in words.out
    assert "; without spin about the normal" in words.out
    assert words.out.count(CAUTION) == 1
    for text in (
        run("run", one, "--json", "--no-estimate-error").out,
        (tmp_path / "one.json").read_text(),
    ):
        plan = json.loads(text)["plan"]
        assert "spin about the normal: its friction is left out" in plan["left_out"]
        assert any(CAUTION in each for each in plan["cautions"])
    assert (
        "model (2 of 3 impacts): friction of the spin"
        in run("run", sweep, "--no-estimate-error").out
    )


@pytest.mark.parametrize(
    "words",
    [("sweep", 2), ("compare", 2), *longer((("compare", 1),)), ("sweep", 2, "--json")],
)
def test_commands_that_print_tables_tell_too(run, files, words):
    command, which, *options = words
    ran = run(command, files[which], *options)
    assert ran.status == 0
    assert CAUTION in " ".join((ran.out + ran.err).split())


@pytest.mark.slow
def test_a_report_and_a_picture_of_a_ball(run, files, tmp_path, monkeypatch):
    shorten(monkeypatch)
    kind, one, _ = files
    if kind == "sphere" and of_commands("report"):
        page = tmp_path / "page.html"
        assert run("report", one, "--out", page).status == 0
        assert CAUTION in page.read_text()
    ran = run("animate", one, "--out", tmp_path / "one.gif")
    assert ran.status == 0
    assert CAUTION in ran.err
