"""The table of arrays in `contactlab guide many-machines`: each row is what comes back."""

import importlib

import numpy as np
import pytest

import contactlab
from contactlab import Collision, Encounter, HalfSpace, Material, Scene, Sphere, collide, rebound
from tests.present import PACKAGE

STEEL = Material.named("steel")
BODIES = Sphere(0.01, STEEL), HalfSpace(STEEL), 0.3
PSI1, CHI = np.array([0.5, 1.2, 3.0]), np.array([1.0, 1.2, 1.4412])
NORMAL, VELOCITY = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, -2.0])
ANSWER = rebound(PSI1, CHI)
AFTER = collide(Encounter(*BODIES, normal=NORMAL, velocity=VELOCITY))


def refuses(words, call, *arguments, **named):
    with pytest.raises(ValueError, match=words):
        call(*arguments, **named)


def moved(velocity):
    """Return the velocity after an impact."""
    return Collision.of_arrays(*BODIES, normal=NORMAL, velocity=velocity).velocity


def scene(psi1):
    return Scene.nondimensional(psi1=psi1, chi=1.4)


def numpy(_):
    assert type(rebound(PSI1, CHI)) is np.ndarray
    assert type(rebound([1, 2], [1.4])) is np.ndarray
    assert type(rebound(1.2, 1.4)) is float
    refuses("must broadcast to one", rebound, PSI1, CHI[:2])
    refuses("JAX or PyTorch; collide", moved, VELOCITY)
    assert scene(PSI1).psi1.tolist() == PSI1.tolist()


def xarray(library):
    angle, ratio = library.DataArray(PSI1, dims="angle"), library.DataArray(CHI, dims="chi")
    psi2 = rebound(angle, ratio)
    assert (type(psi2), psi2.dims) == (library.DataArray, ("angle", "chi"))
    np.testing.assert_allclose(psi2.values, rebound(PSI1[:, None], CHI), atol=1e-12)
    refuses("must have equal labels", rebound, angle.assign_coords(angle=[1, 2, 3]),
            angle.assign_coords(angle=[1, 2, 4]))  # fmt: skip
    refuses("DataArray", rebound, angle.to_dataset(name="psi1"), 1.4)
    refuses("DataArray", rebound, angle.variable, 1.4)
    refuses("JAX or PyTorch", moved, library.DataArray(VELOCITY, dims="axis"))
    refuses("dimensions with names", scene, angle)
    if importlib.util.find_spec("dask"):
        assert rebound(angle.chunk(1), 1.4).chunks is not None


def pandas(library):
    angle = library.Series(PSI1, index=[2, 0, 1])
    psi2 = rebound(angle, library.Series(CHI, index=[1, 2, 0]))
    assert (type(psi2), psi2.index.tolist()) == (library.Series, [2, 0, 1])
    np.testing.assert_allclose(psi2.to_numpy(), rebound(PSI1, CHI[[1, 2, 0]]), atol=1e-12)
    refuses("must have equal labels", rebound, angle, library.Series(CHI, index=[1, 2, 3]))
    refuses("Series", rebound, angle.to_frame(), 1.4)
    refuses("JAX or PyTorch", moved, library.Series(VELOCITY))
    assert scene(library.Series(PSI1)).psi1.tolist() == PSI1.tolist()
    refuses("index", scene, angle)


def dask(_):
    arrays = pytest.importorskip("dask.array")
    lazy = arrays.from_array(PSI1, chunks=2)
    psi2 = rebound(lazy, CHI)
    assert type(psi2) is arrays.Array
    assert np.array_equal(psi2.compute(scheduler="synchronous"), ANSWER)
    other = rebound(lazy, arrays.from_array(CHI, chunks=1))
    assert np.array_equal(other.compute(scheduler="synchronous"), ANSWER)
    refuses("unknown size", rebound, lazy[lazy > 1.0], 1.4)
    refuses("JAX or PyTorch", moved, arrays.from_array(VELOCITY))
    refuses("not computed", scene, lazy)


def jax(library):
    array = library.numpy.asarray
    psi2 = rebound(array(PSI1), array(CHI))
    assert isinstance(psi2, library.Array)
    np.testing.assert_allclose(psi2, ANSWER, atol=2e-6)
    refuses("derivatives", rebound, array(PSI1), 1.4, derivatives=True)
    slope = library.vmap(library.grad(rebound), in_axes=(0, None))(array(PSI1), 1.4412)
    np.testing.assert_allclose(slope, rebound(PSI1, 1.4412, derivatives=True)[1], atol=1e-4)
    after = library.jit(moved)(array(VELOCITY))
    assert isinstance(after, library.Array)
    np.testing.assert_allclose(after, AFTER.velocity, atol=2e-6)
    assert scene(array(PSI1)).psi1.size == 3
    refuses("is traced by jax", library.jit(lambda x: scene(x).psi1), array(PSI1))


def torch(library):
    psi1 = library.tensor(PSI1, requires_grad=True)
    psi2 = rebound(psi1, library.tensor(CHI))
    assert type(psi2) is library.Tensor
    np.testing.assert_allclose(psi2.detach().numpy(), ANSWER, atol=1e-9)
    (slope,) = library.autograd.grad(psi2.sum(), psi1)
    np.testing.assert_allclose(slope, rebound(PSI1, CHI, derivatives=True)[1], atol=1e-8)
    refuses("derivatives", rebound, psi1, 1.4, derivatives=True)
    after = moved(library.tensor(VELOCITY, requires_grad=True))
    assert after.requires_grad
    np.testing.assert_allclose(after.detach().numpy(), AFTER.velocity, atol=1e-9)
    assert scene(psi1.detach()).psi1.size == 3
    refuses("has a gradient", scene, psi1)


ROWS = {"NumPy": numpy, "xarray": xarray, "pandas": pandas, "dask": dask, "JAX": jax,
        "PyTorch": torch}  # fmt: skip


def test_every_row_of_the_guide_is_tested():
    text = (PACKAGE / "guide" / "many-machines.md").read_text("utf-8")
    table = text[text.index("| arrays of |") :].split("\n\n")[0].splitlines()
    firsts = [line.strip("| ").replace(",", " ").replace(":", " ").split()[0] for line in table[2:]]
    assert firsts == [*ROWS]


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n == "JAX")) for n in ROWS]
)
def test_what_comes_back(name):
    package = ROWS[name].__name__
    reason = f"{package} is not installed: an extra of contactlab has it"
    ROWS[name](pytest.importorskip(package, reason=reason))


def test_two_packages_are_refused_together():
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    series, array = pandas.Series(PSI1), xarray.DataArray(PSI1, dims="impact")
    refuses("one package", rebound, series, array)
    for one in (series, array):
        refuses("has no labels", contactlab.rebound, one, CHI)
