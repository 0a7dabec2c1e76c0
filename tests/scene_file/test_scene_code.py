"""A scene runs no code: reading imports nothing, and a law in a file needs the user's word."""

import json
import subprocess
import sys

import pytest

from contactlab import Simulation, create, read_scene
from contactlab.cli.main import main
from tests.longer import longer
from tests.present import of_commands
from tests.short_animations import shorten

#: A friction law that says whether its file ran.
LAW = """
from pathlib import Path
from contactlab_laws.coulomb import Coulomb

Path({ran!r}).write_text("ran")

class Evil(Coulomb):
    pass
"""
SCENE = "[nondimensional]\nchi = 1.0\npsi1 = 9.0\n"
SWEEP = "[nondimensional]\nchi = 1.0\n[sweep]\npsi1 = [8.0, 9.0]\n"


@pytest.fixture
def ran(tmp_path, monkeypatch):
    """Return the path of a file that the law's code writes; the scene's folder is ``scenes``."""
    ran = tmp_path / "ran"
    for folder in ("scenes", "beside", "home"):
        (tmp_path / folder).mkdir()
    for place in ("beside/evil.py", "home/evil.py", "scenes/scene_evil.py"):
        (tmp_path / place).write_text(LAW.format(ran=str(ran)))
    (tmp_path / "scenes" / "link.py").symlink_to(tmp_path / "beside" / "evil.py")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.syspath_prepend(tmp_path / "scenes")
    monkeypatch.chdir(tmp_path / "scenes")
    yield ran
    sys.modules.pop("scene_evil", None)


#: What a scene writes, and the file that the refusal names.
PLACES = {
    "scene_evil.py:Evil": "scenes/scene_evil.py",
    "../beside/evil.py:Evil": "beside/evil.py",
    "{root}/beside/evil.py:Evil": "beside/evil.py",
    "~/evil.py:Evil": "home/evil.py",
    "link.py:Evil": "beside/evil.py",
    "link.py": "beside/evil.py",
    "none.py:Evil": "scenes/none.py",
    "scene_evil:Evil": "scene_evil",
}


def written(folder, name, *, kind="tangential", scene=SCENE, more=""):
    """Return the path of a scene that names a law."""
    path = folder / "scene.toml"
    path.write_text(f"{scene}[simulation]\n{kind} = {json.dumps(name)}\n{more}")
    return path


def refused(error, where):
    """Assert that a refusal names the whole path and the remedy, in one sentence."""
    assert f"{where!r}" in error
    assert "--allow-code" in error
    assert "read_scene(path, allow_code=True)" in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize("kind", ["normal", "tangential", "integrator"])
@pytest.mark.parametrize(("name", "where"), PLACES.items())
@pytest.mark.parametrize("folder", ["", "."])
def test_a_scene_that_names_code_is_read_and_refused(tmp_path, ran, name, where, kind, folder):
    name = name.format(root=tmp_path)
    where = str(tmp_path / where) if "/" in where else where
    path = written(tmp_path / "scenes", name, kind=kind)
    laws = read_scene("scene.toml" if folder else path).laws
    for made in (
        laws.simulation,
        laws.resolve,
        laws.suit if kind == "integrator" else laws.resolve,
        lambda: laws.set({"tangential.share": 1.0}).simulation(),
        lambda: laws.choose(**{kind: getattr(laws, kind)}).simulation(),
        lambda: Simulation(**{kind: getattr(laws, kind)}),
        lambda: create(getattr(laws, kind)),
    ):
        with pytest.raises(ValueError, match="name = ") as error:
            made()
        refused(str(error.value), where)
    assert not ran.exists()


@pytest.mark.parametrize("name", ["../beside/evil.py:Evil", "~/evil.py:Evil", "scene_evil:Evil"])
def test_a_scene_runs_its_code_with_the_users_word(tmp_path, ran, name):
    file = read_scene(written(tmp_path / "scenes", name), allow_code=True)
    assert not ran.exists()
    assert type(file.laws.simulation().tangential).__name__ == "Evil"
    assert ran.exists()


@pytest.mark.usefixtures("ran")
def test_a_law_that_the_caller_names_takes_the_place_of_the_scenes(tmp_path):
    laws = read_scene(written(tmp_path / "scenes", "scene_evil.py:Evil")).laws
    assert type(laws.choose(tangential="springs").simulation().tangential).__name__ == "Springs"
    name = "scene_evil.py:Evil"  # the same words, written by the caller
    assert type(laws.choose(tangential=name).simulation().tangential).__name__ == "Evil"


#: Options that name a file or module beside the law: no option is of such a law.
OPTIONS = (
    "'tangential.evil.py:Evil'.share = 1", "'normal.py:Evil'.share = 1",
    "'tangential.evil:Evil'.share = 1", "share = 1", "'evil.py:Evil'.share = 1",
)  # fmt: skip


@pytest.mark.parametrize("option", OPTIONS)
def test_options_run_no_code(tmp_path, ran, option):
    folder = tmp_path / "scenes"
    for name in ("normal.py", "tangential.evil.py", "evil.py"):
        (folder / name).write_text(LAW.format(ran=str(ran)))
    for allow in (False, True):
        path = written(folder, "scene_evil.py:Evil", more=f"[simulation.options]\n{option}\n")
        with pytest.raises(ValueError, match=r"simulation\.options\..*is not an option of a law"):
            read_scene(path, allow_code=allow)
    assert main(["run", "--psi1", "1", "--chi", "1", "--set", "normal.py:Evil.share=1"]) == 2
    assert not ran.exists()


def test_reading_imports_no_law(tmp_path):
    """Of an installed law neither, though an option is unknown."""
    more = "normal = 'tsuji'\n[simulation.options]\ntangential.share = 1\n"
    good = written(tmp_path, "springs", more=more)
    bad = tmp_path / "bad.toml"
    bad.write_text(good.read_text() + "share = 1\n")
    code = (
        "import sys, contactlab\n"
        f"contactlab.read_scene({str(good)!r})\n"
        f"try: contactlab.read_scene({str(bad)!r})\n"
        "except ValueError: print([n for n in sys.modules if n.startswith('contactlab_laws')])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


#: Commands that run the law of a scene.
COMMANDS = {
    "run": (SCENE, ()),
    "sweep": (SWEEP, ()),
    "compare": (SWEEP, ()),
    "report": (SCENE, ("--out", "page.html")),
    "animate": (SCENE, ("--out", "moving.gif")),
    "cite": (SCENE, ()),
}


def command(capsys, *words):
    status = main(list(map(str, words)))
    return status, capsys.readouterr().err


@pytest.mark.parametrize(("name", "case"), of_commands(*COMMANDS.items()))
def test_every_command_needs_the_users_word(tmp_path, ran, capsys, name, case):
    scene, options = case
    written(tmp_path / "scenes", "../beside/evil.py:Evil", scene=scene)
    status, told = command(capsys, name, "scene.toml", *options)
    assert status == 2
    refused(told, str(tmp_path / "beside" / "evil.py"))
    assert not ran.exists()
    if name != "animate":  # whose law needs fields
        assert command(capsys, name, "scene.toml", *options, "--allow-code")[0] == 0
        assert ran.exists()


@pytest.mark.parametrize("kind", ["normal", "integrator"])
def test_fit_needs_the_users_word(tmp_path, ran, capsys, kind):
    """It takes the normal law of a scene, and neither of the others."""
    pytest.importorskip("contactlab_fit")
    written(tmp_path / "scenes", "../beside/evil.py:Evil", kind=kind)
    (tmp_path / "scenes" / "data.csv").write_text("psi1,chi,psi2\n9,1,5\n8,1,4\n8.5,1,4.5\n")
    words = ("fit", "data.csv", "scene.toml", "--tangential", "coulomb", "--bootstrap", "0")
    status, told = command(capsys, *words, "--fit", "stiffness_ratio")
    if kind == "normal":
        assert status == 2
        refused(told, str(tmp_path / "beside" / "evil.py"))
        told = command(capsys, *words, "--fit", "stiffness_ratio", "--allow-code")[1]
        assert ran.exists()
        assert "pass the law as tangential" in told
    else:
        assert "--allow-code" not in told
        assert not ran.exists()


#: Commands with laws in place of the scene's own; ``--all`` takes every friction law.
REPLACED = (
    (SCENE, "run", "tangential", ("--tangential", "coulomb")),
    (SWEEP, "sweep", "tangential", ("--tangential", "coulomb")),
    (SWEEP, "compare", "tangential", ("--tangential", "coulomb,annulus")),
    (SWEEP, "compare", "normal", ("--normal", "hertz")),
    (SWEEP, "compare", "integrator", ("--integrator", "paper,symplectic")),
    (SWEEP, "compare", "tangential", ("--all",)),
    (SCENE, "cite", "tangential", ("--tangential", "coulomb")),
    (SCENE, "cite", "normal", ("--normal", "hertz")),
    (SCENE, "cite", "integrator", ("--integrator", "paper")),
    (SCENE, "report", "normal", ("--normal", "hertz", "--out", "page.html")),
    *longer(
        (SCENE, "animate", "tangential", ("--tangential", "annulus", "--out", "moving.gif")),
    ),
)


@pytest.mark.parametrize(("scene", "name", "kind", "words"), REPLACED)
def test_a_law_that_the_command_line_replaces_is_not_run(
    tmp_path, ran, capsys, monkeypatch, scene, name, kind, words
):
    if name == "report":
        pytest.importorskip("contactlab_pages")
    shorten(monkeypatch)
    written(tmp_path / "scenes", "../beside/evil.py:Evil", kind=kind, scene=scene)
    status, told = command(capsys, name, "scene.toml", *words)
    assert (status, [line for line in told.splitlines() if "error" in line]) == (0, [])
    assert not ran.exists()


@pytest.mark.usefixtures("ran")
def test_a_law_of_the_command_line_needs_no_more_words(tmp_path, capsys):
    written(tmp_path / "scenes", "hertz", kind="normal")
    assert command(capsys, "run", "scene.toml", "--tangential", "scene_evil.py:Evil")[0] == 0


def test_an_installed_law_is_no_code_of_the_scene(tmp_path):
    laws = read_scene(written(tmp_path, "contactlab:coulomb")).laws
    assert type(laws.simulation().tangential).__name__ == "Coulomb"
