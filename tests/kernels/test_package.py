"""The package for npm: what it lists is there, and its types are those of the modules."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest

import contactlab
from tests.kernels.test_kernels import HERE, KERNELS, NODE, needs_node
from tests.present import ROOT

PACKAGE = json.loads((KERNELS / "package.json").read_text("utf-8"))
NPM = shutil.which("npm")
#: A release of the compiler, so that the outcome is always the same.
TYPESCRIPT = "typescript@5.9.3"
STRICT = ("--strict", "--exactOptionalPropertyTypes", "--noUncheckedIndexedAccess")
NODE_MODULES = ("--module", "nodenext", "--target", "es2022", "--lib", "es2022,dom")


def paths_of(door):
    """Return the files behind a door of the package, under any condition."""
    if isinstance(door, str):
        return [door]
    return [path for each in door.values() for path in paths_of(each)]


def test_what_the_package_lists_is_there():
    listed = [*PACKAGE["files"], "package.json", "README.md", "LICENSE"]
    assert sorted(each.name for each in KERNELS.iterdir()) == sorted(listed)
    for door in PACKAGE["exports"].values():
        for path in paths_of(door):
            assert path.removeprefix("./") in listed
    assert PACKAGE["version"] == contactlab.__version__


def test_the_license_is_that_of_the_repository():
    assert (KERNELS / "LICENSE").read_text("utf-8") == (ROOT / "LICENSE").read_text("utf-8")


def declared(module):
    """Return {function: arguments that must be given} and the constants of the types."""
    text = (KERNELS / f"{module}.d.mts").read_text("utf-8")
    functions = re.findall(r"^export function (\w+)\((.*?)\): ", text, re.MULTILINE | re.DOTALL)
    lengths = {name: len(re.findall(r"\w+: ", given)) for name, given in functions}
    return lengths, re.findall(r"^export const (\w+)", text, re.MULTILINE)


@needs_node
@pytest.mark.parametrize("module", ["contactlab_bounce", "contactlab_springs"])
def test_the_types_declare_what_the_module_exports(module):
    code = (
        "const all = Object.entries(await import(process.argv[1]));"
        "console.log(JSON.stringify(all.map(([name, each]) => [name, each.length ?? null])))"
    )
    words = [NODE, "--input-type=module", "-e", code, (KERNELS / f"{module}.mjs").as_uri()]
    done = subprocess.run(words, capture_output=True, text=True, check=True, timeout=60)
    exported = dict(json.loads(done.stdout))
    functions, constants = declared(module)
    assert functions == {name: given for name, given in exported.items() if given is not None}
    assert constants == [name for name, given in exported.items() if given is None]
    required = (KERNELS / f"{module}.d.cts").read_text("utf-8")
    assert set(re.findall(r"^export const (\w+): typeof module", required, re.M)) == {*exported}


@pytest.fixture(scope="module")
def compiler(tmp_path_factory):
    """Return the compiler for TypeScript in a folder that has the package installed."""
    tmp_path = tmp_path_factory.mktemp("npm")
    if NPM is None:
        pytest.skip("npm is not there")
    words = [NPM, "install", "--silent", "--no-audit", "--no-fund", "--install-links"]
    try:
        done = subprocess.run(
            [*words, TYPESCRIPT, KERNELS], cwd=tmp_path, capture_output=True, text=True, timeout=120
        )
    except subprocess.TimeoutExpired:
        pytest.skip("the registry of npm does not answer")
    if done.returncode:
        pytest.skip(f"npm has no compiler for TypeScript: {done.stderr.strip()[-200:]}")
    shutil.copytree(KERNELS, tmp_path / "copied")
    return tmp_path / "node_modules" / ".bin" / "tsc"


def printed(compiler, program, modules):
    """Return what a program prints that is compiled by strict rules."""
    folder = compiler.parents[2]
    shutil.copy(HERE / program, folder)
    told = subprocess.run(
        [compiler, *STRICT, *modules, program],
        cwd=folder, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout
    script = program.replace("mts", "mjs").replace("cts", "cjs")
    ran = subprocess.run([NODE, script], cwd=folder, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


@pytest.mark.slow
@needs_node
def test_a_program_in_strict_typescript_compiles_and_runs(compiler):
    answers = printed(compiler, "typed.mts", NODE_MODULES)
    bounced, velocity, heavy, psi2, course, springs, work, force = answers
    assert (bounced, heavy) == (False, 0.43 + 0.75)
    assert springs >= 50
    assert velocity[2] == pytest.approx(0.9 * 2.0)
    assert psi2 - course == pytest.approx(contactlab.rebound(1.2, 1.4412), abs=0.02)
    assert work >= 0.0
    assert np.linalg.norm(force) <= 0.3


@pytest.mark.slow
@needs_node
@pytest.mark.parametrize("module", ["node16", "nodenext"])
def test_a_program_of_commonjs_has_the_types(compiler, module):
    """Under node16 a file that is required has types of its own, or is refused."""
    version = subprocess.run([NODE, "--version"], capture_output=True, text=True, check=True)
    if tuple(map(int, version.stdout[1:].split(".")[:2])) < (20, 19):
        pytest.skip("Node cannot require a module")
    length, velocity = printed(compiler, "required.cts", ["--module", module, *NODE_MODULES[2:]])
    assert length == 2 + 3 * 8
    assert velocity[2] == pytest.approx(1.8)
