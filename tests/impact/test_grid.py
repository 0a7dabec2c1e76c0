"""Grids, and results with named dimensions."""

import pickle
import sys

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, read_scene
from contactlab.impact.grid import MOST_IMPACTS
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.outcome.columns import COLUMNS
from contactlab.outcome.export import write_csv, write_npz
from tests.present import extra
from tests.solve.any_scene import EXACT

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
CHI, PSI1 = [1.0, 1.2, 1.4412], [0.0, 2.0, 6.0, 8.0]
RIGID = Simulation(tangential="coulomb", integrator="symplectic")


@pytest.fixture(scope="module")
def result():
    return RIGID.sweep(Scene.grid(chi=CHI, psi1=PSI1))


def test_every_combination_the_last_fastest(result):
    grid = result.scene
    assert (grid.shape, grid.dimensions) == ((12,), (3, 4))
    pairs = [(chi, psi1) for chi in CHI for psi1 in PSI1]
    assert list(zip(grid.chi, grid.psi1, strict=True)) == pairs
    assert not grid.take(slice(2, 5)).axes
    assert grid == Scene.nondimensional(psi1=grid.psi1, chi=grid.chi)


def test_a_grid_pickles_and_is_read_only(result):
    again = pickle.loads(pickle.dumps(result.scene))
    assert again == result.scene
    assert {name: values.tolist() for name, values in again.axes.items()} == {
        "chi": CHI,
        "psi1": PSI1,
    }
    with pytest.raises(TypeError):
        again.axes["chi"] = [1.0]
    with pytest.raises(ValueError, match="read-only"):
        again.axes["chi"][0] = 2.0


@extra("xarray")
def test_an_array_has_the_axes_of_the_grid(result):
    data = result.to_xarray()
    assert dict(data.sizes) == {"chi": 3, "psi1": 4}
    for chi in CHI:
        for psi1 in PSI1:
            found = float(data.psi2.sel(chi=chi, psi1=psi1))
            assert found == pytest.approx(float(rigid_body_rebound(psi1, chi)), abs=1e-12)
    assert data.incidence_angle.attrs == {"units": "rad"}
    assert set(data.status.values.flat) == {"SUCCESS"}


@extra("pandas")
def test_a_table_has_them_as_its_index(result):
    frame = result.to_dataframe()
    assert frame.index.names == ["chi", "psi1"]
    assert frame.loc[(1.2, 8.0), "psi2"] == pytest.approx(rigid_body_rebound(8.0, 1.2))
    assert frame.psi2.tolist() == result.psi2.tolist()
    assert frame.attrs["units"]["rebound_normal_velocity"] == "1"


@extra("xarray")
def test_bodies_have_units_and_their_entries_are_axes():
    ball = Sphere(0.0127, STEEL)
    grid = Scene.grid(
        ball,
        HalfSpace(STEEL),
        friction_coefficient=[0.1, 0.2],
        normal_speed=1.0,
        tangential_velocity=[1.0, 2.0, 3.0],
    )
    data = RIGID.sweep(grid).to_xarray()
    assert data.psi2.dims == ("friction_coefficient", "tangential_velocity")
    assert data.tangential_velocity.attrs == {"units": "m/s"}
    assert data.rebound_spin.attrs == {"units": "rad/s"}
    one = RIGID.run(Scene(ball, HalfSpace(STEEL), 0.2, 1.0, tangential_velocity=3.0))
    assert float(data.rebound_spin[1, 2]) == pytest.approx(one.rebound_spin, rel=1e-14)


@extra("xarray")
def test_what_is_no_grid_has_the_dimension_impact(result):
    assert dict(result[2:5].to_xarray().sizes) == {"impact": 3}
    assert result[2:5].to_dataframe().index.name == "impact"
    assert dict(result[2].to_xarray().sizes) == {}
    assert len(result[2].to_dataframe()) == 1
    two = RIGID.run(Scene.nondimensional(psi1=np.ones((2, 1)), chi=np.ones(3)))
    assert dict(two.to_xarray().sizes) == {"impact_0": 2, "impact_1": 3}
    assert len(two.to_dataframe()) == 6


@extra("pandas")
def test_columns_are_those_of_the_csv(result, tmp_path):
    write_csv(result, tmp_path / "a.csv")
    headings = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
    frame = result[0:3].to_dataframe()
    units = frame.attrs["units"]
    named = [f"{name} ({units[name]})" if units[name] else name for name in frame.columns]
    undefined = [column.name for column in COLUMNS if column.read(result) is None]
    assert [one for one in headings if one.partition(" ")[0] not in undefined] == named


@extra("xarray")
def test_entries_that_are_no_columns_are_written_too(tmp_path):
    (tmp_path / "grid.toml").write_text(
        """
[sphere]
radius = 0.01
material = { young_modulus = 208e9, poisson_ratio = 0.3, density = 7850 }
[target]
kind = "half-space"
material = { young_modulus = 208e9, poisson_ratio = 0.3 }
[impact]
friction_coefficient = 0.2
speed = 1.0
angle_deg = 30
[sweep]
product = true
sphere.radius = [0.01, 0.02]
angle_deg = [10, 20, 30]
""",
        encoding="utf-8",
    )
    result = RIGID.sweep(read_scene(tmp_path / "grid.toml").scene)
    write_csv(result, tmp_path / "a.csv")
    write_npz(result, tmp_path / "a.npz")
    lines = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("sphere.radius (m),angle_deg (deg),psi1 (1),")
    assert lines[4].startswith("0.02,10.0,")
    with np.load(tmp_path / "a.npz") as content:
        assert content["sphere.radius"].tolist() == [0.01] * 3 + [0.02] * 3
    assert result.to_dict()["angle_deg"] == [10.0, 20.0, 30.0] * 2
    data = result.to_xarray()
    assert data.psi2.dims == ("sphere.radius", "angle_deg")
    assert data["sphere.radius"].attrs == {"units": "m"}


@pytest.mark.parametrize(
    ("method", "module"), [("to_dataframe", "pandas"), ("to_xarray", "xarray")]
)
def test_without_the_extra_it_is_named(result, monkeypatch, method, module):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=rf"{method} needs {module}.*\[{module}\]"):
        getattr(result, method)()


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"psi1": 1.0, "chi": 1.0}, "none of them varies"),
        ({"psi1": [[1.0]], "chi": 1.0}, "psi1 = .*plain list"),
        ({"psi1": [1.0, np.nan], "chi": 1.0}, "psi1 = .*finite"),
        ({"psi1": [1.0], "chi": [1.0, -1.0]}, "chi = .*positive"),
        ({"psi1": np.ones(4000), "chi": np.ones(4000)}, f"at most {MOST_IMPACTS}"),
    ],
)
def test_bad_grids(entries, words):
    with pytest.raises(ValueError, match=words):
        Scene.grid(**entries)


SCENE = """
[nondimensional]
chi = 1.0
[sweep]
product = {product}
chi = [1.0, 1.2, 1.4412]
psi1 = {{ start = 0.0, stop = 6.0, count = 4 }}
"""


def test_a_file_asks_for_the_product(tmp_path):
    path = tmp_path / "grid.toml"
    path.write_text(SCENE.format(product="true"), encoding="utf-8")
    file = read_scene(path)
    assert file.scene.dimensions == Scene.grid(chi=CHI, psi1=[0.0, 2.0, 4.0, 6.0]).dimensions
    assert file.scene == Scene.grid(chi=CHI, psi1=[0.0, 2.0, 4.0, 6.0])
    assert file.varied["psi1"].tolist() == file.scene.psi1.tolist()


@pytest.mark.parametrize(
    ("product", "words"), [("false", "write product = true"), ("1", "sweep.product = 1")]
)
def test_a_file_that_does_not_is_refused(tmp_path, product, words):
    path = tmp_path / "grid.toml"
    path.write_text(SCENE.format(product=product), encoding="utf-8")
    with pytest.raises(ValueError, match=words):
        read_scene(path)


def test_speeds_and_angles_make_a_grid_too():
    ball, plate = Sphere(0.01, STEEL), HalfSpace(STEEL)
    speeds, angles = [0.5, 5.0], [10.0, 45.0, 80.0]
    grid = Scene.grid(ball, plate, friction_coefficient=0.1, speed=speeds, angle_deg=angles)
    assert grid.dimensions == (2, 3)
    one = Scene.at_angle(ball, plate, 0.1, speed=5.0, angle_deg=45.0)
    assert grid.take(4) == one
    result = RIGID.sweep(grid).check()
    slips = 1.0 - 2.0 * 0.1 / np.tan(np.radians(80.0))
    assert result.tangential_restitution[2] == pytest.approx(slips, rel=1e-12)
    with pytest.raises(TypeError, match="angle_deg"):
        Scene.grid(ball, plate, friction_coefficient=0.1, speed=speeds)
    with pytest.raises(ValueError, match=r"speed \(2,\), angle_deg \(3,\).*Scene.grid"):
        Scene.at_angle(ball, plate, 0.1, speed=speeds, angle_deg=angles)


GRIDS = [
    {"psi1": [1.0, 2.0], "chi": [1.0, 2.0, 3.0]},
    {"psi1": [1.0, 2.0], "chi": 1.4, "lam": [0.1, 0.2, 0.3], "eta": 0.5},
    {"psi1": 1.0, "chi": 1.4, "lam": [0.1, 0.2], "eta": [0.2, 0.4, 0.5]},
    {"psi1": [1.0, 2.0], "chi": 1.4, "lam": [0.0, 0.2, 0.3], "rho": [0.3, 0.5]},
    {"lam": [0.0, 0.2, 0.3], "psi1": 1.0, "chi": 1.4, "rho": 0.5},
]


@extra("xarray")
@pytest.mark.parametrize("entries", GRIDS, ids=lambda entries: "-".join(entries))
def test_a_grid_of_any_group(entries):
    lists = {name: values for name, values in entries.items() if isinstance(values, list)}
    grid = Scene.grid(**entries)
    assert grid.dimensions == tuple(map(len, lists.values()))
    assert list(grid.axes) == list(lists)
    result = EXACT.sweep(grid).check()
    sizes = {name: len(values) for name, values in lists.items()}
    assert dict(result.to_xarray().sizes) == sizes
    last = {name: values[-1] if name in lists else values for name, values in entries.items()}
    assert result[-1].psi2 == pytest.approx(EXACT.run(Scene.nondimensional(**last)).psi2, abs=1e-11)
