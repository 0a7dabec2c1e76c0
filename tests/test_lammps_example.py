"""The scripts of examples/lammps take the options that their page shows; LAMMPS is not run."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "examples" / "lammps"
PAGE = (FOLDER / "README.md").read_text("utf-8")
SCRIPTS = ("build", "rebounds", "checks", "cost", "gas", "dense_flow")


def shown():
    """Commands of the page and of the scripts' own examples."""
    texts = [PAGE, *((FOLDER / f"{name}.py").read_text("utf-8") for name in SCRIPTS)]
    return sorted(
        {line.strip() for text in texts for line in re.findall(r"^ +python \w+\.py .*", text, re.M)}
    )


@pytest.mark.parametrize("name", SCRIPTS)
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
    listed = set(re.findall(r"`(\w+\.(?:py|cpp|h))`", PAGE)) | {
        "gran_sub_mod_tangential_springs.cpp"
    }
    assert {name for name in files if not name.endswith(".png")} <= listed


def test_the_sub_model_calls_the_kernel_that_is_shipped():
    source = (FOLDER / "gran_sub_mod_tangential_springs.cpp").read_text("utf-8")
    kernel = FOLDER.parents[1] / "contactlab" / "kernels" / "contactlab_springs.h"
    for name in set(re.findall(r"contactlab_springs_\w+|CONTACTLAB_\w+", source)):
        assert name in kernel.read_text("utf-8")
