"""Sentences on what a model leaves out, with a size where one is known (theory §9)."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.impact.scene import Scene

#: Shift of psi2 by elastic coupling of unlike bodies, of three-dimensional half-space solutions
#: with one-way coupling, nu = 0.3, chi = 49/34, against the axisymmetric theory; to 0.002.
COUPLING_LAMBDA = (0.0, 0.25, 0.5, 1.0, 2.0)
COUPLING_PSI1 = (0.0, 0.5, 1.0, 1.5, 2.0, 3.0)
COUPLING_SHIFT = (
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, 0.0026, 0.0150, 0.0033, 0.0007, 0.0021),
    (0.0, 0.0117, 0.0468, 0.0125, 0.0016, 0.0060),
    (0.0, 0.0667, 0.1266, 0.0463, 0.0062, 0.0208),
    (0.0, 0.1681, 0.2560, 0.1428, 0.0413, 0.0598),
)
#: Shifts below this are not worth a sentence.
LEAST_SHIFT = 1e-3


def coupling_number(scene: Scene) -> Any:
    """Return Lambda = kappa beta/mu, beta Dundurs' constant; infinite without friction."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        strength: Any = np.abs(scene.pair.stiffness_ratio * scene.pair.dundurs_beta)
        return np.where(strength == 0.0, 0.0, np.divide(strength, scene.friction_coefficient))


def coupling_shift(scene: Scene) -> Any:
    """Return about how far coupling moves psi2, by the table above; at its ends beyond it."""
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
    return np.where(np.asarray(scene.friction_coefficient) == 0.0, 0.0, shift)


def coupling(scene: Scene) -> tuple[str, ...]:
    """Return the caution of unlike bodies, whose pressure drags the surfaces sideways."""
    beta = scene.pair.dundurs_beta
    if beta == 0.0 if isinstance(beta, float) else not np.any(beta):
        return ()
    number, shift = (
        np.broadcast_to(each, scene.shape)
        for each in (coupling_number(scene), coupling_shift(scene))
    )
    worst = np.unravel_index(np.argmax(shift), scene.shape) if scene.shape else ()
    if not float(shift[worst]) >= LEAST_SHIFT:
        return ()
    beyond = "at least " if float(number[worst]) > COUPLING_LAMBDA[-1] else "about "
    upto = "up to " if scene.shape else ""
    return (
        "unlike bodies: the elastic coupling of pressure and slip is left out, Lambda = "
        f"kappa beta/mu = {float(number[worst]):.2g}; it moves psi2 by {upto}{beyond}"
        f"{float(shift[worst]):.1g} (model, not numerical error)",
    )


def three_numbers(scene: Scene) -> tuple[str, ...]:
    """Return the caution of three numbers, all else being one, that may be meant for a vector."""
    if scene.shape != (3,) or scene.sphere is None:
        return ()
    arrays = [name for name, number in scene.numbers().items() if np.ndim(number)]
    if len(arrays) != 1:
        return ()
    return (
        f"{arrays[0]} has three numbers, taken for three impacts: vectors in space belong in an "
        "Encounter",
    )


def hemisphere(claims: frozenset[str]) -> tuple[str, ...]:
    """Return the caution of a pressure that is taken for a hemisphere and may be none."""
    if "hertzian_pressure" in claims:
        return ()
    return (
        "the friction law takes the pressure for a hemisphere over the contact radius that "
        "carries the friction load; the normal law does not say that it is one (model error)",
    )
