"""Effect of spin about the normal on an impact, where its friction is left out."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlab.impact.body_contact import sides, spin_about, turning_compliance
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.impact.table import between_nodes, read_rows
from contactlab.numeric.types import Array, Mask, Real
from contactlab.numeric.vectors import components

#: psi2 and loss of spin by two programs that solve the half-space with slip and spin together.
FILE = Path(__file__).with_name("normal_spin.csv")
#: Loss of w over chi_w where spin makes all of the contact slip: (15 pi/32) (4/5) B(6/5, 1/2).
ALL_SLIPS = 2.1100237
#: Points of the sums over a gross slip; 16 hold the closed forms to 1e-6.
POINTS = 16
#: Largest w at which the continuation beyond the table was measured, by half-space solutions.
LARGEST_W = 50.0


class Nodes(NamedTuple):
    """The table: its axes psi1, chi and w, and psi2 and loss over chi_w at the nodes."""

    axes: tuple[Array, Array, Array]
    psi2: Array
    loss: Array


class NormalSpin(NamedTuple):
    """Spin about the normal that the law leaves out, and the changes by its friction.

    Attributes
    ----------
    acts : bool or array of bool
        True where there is friction, and the bodies turn against each other about the normal.
    w : float or array
        kappa omega a/(mu v1): omega the relative spin about the normal, a the largest contact
        radius. Not negative.
    shift : float or array
        Shift of psi2, with the sign in which slip before the impact is positive.
    loss : float or array
        Part of the relative spin about the normal that friction takes.
    known : bool or array of bool
        True where shift and loss are those of the table, or of its closed form of gross slip.
    """

    acts: Mask
    w: Real
    shift: Real
    loss: Real
    known: Mask


@cache
def nodes() -> Nodes:
    """Return the table, arrays of shape (psi1, chi, w)."""
    _, rows = read_rows(FILE)
    chi, psi1, w = (np.unique(column) for column in rows[:, :3].T)
    sized = rows[:, 3:].reshape(len(chi), len(psi1), len(w), 2)
    psi2, loss = np.moveaxis(sized, (0, 3), (2, 0))
    return Nodes((psi1, chi, w), psi2, loss)


def shift_and_loss(psi1: Real, chi: Real, w: Real, chi_w: Real) -> tuple[Array, Array]:
    """Return the shift of psi2 by spin about the normal, and the loss of w; both without unit.

    Both are linear between the nodes of a table of half-space solutions with psi1 up to 7, chi
    from 1 to 1.75 and w up to 5. Where the shift exceeds 0.01 it lies within 0.6 to 1.9 times that
    of random impacts, nu from 0 to 0.49. Gross slip beyond the table has a closed form, and larger
    w a continuation that holds up to ``LARGEST_W``. Other entries are clipped to the table's range:
    ``NormalSpin.known`` is False there.

    Parameters
    ----------
    psi1 : float or array
        Scaled slip velocity before the impact, eq. (29); the shift has its sign.
    chi : float or array
        Inertia ratio of slip, eq. (38).
    w : float or array
        Rim speed of the spin in the unit of psi, kappa omega a/(mu v1); the loss has its sign.
    chi_w : float or array
        Inertia ratio of spin, (kappa/2) M_n a²/J about the normal; the loss is of first order in
        it, and at most 2 w.
    """
    slip, chi, rim = np.broadcast_arrays(np.abs(psi1), chi, np.abs(w))
    axes, psi2, loss = nodes()
    with np.errstate(all="ignore"):
        entries = slip, chi, rim
        alone = between_nodes((slip, chi, 0.0), axes, psi2)
        with_spin, taken = (between_nodes(entries, axes, values) for values in (psi2, loss))
        # Beyond the last w friction along the slip falls as 1/w, and psi2 tends to psi1.
        beyond = np.maximum(rim / axes[2][-1], 1.0)
        inside = np.minimum(slip, axes[0][-1])
        kept = inside * (with_spin / np.where(inside > 0.0, inside, 1.0)) ** (1.0 / beyond)
        shift = np.where(beyond > 1.0, kept, with_spin) - alone
        taken = np.where(beyond > 1.0, ALL_SLIPS - (ALL_SLIPS - taken) / beyond, taken)
        gross = slip > np.maximum(axes[0][-1], 4.0 * chi)
        if gross.any():
            closed = gross_slip(*(np.where(gross, each, 8.0) for each in (slip, chi, rim)))
            shift, taken = (
                np.where(gross, *pair) for pair in zip(closed, (shift, taken), strict=True)
            )
        # A passive contact cannot return the spin faster than it came.
        taken = np.minimum(taken * chi_w, 2.0 * rim)
    return np.copysign(1.0, psi1) * shift, np.copysign(1.0, w) * taken


def gross_slip(psi1: Array, chi: Array, w: Array) -> tuple[Array, Array]:
    """Return shift of psi2 and loss of w over chi_w of an impact that slips throughout.

    Exact for w far below psi1, psi1 at least 4 chi. There friction is mu P (1 - eps²/10) and its
    moment mu P a eps/5, eps = w a/(psi - V): the slip of the surfaces, not that of the bodies. For
    large w the shift tends to 4 chi, and the loss to that of pure spin.

    Parameters
    ----------
    psi1, chi, w : float or array
        As in ``shift_and_loss``; not negative.
    """
    shift: Real = 0.0
    loss: Real = 0.0
    for angle in (np.arange(POINTS) + 0.5) * (math.pi / POINTS):
        rate, weight = math.cos(angle), math.sin(angle) ** 1.8 * (math.pi / POINTS)
        over = w / (psi1 - 2.0 * chi + (2.0 * chi - 1.0) * rate)
        shift, loss = shift + weight * over * over, loss + weight * over
    return 1.0 / (5.0 / (chi * shift) + 0.25 / chi), np.minimum(0.4 * loss, ALL_SLIPS)


def normal_spin(scene: Scene, *, answered: Mask = False) -> NormalSpin | None:
    """Return the effect of spin about the normal in each impact, or None without such spin.

    Parameters
    ----------
    scene : Scene
    answered : bool or array of bool
        True where the law answers the spin of ``scene``: only bodies off centre are left then.
    """
    omega, inverse = scene.normal_spin, scene.pair.inverse_spin_mass
    if scene.frame is not None and scene.encounter is not None:
        normal = components(scene.frame[..., 0, :])
        omega = spin_about(scene.encounter, normal)
        if np.any(omega):
            bodies = sides(scene.encounter, normal)
            inverse = turning_compliance(bodies, normal, scene.pair.radius)
    acts = (np.asarray(omega) != 0.0) & (np.asarray(scene.friction_coefficient) > 0.0)
    acts = acts & ~(answered & np.not_equal(scene.normal_spin, 0.0))
    acts = np.broadcast_to(acts, scene.shape)
    if not acts.any():
        return None
    central = scene.central
    with np.errstate(all="ignore"):
        radius: Real = hertz_scales(central).radius
        w = np.where(acts, np.abs(omega) * radius * central.psi_scale, 0.0)
        inertia = 0.5 * central.pair.stiffness_ratio * central.pair.normal_mass
        chi_w = inertia * inverse * (radius / central.pair.radius) ** 2
        shift, loss = shift_and_loss(central.psi1, central.chi, w, chi_w)
        part = np.where(acts, loss / np.where(w > 0.0, w, 1.0), 0.0)
    known = _covers(np.abs(central.psi1), np.asarray(central.chi), w)
    return NormalSpin(acts, w, np.where(acts, shift, 0.0), part, known)


def _covers(psi1: Array, chi: Array, w: Array) -> Mask:
    """Return where the table has an impact, or it slips throughout beyond the table."""
    slips, ratios, _ = (axis[[0, -1]] for axis in nodes().axes)
    tabled = (psi1 <= slips[1]) & (chi >= ratios[0]) & (chi <= ratios[1])
    gross = psi1 > np.maximum(slips[1], 4.0 * chi)
    known: Mask = (tabled | gross) & (w <= LARGEST_W)
    return known
