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


def test_what_the_package_lists_is_there():
    listed = [*PACKAGE["files"], "package.json", "README.md", "LICENSE"]
    assert sorted(each.name for each in KERNELS.iterdir()) == sorted(listed)
    for door in PACKAGE["exports"].values():
        for path in [door] if isinstance(door, str) else door.values():
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


@pytest.mark.slow
@needs_node
def test_a_program_in_strict_typescript_compiles_and_runs(tmp_path):
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
    shutil.copy(HERE / "typed.mts", tmp_path)
    compiler = tmp_path / "node_modules" / ".bin" / "tsc"
    told = subprocess.run(
        [compiler, *STRICT, *NODE_MODULES, "typed.mts"],
        cwd=tmp_path, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout
    ran = subprocess.run([NODE, "typed.mjs"], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    bounced, velocity, heavy, psi2, course, springs, work, force = json.loads(ran.stdout)
    assert (bounced, heavy) == (False, 0.43 + 0.75)
    assert springs >= 50
    assert velocity[2] == pytest.approx(0.9 * 2.0)
    assert psi2 - course == pytest.approx(contactlab.rebound(1.2, 1.4412), abs=0.02)
    assert work >= 0.0
    assert np.linalg.norm(force) <= 0.3
