"""What the README says is printed is printed."""

import contextlib
import io
import json
import re
import sys
import types

import numpy as np
import pytest

from contactlab import Simulation, create, read_scene
from contactlab.cli import guide
from contactlab.cli.main import main
from contactlab.impact.hertz import peak_pressure
from contactlab.registry.registry import REGISTRY
from contactlab.testing import CHECKS, Verdict, check_law
from tests.present import ROOT, needs_sources

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
EXAMPLES = ROOT / "examples"
LAWS, STARTING = (guide.text(topic) for topic in ("laws", "getting-started"))
SNIPPETS = re.findall(r"```python\n(.*?)```\n", TEXT, re.DOTALL)
#: Words above which a newcomer sees too much before the first picture of their own.
MOST_WORDS = 900


def run(code):
    """Run a snippet as a module of its own; return what it defines and prints."""
    module = types.ModuleType("README")
    sys.modules["README"] = module  # a class must be found again to be copied
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), vars(module))
    return module, printed.getvalue()


def test_four_lines_end_in_a_plot_of_the_ball_of_the_moving_picture(tmp_path, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    (code,) = SNIPPETS
    assert len([line for line in code.splitlines() if line]) == 4
    monkeypatch.chdir(tmp_path)
    pyplot.close("all")  # of tests before
    try:
        module, _ = run(code)
        (number,) = pyplot.get_fignums()
        (axes,) = pyplot.figure(number).axes
        assert len(axes.lines) == 4  # the force, zero and the limits
    finally:
        pyplot.close("all")
    assert (tmp_path / "impact.png").read_bytes().startswith(b"\x89PNG")
    thrown = read_scene(EXAMPLES / "thrown_ball.toml").scene
    assert (module.scene.psi1, module.scene.chi) == (thrown.psi1, thrown.chi)


def test_there_are_few_words():
    assert len(TEXT.split()) <= MOST_WORDS


@needs_sources
def test_the_caption_of_the_moving_picture_is_what_the_contact_does():
    """Slip forward everywhere, stick everywhere, then slip backward outside and stick within."""
    scene = read_scene(EXAMPLES / "thrown_ball.toml").scene
    told = " ".join(TEXT.split())
    assert f"psi1 = {scene.psi1:.2f}, chi = {scene.chi:.2f}" in told
    assert "slips forward (blue), sticks (grey), then slips backward from its rim inwards" in told
    history = Simulation().run(scene, history="fields").check().history
    touching = history.fields["radius"] <= history.contact_radius[:, None]
    shares = {}
    for name, sign in (("forward", 1.0), ("backward", -1.0)):
        slips = touching & (history.fields["slipping"] * sign > 0.0)
        shares[name] = slips.sum(axis=1) / touching.sum(axis=1).clip(1)
    forward, backward = (np.flatnonzero(shares[name] > 0.05) for name in ("forward", "backward"))
    sticks = np.flatnonzero((shares["forward"] < 0.05) & (shares["backward"] < 0.05))
    assert shares["forward"][forward[1] : forward[-2]].min() == 1.0
    assert forward[-1] < sticks[len(sticks) // 2] < backward[0]
    middle = backward[len(backward) // 3]
    slips = np.flatnonzero(history.fields["slipping"][middle][touching[middle]])
    assert slips[0] > 0
    assert slips[-1] == touching[middle].sum() - 1
    assert backward[-1] > 0.98 * len(shares["backward"])


@needs_sources
def test_links_and_pictures_lead_to_files():
    for target in re.findall(r"\]\(([^)]+)\)", TEXT):
        path, _, anchor = target.partition("#")
        assert (ROOT / path).is_file(), target
        if anchor:
            headings = re.findall(r"^#+ (.*)$", (ROOT / path).read_text("utf-8"), re.MULTILINE)
            assert anchor in {re.sub(r"[^\w -]", "", h).lower().replace(" ", "-") for h in headings}


def test_the_commands_take_any_python_of_the_least_version():
    least = re.search(r'requires-python = ">=(.*)"', (ROOT / "pyproject.toml").read_text("utf-8"))
    assert f"Python {least[1]}" in TEXT
    assert re.findall(r"python3[\d.]*(?= -m venv)", TEXT) == ["python3", "python3"]


def test_the_first_command_shows_what_it_does():
    """Packages come from a network: pip tells which, and how much of each has come."""
    command = TEXT.partition("<!-- main job -->")[2].partition("<!-- end -->")[0]
    assert "pip install ." in command
    assert "-q" not in command


def test_the_moving_picture_is_small():
    assert (ROOT / "examples" / "pictures" / "impact.gif").stat().st_size < 1_500_000


def test_the_table_of_errors_names_every_law():
    """But for the one that makes no force, and laws of other distributions."""
    table = LAWS.partition("## Error against run time")[2].partition("\n## ")[0]
    told = set(re.findall(r"^\| `(\w+)`", table, re.MULTILINE))
    ours = {
        info.name.partition(".")[2]
        for info in REGISTRY.installed()
        if info.kind == "tangential" and info.distribution == "contactlab"
    }
    assert told == ours - {"frictionless"}


def test_the_law_of_ones_own_passes_the_kit_as_it_stands():
    blocks = re.findall(r"```python\n(.*?)```", LAWS, re.DOTALL)
    module, _ = run(next(code for code in blocks if "Smoothed" in code))
    found = check_law(module.Smoothed())
    assert {item.verdict for item in found} >= {Verdict.PASSED, Verdict.EXPECTED_FAILURE}
    told = re.search(r"conformance kit: (\d+) of its (\d+) small named checks", LAWS)
    assert told, "the guide should say how many checks apply"
    assert (len(found), len(CHECKS)) == (int(told[1]), int(told[2]))


def printed(*arguments):
    """Return what a command prints as JSON."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
        assert main([*map(str, arguments), "--json"]) == 0
    return json.loads(out.getvalue())


def rows(section, text=TEXT):
    """Return the rows of the table of a section, without heading."""
    part = text.partition(section)[2].partition("\n## ")[0]
    lines = [line for line in part.splitlines() if re.match(r"^\| (?!!|\|)", line)]
    return [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in lines[1:]]


def close(told, value):
    """Compare a number of the README, of one digit or two, with the one that it rounds."""
    if float(told) == 0.0:
        return abs(value) < 1e-6
    digits = len(told.lower().partition("e")[0].replace(".", "").lstrip("0"))
    return abs(value / float(told) - 1.0) <= (0.35 if digits == 1 else 0.06)


@pytest.mark.slow
def test_the_table_of_laws_is_what_the_command_prints():
    scores = {one["law"]: one for one in printed("compare", "--all")["scores"]}
    table = rows("## What discrete-element codes do", LAWS)
    assert len(table) == 11
    for name, *told in table:
        law, _, form = name.removeprefix("rigid ").partition(",")
        form = form.split()[0] if law == "mindlin_cap" else ""
        one = scores[f"{law} {form}".strip().removesuffix(" displacement")]
        found = [one[key] for key in ("rms", "worst", "energy_made", "pressed_force")]
        for number, value in zip(told, found, strict=True):
            assert value is None if number == "-" else close(number, value), (name, number, value)
        assert one["numerical_error"] < 0.005


def test_the_table_of_the_experiment_is_what_the_command_prints():
    measured = printed("compare", ROOT / "examples" / "kharaz2001.toml")["measured"]
    for name, *told in rows("## The experiment"):
        law = name.partition(" ")[0]
        for series, rms in zip(measured, told, strict=True):
            assert close(rms.removesuffix(" rad/s").rstrip("°"), series["laws"][law]["rms"])


def test_the_distance_of_the_springs_and_of_the_codes():
    """What the README says of the picture stands in the table that the command prints."""
    told = {name: cells for name, *cells in rows("## What discrete-element codes do", LAWS)}
    assert float(told["springs"][1]) <= 1e-4
    worst = [float(cells[1]) for name, cells in told.items() if name.startswith("mindlin_cap")]
    assert f"{min(worst)} to {max(worst)} in psi2" in " ".join(TEXT.split())


def test_the_numbers_of_ones_body():
    """Each is that of the guide, or what the scene that stands beside it gives."""
    told = " ".join(TEXT.partition("## Your body")[2].partition("## Install")[0].split())
    engines = rows("## What it changes", guide.text("engines"))
    worst = {law: cells[0] for _, law, *cells in engines}
    own, ours = worst["`mindlin/force`"], worst["`mindlin_springs`, 8 springs"]
    assert f"{own} with LAMMPS's `mindlin/force`, {ours} with eight springs" in told
    thrown = re.search(r"throw of ([\d.]+°) by contactlab, ([\d.]+°)", guide.text("engines"))
    assert f"{thrown[1]}, pooltool's default {thrown[2]}" in told
    falling = dict(re.findall(r"^ +(\d+)° +([\d.]+)", guide.text("any-two-bodies"), re.MULTILINE))
    assert f"tilted by 30°: its end rebounds with {falling['30']} m/s" in told
    foot = read_scene(EXAMPLES / "foot.toml")
    for law, slip in (("fronts", 0.342), ("coulomb", 0.0)):
        result = Simulation(tangential=law).run(foot.scene).check()
        assert result.rebound_slip_velocity == pytest.approx(slip, abs=5e-4)
    assert foot.scene.slip_velocity < 0.0
    assert "slips back at 0.34 m/s" in told
    club: dict[str, object] = {}
    exec((EXAMPLES / "toe_shot.py").read_text("utf-8").partition("# %%")[0], club)
    spins = []
    for law in ("springs", "coulomb"):
        normal = create("normal.viscoelastic", restitution=0.8)
        shot = club["shot"](0.015, Simulation(normal=normal, tangential=law))
        spins.append(round(-shot.spin[1] / (2.0 * np.pi) * 60.0))
        if law == "springs":
            wide = shot.result.motion.maximum_radius / club["ball"].radius
            assert wide == pytest.approx(0.48, abs=0.005)
            assert "contact radius over R" in str(shot.plan)
    assert "backspin 15 mm off the toe: {} rpm, rigid {}".format(*spins) in told


def test_the_pressure_of_the_first_scene():
    first = re.search(r"```python\n(.*?)```", STARTING, re.DOTALL)[1]
    module, _ = run(first)
    pressure = float(peak_pressure(module.scene)) / 1e9
    words = " ".join(STARTING.split())
    assert f"{pressure:.1f} GPa in this impact" in words
    assert f"above {pressure / 1.6:.1f} GPa stays elastic" in words


def test_nothing_is_said_of_codes_or_times_that_no_command_prints():
    for words in ("mostly meet", "compiled", "2.5 µs", "busy machine", "No constant is fitted"):
        for text in (TEXT, LAWS):
            assert words not in text.replace("compiled_codes.toml", "")
