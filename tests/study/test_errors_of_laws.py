"""The errors in the table of `contactlab guide laws` are those of the benchmark's quick scenes."""

import re

import numpy as np
import pytest

import contactlab
from contactlab import Simulation
from contactlab.cli.guide import text
from contactlab.study.bench_methods import scenes

TABLE = text("laws").partition("## Error against run time")[2].partition("\n## ")[0]
ROW = re.compile(r"^\| `(\w+)`, `(\w+)` \| ([^|]*) \| ([\d.e-]+) \| ([\d.e-]+) \|", re.MULTILINE)
EXACT = ("fronts",)  # as good as the reference: rounding decides


@pytest.fixture(scope="module")
def known():
    exact = Simulation(integrator=contactlab.create("integrator.events", tolerance=1e-12))
    return [(scene, float(exact.run(scene).check().psi2)) for scene in scenes(quick=True)]


def rows():
    return [row for row in ROW.findall(TABLE) if row[0] not in EXACT]


def test_the_table_has_rows_of_laws_that_take_steps():
    assert len(rows()) >= 6


@pytest.mark.parametrize(("law", "integrator", "words", "rms", "largest"), rows())
def test_errors_are_those_of_the_table(known, law, integrator, words, rms, largest):
    options = {name: int(value) for name, value in re.findall(r"(\w+)=(\d+)", words)}
    steps = {"steps": options.pop("steps")}
    simulation = Simulation(
        tangential=contactlab.create(f"tangential.{law}", **options),
        integrator=contactlab.create(f"integrator.{integrator}", **steps),
    )
    error = [float(simulation.run(scene).psi2) - psi2 for scene, psi2 in known]
    assert float(np.sqrt(np.mean(np.square(error)))) == pytest.approx(float(rms), rel=0.05)
    assert float(np.max(np.abs(error))) == pytest.approx(float(largest), rel=0.12)
