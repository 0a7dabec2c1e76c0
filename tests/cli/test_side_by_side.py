"""The tables of ``contactlab compare`` as they are printed, against closed forms."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, read_scene
from contactlab.study import side_by_side
from contactlab.study.comparison import compare
from contactlab.study.scores import Score
from contactlab.study.side_by_side import default_quantities, describe, describe_scores
from tests.cli.conftest import EXAMPLES

RIGID, LOOSE = (Simulation(tangential=name) for name in ("coulomb", "frictionless"))


@pytest.fixture
def timed():
    """Compare with run times of 2 µs and 5.12 µs an impact."""

    def call(file, laws=None):
        comparison = compare(file, laws or {"coulomb": RIGID, "frictionless": LOOSE})
        runs = [
            attrs.evolve(run, run_time_per_impact=seconds)
            for run, seconds in zip(comparison.runs, (2e-6, 5.12e-6), strict=False)
        ]
        return attrs.evolve(comparison, runs=tuple(runs))

    return call


CAUTION = """\
caution, coulomb: rigid bodies: tangential elasticity is left out, which moves psi2 of solid
  spheres by up to about 1.5 where the contact sticks (model, not numerical error)"""
COST = """\
cost          run time an impact  relative  impacts followed
------------  ------------------  --------  ----------------
coulomb       2 µs                1         2 of 2
frictionless  5.12 µs             2.6       2 of 2"""


def test_measured_values_beside_two_laws(measured, timed):
    """Rigid: psi1 - 4 chi; without friction psi1. One reading without its error."""
    text = (
        measured.read_text(encoding="utf-8")
        .replace("2.9", "2.8")
        .replace("error = [0.05, 0.05]\n", "")
    )
    measured.write_text(text + "label = 'by eye'\nerror = [0.05, 0.0]\n", encoding="utf-8")
    file = read_scene(measured)
    comparison = timed(file)
    assert default_quantities(comparison) == ["psi2"]
    assert (
        describe(comparison, ["psi2"], file)
        == f"""\
psi2, measured: made up
psi1  measured  reading error  coulomb  frictionless  coulomb - measured  frictionless - measured
----  --------  -------------  -------  ------------  ------------------  -----------------------
   6       2.1           0.05        2             6                -0.1                      3.9
   7       2.8              0        3             7                 0.2                      4.2

law - measured  law             rms  largest  unit  where largest
--------------  ------------  -----  -------  ----  -------------
psi2            coulomb       0.158      0.2  1     at psi1 7
psi2            frictionless   4.05      4.2  1     at psi1 7

{CAUTION}

{COST}"""
    )


def test_a_sweep_has_a_row_for_each_impact(timed, tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text(
        "[about]\ntitle = 'A title'\ncitation = '''Somebody,\n  in  a journal'''\n"
        "[nondimensional]\n[sweep]\npsi1 = [1.0, 6.0]\nchi = [1.0, 1.25]\n",
        encoding="utf-8",
    )
    file = read_scene(path)
    assert (
        describe(timed(file), ["psi2", "slip_restitution"], file)
        == f"""\
A title

Somebody, in a journal

psi2:
psi1   chi  coulomb  frictionless  frictionless - coulomb
----  ----  -------  ------------  ----------------------
   1     1        0             1                       1
   6  1.25        1             6                       5

slip_restitution:
psi1   chi   coulomb  frictionless  frictionless - coulomb
----  ----  --------  ------------  ----------------------
   1     1         0             1                       1
   6  1.25  0.166667             1                0.833333

{CAUTION}

{COST}"""
    )


def test_one_impact_has_a_row_for_each_quantity(timed):
    scene = Scene.nondimensional(psi1=6.0, chi=1.25)
    file = attrs.evolve(read_scene(EXAMPLES / "kharaz2001.toml"), scene=scene, measured=(),
                        title="", citation="")  # fmt: skip
    comparison = timed(file)
    told = default_quantities(comparison)
    assert "psi2" in told
    assert not [name for name in told if np.isnan(comparison.values(name, "coulomb"))]
    text = describe(comparison, ["psi2", "slip_restitution"], file)
    assert text.splitlines()[:4] == [
        "                   coulomb  frictionless  frictionless - coulomb  unit",
        "----------------  --------  ------------  ----------------------  ----",
        "psi2                     1             6                       5  1",
        "slip_restitution  0.166667             1                0.833333  1",
    ]
    assert text.endswith(COST.replace("2 of 2", "1 of 1"))


def test_a_sweep_without_measured_values_shows_psi2(short_sweep, timed):
    file = read_scene(short_sweep)
    assert default_quantities(timed(file)) == ["psi2"]
    three = COST.replace("2 of 2", "3 of 3")
    assert describe(timed(file), ["psi2"], file).endswith(f"\n\n{three}")


def test_a_quantity_of_both_sweep_and_measurement_is_shown_once(measured, timed):
    file = read_scene(measured)
    text = describe(timed(file), ["psi2", "slip_restitution"], file)
    assert text.startswith("psi2, measured: made up\n")
    assert text.index("slip_restitution:\npsi1 ") > text.index("psi2, measured")
    assert "psi2:\n" not in text
    single = attrs.evolve(file, scene=Scene.nondimensional(psi1=6.0, chi=1.0), varied={"psi1": 6.0})
    text = describe(timed(single), ["psi2"], single)
    assert text.index("psi2, measured: made up") > text.index("\npsi2  ")
    assert "law - measured" in text


def score(law, rms, **more):
    numbers = {"worst": 0.5, "where": 1.25, "numerical_error": 1e-7, "energy_made": 1e-13,
               "pressed_force": np.nan, "run_time_per_impact": 1.5e-4}  # fmt: skip
    return Score(law=law, integrator="events" if law == "a" else "", rms=rms, **(numbers | more))


def test_scores_stand_by_their_distance_from_the_first_law(short_sweep):
    file = read_scene(short_sweep)
    comparison = compare(file, {"coulomb": RIGID})
    scores = [score("a", 9.0), score("b", 0.25, energy_made=2e-12), score("c", 0.0123),
              score("d", 1e-13, worst=9.9e-13, energy_made=-0.5)]  # fmt: skip
    text = describe_scores(scores, comparison, file)
    rows = [line.split() for line in text.splitlines() if line[:2] in ("a ", "b ", "c ", "d ")]
    assert rows == [
        ["a", "events", "reference", "1e-07", "0", "-", "150", "µs"],
        ["d", "0", "0", "1.2", "1e-07", "-0.5", "-", "150", "µs"],
        ["c", "0.012", "0.5", "1.2", "1e-07", "0", "-", "150", "µs"],
        ["b", "0.25", "0.5", "1.2", "1e-07", "2e-12", "-", "150", "µs"],
    ]
    assert " ".join(text.split()).endswith(
        "psi2: distance from a over 3 impacts, model error and numerical error together. "
        "Numerical error of psi2: the largest estimated or declared one. Energy from nothing: over "
        "the energy at the start. Force from load alone: what pressing adds to a sheared contact, "
        "over mu P_max; a dash for laws that are not stepped. Time: in the sweep."
    )
    assert max(map(len, text.splitlines())) <= 100
    titled = attrs.evolve(file, title="T", citation="C  c")
    assert describe_scores(scores, comparison, titled).startswith("T\n\nC c\n\n")


def cautioned(names, sentences):
    """Return the cautions of runs whose plans have these sentences."""

    @attrs.frozen
    class Plan:
        cautions: tuple

    @attrs.frozen
    class Run:
        name: str
        plan: Plan

        @property
        def result(self):
            return self

    @attrs.frozen
    class Runs:
        runs: tuple

    runs = [Run(name, Plan(tuple(sentences.get(name, ())))) for name in names]
    return side_by_side._cautions(Runs(tuple(runs)))


def test_a_caution_is_told_once_with_its_laws():
    both = cautioned("abc", {"a": ["one", "two"], "b": ["one"], "c": ["one"]})
    assert both == "caution, all laws: one\ncaution, a: two"
    assert cautioned("abc", {"a": ["one"], "c": ["one"]}) == "caution, a, c: one"
    assert cautioned("a", {"a": ["one"]}) == "caution, a: one"
    assert cautioned("ab", {}) == ""
    long = cautioned("a", {"a": ["word " * 30]})
    first, second = long.splitlines()
    assert 90 < len(first) <= 96
    assert second.startswith("  word")
