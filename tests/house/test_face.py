"""The package as a program and as a list of names."""

import runpy
import sys

import pytest

import contactlab


def test_the_package_is_the_command(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["contactlab", "--version"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("contactlab", run_name="__main__")
    assert ended.value.code in (0, None)
    assert contactlab.__version__ in capsys.readouterr().out


def test_names_that_are_not_imported_yet_are_listed():
    listed = dir(contactlab)
    assert listed == sorted(listed)
    assert set(listed) == {*contactlab.__all__, *contactlab.MODULES, "__version__"}
    for name in contactlab.__all__:
        assert getattr(contactlab, name) is not None
    for package in ("contracts", "figures", "study", "testing", "materials"):
        module = getattr(contactlab, package)
        assert set(getattr(module, "__all__", ())) <= set(dir(module))


@pytest.mark.parametrize(
    ("name", "hint"),
    [("simulate", "; did you mean 'Simulation'[?]"), ("zzzzzz", ""), ("__nothing__", "")],
)
def test_a_name_that_there_is_not_is_no_attribute(name, hint):
    with pytest.raises(
        AttributeError, match=f"^module 'contactlab' has no attribute '{name}'{hint}$"
    ):
        getattr(contactlab, name)
