"""What the README says is printed is printed."""

import contextlib
import io
import re
import sys
import types
from pathlib import Path

import pytest

from contactlab.compose.registry import REGISTRY
from contactlab.testing import CHECKS, Verdict, check_law

TEXT = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"```python\n(.*?)```\n(?:```text\n(.*?)```\n)?", TEXT, re.DOTALL)


def run(code):
    """Run a snippet as a module of its own; return what it defines and prints."""
    module = types.ModuleType("README")
    sys.modules["README"] = module  # a class must be found again to be copied
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), vars(module))
    return module, printed.getvalue()


@pytest.mark.parametrize(("code", "expected"), SNIPPETS)
def test_a_snippet_prints_what_is_shown(code, expected):
    assert "print" in code
    assert run(code)[1] == expected


def test_there_are_snippets():
    assert len(SNIPPETS) == 4


def test_the_table_of_errors_names_every_law():
    """But for the one that makes no force, and laws of other distributions."""
    table = TEXT.partition("## Error against run time")[2].partition("\n## ")[0]
    told = set(re.findall(r"^\| (?:rigid )?(\w+)", table, re.MULTILINE)) - {"law"}
    ours = {
        info.name.partition(".")[2]
        for info in REGISTRY.installed()
        if info.kind == "tangential" and info.distribution == "contactlab"
    }
    assert told == ours - {"frictionless"}


def test_the_law_of_ones_own_passes_the_kit_as_it_stands():
    module, _ = run(next(code for code, _ in SNIPPETS if "Smoothed" in code))
    found = check_law(module.Smoothed())
    assert {item.verdict for item in found} >= {Verdict.PASSED, Verdict.EXPECTED_FAILURE}
    told = re.search(r"conformance kit: (\d+) of its (\d+) small named checks", TEXT)
    assert told, "the README should say how many checks apply"
    assert (len(found), len(CHECKS)) == (int(told[1]), int(told[2]))
