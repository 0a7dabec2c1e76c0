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
    assert {*contactlab.__all__, *contactlab.MODULES, "create", "__version__"} <= set(listed)
    for name in contactlab.__all__:
        assert getattr(contactlab, name) is not None


def test_a_name_that_there_is_not_is_no_attribute():
    with pytest.raises(AttributeError, match=r"^module 'contactlab' has no attribute 'simulate'$"):
        _ = contactlab.simulate
