"""`contactlab fit` and `contactlab materials`."""

import csv
import json

import pytest

from contactlab_fit import estimation
from tests.cli.conftest import EXAMPLES
from tests.longer import longer

KHARAZ = EXAMPLES / "kharaz2001.toml"
VISCOELASTIC = "viscoelastic (restitution=%s)"
HALF = "options = { normal = { restitution = 0.5 } }"
E_T = ("--quantity", "tangential_restitution")


def test_kharaz_gives_the_friction_that_was_found_by_hand(run):
    ran = run("fit", KHARAZ, *E_T, "--json", "--bootstrap", 40)
    one = json.loads(ran.out)["parameters"]["friction_coefficient"]
    assert ran.status == 0
    assert one["value"] == pytest.approx(0.0933, abs=5e-5)
    assert one["interval_95"][0] < 0.092 < one["interval_95"][1]  # the authors' own
    assert one["bootstrap_95"][0] < 0.092 < one["bootstrap_95"][1]
    assert json.loads(ran.out)["rms"]["tangential_restitution"] < 0.015


@pytest.mark.parametrize(
    "laws",
    [["exact", "coulomb"],
     *longer(["exact", "coulomb", "mindlin_cap"])],
)  # fmt: skip
def test_laws_are_ranked_on_kharaz(run, tmp_path, laws):
    table, picture = tmp_path / "residuals.csv", tmp_path / "fit.png"
    ran = run("fit", KHARAZ, *E_T, "--tangential", ",".join(laws), "--bootstrap", 0,
              "--residuals", table, "--figure", picture, "--json")  # fmt: skip
    ranking = json.loads(ran.out)["ranking"]
    assert [one["law"] for one in ranking] == laws
    criteria = [one["fit"]["aic"] for one in ranking]
    assert criteria[1] - criteria[0] > 10.0
    rms = [one["fit"]["rms"]["tangential_restitution"] for one in ranking]
    assert rms == pytest.approx([0.0119, 0.0463, 0.0888][: len(laws)], abs=2e-4)
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert [row["law"] for row in rows].count("coulomb") == 11
    first = rows[0]
    difference = float(first["measured"]) - float(first["predicted"])
    assert float(first["residual"]) == pytest.approx(difference, abs=1e-12)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_tables(run, impacts):
    ran = run("fit", impacts, KHARAZ, "--tangential", "exact,coulomb", "--bootstrap", 5)
    assert ran.status == 0
    assert "friction_coefficient" in ran.out
    assert "bootstrap from" in ran.out
    assert "laws by fit" in ran.out
    ranked = ran.out.partition("laws by fit")[2].splitlines()[3:5]
    behind = [float(row.split()[1]) for row in ranked]
    assert behind[0] == 0.0 <= behind[1]
    assert "columns not used: # remark" in ran.out


def test_a_column_is_named_on_the_command_line(run, impacts):
    plain = run("fit", impacts, KHARAZ, "--bootstrap", 0, "--json")
    text = impacts.read_text(encoding="utf-8")
    impacts.write_text(text.replace("angle (deg)", "a = 1 [deg]"), encoding="utf-8")
    named = ("--column", "a = 1 [deg]=incidence_angle")
    ran = run("fit", impacts, KHARAZ, "--bootstrap", 0, "--json", *named)
    assert ran.status == 0
    assert json.loads(ran.out) == json.loads(plain.out)
    assert "write HEADING=NAME" in run("fit", impacts, KHARAZ, "--column", "angle").err


def test_a_parameter_has_a_row_with_its_intervals(run, impacts):
    options = ("--tangential", "coulomb", "--bootstrap", 5)
    ran = run("fit", impacts, KHARAZ, *options)
    found = json.loads(run("fit", impacts, KHARAZ, *options, "--json").out)
    one = found["parameters"]["friction_coefficient"]
    (row,) = [row for row in ran.out.splitlines() if row.startswith("friction_coefficient")]
    told = [float(number) for number in row.split()[1:]]
    expected = [one["value"], one["standard_error"], *one["interval_95"], *one["bootstrap_95"]]
    assert told == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("own", "options", "laws"),
    [
        ("", (), "exact elastic law (tabulated rebound)"),
        ("", ("--normal", "hertz"), "exact elastic law (tabulated rebound)"),
        ('normal = "hertz"\ntangential = "springs"', (), "exact elastic law (tabulated rebound)"),
        ('normal = "viscoelastic"', (), f"{VISCOELASTIC % 0.9}, partial slip (tabulated rebound)"),
        (f'normal = "viscoelastic"\n{HALF}', (), VISCOELASTIC % 0.5),
        pytest.param(f'normal = "tsuji"\n{HALF}',
                     ("--normal", "hunt_crossley", "--tangential", "coulomb"),
                     "hunt_crossley (restitution=0.9), coulomb, events",
                     marks=pytest.mark.slow),
        ("", ("--set", "normal.restitution=0.8", "--normal", "tsuji"), "tsuji (restitution=0.8)"),
        ("", ("--tangential", "springs", "--integrator", "paper"), "hertz, springs, paper"),
    ],
)  # fmt: skip
def test_laws_are_those_of_the_file_and_of_the_options(run, impacts, tmp_path, own, options, laws):
    """The exact law is the table unless a normal law or an option is asked for."""
    bodies = tmp_path / "bodies.toml"
    steel = "radius = 0.01\nmaterial = 'steel'"
    bodies.write_text(
        f"[sphere]\n{steel}\n[target]\nkind = 'half-space'\nmaterial = 'steel'\n[impact]\n"
        f"speed = 2.0\n[simulation]\n{own}\n",
        encoding="utf-8",
    )
    ran = run("fit", impacts, bodies, "--bootstrap", 0, "--json", *options)
    assert json.loads(ran.out)["laws"].startswith(laws)


@pytest.mark.slow
def test_cautions_are_told_of_every_law(run):
    options = ("fit", KHARAZ, *E_T, "--tangential", "exact,coulomb", "--bootstrap", 0)
    content = json.loads(run(*options, "--json").out)
    exact, coulomb = (one["fit"]["cautions"] for one in content["ranking"])
    assert content["cautions"] == exact
    assert any("friction_coefficient by up to" in text for text in exact)
    text = run(*options).out
    assert all(f"caution: {one}" in text for one in exact)
    assert all(text.count(one) == 1 for one in [*exact, *coulomb])


@pytest.mark.slow
def test_the_notes_lead_from_a_csv_of_soft_data_to_its_friction(run, tmp_path):
    """Each command does what the words before it say; made with mu .35, e .75, beta0 .1."""
    data, bodies = tmp_path / "soft.csv", tmp_path / "bodies.toml"
    numbers = (
        (10, 14.77, 2.38), (20, 14.10, 4.69), (30, 12.99, 6.86), (40, 11.49, 8.82),
        (50, 9.64, 10.51), (60, 7.50, 11.88), (68, 5.62, 13.95), (74, 4.13, 15.85),
    )  # fmt: skip
    rows = ["angle_deg,vn (m/s),rebound_tangential_velocity (m/s)"]
    rows += [f"{angle},{normal},{along}" for angle, normal, along in numbers]
    data.write_text("\n".join(rows), encoding="utf-8")
    bodies.write_text(
        "[sphere]\nradius = 0.02134\nmaterial = 'nylon'\n[target]\nkind = 'half-space'\n"
        "material = 'steel'\n[impact]\nspeed = 20.0\n",
        encoding="utf-8",
    )
    command = ("fit", data, bodies, "--bootstrap", 0)
    positive = run(*command, "--column", "vn (m/s)=rebound_normal_velocity (m/s)")
    assert "--column 'vn (m/s)=-rebound_normal_velocity (m/s)' reads it so" in positive.err
    command += ("--column", "vn (m/s)=-rebound_normal_velocity (m/s)")
    assert "fit restitution too: that of normal=viscoelastic" in run(*command).err
    both = run(*command, "--fit", "friction_coefficient,restitution").out
    assert "Fit shear_loss" in both
    names = "friction_coefficient,restitution,beta0"
    ran = run(
        *command, "--fit", names, "--normal", "tsuji,hertz", "--tangential", "walton", "--json"
    )
    first, second = json.loads(ran.out)["ranking"]
    assert (first["law"], second["law"]) == ("tsuji", "hertz")
    assert first["fit"]["parameters"]["friction_coefficient"]["value"] == pytest.approx(0.35, 0.03)
    assert list(second["fit"]["parameters"]) == [
        "friction_coefficient", "tangential.beta0"
    ]  # fmt: skip
    assert ran.status == 0


@pytest.mark.slow
def test_restitution_comes_out_of_kharaz(run):
    """Of e_t and the rebound angle: nearer to 1 than the 0.98 that is quoted beside them."""
    ran = run("fit", KHARAZ, "--fit", "friction_coefficient,restitution",
              "--quantity", "tangential_restitution,rebound_angle_deg",
              "--bootstrap", 0, "--json")  # fmt: skip
    content = json.loads(ran.out)
    found = content["parameters"]["normal.restitution"]
    assert found["value"] == pytest.approx(0.994, abs=0.002)
    assert found["interval_95"] == pytest.approx([0.984, 1.0], abs=0.002)
    assert content["laws"].startswith("viscoelastic (restitution=0.99")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--fit", "mu"), "did you mean 'friction_coefficient'"),
        (("--fit", "stiffness_ratio"), "measure tangential_restitution at angles"),
        (("--tangential", "exakt"), "'exakt'"),
        (("--normal", "herz"), "did you mean 'hertz'"),
        (("--quantity", "spin"), "was not measured"),
        (("--bootstrap", "-1"), "--bootstrap"),
        (("--set", "normal.stiffness=1"), "stiffness"),
        (("--figure", "a.jpg"), "must end in .png"),
    ],
)
def test_bad_input_is_one_line_and_status_2(run, impacts, arguments, words):
    ran = run("fit", impacts, KHARAZ, *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err


@pytest.mark.parametrize(
    ("files", "words"),
    [
        (["a.csv"], "SCENE.toml with"),
        (["none.csv", KHARAZ], "none.csv: no such file"),
        ([EXAMPLES / "steel_ball.toml"], "has no [[measured]] values"),
        ([KHARAZ, KHARAZ], "SCENE.toml with"),
        (["a.csv", "b.csv", KHARAZ], "FILE = a.csv b.csv"),
        (["none.toml"], "none.toml: no such file"),
    ],
)
def test_files_that_are_not_there_or_too_many(run, files, words):
    ran = run("fit", *files)
    assert (ran.status, ran.out) == (2, "")
    assert words in ran.err


def test_the_data_are_not_written_over(run, impacts):
    before = impacts.read_text(encoding="utf-8")
    ran = run("fit", impacts, KHARAZ, "--residuals", impacts)
    assert ran.status == 2
    assert "is the same file" in ran.err
    assert impacts.read_text(encoding="utf-8") == before


@pytest.mark.slow
def test_a_law_that_cannot_be_fitted_is_said_and_the_others_stay(run):
    ran = run("fit", KHARAZ, *E_T, "--fit", "stiffness_ratio", "--tangential", "exact,coulomb",
              "--bootstrap", 0)  # fmt: skip
    assert ran.status == 1
    assert "exact" in ran.out
    assert "coulomb: the data do not determine stiffness_ratio" in ran.err


def test_an_interruption_keeps_what_is_done(run, impacts, monkeypatch, tmp_path):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(estimation, "_solve_again", interrupted)
    ran = run("fit", impacts, KHARAZ, "--residuals", tmp_path / "r.csv")
    assert ran.status == 130
    assert "friction_coefficient" in ran.out
    assert ran.out.endswith("not complete: interrupted\n")
    assert len((tmp_path / "r.partial.csv").read_text(encoding="utf-8").splitlines()) == 5
    content = json.loads(run("fit", impacts, KHARAZ, "--json").out)
    assert content["complete"] is False
    assert content["parameters"]["friction_coefficient"]["bootstrap_95"] is None


def test_materials_are_listed_and_told_with_their_sources(run):
    ran = run("materials")
    assert ran.status == 0
    assert "soda-lime glass" in ran.out
    assert "'soda-lime glass' or 'borosilicate glass'" in run("materials", "glass").err
    one = run("materials", "soda-lime glass").out
    assert "dowling, table 5.2" in one
    assert "Mechanical Behavior of Materials" in one
    assert json.loads(run("materials", "steel", "--json").out)["materials"][0]["density"] == 7850.0
    assert run("materials", "steal").status == 2
