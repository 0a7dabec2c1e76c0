"""The errors in the table of `contactlab guide choosing` are those of the benchmark's scenes."""

import re

import numpy as np
import pytest

import contactlab
from contactlab import Simulation
from contactlab.cli.guide import text
from contactlab.study.bench_methods import scenes

SECTION = text("choosing").partition("## Error and cost")[2].partition("\n## ")[0]
ROW = re.compile(
    r"^\| `(\w+)`(?:, `(\w+)`)? \| ([^|]*) \| ([\d.e-]+) \| ([\d.e-]+) \|", re.MULTILINE
)
#: Words of the column "resolution", and the options that they stand for.
OPTIONS = re.compile(r"(\d+) (springs|annuli|steps)|(tolerance) ([\d.e-]+)")
FINER = ("fronts",)  # as good as the reference, or so near that rounding decides


def resolution(words):
    """Return the options of law and integrator."""
    found = {}
    for count, name, tolerance, value in OPTIONS.findall(words):
        found[name or tolerance] = int(count) if name else float(value)
    return found


@pytest.fixture(scope="module")
def known():
    exact = Simulation(integrator=contactlab.create("integrator.events", tolerance=1e-12))
    return [(scene, float(exact.run(scene).check().psi2)) for scene in scenes(quick=False)]


def rows():
    found = [row for row in ROW.findall(SECTION) if row[0] not in FINER]
    return [row for row in found if row[1] or row[0] == "coulomb"]


def test_the_table_has_its_rows():
    assert len(rows()) >= 9


@pytest.mark.parametrize(("law", "integrator", "words", "rms", "largest"), rows())
def test_errors_are_those_of_the_table(known, law, integrator, words, rms, largest):
    options = resolution(words)
    parts = {key: value for key, value in options.items() if key in ("springs", "annuli")}
    steps = {key: value for key, value in options.items() if key in ("steps", "tolerance")}
    simulation = Simulation(
        tangential=contactlab.create(f"tangential.{law}", **parts),
        integrator=contactlab.create(f"integrator.{integrator or 'symplectic'}", **steps),
    )
    error = [float(simulation.run(scene).psi2) - psi2 for scene, psi2 in known]
    assert float(np.sqrt(np.mean(np.square(error)))) == pytest.approx(float(rms), rel=0.05)
    assert float(np.max(np.abs(error))) == pytest.approx(float(largest), rel=0.12)
