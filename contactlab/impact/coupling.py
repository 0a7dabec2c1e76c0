"""Cautions about elastic coupling of unlike bodies (theory §9), and about three numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.impact.hertz import slips_throughout_elastic
from contactlab.impact.scene import Scene

#: Shift of psi2 by elastic coupling of unlike bodies, to 0.002: the difference between
#: three-dimensional half-space solutions with one-way coupling and the axisymmetric theory. The
#: solutions have this chi and this effective Poisson's ratio; for other scenes the table gives
#: a rough size only.
COUPLING_CHI, COUPLING_NU = 49.0 / 34.0, 0.3
COUPLING_LAMBDA = (0.0, 0.25, 0.5, 1.0, 2.0)
COUPLING_PSI1 = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0)
COUPLING_SHIFT = (
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 0.0026, 0.0150, 0.0033, 0.0007, 0.0021),
    (0.0, 0.0117, 0.0468, 0.0125, 0.0016, 0.0060),
    (0.0, 0.0667, 0.1266, 0.0463, 0.0062, 0.0208),
    (0.0, 0.1681, 0.2560, 0.1428, 0.0413, 0.0598),
)
#: Smallest shift of psi2 with a caution.
LEAST_SHIFT = 1e-3
#: Largest difference of chi, and of Poisson's ratio, at which the table fits a scene.
NEAR = 0.03


def coupling_number(scene: Scene) -> Any:
    """Return Lambda = kappa beta/mu, beta Dundurs' constant; infinite without friction."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        strength: Any = np.abs(scene.pair.stiffness_ratio * scene.pair.dundurs_beta)
        return np.where(strength == 0.0, 0.0, np.divide(strength, scene.friction_coefficient))


def coupling_shift(scene: Scene) -> Any:
    """Return the shift of psi2 by coupling, from the table, clipped to its range.

    In gross slip throughout the table does not hold and the shift is NaN; without friction it is 0.
    """
    row, column = np.broadcast_arrays(
        np.clip(coupling_number(scene), 0.0, COUPLING_LAMBDA[-1]),
        np.clip(np.abs(scene.psi1), 0.0, COUPLING_PSI1[-1]),
    )
    table = np.array(COUPLING_SHIFT)
    lines = np.stack([np.interp(column, COUPLING_PSI1, line) for line in table])
    at = np.clip(np.searchsorted(COUPLING_LAMBDA, row, side="right") - 1, 0, len(table) - 2)
    below, above = (np.take_along_axis(lines, (at + k)[None], axis=0)[0] for k in (0, 1))
    edges = np.array(COUPLING_LAMBDA)
    share = (row - edges[at]) / (edges[at + 1] - edges[at])
    shift = below + share * (above - below)
    slipping = slips_throughout_elastic(np.asarray(scene.psi1), np.asarray(scene.chi))
    shift = np.where(slipping, np.nan, shift)
    return np.where(np.asarray(scene.friction_coefficient) == 0.0, 0.0, shift)


def coupling(scene: Scene) -> tuple[str, ...]:
    """Return the cautions of unlike bodies, whose normal pressure shears the contact."""
    beta = scene.pair.dundurs_beta
    if beta == 0.0 if isinstance(beta, float) else not np.any(beta):
        return ()
    shape = np.broadcast_shapes(scene.shape, (1,))
    number, shift, psi1, chi, kappa = (
        np.broadcast_to(each, shape).ravel()
        for each in (
            coupling_number(scene),
            coupling_shift(scene),
            np.abs(scene.psi1),
            scene.chi,
            scene.pair.stiffness_ratio,
        )
    )
    start = (
        "unlike bodies: the elastic coupling of pressure and slip is left out, "
        "Lambda = kappa beta/mu"
    )
    upto = "up to " if scene.shape else ""
    cautions = []
    if np.any(shift >= LEAST_SHIFT):
        worst = int(np.nanargmax(shift))
        nu = (2.0 - 2.0 * kappa[worst]) / (2.0 - kappa[worst])
        beyond = "at least " if number[worst] > COUPLING_LAMBDA[-1] else "about "
        cautions.append(
            f"{start} = {number[worst]:.2g}; it moves psi2 by {upto}{beyond}{shift[worst]:.1g} "
            f"(model, not numerical error; {_table(chi[worst], nu, psi1[worst])})"
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        slipping = np.where(np.isnan(shift), number / psi1, 0.0)
    if np.any(slipping * slipping >= LEAST_SHIFT):
        worst = int(np.argmax(slipping))
        cautions.append(
            f"{start} = {number[worst]:.2g}; where the whole contact slips it moves psi2 to second "
            f"order in Lambda/psi1 = {upto}{slipping[worst]:.2g} only, by how much is not known "
            "(model, not numerical error)"
        )
    return tuple(cautions)


def _table(chi: float, nu: float, psi1: float) -> str:
    """Return in words which scenes the table is for, and how this scene differs."""
    off = []
    if abs(chi - COUPLING_CHI) > NEAR:
        off.append(f"chi = {chi:.3g}")
    if abs(nu - COUPLING_NU) > NEAR:
        off.append(f"nu = {nu:.2g}")
    if psi1 > COUPLING_PSI1[-1]:
        off.append(f"psi1 = {psi1:.3g}")
    source = f"by a table for chi = {COUPLING_CHI:.3g}, nu = {COUPLING_NU:g}, psi1 up to 3"
    return source + (f"; a rough guide at {', '.join(off)}" if off else "")


def three_numbers(scene: Scene) -> tuple[str, ...]:
    """Return the caution of a single entry with three numbers, which may be meant as a vector."""
    if scene.shape != (3,) or scene.sphere is None:
        return ()
    arrays = [name for name, number in scene.numbers().items() if np.ndim(number)]
    if len(arrays) != 1:
        return ()
    return (
        f"{arrays[0]} has three numbers, taken for three impacts: vectors in space belong in an "
        "Encounter",
    )
