"""``rebound`` of arrays of JAX and PyTorch, and its formulas by the standard, against NumPy's."""

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, Scene, Sphere, rebound
from contactlab_laws import compiled
from contactlab_laws.tables import elastic, regions, traced

pytest.importorskip("table_builders", reason="table_builders is not in the wheel")

from table_builders.elastic.exact import exact

#: Corners of the regions, where conditions choose: psi1 = 1, 4 chi - 1, 0; chi = 1/2.
CORNERS = [(p, x) for x in (1e-3, 0.25, 0.5, 0.6, 0.75, 1.44, 2.5)
           for p in (0.0, 1e-12, 0.3, 1.0, 1.0 + 1e-12, 4.0 * x - 1.0, 2.0 * x, 9.0)]  # fmt: skip

needs_namespace = pytest.mark.skipif(
    not hasattr(np, "astype"), reason="NumPy before 2.1 is no namespace of the array API standard"
)


def impacts(low, high, count=20_000):
    draw = np.random.default_rng(5)
    psi1, chi = draw.uniform(-7.0, 7.0, count), draw.uniform(low, high, count)
    corners = np.array([each for each in CORNERS if low <= each[1] <= high]).T
    return np.concatenate((psi1, corners[0], -corners[0])), np.concatenate((chi, *2 * [corners[1]]))


@needs_namespace
def test_the_formulas_give_what_the_table_gives():
    psi1, chi = impacts(1e-3, 2.5)
    psi2 = traced.rebound(np, traced.elastic_constants(), psi1, chi)
    np.testing.assert_allclose(psi2, rebound(psi1, chi), atol=1e-9)
    assert (np.abs(psi2) <= np.abs(psi1)).all()
    assert np.array_equal(traced.rebound(np, traced.elastic_constants(), -psi1, chi), -psi2)


@needs_namespace
def test_the_formulas_with_loss_give_what_the_table_gives():
    psi1, chi = impacts(0.3, 2.5)
    e = np.random.default_rng(6).uniform(0.0, 1.0, psi1.size)
    e[:500], e[500:2500], e[2500:3000] = 0.0, 0.99 + 0.01 * e[500:2500], 1.0
    tables = traced.list_constants()
    psi2 = traced.rebound_with_loss(np, tables, psi1, chi, e, joined=True)
    np.testing.assert_allclose(psi2, rebound(psi1, chi, restitution=e), atol=1e-9)
    low = np.minimum(e, 0.99)
    alone = traced.rebound_with_loss(np, tables, psi1, chi, low, joined=False)
    np.testing.assert_allclose(alone, rebound(psi1, chi, restitution=low), atol=1e-9)


def test_the_formulas_ask_for_the_standard_alone():
    strict = pytest.importorskip("array_api_strict")
    psi1, chi = impacts(0.3, 2.5, count=500)
    e = np.random.default_rng(9).uniform(0.0, 1.0, psi1.size)
    given = [strict.asarray(each) for each in (psi1, chi, e)]
    elastic, lossy = (
        {name: strict.asarray(np.array(each)) for name, each in constants.items()}
        for constants in (traced.elastic_constants(), traced.list_constants())
    )
    psi2 = np.asarray(traced.rebound(strict, elastic, *given[:2]))
    np.testing.assert_allclose(psi2, rebound(psi1, chi), atol=1e-9)
    psi2 = np.asarray(traced.rebound_with_loss(strict, lossy, *given, joined=True))
    np.testing.assert_allclose(psi2, rebound(psi1, chi, restitution=e), atol=1e-9)


@needs_namespace
@pytest.mark.parametrize(("psi1", "chi"), [(np.nan, 1.0), (np.inf, 1.0), (1.0, 0.0), (1.0, 2.6),
                                           (1.0, np.nan), (1.0, -1.0)])  # fmt: skip
def test_out_of_the_table_psi2_is_nan(psi1, chi):
    psi1, chi, e = np.array([psi1]), np.array([chi]), np.array([1.0])
    assert np.isnan(traced.rebound(np, traced.elastic_constants(), psi1, chi)).all()
    tables = traced.list_constants()
    assert np.isnan(traced.rebound_with_loss(np, tables, psi1, chi, e, joined=True)).all()


def test_jax_arrays_give_jax_arrays(jax):
    psi1, chi = impacts(1e-3, 2.5, count=300)
    for function in (rebound, jax.jit(rebound), jax.vmap(rebound), jax.jit(jax.vmap(rebound))):
        psi2 = function(jax.numpy.asarray(psi1), jax.numpy.asarray(chi))
        assert isinstance(psi2, jax.Array)
        np.testing.assert_allclose(psi2, rebound(psi1, chi), atol=1e-9)
    table = rebound(jax.numpy.asarray(psi1)[:, None], np.array([0.8, 1.4]))
    np.testing.assert_allclose(table, rebound(psi1[:, None], np.array([0.8, 1.4])), atol=1e-9)
    one = rebound(jax.numpy.asarray(1.2), 1.44)
    assert one.shape == ()
    assert float(one) == pytest.approx(rebound(1.2, 1.44), abs=1e-9)
    assert rebound(jax.numpy.zeros((0,)), 1.44).shape == (0,)


def test_jax_takes_restitutions(jax):
    psi1, chi = impacts(0.3, 2.5, count=300)
    given, ratios = jax.numpy.asarray(psi1), jax.numpy.asarray(chi)
    each = np.random.default_rng(7).uniform(0.0, 1.0, psi1.size)
    for e in (0.0, 0.8, 0.995, 1, each, jax.numpy.asarray(each)):
        plain = rebound(psi1, chi, restitution=np.asarray(e, dtype=float) if np.ndim(e) else e)
        np.testing.assert_allclose(rebound(given, ratios, restitution=e), plain, atol=1e-9)
    by_e = jax.jit(lambda e: rebound(1.2, 1.44, restitution=e))
    assert float(by_e(0.7)) == pytest.approx(rebound(1.2, 1.44, restitution=0.7), abs=1e-9)


def test_jax_differentiates(jax):
    """Against the complex step of NumPy's table; 0 is a point like any other."""
    psi1 = np.array([-3.0, 0.2, 0.9, 1.2, 2.0, 4.0, 7.0])
    _, by_psi1, by_chi = rebound(psi1, 49 / 34, derivatives=True)
    found = jax.vmap(jax.grad(rebound, argnums=(0, 1)), in_axes=(0, None))(psi1, 49 / 34)
    np.testing.assert_allclose(found[0], by_psi1, atol=1e-8)
    np.testing.assert_allclose(found[1], by_chi, atol=1e-8)
    at_zero = (rebound(1e-6, 1.44) - rebound(-1e-6, 1.44)) / 2e-6
    assert float(jax.grad(rebound)(0.0, 1.44)) == pytest.approx(at_zero, abs=1e-5)
    for corner in CORNERS:
        slopes = np.array(jax.grad(rebound, argnums=(0, 1))(*corner))
        assert np.isfinite(slopes).all(), corner
    psi2, slope = jax.jvp(rebound, (psi1, 49 / 34), (np.ones_like(psi1), 2.0))
    np.testing.assert_allclose(psi2, rebound(psi1, 49 / 34), atol=1e-9)
    np.testing.assert_allclose(slope, by_psi1 + 2.0 * by_chi, atol=1e-8)


@pytest.mark.slow
def test_jax_differentiates_with_loss(jax):
    psi1 = np.array([-3.0, 0.2, 0.9, 1.2, 2.0, 4.0, 7.0])

    def lossy(psi1, chi, e):
        return rebound(psi1, chi, restitution=e)

    *_, by_psi1, by_chi, by_e = rebound(psi1, 49 / 34, restitution=0.8, derivatives=True)
    found = jax.vmap(jax.grad(lossy, argnums=(0, 1, 2)), in_axes=(0, None, None))(
        psi1, 49 / 34, 0.8
    )
    for mine, theirs in zip(found, (by_psi1, by_chi, by_e), strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-8)


@pytest.mark.slow
def test_second_derivatives_are_differences_of_first(jax):
    """Within 1e-6, away from psi1 = 1, 4 chi - 1 and chi = 1/2."""
    draw = np.random.default_rng(8)
    psi1, chi = draw.uniform(0.0, 7.0, 2000), draw.uniform(0.05, 2.45, 2000)
    away = np.minimum(np.abs(psi1 - 1.0), np.abs(psi1 - 4.0 * chi + 1.0)) > 0.02
    away &= np.abs(chi - 0.5) > 0.02
    psi1, chi = psi1[away], chi[away]
    found = jax.jit(jax.vmap(jax.hessian(rebound, argnums=(0, 1))))(psi1, chi)

    def slopes(k, one):
        """Return both first derivatives ``k`` steps along psi1 or chi."""
        moved = psi1 + k * step * one, chi + k * step * (1 - one)
        return np.array(rebound(*moved, derivatives=True)[1:])

    step = 1e-5
    for mine, one in zip(np.array(found), (1, 0), strict=True):
        near, far = (slopes(k, one) - slopes(-k, one) for k in (1, 2))
        assert np.abs(mine - (8.0 * near - far) / (12.0 * step)).max() < 1e-6


@pytest.mark.slow
@pytest.mark.skipif(compiled.library() is None, reason="Python's solver takes some minutes")
def test_second_derivatives_are_those_of_the_exact_law(jax):
    """Within 1e-6, away from psi1 = 0, 1, 4 chi - 1 and chi = 1/2; 5e-3 from cuts and seam."""
    draw = np.random.default_rng(10)
    psi1, chi = draw.uniform(0.01, 7.0, 4000), draw.uniform(0.05, 2.45, 4000)
    away = np.minimum(np.abs(psi1 - 1.0), np.abs(psi1 - 4.0 * chi + 1.0)) > 0.02
    away &= (np.abs(chi - 0.5) > 0.02) & (psi1 < np.maximum(1.0, 4.0 * chi - 1.0))
    psi1, chi, step = psi1[away], chi[away], 4e-4
    weights = np.array([2.0, -27.0, 270.0, -490.0, 270.0, -27.0, 2.0]) / (180.0 * step**2)
    same = np.ones(psi1.size, dtype=bool)

    def second(along_psi1, along_chi):
        """Return the sixth-order second difference of the exact law along a direction."""
        shifts = np.arange(-3, 4)[:, None] * step
        moved = psi1 + along_psi1 * shifts, chi + along_chi * shifts
        for far in (-5e-3, 5e-3):
            there = sides(psi1 + along_psi1 * far, chi + along_chi * far)
            same[there != sides(psi1, chi)] = False
        return weights @ exact(*(each.ravel() for each in moved)).reshape(7, -1)

    def sides(psi1, chi):
        """Return the region of each impact, and the side of the seam within SLIP_ON."""
        here = regions.places(psi1, chi, elastic.load_table().cuts)
        side = np.empty(psi1.size, dtype=int)
        side[here.who] = 2 * here.region + ((here.region == regions.SLIP_ON) & (here.a > 0.5))
        return side

    twice, both, chi_twice = second(1, 0), second(1, 1), second(0, 1)
    mixed = 0.5 * (both - twice - chi_twice)
    found = np.array(jax.jit(jax.vmap(jax.hessian(rebound, argnums=(0, 1))))(psi1, chi))
    for mine, theirs in zip(
        (found[0, 0], found[0, 1], found[1, 1]), (twice, mixed, chi_twice), strict=True
    ):
        assert np.abs(mine - theirs)[same].max() < 1e-6
    assert same.sum() > 0.95 * same.size > 1500


def test_float32_keeps_its_digits(jax):
    """2e-6 of max(1, abs(psi1)): the largest of a million impacts was 1.2e-6."""
    psi1, chi = (each.astype(np.float32) for each in impacts(0.3, 2.49, count=20_000))
    size = np.maximum(1.0, np.abs(psi1))
    exact = rebound(psi1.astype(float), chi.astype(float))
    psi2 = rebound(jax.numpy.asarray(psi1), jax.numpy.asarray(chi))
    assert psi2.dtype == np.float32
    assert (np.abs(np.asarray(psi2, float) - exact) / size).max() < 2e-6
    assert rebound(jax.numpy.asarray(psi1), 1.44).dtype == np.float32
    lossy = rebound(jax.numpy.asarray(psi1), jax.numpy.asarray(chi), restitution=0.75)
    exact = rebound(psi1.astype(float), chi.astype(float), restitution=0.75)
    assert (np.abs(np.asarray(lossy, float) - exact) / size).max() < 2e-6
    for chi in (np.array([1.44], ">f8"), np.array([1.44], np.longdouble), np.longdouble(1.44)):
        found = rebound(jax.numpy.asarray([1.0, 2.0]), chi)
        assert found == pytest.approx(rebound([1.0, 2.0], 1.44), abs=1e-9)
    assert rebound(jax.numpy.asarray([1, 2]), 1.44).dtype == np.float64
    assert rebound(jax.numpy.asarray([1.0], "float16"), 1.44).dtype == np.float32


def test_known_numbers_are_refused_and_traced_ones_are_nan(jax):
    one = jax.numpy.asarray([1.0, 2.0])
    for arguments, words in (
        ((one, 2.6), r"chi = 2.6: must be positive and at most 2.5 with arrays of jax; the table"),
        ((one * np.nan, 1.0), "psi1"),
        ((one, -1.0), "chi"),
        ((one, jax.numpy.ones(3)), "must fit"),
        ((one, "1.4"), "chi"),
    ):
        with pytest.raises(ValueError, match=words):
            rebound(*arguments)
    with pytest.raises(ValueError, match="restitution"):
        rebound(one, 1.0, restitution=1.5)
    with pytest.raises(ValueError, match=r"chi = 0.2: must lie from 0.3 to 3.0 with arrays of jax"):
        rebound(one, 0.2, restitution=0.5)
    with pytest.raises(ValueError, match="restitution = True"):
        rebound(one, 1.0, restitution=True)
    with pytest.raises(ValueError, match="tolerance"):
        rebound(one, 1.0, tolerance=2.0)
    with pytest.raises(ValueError, match=r"derivatives.*jax\.grad"):
        rebound(one, 1.0, derivatives=True)
    for kind in ("complex64", "bool"):  # a type is known, also of what is traced
        with pytest.raises(ValueError, match=r"psi1 = .*: must be a real number"):
            jax.jit(rebound)(one.astype(kind), 1.0)
    assert np.isnan(jax.jit(rebound)(one, 2.6)).all()
    assert np.isnan(jax.jit(rebound)(one * np.nan, 1.0)).all()
    pandas = pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="one package"):
        rebound(one, pandas.Series([1.0, 2.0]))


def test_other_doors_take_known_arrays_and_refuse_traced_ones(jax):
    steel = Material.named("steel")
    bodies = Sphere(0.01, steel), HalfSpace(steel)
    assert Scene.nondimensional(psi1=jax.numpy.asarray([1.0, 2.0]), chi=1.4).psi1.tolist() == [1, 2]
    for door in (
        lambda x: Scene.nondimensional(psi1=x, chi=1.4).psi1,
        lambda x: Scene(*bodies, 0.2, x, 1.0).psi1,
        lambda x: Encounter(*bodies, 0.2, normal=(0, 0, -1), velocity=x).velocity,
    ):
        with pytest.raises(ValueError, match="is traced by jax; of scenes"):
            jax.jit(door)(jax.numpy.asarray([1.0, 2.0, 3.0]))


def test_tensors_give_tensors(torch):
    psi1, chi = impacts(0.3, 2.5, count=300)
    e = np.random.default_rng(7).uniform(0.0, 1.0, psi1.size)
    given, ratios, each = (torch.tensor(values) for values in (psi1, chi, e))
    psi2 = rebound(given, ratios)
    assert psi2.dtype == torch.float64
    np.testing.assert_allclose(psi2.numpy(), rebound(psi1, chi), atol=1e-9)
    for lossy in (0.0, 0.8, 1, e, each):
        plain = rebound(psi1, chi, restitution=np.asarray(lossy) if np.ndim(lossy) else lossy)
        found = rebound(given, ratios, restitution=lossy)
        np.testing.assert_allclose(found.numpy(), plain, atol=1e-9)
    plain = rebound(psi1, np.full_like(psi1, 49 / 34))
    np.testing.assert_allclose(rebound(given, 49 / 34).numpy(), plain, atol=1e-9)
    assert rebound(given.float(), 1.44).dtype == torch.float32
    assert rebound(torch.tensor([1, 2]), 1.44).dtype == torch.float32
    assert rebound(given[:, None], np.array([0.8, 1.4])).shape == (psi1.size, 2)


def test_gradients_pass_tensors(torch):
    psi1 = torch.tensor([-3.0, 0.2, 0.9, 1.2, 2.0, 4.0, 7.0], dtype=torch.float64)
    chi = torch.tensor(49 / 34, dtype=torch.float64, requires_grad=True)
    _, by_psi1, by_chi = rebound(psi1.numpy(), 49 / 34, derivatives=True)
    psi1.requires_grad_(True)
    found = torch.autograd.grad(rebound(psi1, chi).sum(), (psi1, chi))
    np.testing.assert_allclose(found[0].numpy(), by_psi1, atol=1e-8)
    assert float(found[1]) == pytest.approx(by_chi.sum(), abs=1e-8)
    with pytest.raises(ValueError, match=r"psi1 = .*has a gradient.*; give \.detach"):
        Scene.nondimensional(psi1=psi1, chi=1.4)
    assert Scene.nondimensional(psi1=psi1.detach(), chi=1.4).psi1.size == 7
    for arguments, words in (
        ((psi1, 2.6), r"chi = 2.6: .* at most 2.5 with arrays of torch"),
        ((psi1 * np.nan, 1.0), "psi1"),
        ((psi1, torch.ones(3)), "must fit"),
    ):
        with pytest.raises(ValueError, match=words):
            rebound(*arguments)
    with pytest.raises(ValueError, match=r"derivatives.*torch\.autograd"):
        rebound(psi1, 1.0, derivatives=True)
