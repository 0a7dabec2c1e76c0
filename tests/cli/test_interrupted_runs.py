"""Ctrl-C in the middle of laws, checks, samples or frames keeps those that are done."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

from contactlab.figures import animation
from contactlab.registration.manager import MANAGER, Told
from contactlab.study import comparison, evidence, validation
from tests.cli.conftest import EXAMPLES, interrupting, partial
from tests.longer import longer

KHARAZ = EXAMPLES / "kharaz2001.toml"
E_T = ("--quantity", "tangential_restitution", "--tangential", "exact,coulomb,stronge")


def test_compare_keeps_the_laws_that_are_done(run, monkeypatch, measured, tmp_path):
    """Of the second law the sweep is done, the measured points are not: it is left out."""
    picture = tmp_path / "c.png"
    picture.write_text("earlier")
    words = ("compare", measured, "--tangential", "coulomb,frictionless,stronge")
    runs = comparison._run
    monkeypatch.setattr(comparison, "REPEATS", 1)
    monkeypatch.setattr(
        comparison, "LONG_RUN", np.inf
    )  # of each law two sweeps, and measured points
    monkeypatch.setattr(comparison, "_run", interrupting(runs, 5))
    ran = run(*words, "--figure", picture)
    assert ran.status == 130
    assert "coulomb" in ran.out
    assert "frictionless" not in ran.out
    assert "interrupted: not compared: frictionless, stronge" in ran.err
    assert partial(picture).read_bytes().startswith(b"\x89PNG")
    assert picture.read_text() == "earlier"
    monkeypatch.setattr(comparison, "_run", interrupting(runs, 7))
    ran = run(*words, "--json")
    content = json.loads(ran.out)
    assert (ran.status, content["complete"]) == (130, False)
    assert list(content["laws"]) == ["coulomb", "frictionless"]
    assert list(content["measured"][0]["laws"]) == ["coulomb", "frictionless"]
    monkeypatch.setattr(comparison, "_run", interrupting(runs, 2))
    ran = run(*words)
    assert (ran.status, ran.out) == (130, "")


@pytest.mark.parametrize(("done", "sources"), [(1, 0), (2, 0), *longer((2, 1))])
def test_validate_keeps_checks_and_sources(run, monkeypatch, done, sources):
    checks = [validation._rigid] * done + [interrupting(None, 0)] * (sources == 0)
    own = MANAGER.gather("checks")[0].info
    told = [Told(own, check) for check in checks]
    gather = MANAGER.gather
    monkeypatch.setattr(
        MANAGER, "gather", lambda kind, **kw: told if kind == "checks" else gather(kind, **kw)
    )
    monkeypatch.setattr(evidence, "evidence_of", interrupting(evidence.evidence_of, sources))
    ran = run("validate")
    assert ran.status == 130
    assert ran.out.endswith("not complete: interrupted\n")
    assert ran.out.count("coulomb: psi2") == done
    assert ran.out.count("(experiment)") == sources
    assert json.loads(run("validate", "--json").out)["complete"] is False


@pytest.mark.slow
def test_an_animation_keeps_its_frames(run, monkeypatch, ball, tmp_path):
    monkeypatch.setattr(animation, "SAMPLES", (0.0, 1.0))
    monkeypatch.setattr(animation, "DOTS", 30)
    shown = 3 + len(animation.SAMPLES)  # the palette is of some frames, before all are drawn
    monkeypatch.setattr(animation.Forces, "show", interrupting(animation.Forces.show, shown))
    picture = tmp_path / "a.gif"
    ran = run("animate", ball, "--out", picture)
    assert (ran.status, ran.out) == (130, "")
    with Image.open(picture) as written:
        assert written.n_frames == 3
