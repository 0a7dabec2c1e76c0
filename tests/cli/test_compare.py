"""``contactlab compare``: laws side by side, against each other and against measurement."""

from __future__ import annotations

import csv
import io
import json
import math

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, read_scene
from contactlab.cli import compare as command
from contactlab.cli.drawing import draw_all
from contactlab.figures.files import save_figure
from contactlab.study.comparison import compare
from contactlab.study.comparison_figure import differences, laws_over_sweep
from tests.laws.tangential_laws import Creator
from tests.longer import longer

BOTH = ("--tangential", "coulomb,frictionless")
UNITS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}


def test_differences_are_from_the_first_law(run, short_sweep):
    content = json.loads(run("compare", short_sweep, *BOTH, "--json").out)
    assert list(content["laws"]) == ["coulomb", "frictionless"]
    assert content["laws"]["coulomb"]["differences"]["psi2"] == [0.0, 0.0, 0.0]
    assert content["laws"]["frictionless"]["differences"]["psi2"] == pytest.approx([0, 2, 4])
    assert content["laws"]["coulomb"]["run_time_per_impact_s"] > 0.0


def test_measured_values_with_rms_and_largest_difference(run, measured):
    content = json.loads(run("compare", measured, *BOTH, "--json").out)
    (series,) = content["measured"]
    rigid = series["laws"]["coulomb"]
    assert rigid["values"] == pytest.approx([2.0, 3.0], abs=1e-9)
    assert rigid["rms"] == pytest.approx(0.1, abs=1e-9)
    assert rigid["largest"] == pytest.approx(0.1, abs=1e-9)
    loose = series["laws"]["frictionless"]
    assert loose["rms"] == pytest.approx(math.sqrt((3.9**2 + 4.1**2) / 2))


def test_tables(run, measured, short_sweep, ball):
    with_points = run("compare", measured, *BOTH)
    for words in ("made up", "coulomb - measured", "rms", "run time an impact", "2 of 2"):
        assert words in with_points.out
    assert "frictionless - coulomb" in run("compare", short_sweep, *BOTH).out
    first, second = with_points.out.partition("relative")[2].splitlines()[2:4]
    times = [float(row.split()[1]) * UNITS[row.split()[2]] for row in (first, second)]
    ratios = [float(row.split()[3]) for row in (first, second)]
    assert ratios == pytest.approx([1.0, times[1] / times[0]], rel=0.1)
    single = run("compare", ball, *BOTH, "--normal", "hertz").out
    assert "rebound_spin" in single
    assert "1 of 1" in single


def test_a_nondimensional_scene_claims_no_units(run, short_sweep):
    out = run("compare", short_sweep, *BOTH, "--quantity", "friction_work").out
    assert "friction_work:" in out
    assert "(J)" not in out


def test_csv_is_tidy(run, measured):
    rows = list(csv.DictReader(io.StringIO(run("compare", measured, *BOTH, "--csv").out)))
    assert {row["table"] for row in rows} == {"scene", "measured"}
    chosen = [row for row in rows if row["table"] == "measured" and row["law"] == "coulomb"]
    assert [float(row["x"]) for row in chosen] == [6.0, 7.0]
    assert [float(row["reference"]) for row in chosen] == [2.1, 2.9]
    for row in rows:
        gap = float(row["value"]) - float(row["reference"])
        assert float(row["difference"]) == pytest.approx(gap)


def test_integrators_can_be_compared_too(run, short_sweep):
    content = json.loads(run("compare", short_sweep, "--tangential", "coulomb", "--integrator",
                             "paper,symplectic", "--json").out)  # fmt: skip
    assert list(content["laws"]) == ["paper", "symplectic"]


def test_normal_laws_that_no_friction_law_is_common_to_have_their_own(run):
    ran = run("compare", "--psi1", "1.2", "--chi", "1.44", "--json", "--normal", "hertz,linear")
    assert list(json.loads(ran.out)["laws"]) == [
        "hertz + fronts", "hertz + annulus", "hertz + coulomb", "linear + annulus",
        "linear + coulomb",
    ]  # fmt: skip


def test_elastic_and_rigid_are_the_default(run):
    content = json.loads(run("compare", "--psi1", "1.2", "--chi", "1.44", "--json").out)
    assert list(content["laws"]) == ["fronts", "coulomb"]
    assert content["laws"]["fronts"]["values"]["psi2"] < -0.1
    plastic = run("compare", "--psi1", "1.2", "--chi", "1.44", "--json", "--normal", "walton_braun",
                  "--set", "normal.restitution=0.8")  # fmt: skip
    assert list(json.loads(plastic.out)["laws"]) == ["annulus", "coulomb"]
    assert content["laws"]["coulomb"]["values"]["psi2"] == pytest.approx(0.0, abs=1e-12)


def test_option_goes_to_the_laws_that_know_it(run, short_sweep):
    ran = run("compare", short_sweep, "--tangential", "annulus,coulomb", "--json",
              "--set", "tangential.annuli=5")  # fmt: skip
    assert ran.status == 0
    named = run("compare", short_sweep, "--tangential", "annulus,coulomb", "--json",
                "--set", "tangential.annulus.annuli=5")  # fmt: skip
    assert named.status == 0
    assert json.loads(named.out)["laws"]["annulus"]["values"]["psi2"] == pytest.approx(
        json.loads(ran.out)["laws"]["annulus"]["values"]["psi2"], abs=1e-15
    )
    unknown = run("compare", short_sweep, *BOTH, "--set", "tangential.annuli=5")
    assert unknown.status == 2
    assert "no chosen law" in unknown.err
    assert "known: none" in unknown.err
    springs = ("--tangential", "springs,coulomb", "--set", "tangential.sprngs=5")
    misspelt = run("compare", short_sweep, *springs)
    assert "did you mean 'tangential.springs'? known:" in misspelt.err


@pytest.mark.parametrize(
    "scene",
    [*longer("measured", "short_sweep"), "ball"],
)
def test_figure(run, request, tmp_path, scene):
    path = tmp_path / "figure.png"
    file = request.getfixturevalue(scene)
    assert run("compare", file, *BOTH, "--figure", path).status == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    assert path.stat().st_size > 20_000


def test_a_dollar_in_a_label_begins_no_formula(run, measured, tmp_path):
    text = measured.read_text(encoding="utf-8") + "label = 'a $\\foo$ for 3 $'\n"
    measured.write_text(text, encoding="utf-8")
    ran = run("compare", measured, *BOTH, "--figure", tmp_path / "figure.png")
    assert (ran.status, ran.err) == (0, "")


def test_every_law_in_one_picture(tmp_path, short_sweep):
    laws = {name: Simulation(tangential=name) for name in ("coulomb", "fronts")}
    draw_all(tmp_path / "all.png", compare(read_scene(short_sweep), laws), "psi2")
    assert (tmp_path / "all.png").read_bytes().startswith(b"\x89PNG")


def curves(axes):
    """Return the curves on some axes, parted at NaN, as arrays of shape (points, 2)."""
    found = []
    for line in axes.lines:
        points = np.transpose(line.get_data())
        gaps = np.flatnonzero(np.isnan(points[:, 0]))
        found += [part[~np.isnan(part[:, 0])] for part in np.split(points, gaps)]
    return [part for part in found if len(part) > 1]


@pytest.mark.parametrize("speeds_first", [True, False])
def test_of_two_entries_that_vary_the_longer_is_the_abscissa(tmp_path, speeds_first):
    """A line from the end of one curve to the start of the next would say nothing."""
    entries = ["friction_coefficient = [0.05, 0.2]\n", "angle_deg = [10.0, 40.0, 70.0]\n"]
    path = tmp_path / "product.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
        "material = 'steel'\n[impact]\nspeed = 1.0\n[sweep]\nproduct = true\n"
        + "".join(entries if speeds_first else entries[::-1])
    )
    comparison = compare(read_scene(path), {"rigid": Simulation(tangential="coulomb")})
    axes = laws_over_sweep(Figure().subplots(), comparison, "tangential_restitution")
    assert "angle" in axes.get_xlabel()
    assert "restitution" in axes.get_ylabel()
    assert "friction_coefficient" in axes.get_title()
    drawn = curves(axes)
    assert len(drawn) == 2
    for points, friction in zip(drawn, (0.05, 0.2), strict=True):
        rigid = 1.0 - 2.0 * friction / np.tan(np.radians(points[:, 0]))
        np.testing.assert_allclose(points[:, 1], np.maximum(rigid, 5.0 / 7.0), atol=1e-9)
    axes = differences(Figure().subplots(), comparison, "tangential_restitution")
    assert "angle" in axes.get_xlabel()
    assert "law" in axes.get_ylabel()


def test_csv_tells_every_entry_that_varies(run, tmp_path):
    path = tmp_path / "product.toml"
    path.write_text(
        "[nondimensional]\npsi1 = 6.0\n[sweep]\nproduct = true\nchi = [1.0, 1.2]\n"
        "psi1 = [0.0, 7.0]\n"
    )
    rows = list(csv.DictReader(io.StringIO(run("compare", path, *BOTH, "--csv").out)))
    told = [(float(row["x"]), float(row["psi1 (1)"])) for row in rows if row["law"] == "coulomb"]
    assert told == [(1.0, 0.0), (1.0, 7.0), (1.2, 0.0), (1.2, 7.0)]


def test_cautions_of_the_plans_are_told_with_their_laws(run, tmp_path):
    path = tmp_path / "unlike.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
        "material = 'soda-lime glass'\n[impact]\nspeed = 1.0\nangle_deg = 10.0\n"
        "friction_coefficient = 0.1\n"
    )
    laws = ("--tangential", "fronts,mindlin_cap")
    out = " ".join(run("compare", path, *laws).out.split())
    assert out.count("caution, all laws: model: unlike bodies") == 1
    assert "caution, mindlin_cap: model: one spring" in out
    told = json.loads(run("compare", path, *laws, "--json").out)["laws"]["fronts"]["cautions"]
    assert len(told) == 1


@pytest.mark.slow
def test_the_look_of_a_figure(run, short_sweep, tmp_path):
    sizes = []
    for style in ("print", "slides"):
        path = tmp_path / f"{style}.svg"
        assert run("compare", short_sweep, *BOTH, "--figure", path, "--style", style).status == 0
        sizes.append(path.read_text("utf-8").count("DejaVuSans"))
    assert sizes[0] == 0 < sizes[1]


def test_a_batch_without_a_file_is_drawn_over_what_varies():
    steel = Material.named("steel")
    angles = np.array([10.0, 40.0, 70.0])
    impacts = Scene.at_angle(
        Sphere(0.01, steel), HalfSpace(steel), 0.2, speed=1.0, angle_deg=angles
    )
    laws = {"rigid": Simulation(tangential="coulomb")}
    for scene, word, x in (
        (impacts, "normal (°)", angles),
        (Scene.nondimensional(psi1=angles, chi=1.0), "psi_1", angles),
        (Scene.nondimensional(psi1=2.0, chi=angles), "chi", angles),
    ):
        axes = laws_over_sweep(Figure().subplots(), compare(scene, laws), "psi2")
        assert word in axes.get_xlabel()
        np.testing.assert_allclose(axes.lines[0].get_xdata(), x)


@pytest.mark.slow
def test_a_pdf_has_fonts_that_journals_take(run, short_sweep, tmp_path):
    path = tmp_path / "figure.pdf"
    assert run("compare", short_sweep, *BOTH, "--figure", path).status == 0
    assert b"/Type3" not in path.read_bytes()
    figure = Figure()
    figure.subplots().set_xlabel("of one's own")
    save_figure(figure, path)
    assert b"/Type3" not in path.read_bytes()
    with pytest.raises(ValueError, match=r"must end in .png, .pdf, .svg"):
        save_figure(figure, tmp_path / "figure.eps")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--tangential", "coulomb,columb"), "did you mean"),
        (("--tangential", ","), "at least one"),
        (("--tangential", "coulomb,coulomb"), "repeated"),
        (("--quantity", "e_t", *BOTH), "did you mean 'tangential_restitution'"),
        (("--quantity", "psi3", *BOTH), "did you mean 'psi2'"),
        (("--figure", "figure.bmp"), ".png"),
        (("--json", "--csv"), "not allowed"),
        (("--set", "annuli=3", *BOTH), "--set tangential.annuli=..."),
    ],
)
def test_bad_input(run, short_sweep, arguments, words):
    ran = run("compare", short_sweep, *arguments)
    assert ran.status == 2
    assert ran.out == ""
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err


def test_a_quantity_that_there_is_not_is_refused_before_anything_is_run(
    run, short_sweep, monkeypatch
):
    monkeypatch.setattr(command, "compare", None)
    ran = run("compare", short_sweep, *BOTH, "--quantity", "psi3")
    assert ran.status == 2
    assert "--quantity" in ran.err


def test_failed_law_is_a_gap_and_status_1(run, tmp_path):
    path = tmp_path / "stiff.toml"
    path.write_text("[nondimensional]\npsi1 = 1.0\nchi = 1000.0\n", encoding="utf-8")
    settings = ("--set", "integrator.steps=5", "--set", "integrator.refine=false")
    ran = run("compare", path, "--json", "--tangential", "annulus,coulomb", *settings)
    content = json.loads(ran.out)
    assert ran.status == 1
    assert content["laws"]["annulus"]["values"]["psi2"] is None
    assert content["laws"]["annulus"]["status"] == "TOO_FEW_STEPS"
    assert "annulus" in ran.err


def test_failure_at_a_measured_point_is_told_too(run, tmp_path):
    path = tmp_path / "stiff.toml"
    path.write_text(
        "[nondimensional]\npsi1 = 1.0\nchi = 1.0\n[[measured]]\nquantity = 'psi2'\n"
        "against = 'chi'\nsource = 'made up'\nx = [1.0, 1000.0]\nvalues = [0.1, 0.2]\n",
        encoding="utf-8",
    )
    settings = ("--set", "integrator.steps=40", "--set", "integrator.refine=false")
    ran = run("compare", path, "--integrator", "symplectic", "--tangential", "springs", *settings)
    assert ran.status == 1
    assert "springs, at the measured values of psi2 (1 of 2): The steps are too few" in ran.err


def test_an_answer_that_is_not_sound_is_no_number(short_sweep):
    """Energy from nothing ends UNBALANCED, with a psi2 that must not get into a table."""
    scene = read_scene(short_sweep).scene
    comparison = compare(scene, {"creator": Simulation(tangential=Creator())})
    assert np.isnan(comparison.values("psi2", "creator")).tolist() == [False, True, True]
    assert "creator (2 of 3)" in comparison.failures()[0]
    with pytest.raises(ValueError, match=r"scene = 3\.0"):
        compare(3.0, {})


def test_no_difference_is_largest_where_a_law_gave_no_answer(measured):
    creator = {"creator": Simulation(tangential=Creator())}
    (agreement,) = compare(read_scene(measured), creator).agreements
    assert np.isnan(agreement.where_largest("creator"))
    assert np.isnan(agreement.largest("creator"))


def test_single_scene_object_can_be_compared(short_sweep):
    file = read_scene(short_sweep)
    comparison = compare(file.scene, {"rigid": file.laws.simulation()})
    assert comparison.names == ["rigid"]
    assert comparison.agreements == ()
    assert comparison.failures() == []


def test_psi1_and_chi_stand_in_place_of_a_file(run):
    ran = run("compare", "--psi1", "0:6:4", "--chi", 1.18, *BOTH, "--json")
    assert ran.status == 0
    psi2 = json.loads(ran.out)["laws"]["coulomb"]["values"]["psi2"]
    assert psi2 == pytest.approx([max(psi1 - 4 * 1.18, 0.0) for psi1 in (0.0, 2.0, 4.0, 6.0)])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--psi1", 1), "--chi: must be given too"),
        (("--chi", 1), "--psi1: must be given too"),
        (("--psi1", "0:6:4", "--chi", "1:2:3"), "only one may be a range"),
    ],
)
def test_half_given_or_doubly_varied_numbers_are_refused(run, given, words):
    ran = run("compare", *given)
    assert ran.status == 2
    assert words in ran.err


def test_numbers_beside_a_file_are_refused(run, short_sweep):
    ran = run("compare", short_sweep, "--psi1", 1, "--chi", 1)
    assert ran.status == 2
    assert "leave out the file" in ran.err


@pytest.mark.slow
def test_loops_of_laws_that_have_steps(run, ball, tmp_path):
    picture = tmp_path / "loops.svg"
    laws = "springs,mindlin_cap,coulomb"
    done = run("compare", ball, "--tangential", laws, "--loops", str(picture))
    text = picture.read_text()
    assert "mindlin_cap" in text
    assert "oscillating load" in text
    assert "coulomb" not in text
    assert "coulomb is left out" in done.err
