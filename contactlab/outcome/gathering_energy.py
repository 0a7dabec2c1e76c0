"""The energy books of gatherings: of all contacts together, as one moves another (theory §18)."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, greater, some
from contactlab.numeric.types import Real
from contactlab.outcome.energy import (
    LARGEST_RESTITUTION,
    LARGEST_UNDECLARED,
    EnergyLedger,
    Judged,
    gains_of_losses,
    tell_each,
)
from contactlab.outcome.motion import Motion


def gathering_ledger(scene: Scene, motion: Motion) -> EnergyLedger:
    """Return the books of each gathering in J, arrays of shape (gatherings,).

    The start is the energy of the relative motion that contacts can take; the end is what their
    forces leave of it, without the work of constant forces.
    """
    links, told = scene.links, motion.contacts
    assert links is not None
    start = links.energy[..., 0]
    if told is None:
        nothing = np.full(start.shape, math.nan)
        names = ("end", "normal_loss", "friction_work", "shear_loss", "imbalance")
        return EnergyLedger(start=start, **dict.fromkeys(names, nothing))
    after = np.concatenate(
        [np.asarray(motion.normal_velocity)[..., None], links.velocity[..., 1:]], axis=-1
    )
    after[..., 1:] += motion.slip_velocity_change
    # the sum of f q over the instants, from q = q0 - W p + a t
    mean = 0.5 * (links.velocity + after)
    late = told.moment - 0.5 * told.pushed[..., None] * told.impulse
    taken = (told.impulse * mean + links.pull * late).sum(axis=(-1, -2))
    losses = [
        np.asarray(each).sum(axis=-1)
        for each in (told.dissipation, motion.friction_work, motion.shear_loss)
    ]
    return EnergyLedger(
        start=start,
        end=start - taken,
        normal_loss=losses[0],
        friction_work=losses[1],
        shear_loss=losses[2],
        imbalance=taken - sum(losses),
        checked=~links.loaded.any(axis=-1),
    )


@np.errstate(all="ignore")
def judge_gathering(motion: Motion, scene: Scene, bound: Real, cancels: float) -> Motion:
    """Return ``motion`` with status ``UNBALANCED`` where the books of a gathering do not balance.

    ``bound`` is that of each contact. What lies under a load keeps energy at the end, which no law
    tells: such gatherings are judged by their gain alone.
    """
    if motion.contacts is None:
        return motion
    books = gathering_ledger(scene, motion)
    most = np.max(bound, axis=-1) if np.ndim(bound) else bound
    most = greater(choose(most == math.inf, LARGEST_UNDECLARED, most), cancels)
    start = np.where(books.checked, books.start, math.inf)  # a load has no part in what is judged
    off = np.abs(books.imbalance) / start
    left = books.end / books.start
    pushed = scene.links is not None and scene.links.pull.any(axis=(-1, -2))
    rows: list[Judged] = [
        (off > most, "Off by {:.2g} of the energy at the start.", lambda: (off,)),
        (
            (left > LARGEST_RESTITUTION**2) & ~np.asarray(pushed),
            "The bodies gain {:.2g} of their energy.",
            lambda: (left - 1.0,),
        ),
        *gains_of_losses(books, start, most),
    ]
    for where, sentence, numbers in rows:
        if some(where):
            each = np.broadcast_to(np.asarray(where)[:, None], scene.shape)
            words = np.asarray(tell_each(sentence, *numbers()))
            sentences = np.broadcast_to(words[:, None], scene.shape)
            motion = motion.failing(each, Status.UNBALANCED, sentences)
    return motion
