"""``contactlab compare --all``: every law that fits, one row a law."""

from __future__ import annotations

import json

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, read_scene
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.registry.registry import REGISTRY
from contactlab.scene_file import LawChoice
from contactlab.study.comparison import compare
from contactlab.study.scores import DEFAULT_SCENE, candidates, pressed_force
from tests.laws.normal_laws import Damped

CHI = 49.0 / 34.0


@pytest.fixture
def sweep(tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text(
        f"[nondimensional]\nchi = {CHI}\n[sweep]\npsi1 = [0.5, 1.2, 3.0]\n"
        "[simulation]\nintegrator = 'paper'\noptions.integrator.paper.steps = 300\n",
        encoding="utf-8",
    )
    return path


@pytest.fixture
def without_annuli(monkeypatch):
    """The slowest law is blocked, as a user may."""
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "tangential.annulus")


@pytest.mark.slow
def test_every_law_has_a_row_under_an_integrator_that_suits_it(run, sweep, without_annuli):
    ran = run("compare", sweep, "--all", "--json")
    rows = {row["law"]: row for row in json.loads(ran.out)["scores"]}
    installed = {name.partition(".")[2] for name in REGISTRY.names("tangential")}
    assert installed - {"annulus"} <= set(rows)
    assert not any(name.split()[0] == "annulus" for name in rows)
    assert {"mindlin_cap increment", "mindlin_cap increment_rescaled"} <= set(rows)
    assert next(iter(rows)) == "fronts"
    # The file names `paper`, which runs what takes steps; the others have their own, or none.
    assert (rows["fronts"]["integrator"], rows["springs"]["integrator"]) == ("events", "paper")
    assert rows["coulomb"]["integrator"] == ""
    assert rows["fronts"]["rms"] == rows["fronts"]["worst"] == 0.0
    psi1 = np.array([0.5, 1.2, 3.0])
    exact = Simulation().run(Scene.nondimensional(psi1=psi1, chi=CHI)).psi2
    off = np.abs(rigid_body_rebound(psi1, CHI) - exact)
    assert rows["coulomb"]["worst"] == pytest.approx(off.max(), abs=1e-9)
    assert rows["coulomb"]["where"] == psi1[off.argmax()]
    assert rows["coulomb"]["rms"] == pytest.approx(np.sqrt(np.mean(off**2)), abs=1e-9)
    assert rows["springs"]["worst"] < 1e-3 < 0.1 < rows["mindlin_cap"]["worst"]
    assert rows["mindlin_cap"]["energy_made"] > 0.01 > 1e-3 > rows["springs"]["energy_made"]
    assert 1e-5 < rows["springs"]["numerical_error"] < 1e-2


def test_pressing_alone_in_closed_form():
    """At zeta = 0.4 the spring is at its cap, u = b²/1.5, and F = 1.5 u at zeta = 1."""
    assert pressed_force(contactlab.create("tangential.mindlin_cap")) == pytest.approx(
        0.4 - 0.4**1.5, abs=1e-12
    )
    increment = contactlab.create("tangential.mindlin_cap", form="increment")
    assert pressed_force(increment) == pytest.approx(0.0, abs=1e-12)
    assert np.isnan(pressed_force(contactlab.create("tangential.coulomb")))


def test_a_normal_law_leaves_out_what_does_not_fit():
    """Over a damped contact the exact law has nothing to say, and annuli are the default."""
    found = candidates(LawChoice(normal="hertz"))
    assert next(iter(found.simulations)) == "fronts"
    assert found.left_out == {}
    law = Damped()
    assert contactlab.registry.composition.prefer_law("tangential", law) == "annulus"


def test_without_a_scene_it_is_that_of_the_codes(run):
    content = json.loads(run("compare", "--tangential", "mindlin_cap,coulomb", "--json").out)
    assert content["varied"]["psi1"] == read_scene(DEFAULT_SCENE).scene.psi1.tolist()
    code = content["measured"][0]
    assert "LIGGGHTS" in read_scene(DEFAULT_SCENE).measured[0].label
    assert code["laws"]["mindlin_cap"]["largest"] < 2e-3 < 0.1 < code["laws"]["coulomb"]["largest"]


def test_a_law_that_the_files_integrator_does_not_run_gets_another(run, sweep):
    content = json.loads(run("compare", sweep, "--tangential", "fronts,springs", "--json").out)
    assert content["laws"]["fronts"]["values"]["psi2"][2] == pytest.approx(-1.3796832924, abs=1e-9)
    asked = run("compare", sweep, "--tangential", "fronts", "--integrator", "paper")
    assert asked.status == 2
    assert "; use " in asked.err


@pytest.mark.slow
def test_table_and_figure(run, sweep, tmp_path, without_annuli):
    path = tmp_path / "all.png"
    ran = run("compare", sweep, "--all", "--figure", path)
    assert ran.status == 0
    assert path.stat().st_size > 40_000
    for words in ("energy", "reference", "mindlin_deresiewicz", "thornton_yin", "distance"):
        assert words in ran.out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--tangential", "coulomb"), "leave out --tangential"),
        (("--integrator", "paper"), "leave out --tangential"),
        (("--set", "tangential.annuli=5"), "with --all name one law"),
        (("--set", "tangential.annulus.anuli=5"), "annuli"),
    ],
)
def test_bad_input(run, sweep, arguments, words):
    ran = run("compare", sweep, "--all", *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert words in ran.err


@pytest.mark.slow
def test_all_of_a_single_impact_have_a_row_each(run, ball):
    ran = run("compare", ball, "--all")
    assert ran.status == 0
    laws = [
        line.split()[0] for line in ran.out.partition("cost")[0].splitlines() if line[:1].islower()
    ]
    assert laws[:3] == ["law", "fronts", "annulus"]
    assert "caution," in ran.out


def test_bands_are_the_numerical_error_carried_into_the_quantity():
    """Of psi2 the error itself; of e_t its share, the change of v over that of v_x, linear."""
    oxide = contactlab.Material(young_modulus=380e9, poisson_ratio=0.23, density=4000.0)
    glass = contactlab.Material(young_modulus=70e9, poisson_ratio=0.25)
    angle = np.radians([5.0, 20.0, 30.0])
    scene = Scene(
        contactlab.Sphere(2.5e-3, oxide), contactlab.HalfSpace(glass), 0.092,
        3.9 * np.cos(angle), 3.9 * np.sin(angle),
    )  # fmt: skip
    springs = contactlab.create("tangential.springs", springs=6)
    laws = {
        "springs": Simulation(tangential=springs),
        "other": Simulation(tangential="linear_spring"),
    }
    plain = compare(scene, laws)
    assert np.isnan(plain.band("psi2", "other")).all()
    guessed = compare(scene, laws, estimate_error=True)
    estimate = np.asarray(guessed.runs[0].result.psi2_error_estimate)
    assert (estimate[:2] > 1e-5).all()
    assert guessed.band("psi2", "springs") == pytest.approx(estimate, rel=1e-9)
    per_psi = 2.0 / 7.0 / scene.psi_scale / (3.9 * np.sin(angle))
    band = guessed.band("tangential_restitution", "springs")
    assert band == pytest.approx(estimate * per_psi, rel=1e-6)
    assert np.isfinite(guessed.numerical_error("other")).all()
