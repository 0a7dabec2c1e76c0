"""The energy books of an impact."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Any, Generic, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import are_zeros, choose, greater, magnitude, of_each, plain, some
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import Each, Json, Mask, Real
from contactlab.outcome.motion import Motion, all_finite
from contactlab.outcome.plan import PlanColumns

if TYPE_CHECKING:  # no single contact needs it
    from contactlab.impact.links import Links

#: A normal restitution above this is energy from nothing where no error of it is declared: an
#: explicit scheme with the fewest steps leaves e - 1 = 3e-3.
LARGEST_RESTITUTION = 1.02
#: Losses below zero, over the energy at the start: rounding, and what steps of both motions leave
#: where no error is declared. The jump of DMT's force as contact ends left 0.003 in 200 steps, 0.01
#: in 50 and 0.05 in 7; other laws left less.
ROUNDING, STEPS_LEAVE = 1e-9, 0.05
#: Errors of the rates over v1 are at most so many times those of the books over the energy at the
#: start; up to 4 times where rods of mu = 1e6 lost digits.
BOOKS_TELL = 10.0
#: Errors of the energy over those of the rate at the end: 2, and some more for the second order.
OF_THE_RATE = 2.5
#: A slip velocity at the end above this multiple of the slip velocity at the start is energy from
#: nothing too. The capped spring of discrete-element codes makes some energy; its slip velocity
#: stays below this bound between elastic spheres, and exceeds it under strongly damped normal laws.
LARGEST_SLIP = 1.1
#: Without a declared bound an imbalance above the whole energy at the start is a failure.
LARGEST_UNDECLARED = 1.0
#: Where a judge fails impacts, its sentence, and the numbers in it.
Judged: TypeAlias = tuple[Mask, str, Callable[[], tuple[Real, ...]]]


@tell_attributes
@attrs.frozen(kw_only=True, eq=False)
class EnergyLedger(Generic[Each]):
    """Kinetic energy of the relative motion at the contact, in J.

    Attributes
    ----------
    start, end : float or array
        ½ M_n v_z² + ½ M_t v_x² before and after, and ½ J omega_n² of spin about the normal.
    normal_loss : float or array
        ½ M_n v_z² before less after: loss of a dissipative normal law; zero if elastic. Where
        friction changed the normal motion: the dissipation that the normal law declares.
    friction_work : float or array
        Sum over the steps, computed by the law from traction and slip; where ``checked`` is False
        the energy that the velocities lose.
    shear_loss : float or array
        What a viscous contact lost in shear, beside the friction work; 0 in other contacts.
    imbalance : float or array
        start - end - normal_loss - friction_work - shear_loss: zero in an exact solution. In an
        axisymmetric law the losses are independent: the normal force does no work in slip,
        friction none in approach. NaN if friction changed the normal motion and the normal law
        declares no dissipation.
    checked : bool or array of bool
        False where the books close by construction and the imbalance checks nothing.
    """

    start: Each = attrs.field(metadata={"unit": "J"})
    end: Each = attrs.field(metadata={"unit": "J"})
    normal_loss: Each = attrs.field(metadata={"unit": "J"})
    friction_work: Each = attrs.field(metadata={"unit": "J"})
    shear_loss: Each = attrs.field(metadata={"unit": "J"})
    imbalance: Each = attrs.field(metadata={"unit": "J"})
    checked: Mask = True

    @property
    def relative_imbalance(self) -> Each:
        """Imbalance over the energy at the start, unit 1; 0 of bodies that passed through."""
        with np.errstate(under="ignore"):
            imbalance: Any = self.imbalance
            return imbalance / (self.start + (self.start == 0.0))  # passed: 0 over 0

    def to_dict(self) -> dict[str, Json]:
        """Return the entries and the relative imbalance as plain numbers or lists."""
        from contactlab.outcome.columns import json_value  # a run needs none of this

        entries = attrs.asdict(self) | {"relative_imbalance": self.relative_imbalance}
        return {name: json_value(value) for name, value in entries.items()}


def ledger(scene: Scene, motion: Motion, checked: Mask = True) -> EnergyLedger:
    """Return the energy books of ``motion``, in J, from its velocities and its friction work.

    Those of a gathering are of all its contacts together, arrays of shape (gatherings,): one moves
    another (theory §18). Constant forces do work beside them, and a load has energy of its own.
    """
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        if scene.links is not None:
            return _of_contacts(scene.links, motion)
        start, lost, slip = kinetics.energies(
            scene, motion.normal_velocity, motion.slip_velocity_change
        )
        if kinetics.turns(scene):
            whole, taken = kinetics.spin_energies(scene, motion.normal_spin_change)
            start, slip = start + whole, slip + taken
        losses = motion.friction_work, motion.shear_loss
        start = of_each(start, scene.shape)
        return books((start, lost, slip), losses, motion.exchange, checked)


def _of_contacts(links: Links, motion: Motion) -> EnergyLedger:
    """Return the books of gatherings by the impulses of their contacts."""
    start, told = links.energy[..., 0], motion.contacts
    taken = lost = np.full(start.shape, math.nan)
    if told is not None:
        mean = links.velocity.copy()
        mean[..., 0] = 0.5 * (mean[..., 0] + motion.normal_velocity)
        mean[..., 1:] += 0.5 * np.asarray(motion.slip_velocity_change)
        # the sum of f q over the instants, from q = q0 - W p + a t
        late = told.moment - 0.5 * told.pushed[..., None] * told.impulse
        taken = (told.impulse * mean + links.pull * late).sum(axis=(-1, -2))
        lost = told.dissipation.sum(axis=-1)
    losses = np.sum(motion.friction_work, axis=-1), np.sum(motion.shear_loss, axis=-1)
    return books((start, lost, taken - lost), losses, 0.0, ~links.loaded.any(axis=-1))


def books(
    energies: tuple[Real, Real, Real], losses: tuple[Real, Real], exchange: Real, checked: Mask
) -> EnergyLedger:
    """Return the energy books of the energy at the start, and of what approach and slip lose.

    ``losses`` are friction work and loss in shear, ``exchange`` is the energy in J
    that friction moved from the normal to the tangential motion.
    """
    start, lost, slip = energies
    friction_work, shear_loss = losses
    return EnergyLedger(
        start=start,
        end=start - lost - slip,
        normal_loss=lost - exchange,
        friction_work=friction_work,
        shear_loss=shear_loss,
        imbalance=slip - friction_work - shear_loss + exchange,
        checked=checked,
    )


def passes(
    motion: Motion,
    normal: NormalMotion,
    bound: Real,
    restitution_error: Real,
    *,
    scene: Scene,
    coupled: bool,
    bare: bool,
) -> bool:
    """Return whether ``sound`` and the judges leave one impact as it is: all in a few floats.

    ``bare`` is ``coupled`` of ``sound``. A change of the spin about the normal is left to them.
    """
    if motion.status is not Status.SUCCESS or not all_finite(motion, bare):
        return False
    parting = magnitude(normal.final_rate)
    if parting > scene.normal_speed and judge_energy(motion, normal) is not motion:
        return False
    exchange: Real = motion.exchange
    alone = exchange == 0.0 and motion.normal_spin_change == 0.0 and not coupled
    if not alone and kinetics.turns(scene):
        return False
    slip = scene.slip_velocity
    change: Real = motion.slip_velocity_change
    start, lost, slip_loss = kinetics.energies(scene, motion.normal_velocity, change)
    if bound == math.inf:
        bound = LARGEST_UNDECLARED
    work, shear_loss = motion.friction_work, motion.shear_loss
    least = -(min(bound, STEPS_LEAVE) + ROUNDING) * start
    if magnitude(slip_loss - work - shear_loss + exchange) > bound * start:
        return False
    if work < least or shear_loss < least:
        return False
    if alone:
        return not magnitude(slip + change) > LARGEST_SLIP * magnitude(slip)
    gain = OF_THE_RATE * restitution_error + ROUNDING
    if lost - exchange < -(STEPS_LEAVE if gain != gain else gain) * start:
        return False
    return bool(start - lost - slip_loss <= LARGEST_RESTITUTION**2 * start)


def judge_energy(motion: Motion, normal: NormalMotion) -> Motion:
    """Return ``motion`` with status ``UNBALANCED`` where the normal law alone makes energy.

    ``normal`` is the motion without friction; its error is small beside that of steps.
    """
    error = normal.accuracy
    most = LARGEST_RESTITUTION if math.isnan(error) else 1.0 + OF_THE_RATE * error + ROUNDING
    speed: Real = normal.scene.normal_speed
    parting = magnitude(normal.final_rate)
    faster = parting > most * speed
    if not some(faster):
        return motion
    sentence = "Without friction the bodies part {:.4g} times as fast as they met."
    return motion.failing(faster, Status.UNBALANCED, tell_each(sentence, parting / speed))


def judge_books(
    motion: Motion,
    scene: Scene,
    bound: Real,
    cancels: float = 0.0,
    *,
    coupled: bool = False,
    restitution_error: Real = math.nan,
) -> tuple[Motion, Real]:
    """Return ``motion`` with status ``UNBALANCED`` where the energy books do not balance.

    Beside it stands the imbalance over the energy at the start, 0 where none exceeds ``bound``. It
    fails above ``bound`` and ``cancels``, or above 1 if the bound is infinite. Or a loss or work is
    below zero by more than rounding and what is declared; or the bodies slip faster than at first
    touch. If friction changed the normal motion, as in motions of both ``coupled``, or the spin
    about the normal, one of the two may gain what the other loses, and the sum of both energies is
    judged.
    ``restitution_error`` is declared, NaN if it is not. The contacts of a gathering share what is
    judged of all of them: ``bound`` is the largest of theirs.
    """
    alone: Mask = False
    if not coupled:
        changed = not are_zeros(motion.exchange) or not are_zeros(motion.normal_spin_change)
        if not changed and not _spoils(motion, scene, bound):
            return motion, 0.0
        alone = (motion.exchange == 0.0) & (motion.normal_spin_change == 0.0)
    if scene.links is not None:  # what errors laws declare is of one contact
        bound, restitution_error = np.max(bound, axis=-1) if np.ndim(bound) else bound, math.nan
    gain = OF_THE_RATE * restitution_error + ROUNDING
    gain = choose(gain == gain, gain, STEPS_LEAVE)
    return _mark_imbalance(motion, scene, greater(bound, cancels), alone, gain)


def raise_errors(
    columns: PlanColumns, scene: Scene, off: Real, bound: Real, cancels: float
) -> PlanColumns:
    """Return the columns of a plan with errors as large as books are off beyond a law's bound.

    Books that are off by more than ``cancels`` are a failure.
    """
    doubted = np.asarray((off > bound) & (off <= cancels))
    if not some(doubted):
        return columns
    speed: Real = scene.normal_speed
    rate = BOOKS_TELL * np.asarray(off)
    with np.errstate(all="ignore"):
        slip: Real = rate * speed * np.asarray(scene.psi_scale)
        psi2 = np.where(doubted, np.maximum(columns.psi2_error, slip), columns.psi2_error)
        own = columns.restitution_error
        restitution = np.where(doubted, np.maximum(own, rate), own)
    return columns._replace(psi2_error=plain(psi2), restitution_error=plain(restitution))


@np.errstate(all="ignore")
def _spoils(motion: Motion, scene: Scene, bound: Real) -> bool:
    """Return whether any judge of ``_mark_imbalance`` fails an impact that slip alone changed."""
    change: Real = motion.slip_velocity_change
    start, _, lost = kinetics.energies(scene, motion.normal_velocity, change)
    work: Real = motion.friction_work
    least: Real = -(np.minimum(bound, STEPS_LEAVE) + ROUNDING) * start
    bad = work < least
    if not are_zeros(shear_loss := motion.shear_loss):
        bad |= shear_loss < least
        work = work + shear_loss
    bad |= magnitude(lost - work) > np.where(bound == math.inf, LARGEST_UNDECLARED, bound) * start
    slip: Real = scene.slip_velocity
    after = kinetics.size_of(scene, slip + change)
    bad |= after > LARGEST_SLIP * kinetics.size_of(scene, slip)
    return some(bad)


@np.errstate(all="ignore")
def _mark_imbalance(
    motion: Motion, scene: Scene, bound: Real, alone: Mask, gain: Real
) -> tuple[Motion, Real]:
    """Return ``motion`` with the status of each impact whose books do not balance, and how far.

    ``alone`` marks impacts whose slip alone friction changed; ``gain`` is what the normal force may
    make of the energy at the start.
    """
    coupled = np.logical_not(alone)
    books = ledger(scene, motion)
    imbalance = magnitude(books.imbalance)
    start = choose(books.checked, books.start, math.inf)  # no judge knows what a load keeps
    if kinetics.turns(scene):  # a spin that friction left has no part in what is judged
        left = kinetics.energies(scene, motion.normal_velocity, motion.slip_velocity_change)
        start = np.where(motion.normal_spin_change == 0.0, left[0], start)[()]  # a number for one
    least: Real = -(np.minimum(bound, STEPS_LEAVE) + ROUNDING) * start
    # a gain beyond the largest number is none, and one by constant forces no fault
    gains = coupled & np.logical_not(books.end <= LARGEST_RESTITUTION**2 * books.start)
    if scene.links is not None:
        gains &= ~scene.links.pull.any(axis=(-1, -2))
    slips: list[Judged] = []
    if some(alone):
        before: Real = kinetics.slip_speed(scene)
        after = kinetics.size_of(scene, scene.slip_velocity + motion.slip_velocity_change)
        slips = [
            (alone & (after > LARGEST_SLIP * before),
             "The contact slips {:.4g} times as fast as it met.",
             lambda: (np.divide(after, before),))
        ]  # fmt: skip
    rows: list[Judged] = [
        (imbalance > bound * start,
         "Off by {:.2g} of the energy at the start; declared: {:.2g}.",
         lambda: (imbalance / start, bound)),
        (coupled & (-books.normal_loss > gain * start),
         "The normal force makes {:.2g} of the energy at the start.",
         lambda: (-np.divide(books.normal_loss, start),)),
        (books.friction_work < least,
         "The friction work is {:.2g} of the energy at the start.",
         lambda: (np.divide(books.friction_work, start),)),
        (books.shear_loss < least,
         "The loss in shear is {:.2g} of the energy at the start.",
         lambda: (np.divide(books.shear_loss, start),)),
        *slips,
        (gains, "The bodies gain {:.2g} of their energy.",
         lambda: (np.nan_to_num(books.end / books.start - 1.0, nan=math.inf),)),
        ((bound == math.inf) & (imbalance > LARGEST_UNDECLARED * start),
         "Off by {:.3g} times the energy at the start.", lambda: (imbalance / start,)),
    ]  # fmt: skip
    faulty = reduce(or_, [where for where, *_ in rows])
    for where, sentence, numbers in rows if some(faulty) else ():
        if some(where):
            told = kinetics.over_contacts(scene, tell_each(sentence, *numbers()))
            motion = motion.failing(kinetics.over_contacts(scene, where), Status.UNBALANCED, told)
    return motion, kinetics.over_contacts(scene, imbalance / start)


def tell_each(sentence: str, *numbers: Real) -> str | NDArray[np.object_]:
    """Return the sentence of each impact with its numbers filled in, in the shape of the first."""
    shape = np.shape(numbers[0])
    if not shape:
        return sentence.format(*map(float, numbers))
    columns = (np.broadcast_to(each, shape).ravel().tolist() for each in numbers)
    sentences = [sentence.format(*row) for row in zip(*columns, strict=True)]
    return np.array(sentences, dtype=object).reshape(shape)
