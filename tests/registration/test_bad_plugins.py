"""What plug-ins bring that is bad: one sentence each, told once, and all else stands."""

import importlib
import warnings

import numpy as np
import pytest

import contactlab
from contactlab import Material, Scene, Simulation
from contactlab.cli.main import main
from contactlab.outcome.columns import columns
from contactlab.registration.installed import PluginWarning
from contactlab.study.validation import validate

HEAD = """
import contactlab, sys
from contactlab.plugin import Column, Entry, hookimpl
G = dict(young_modulus=1e9, poisson_ratio=0.3, density=1e3, elastic_source="o", density_source="o")
GOOD, SAME = Entry(name="good", **G), Entry(name="same", **G)
def psi2(result): return result.psi2
FAIR = Column("good", "1", value=psi2)
@hookimpl
"""
MATERIALS, COLUMNS, CAUTIONS = (
    HEAD + f"def contactlab_{kind}():\n    " for kind in ("materials", "columns", "cautions")
)
TWO = MATERIALS + "return [GOOD]\n@hookimpl\ndef contactlab_cautions(): return []\n"


@pytest.fixture
def told():
    """Return the sentences of warnings that a function gives, each of them once."""

    def call(function):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            answer = function()
            said = [str(each.message) for each in found if each.category is PluginWarning]
            function()
        assert [str(each.message) for each in found][len(said) :] == []
        return answer, said

    return call


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (MATERIALS + "return ['steel', GOOD]", "brought 'steel', which is no Entry"),
        (MATERIALS + "return [SAME, SAME, GOOD]", "brought 'same' twice, and neither is taken"),
        (
            MATERIALS + "return [Entry(name='x', **{**G, 'density': -1.0}), GOOD]",
            "brought 'x', whose density = -1.0: must be positive",
        ),
        (MATERIALS + "return GOOD", "must be a list; return [...]"),
        (MATERIALS + "return 5", "returned 5 when asked for its materials: must be a list"),
        (MATERIALS + "raise KeyError('k')", "raised when asked for its materials: KeyError"),
        (MATERIALS + "sys.exit(3)", "raised when asked for its materials: SystemExit: 3"),
        ("import sys\nsys.exit(4)", "could not be imported: SystemExit: 4"),
        ("x = 1", "has no hook: define @contactlab.hookimpl def contactlab_materials"),
        (TWO, "has contactlab_cautions, but no entry point cautions.NAME names bad_lab"),
    ],
)
def test_bad_materials(install, told, source, words):
    install("bad", "bad_lab", source, "materials.bad")
    names, said = told(contactlab.materials.names)
    assert len(said) == 1, said
    assert said[0].startswith("'materials.bad' of bad 1.5 ")
    assert words in said[0]
    assert "steel" in names
    assert ("good" in names) == (", GOOD]" in source)


@pytest.mark.parametrize("answer", ["None", "[]"])
def test_a_hook_that_gives_nothing_brings_nothing_and_its_check_says_so(
    install, told, capsys, answer
):
    install("bad", "bad_lab", MATERIALS + f"return {answer}", "materials.bad")
    assert told(contactlab.materials.names)[1] == []
    assert main(["plugins", "check", "materials.bad"]) == 1
    assert "brings nothing: the hook returned None or []" in capsys.readouterr().out


def test_what_a_hook_prints_is_not_on_stdout(install, capsys):
    install("bad", "bad_lab", MATERIALS + "print('hello'); return [GOOD]", "materials.bad")
    assert Material.named("good").density == 1e3
    assert capsys.readouterr() == ("", "hello\n")


def test_a_slow_import_is_told(install, told, monkeypatch):
    from contactlab.registration import manager

    install("bad", "bad_lab", MATERIALS + "return [GOOD]", "materials.bad")
    clock = iter(np.arange(0.0, 1e5, 10.0).tolist())
    monkeypatch.setattr(manager, "time", type("Clock", (), {"perf_counter": lambda: next(clock)}))
    names, said = told(contactlab.materials.names)
    assert "good" in names
    assert said == [  # of what comes with contactlab nothing is told
        "'materials.bad' of bad 1.5 took 10 s to import, and every command that asks for its kind "
        "waits; import what takes long where it is used, in the function"
    ]


def test_a_distribution_that_vanished_takes_its_names_with_it(install, tmp_path):
    install("gone", "gone_lab", MATERIALS + "return [GOOD]", "materials.gone")
    assert Material.named("good").density == 1e3
    for file in (tmp_path / "gone-1.5.dist-info").iterdir():
        file.unlink()
    (tmp_path / "gone-1.5.dist-info").rmdir()
    importlib.invalidate_caches()
    with pytest.raises(ValueError, match="name = 'good': no such material"):
        Material.named("good")


BATCH = Scene.nondimensional(psi1=[1.2, 2.0], chi=1.44)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("[Column('x', None, value=psi2), FAIR]", "brought 'x', whose unit is None; give '1'"),
        ("[Column('x', 'furlong', value=psi2), FAIR]", "'furlong' is no unit of SI"),
        ("[Column('x', 'mm', value=psi2), FAIR]", "'mm' is no unit of SI"),
        ("[Column('a b', '1', value=psi2), FAIR]", "whose name must be letters"),
        ("[Column('x', '1', value=psi2, needs=('speed',)), FAIR]", "which needs 'speed', none of"),
        ("[Column('x', '1'), FAIR]", "which has no value"),
        ("[('x', '1'), FAIR]", "which is no Column"),
        ("[Column('x', '1', value=psi2)] * 2 + [FAIR]", "brought 'x' twice"),
        ("FAIR", "must be a list"),
    ],
)
def test_bad_columns(install, told, source, words):
    install("bad", "bad_lab", COLUMNS + f"return {source}", "columns.bad")
    contactlab.plugin_manager().load("columns")  # a run looks for nothing that is new
    result = Simulation().run(BATCH)
    found, said = told(lambda: {name: values for name, _, values in columns(result)})
    assert len(said) == 1, said
    assert words in said[0]
    assert "x" not in found
    assert ("good" in found) == source.endswith("FAIR]")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("lambda result: 'text'", "it gave 'text', which is no number"),
        ("lambda result: [1.0, 2.0, 3.0]", "it gave the shape (3,) for one impact of a batch"),
        ("lambda result: 1.0 / 0", "ZeroDivisionError"),
    ],
)
def test_numbers_that_are_none_are_nan_and_told(install, value, words):
    brought = COLUMNS + f"return [Column('x', '1', value={value}), FAIR]"
    install("bad", "bad_lab", brought, "columns.bad")
    contactlab.plugin_manager().load("columns")
    result = Simulation().run(BATCH)
    with pytest.warns(PluginWarning, match="column x: NaN for 2 of 2 impacts") as found:
        table = {name: values for name, _, values in columns(result)}
    assert words in str(found[0].message)
    assert np.isnan(table["x"]).all()
    assert table["good"] == pytest.approx(result.psi2)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ("raise RuntimeError('boo')", "raised when asked for its cautions: RuntimeError: boo"),
        ("sys.exit(3)", "raised when asked for its cautions: SystemExit: 3"),
        ("return 'too fast'", "returned 'too fast' when asked for its cautions: must be a list"),
        ("return [5]", "brought 5, which is no str"),
    ],
)
def test_a_caution_that_fails_is_told_once_and_the_run_stands(install, told, answer, words):
    install("bad", "bad_lab", CAUTIONS + answer, "cautions.bad")
    contactlab.plugin_manager().load("cautions")
    expected = Simulation().run(BATCH).psi2
    plan, said = told(lambda: Simulation().run(BATCH).plan.cautions)
    assert len(said) == 1, said
    assert words in said[0]
    assert list(plan) == []
    assert Simulation().run(BATCH).psi2.tolist() == expected.tolist()


CHECKS = """
import contactlab
from contactlab.plugin import Finding
def raises(): raise RuntimeError("boo")
def other(): return 3
@contactlab.hookimpl
def contactlab_checks(): return [raises, other, "none"]
"""


def test_a_check_that_fails_is_a_finding_and_the_others_follow(install, monkeypatch):
    install("bad", "bad_lab", CHECKS, "checks.bad")
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "checks.references")
    with pytest.warns(PluginWarning, match="brought 'none', which is no function"):
        found = [each for each in validate() if "bad" in each.what or "no Finding" in each.what]
    assert [each.ok for each in found] == [False, False]
    assert "raised: RuntimeError: boo" in found[0].what
    assert found[1].what == "returned 3, no Finding"
