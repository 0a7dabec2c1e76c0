"""What the README says is printed is printed."""

import contextlib
import io
import json
import re
import sys
import tomllib
import types

import numpy as np
import pytest

from contactlab import (
    Scene,
    Simulation,
    compare,
    create,
    plugin_manager,
    read_scene,
    register,
)
from contactlab.cli import guide
from contactlab.cli.main import main
from contactlab.impact.hertz import peak_pressure
from contactlab.registry.registry import REGISTRY
from contactlab.testing import Verdict, examine
from tests.present import ROOT, extra, needs_sources

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
EXAMPLES = ROOT / "examples"
LAWS, STARTING = (guide.text(topic) for topic in ("laws", "getting-started"))
SWAP, OWN_LAW = re.findall(r"```python\n(.*?)```\n", TEXT, re.DOTALL)
#: Words without code above which a newcomer sees too much; words a sentence, on average.
MOST_WORDS, MOST_OF_A_SENTENCE = 880, 20


def run(code):
    """Run a snippet as a module of its own; return what it defines and prints."""
    module = types.ModuleType("README")
    sys.modules["README"] = module  # a class must be found again to be copied
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), vars(module))
    return module, printed.getvalue()


def test_eight_lines_swap_a_law_print_and_end_in_the_picture_below_them(tmp_path, monkeypatch):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    assert len([line for line in SWAP.splitlines() if line]) == 8
    monkeypatch.chdir(tmp_path)
    pyplot.close("all")  # of tests before
    try:
        module, told = run(SWAP)
        (axes,) = pyplot.figure(pyplot.get_fignums()[0]).axes
        assert [len(line.get_xdata()) for line in axes.lines] == 3 * [71]
    finally:
        pyplot.close("all")
    assert f"```text\n{told}```" in TEXT
    assert (tmp_path / "swap.png").read_bytes().startswith(b"\x89PNG")
    assert module.scene.psi1[12] == pytest.approx(1.2)


@needs_sources
def test_the_example_swaps_the_laws_as_the_readme_does():
    example = (EXAMPLES / "law_swap.py").read_text("utf-8").replace("law_swap.png", "swap.png")
    assert set(SWAP.splitlines()) <= set(example.splitlines())


@pytest.mark.slow
def test_the_law_of_ones_own_is_checked_and_priced_as_told():
    law = run(OWN_LAW)[0].Smooth()
    found = examine(law)
    verdicts = [item.verdict for item in found]
    told = " ".join(TEXT.split())
    assert f"{verdicts.count(Verdict.PASSED)} checks pass. One fails, `turning_points`," in told
    assert [item.check for item in found if item.verdict is Verdict.FAILED] == ["turning_points"]
    scene = Scene.nondimensional(psi1=np.linspace(0.0, 6.0, 121), chi=1.4412)
    laws = {"exact": Simulation(), "smooth": Simulation(tangential=law)}
    compared = compare(scene, laws | {"annulus": Simulation(tangential="annulus")})
    own, paper = (np.abs(compared.difference("psi2", name)).max() for name in compared.names[1:])
    assert f"off by up to {own:.2f} in psi2, and the paper's annuli by {paper:.3f}" in told


def test_the_law_of_ones_own_is_registered_by_the_lines_that_follow_it():
    """As its entry point names it, and as ``register`` does without a name."""
    (points,) = re.findall(r"```toml\n(.*?)```\n", TEXT, re.DOTALL)
    group = tomllib.loads(points)["project"]["entry-points"]["contactlab"]
    module, _ = run(OWN_LAW)
    assert group == {"tangential.smooth": f"smooth:{module.Smooth.__name__}"}
    assert "`contactlab.register(Smooth)`" in TEXT
    assert [register(module.Smooth)] == [*group]
    try:
        scene = Scene.nondimensional(psi1=1.2, chi=1.4412)
        assert abs(Simulation(tangential="smooth").run(scene).check().psi2) < 1e-3
    finally:
        plugin_manager().unregister(module.Smooth)


def test_there_are_few_words_and_short_sentences():
    prose = re.sub(r"```.*?```", "", TEXT, flags=re.DOTALL)  # comments count too
    assert len(prose.split()) <= MOST_WORDS
    lines = [line for line in prose.splitlines() if not line.startswith(("|", "#", "!["))]
    sentences = re.split(r"(?<=[.:?])[*]*\s+", " ".join(lines))
    assert sum(len(each.split()) for each in sentences) <= MOST_OF_A_SENTENCE * len(sentences)


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
        if path.startswith("plugins/") and not (ROOT / path).parent.is_dir():
            continue  # the folder is taken out
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


@extra("contactlab_halfspace")
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


def test_the_numbers_of_who_uses_it():
    """Each is that of the guide, of an example, or what the scene that stands beside it gives."""
    told = " ".join(TEXT.partition("## Who uses it")[2].partition("## Install")[0].split())
    scene = Scene.nondimensional(psi1=np.linspace(0.05, 7.0, 140), chi=1.75)
    coarse = create("integrator.symplectic", steps=50)
    capped = Simulation(tangential="mindlin_cap", integrator=coarse).run(scene).check().psi2
    worst = np.abs(capped - Simulation().run(scene).check().psi2).max()
    (eight,) = re.findall(
        r"`springs` with .* 8 of them \| .*? to ([\d.]+) at", guide.text("choosing")
    )
    assert (
        f"is off by up to {worst:.2f} in psi2; eight springs by {eight} (chi 1.18 to 1.75)" in told
    )
    falling = dict(re.findall(r"^ +(\d+)° +([\d.]+)", guide.text("any-two-bodies"), re.MULTILINE))
    assert f"tilted by 30°: its end rebounds with {falling['30']} m/s" in told
    foot = read_scene(EXAMPLES / "foot.toml")
    for law, slip in (("fronts", 0.342), ("coulomb", 0.0)):
        result = Simulation(tangential=law).run(foot.scene).check()
        assert result.rebound_slip_velocity == pytest.approx(slip, abs=5e-4)
    assert foot.scene.slip_velocity < 0.0
    assert "slips back at 0.34 m/s" in told
    script: dict[str, object] = {}
    code = (EXAMPLES / "throw_of_billiard_balls.py").read_text("utf-8").partition("print(")[0]
    exec(code, script)
    cut = np.radians([20.0])
    mu = script["friction"](1.34 * np.sin(cut))
    thrown, rigid = script["elastic"](cut, 1.34)[0], script["no_slip"](cut, mu)[0]
    assert f"20° cut and 1.34 m/s: {thrown:.2f}°, a published rigid model {rigid:.2f}°" in told


def test_the_toe_shot_is_cautioned_of_its_wide_contact():
    club: dict[str, object] = {}
    exec((EXAMPLES / "toe_shot.py").read_text("utf-8").partition("# %%")[0], club)
    normal = create("normal.viscoelastic", restitution=0.8)
    shot = club["shot"](0.015, Simulation(normal=normal, tangential="springs"))
    wide = shot.result.motion.maximum_radius / club["ball"].radius
    assert wide == pytest.approx(0.48, abs=0.005)
    assert "large contact" in str(shot.plan)


def test_the_rows_of_the_bench_are_those_of_the_guide():
    """Its own table rounds to two digits, that of the guide has the numbers that it prints."""
    guided = {(name, cells[0]): cells for name, *cells in rows("## Error against run time", LAWS)}
    table = rows("## Three reports")
    assert len(table) == 4
    for name, resolution, error, took in table:
        own = name.replace("`fronts`, the default", "`fronts`, `events`")
        parts = [cells for (law, _), cells in guided.items() if law == own]
        numbers = set(re.findall(r"=(\d+)", parts[0][0])) if "exact" not in resolution else set()
        assert numbers <= set(re.findall(r"\d+", resolution))
        assert close(error, float(parts[0][1]))
        assert parts[0][3] == took


def test_the_plan_is_what_the_command_prints(capsys):
    assert main(["run", str(EXAMPLES / "thrown_ball.toml")]) == 0
    (plan,) = re.findall(r"plan\.\n\n```text\n(.*?)```", TEXT, re.DOTALL)
    assert plan in capsys.readouterr().out


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
