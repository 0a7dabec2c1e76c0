"""Arrays of xarray, pandas and dask: paired by label or refused, never paired by position."""

import subprocess
import sys

import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Sphere,
    collide,
    load_path,
    rebound,
    shapes,
)
from tests.present import extra

STEEL = Material.named("steel")
BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(STEEL)
PSI1, CHI, E = [0.5, 1.25, 3.0], [0.9, 1.4, 2.0], [0.4, 0.7, 0.9]
TABLE = np.array([[rebound(p, c) for c in CHI] for p in PSI1])


def arrays(name):
    return pytest.importorskip(name)


@extra("xarray")
def test_dimensions_of_other_names_are_combined():
    DataArray = arrays("xarray").DataArray
    psi1 = DataArray(PSI1, dims="angle", coords={"angle": [10, 20, 30]}, name="psi1")
    chi = DataArray(CHI, dims="chi", coords={"chi": CHI})
    psi2 = rebound(psi1, chi)
    assert psi2.dims == ("angle", "chi")
    assert psi2.name == "psi2"
    assert psi2.angle.values.tolist() == [10, 20, 30]
    np.testing.assert_allclose(psi2.values, TABLE, atol=1e-10)
    turned = rebound(chi * 0 + 1.25, psi1 * 0 + chi)
    assert float(turned.sel(chi=2.0, angle=20)) == pytest.approx(TABLE[1, 2], abs=1e-10)


@extra("xarray")
def test_equal_dimensions_are_paired_by_coordinate_or_refused():
    DataArray = arrays("xarray").DataArray
    psi1 = DataArray(PSI1, dims="i", coords={"i": [0, 1, 2]})
    chi = DataArray(CHI, dims="i", coords={"i": [0, 1, 2]})
    np.testing.assert_allclose(rebound(psi1, chi), np.diag(TABLE), atol=1e-10)
    for other in (chi.assign_coords(i=[2, 1, 0]), chi[:2], chi.assign_coords(i=[1, 2, 3])):
        with pytest.raises(ValueError, match=r"psi1, chi = .*equal labels.*xarray\.align"):
            rebound(psi1, other)
    table = DataArray(TABLE, dims=("a", "b"))
    across = DataArray(np.abs(TABLE.T) + 0.5, dims=("b", "a"))
    expected = rebound(TABLE, np.abs(TABLE) + 0.5)
    np.testing.assert_allclose(rebound(table, across), expected, atol=1e-10)


@extra("xarray")
def test_derivatives_and_restitutions_keep_dimensions():
    DataArray = arrays("xarray").DataArray
    psi1, chi = DataArray(PSI1, dims="a"), DataArray(CHI, dims="b")
    e = DataArray(E, dims="c")
    found = rebound(psi1, chi, restitution=e, derivatives=True)
    assert [each.name for each in found] == ["psi2", "dpsi2_dpsi1", "dpsi2_dchi", "dpsi2_de"]
    assert all(each.dims == ("a", "b", "c") for each in found)
    three = np.meshgrid(PSI1, CHI, E, indexing="ij")
    plain = rebound(three[0], three[1], restitution=three[2], derivatives=True)
    for mine, theirs in zip(found, plain, strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-9)
    one = rebound(psi1, 1.4, restitution=0.7)
    np.testing.assert_allclose(one, rebound(np.array(PSI1), 1.4, restitution=0.7), atol=1e-10)
    assert rebound(DataArray(1.25), 1.4).dims == ()


@extra("xarray")
def test_lazy_labelled_arrays_stay_lazy():
    DataArray, dask_array = arrays("xarray").DataArray, arrays("dask.array")
    psi1 = DataArray(dask_array.from_array(np.array(PSI1), chunks=2), dims="a")
    psi2 = rebound(psi1, DataArray(CHI, dims="b"))
    assert isinstance(psi2.data, dask_array.Array)
    np.testing.assert_allclose(psi2.compute(), TABLE, atol=1e-10)


@extra("pandas")
def test_series_are_paired_by_index():
    Series = arrays("pandas").Series
    psi1, chi = Series(PSI1, index=["a", "b", "c"]), Series(CHI, index=["a", "b", "c"])
    psi2 = rebound(psi1, chi[["c", "a", "b"]])
    assert psi2.index.tolist() == ["a", "b", "c"]
    assert psi2.name == "psi2"
    np.testing.assert_allclose(psi2, np.diag(TABLE), atol=1e-10)
    alone = rebound(1.25, chi, derivatives=True)
    assert [each.index.tolist() for each in alone] == 3 * [["a", "b", "c"]]
    with_loss = rebound(psi1, 1.4, restitution=Series(E, index=["b", "a", "c"]))
    plain = rebound(np.array(PSI1), 1.4, restitution=np.array([E[1], E[0], E[2]]))
    np.testing.assert_allclose(with_loss, plain, atol=1e-10)
    for other in (Series(CHI), chi[:2], Series(CHI, index=["a", "a", "c"])):
        with pytest.raises(ValueError, match=r"psi1, chi = .*equal labels.*align"):
            rebound(psi1, other)
    spans = arrays("pandas").interval_range(0, 3)  # pandas finds 0.5 in the first
    with pytest.raises(ValueError, match="equal labels"):
        rebound(Series(PSI1, index=[0.5, 1.5, 2.5]), Series(CHI, index=spans))


@extra("pandas")
def test_levels_of_an_index_are_paired_by_name():
    pandas = arrays("pandas")

    def series(values, names, labels):
        index = pandas.MultiIndex.from_tuples(labels, names=names)
        return pandas.Series(values, index=index)

    psi1 = series(PSI1, ["x", "y"], [(0, 1), (1, 0), (1, 1)])
    for chi in (
        series([CHI[1], CHI[0], CHI[2]], ["y", "x"], [(0, 1), (1, 0), (1, 1)]),
        series(CHI, ["y", "x"], [(1, 0), (0, 1), (1, 1)]),
        series(CHI, [None, None], [(0, 1), (1, 0), (1, 1)]),
    ):
        psi2 = rebound(psi1, chi)
        assert psi2.index.equals(psi1.index)
        np.testing.assert_allclose(psi2, np.diag(TABLE), atol=1e-10)
    with pytest.raises(ValueError, match="equal labels"):
        rebound(psi1, series(CHI, ["x", "z"], [(0, 1), (1, 0), (1, 1)]))


@extra("xarray")
@extra("dask")
def test_the_ways_of_dask_and_xarray_by_hand():
    xarray, dask_array = arrays("xarray"), arrays("dask.array")
    psi1 = dask_array.from_array(np.linspace(-6.0, 6.0, 1000), chunks=300)
    chi = dask_array.from_array(np.linspace(0.3, 2.4, 1000), chunks=300)
    expected = rebound(psi1.compute(), chi.compute())
    by_blocks = dask_array.map_blocks(rebound, psi1, chi, dtype=float)
    assert by_blocks.chunks == psi1.chunks
    np.testing.assert_allclose(by_blocks.compute(), expected, atol=1e-10)
    one = dask_array.map_blocks(rebound, psi1, 1.4, dtype=float, restitution=0.8)
    np.testing.assert_allclose(
        one.compute(), rebound(psi1.compute(), 1.4, restitution=0.8), atol=1e-9
    )
    angle = xarray.DataArray(psi1[:30].rechunk(10), dims="angle")
    inertia = xarray.DataArray(chi[:20].rechunk(10), dims="chi")
    by_name = xarray.apply_ufunc(
        rebound, angle, inertia, dask="parallelized", output_dtypes=[float]
    )
    assert by_name.dims == ("angle", "chi")
    plain = rebound(angle.values[:, None], inertia.values)
    np.testing.assert_allclose(by_name.compute(), plain, atol=1e-10)
    assert bool((rebound(angle, inertia) == by_name).all())


@extra("dask")
def test_dask_arrays_are_computed_when_they_are_asked():
    dask_array = arrays("dask.array")
    psi1 = dask_array.from_array(np.array(PSI1)[:, None], chunks=2)
    chi = dask_array.from_array(np.array(CHI), chunks=2)
    psi2 = rebound(psi1, chi)
    assert isinstance(psi2, dask_array.Array)
    np.testing.assert_allclose(psi2.compute(), TABLE, atol=1e-10)
    found = rebound(psi1, np.array(CHI), derivatives=True)
    plain = rebound(np.array(PSI1)[:, None], np.array(CHI), derivatives=True)
    for mine, theirs in zip(found, plain, strict=True):
        np.testing.assert_allclose(mine.compute(), theirs, atol=1e-10)
    with pytest.raises(ValueError, match=r"shapes = .*'chi': \(2,\)}: must fit"):
        rebound(psi1[:, 0], [1.0, 1.4])
    late = rebound(psi1, chi - 1.0)
    with pytest.raises(ValueError, match="chi"):
        late.compute()
    with pytest.raises(ValueError, match="compute_chunk_sizes"):
        rebound(psi1[:, 0][psi1[:, 0] > 1.0], 1.4)


CASES = (
    "named and plain", "plain and named", "series and plain", "named and series",
    "series and dask", "text", "text and dask", "dataset", "variable", "frame",
)  # fmt: skip


def mixed():
    xarray, pandas, dask_array = map(arrays, ("xarray", "pandas", "dask.array"))
    named = xarray.DataArray(PSI1, dims="a")
    series = pandas.Series(PSI1)
    return {
        "named and plain": (named, np.array(CHI)),
        "plain and named": (CHI, named),
        "series and plain": (series, np.array(CHI)),
        "named and series": (named, series),
        "series and dask": (series, dask_array.ones(3)),
        "text": (named, "1.4"),
        "text and dask": (dask_array.ones(3), "1.4"),
        "dataset": (xarray.Dataset({"psi1": ("a", PSI1)}), 1.4),
        "variable": (xarray.Variable("a", PSI1), 1.4),
        "frame": (pandas.DataFrame({"psi1": PSI1}), 1.4),
    }


@extra("xarray")
@extra("pandas")
@extra("dask")
@pytest.mark.parametrize("case", CASES)
def test_what_has_no_common_labels_is_refused(case):
    with pytest.raises(ValueError, match=r"psi1|chi") as refusal:
        rebound(*mixed()[case])
    assert "must" in str(refusal.value) or "no labels" in str(refusal.value)


@extra("dask")
def test_a_bad_tolerance_is_refused_before_anything_is_computed():
    with pytest.raises(ValueError, match="tolerance = 2"):
        rebound(arrays("dask.array").ones(3), 1.4, tolerance=2.0)


LENGTHS = [0.5, 1.25, 3.0]
#: Every other door, by the argument that a refusal names; each takes an array of shape (3,).
DOORS = {
    "psi1": lambda x: Scene.nondimensional(psi1=x, chi=1.44),
    "chi": lambda x: Scene.nondimensional(psi1=1.0, chi=x),
    "lam": lambda x: Scene.nondimensional(psi1=1.0, chi=9.0, lam=x, rho=10.0),
    "rho": lambda x: Scene.nondimensional(psi1=1.0, chi=9.0, lam=0.1, rho=x),
    "friction_coefficient": lambda x: Scene(BALL, PLATE, x, 1.0),
    "normal_speed": lambda x: Scene(BALL, PLATE, 0.2, x),
    "spin": lambda x: Scene(BALL, PLATE, 0.2, 1.0, 1.0, x),
    "speed": lambda x: Scene.at_angle(BALL, PLATE, 0.2, speed=x, angle_deg=5.0),
    "angle_deg": lambda x: Scene.at_angle(BALL, PLATE, 0.2, speed=1.0, angle_deg=x),
    "radius": lambda x: Sphere(x, STEEL),
    "mass": lambda x: Sphere(0.01, STEEL, mass=x),
    "young_modulus": lambda x: Material(young_modulus=x, poisson_ratio=0.3),
    "density": lambda x: Material(young_modulus=1e9, poisson_ratio=0.3, density=x),
    "axis of a grid": lambda x: Scene.grid(psi1=x, chi=[1.0, 2.0]),
    "mu of an encounter": lambda x: Encounter(BALL, PLATE, x, normal=(0, 0, -1), velocity=-1.0),
    "normal": lambda x: Encounter(BALL, PLATE, 0.2, normal=x, velocity=(0, 0, -1)),
    "velocity": lambda x: Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=x),
    "inverse_mass": lambda x: Scene(None, None, 0.2, 1.0, inverse_mass=x,
                                    pair=Scene(BALL, PLATE, 0.2, 1.0).pair),
    "restitution": lambda x: collide(Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1),
                                               velocity=3 * [[0, 0, -1]]), restitution=x),
    "approach": lambda x: load_path(Scene(BALL, BALL, 0.3, 1.0), x, [0.0, 0.0, 0.0]),
    "displacement": lambda x: load_path(Scene(BALL, BALL, 0.3, 1.0), [0.0, 1e-6, 2e-6], x),
    "inertia": lambda x: RigidBody(material=STEEL, mass=1.0, inertia=x, curvature_radius=0.1),
    "flat radii": lambda x: RigidBody(material=STEEL, mass=1.0, inertia=np.eye(3),
                                      curvature_radius=x * np.inf),
    "index": lambda x: Scene(BALL, PLATE, 0.2, [1.0, 2.0, 3.0]).with_index(x),
    "e at each speed": lambda x: collide(Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1),
                                                   velocity=3 * [[0, 0, -1]]),
                                         restitution=lambda _: x),
    "semi-axes": lambda x: shapes.ellipsoid(material=STEEL, semi_axes=x, normal=(0, 0, 1)),
}  # fmt: skip


def labelled():
    xarray, pandas, dask_array = map(arrays, ("xarray", "pandas", "dask.array"))
    return {
        "xarray": (xarray.DataArray(LENGTHS, dims="impact"), "names", r"\.values"),
        "pandas": (pandas.Series(LENGTHS, index=[7, 3, 5]), "index", r"to_numpy\(\)"),
        "frame": (pandas.DataFrame({"x": LENGTHS}), "columns", r"to_numpy\(\)"),
        "dask": (dask_array.from_array(np.array(LENGTHS)), "not computed", r"compute\(\)"),
    }


@extra("xarray")
@extra("pandas")
@extra("dask")
@pytest.mark.parametrize("library", ["xarray", "pandas", "frame", "dask"])
@pytest.mark.parametrize("door", DOORS)
def test_other_doors_refuse_labels_in_one_sentence(door, library):
    given, rule, remedy = labelled()[library]
    with pytest.raises(ValueError, match=f"{rule}.*; .*{remedy}") as refusal:
        DOORS[door](given)
    assert "\n" not in str(refusal.value)


@extra("xarray")
@extra("pandas")
def test_labels_that_pair_nothing_are_no_labels():
    xarray, pandas = arrays("xarray"), arrays("pandas")
    one = xarray.DataArray(PSI1, dims="a")[1]
    assert Scene.nondimensional(psi1=one, chi=1.4).psi1 == 1.25
    counted = Scene.nondimensional(psi1=pandas.Series(PSI1), chi=pandas.Series(CHI))
    assert counted.psi1.tolist() == PSI1
    assert counted.chi.tolist() == pytest.approx(CHI, rel=1e-15)
    extension = pandas.array(PSI1, dtype="Float64").to_numpy()
    assert Scene.nondimensional(psi1=extension, chi=1.4).psi1.tolist() == PSI1
    assert rebound(pandas.Index(PSI1), 1.4).tolist() == rebound(np.array(PSI1), 1.4).tolist()


def test_none_of_the_libraries_is_loaded():
    code = (
        "import sys, numpy, contactlab as c\n"
        "c.rebound([1.2, 2.0], 1.4); c.rebound(numpy.ones(3), 1.4)\n"
        "c.Simulation().run(c.Scene.nondimensional(psi1=[1.2, 2.0], chi=1.4))\n"
        "print({'xarray', 'pandas', 'dask'} & set(sys.modules))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
