"""Tables of very many rows, and the tests of residuals whose cost grows as the rows."""

import json
import math

import attrs
import numpy as np
import pytest

from contactlab import fit
from contactlab.cli.main import main
from contactlab_fit import tabulated
from contactlab_fit.f_test import chance_of, chances_of_each, log_chance, orthonormal, remaining
from tests.fitting.impacts import BODIES

FRICTION = 0.12


def long_table(count):
    generator = np.random.default_rng(3)
    angles, speeds = generator.uniform(3.0, 70.0, count), generator.uniform(1.0, 3.0, count)
    radians = np.radians(angles)
    scene = attrs.evolve(
        BODIES,
        friction_coefficient=FRICTION,
        normal_speed=speeds * np.cos(radians),
        tangential_velocity=speeds * np.sin(radians),
    )
    e_t = tabulated.impacts(scene, None).tangential_restitution
    e_t += 0.01 * generator.standard_normal(count)
    return {"angle_deg": angles, "speed (m/s)": speeds, "tangential_restitution": e_t}


@pytest.mark.parametrize(("freedom", "ratio"), [(20, 3.0), (400, 50.0), (2000, 1e4), (10**6, 1e3)])
def test_the_chance_of_two_terms_is_a_power(freedom, ratio):
    """F with 2 and n degrees of freedom exceeds f by chance (1 + 2 f/n)^(-n/2)."""
    expected = -0.5 * freedom * math.log1p(2.0 * ratio / freedom)
    assert log_chance(2, freedom, ratio) == pytest.approx(expected, rel=1e-4)


def test_running_sums_give_the_chance_of_each_term():
    generator = np.random.default_rng(8)
    residuals, slopes = generator.standard_normal(30), generator.standard_normal((30, 2))
    term = generator.uniform(1.0, 2.0, 30)
    ends = np.arange(3, 31)
    basis = orthonormal(slopes)
    rows = np.arange(30) < ends[:, None]
    products = rows @ (remaining(residuals, basis) * term)
    along = rows @ (basis * term[:, None])
    found = chances_of_each(residuals, slopes, products, rows @ term**2, along, 0.01)
    expected = [chance_of(residuals, slopes, (term * row)[:, None], 0.01) for row in rows]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("count", [30_000, 400_000])
def test_normal_scatter_of_very_many_rows_is_not_accused(count):
    """Some rows lie beyond any cut; that is what so many rows do."""
    found = fit(long_table(count), BODIES)
    low, high = found.parameters["friction_coefficient"].interval
    assert low < FRICTION < high
    assert not found.notes


@pytest.mark.slow
def test_outliers_of_very_many_rows_are_told():
    table = long_table(30_000)
    table["tangential_restitution"][::1500] += 0.5
    assert any("impacts 1, 1501, " in note for note in fit(table, BODIES).notes)


@pytest.mark.slow
def test_the_command_tells_that_it_makes_no_bootstrap_of_a_long_table(tmp_path, capsys):
    data, bodies = tmp_path / "impacts.csv", tmp_path / "bodies.toml"
    columns = long_table(20_001)
    np.savetxt(data, np.transpose([*columns.values()]), header=",".join(columns), comments="",
               delimiter=",")  # fmt: skip
    bodies.write_text("[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\n"
                      "kind = 'half-space'\nmaterial = 'steel'\n", encoding="utf-8")  # fmt: skip
    assert main(["fit", str(data), str(bodies), "--json"]) == 0
    told = capsys.readouterr()
    assert "no bootstrap above 20000 impacts" in told.err
    assert json.loads(told.out)["samples"] == 0
