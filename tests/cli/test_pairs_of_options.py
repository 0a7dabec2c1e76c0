"""Every command with every pair of its options: an answer, or one sentence that refuses."""

import itertools
import json

import pytest

from tests.present import of_commands
from tests.short_animations import shorten

#: Options with a value that serves; ``{}`` is a folder of the test.
LAWS = (
    "--normal hertz", "--tangential springs", "--integrator symplectic",
    "--set tangential.springs=12",
)  # fmt: skip
LOOKS = ("--style slides", "--width one", "--no-progress")
NUMBERS = ("--psi1 1.2", "--chi 1.44")
GRID = ("--psi1 0:4:3", "--chi 1")
COMMANDS = {
    "run": (
        "{ball}", "{foot}", *NUMBERS, "--psi1 0:4:3", *LAWS, *LOOKS, "--json", "--csv",
        "--out {}/out.json", "--history {}/history.csv", "--figure {}/figure.svg",
        "--stick-slip {}/map.svg", "--no-estimate-error",
    ),
    "sweep": (
        "{short}", "{foot}", *GRID, *LAWS, *LOOKS, "--json", "--csv", "--out {}/out.csv",
        "--resume", "--figure {}/figure.svg",
    ),
    "compare": (
        "{short}", *GRID, *LAWS, *LOOKS, "--quantity psi2", "--json", "--csv",
        "--out {}/table.json", "--restitution 0.8", "--figure {}/figure.svg",
        "--loops {}/loops.svg", "--column psi1=psi1",
    ),
    "explore": (
        "--angle 20", "--speed 3", "--spin 0", "--friction 0.2", "--radius 0.02",
        "--inertia-ratio 0.4",
        "--restitution 0.8", "--material steel", "--block brass", "--predict", "--out {}/page.html",
    ),
    "bench": (
        "--integrator symplectic", "--time-limit 0.2", *LOOKS, "--figure {}/figure.svg",
        "--out {}/table.csv", "--csv", "--json", "--markdown",
    ),
    "stability": (
        "--integrator symplectic", "--time-limit 0.2", *LOOKS, "--out {}/table.json", "--csv",
        "--json",
    ),
    "figures": (*LAWS, *LOOKS, "--only 4", "--format pdf"),
    "fit": (
        "--fit friction_coefficient", "--tangential coulomb,mindlin_cap", "--normal hertz",
        "--integrator symplectic", "--set tangential.springs=12",
        "--quantity tangential_restitution", "--bootstrap 3", "--column angle=incidence_angle",
        *LOOKS, "--figure {}/figure.svg", "--residuals {}/table.csv", "--json",
        "--restitution 0.8",
    ),
    "report": (
        "{ball}", "{short}", "{foot}", "--tangential coulomb,frictionless", "--normal hertz",
        "--integrator symplectic", "--restitution 0.8", "--measured {impacts}",
        "--column angle=incidence_angle", "--no-progress",
    ),
    "animate": (
        "{ball}", "{foot}", *NUMBERS, "--tangential springs", "--ghost coulomb", "--no-progress",
    ),
    "cite": ("--normal jkr,hertz", "--tangential springs", "--integrator symplectic"),
    "kernel": ("--out {}/kernel",),
    "materials": ("--json",),
    "plugins": (),
    "guide": ("laws",),
}  # fmt: skip
#: Options that stand before each pair, so that a command is short, or has what it needs.
ALWAYS = {
    "bench": "--quick --tangential coulomb",
    "stability": "--quick --tangential coulomb",
    "figures": "--out {} --only 2",
    "fit": "{impacts} {ball} --bootstrap 0",
    "report": "--out {}/page.html",
    "animate": "--out {}/impact.gif",
}
#: Commands whose options of looks, read by one function for all, are tried alone: `run`, `sweep`
#: and `compare` try them beside every other option.
ALONE = {"bench", "stability", "figures", "fit", "report", "animate"}
PAIRS = [
    (command, pair)
    for command, options in of_commands(*COMMANDS.items())
    for count in range(3)
    for pair in itertools.combinations(options, count)
    if not (count == 2 and command in ALONE and set(LOOKS) & set(pair))
]
#: What makes a comparison short: scenes of few impacts, or laws without an annulus.
SHORT = {"{short}", "--psi1 0:4:3", "--tangential springs"}


def long(command, pair):
    """Return whether a pair takes long, or is of an option that meets any other alike."""
    if len(pair) == 2 and (command == "explore" or set(LOOKS) & set(pair)):
        return True
    default = command == "compare" and pair and not SHORT & set(pair)
    page = command == "report" and len(pair) == 2
    several = page or command in {"bench", "stability", "figures", "fit", "animate"}
    return several or default or ".svg" in str(pair)


CASES = [
    pytest.param(*each, marks=[pytest.mark.slow] if long(*each) else [], id=" ".join(
        [each[0], *each[1]]
    ))
    for each in PAIRS
]  # fmt: skip


@pytest.mark.parametrize(("command", "pair"), CASES)
def test_a_pair_is_answered_or_refused(
    run, ball, short_sweep, impacts, tmp_path, monkeypatch, command, pair
):
    monkeypatch.chdir(tmp_path)
    shorten(monkeypatch)
    places = {
        "{}": tmp_path, "{ball}": ball, "{foot}": ball.with_name("foot.toml"),
        "{short}": short_sweep, "{impacts}": impacts,
    }  # fmt: skip
    words = " ".join((ALWAYS.get(command, ""), *pair))
    for mark, place in places.items():
        words = words.replace(mark, str(place))
    ran = run(command, *words.split())
    if ran.status == 2:
        assert ran.out == ""
        assert len(ran.err.splitlines()) == 1
        assert ran.err.startswith(f"contactlab {command}: error: ")
        return
    assert ran.status == 0
    assert ran.out or ran.err
    for option in pair:
        if "{}" in option:
            written = tmp_path / option.rpartition("/")[2]
            if "no figure drawn: nothing was measured" in ran.err and not written.exists():
                continue  # the limit of time was reached before
            assert written.is_dir() or written.stat().st_size > 0
    if "--json" in pair:
        json.loads(ran.out)
