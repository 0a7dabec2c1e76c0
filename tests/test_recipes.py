"""Recipes for ``contactlab.rebound`` in JAX and PyTorch; run where those are installed."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from contactlab import rebound

RECIPES = Path(__file__).parents[1] / "examples" / "recipes"
PSI1 = np.array([-3.0, 0.2, 0.9, 1.2, 2.0, 4.0, 7.0])
CHI = 49 / 34


def recipe(name):
    """Return a recipe as a module."""
    spec = importlib.util.spec_from_file_location(name, RECIPES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def differences(psi1, chi, step=1e-5):
    """Return central differences of psi2 by psi1 and by chi."""
    by_psi1 = (rebound(psi1 + step, chi) - rebound(psi1 - step, chi)) / (2.0 * step)
    by_chi = (rebound(psi1, chi + step) - rebound(psi1, chi - step)) / (2.0 * step)
    return by_psi1, by_chi


def test_every_recipe_is_run_here():
    names = {path.stem for path in RECIPES.glob("*.py")}
    assert names == {"rebound_in_jax", "rebound_in_torch"}


def test_jax():
    jax = pytest.importorskip("jax", reason="JAX is not installed: pip install contactlab[recipes]")
    ours = recipe("rebound_in_jax").rebound
    by_psi1, by_chi = differences(PSI1, CHI)
    assert np.asarray(ours(PSI1, CHI)) == pytest.approx(rebound(PSI1, CHI), abs=1e-15)
    gradient = jax.jit(jax.vmap(jax.grad(ours, argnums=(0, 1)), in_axes=(0, None)))
    found = gradient(PSI1, CHI)
    assert np.asarray(found[0]) == pytest.approx(by_psi1, abs=1e-4)
    assert np.asarray(found[1]) == pytest.approx(by_chi, abs=1e-4)
    value, slope = jax.jvp(ours, (PSI1, CHI), (np.ones_like(PSI1), 2.0))
    assert np.asarray(value) == pytest.approx(rebound(PSI1, CHI), abs=1e-15)
    assert np.asarray(slope) == pytest.approx(by_psi1 + 2.0 * by_chi, abs=1e-4)
    together = jax.grad(lambda psi1: (ours(psi1, CHI) ** 2).sum())(PSI1)
    assert np.asarray(together) == pytest.approx(2.0 * rebound(PSI1, CHI) * by_psi1, abs=1e-3)


def test_torch():
    torch = pytest.importorskip(
        "torch", reason="PyTorch is not installed: pip install contactlab[recipes]"
    )
    ours = recipe("rebound_in_torch").rebound
    psi1 = torch.tensor(PSI1, requires_grad=True)
    chi = torch.tensor(CHI, dtype=torch.float64, requires_grad=True)
    psi2 = ours(psi1, chi)
    assert psi2.detach().numpy() == pytest.approx(rebound(PSI1, CHI), abs=1e-15)
    (psi2**2).sum().backward()
    by_psi1, by_chi = differences(PSI1, CHI)
    weight = 2.0 * rebound(PSI1, CHI)
    assert psi1.grad.numpy() == pytest.approx(weight * by_psi1, abs=1e-3)
    assert float(chi.grad) == pytest.approx(float((weight * by_chi).sum()), abs=1e-3)
    smooth = torch.tensor([0.7, 1.5, 3.0, 8.0], dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(ours, (smooth, chi), eps=1e-5, atol=1e-4)
    single = torch.tensor([1.2], dtype=torch.float32, requires_grad=True)
    ours(single, torch.tensor(CHI)).sum().backward()
    assert single.grad.dtype == torch.float32
