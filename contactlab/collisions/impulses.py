"""Impulses on two bodies in space, and the velocities and spins after them."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from contactlab.collisions.rebound import rebound
from contactlab.impact.bodies import Pair, Sphere, inverse_turning_mass
from contactlab.impact.body_contact import VELOCITIES, Contact
from contactlab.impact.encounter import Encounter
from contactlab.impact.scene import LEAST_IMPULSE
from contactlab.numeric.arrays import choose, every, finite, lock_arrays, plain, spread
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Mask, Real
from contactlab.numeric.vectors import LEAST, components, three

#: Attributes of a ``Collision``, by name.
Moved: TypeAlias = dict[str, Any]


def pass_through(encounter: Encounter) -> Moved:
    """Return both bodies of every encounter, unchanged as they passed through."""
    shape = encounter.shape
    vectors = {name: np.broadcast_to(getattr(encounter, name), (*shape, 3)) for name in VELOCITIES}
    zero = spread(0.0, shape)
    return vectors | {
        "normal_velocity": np.broadcast_to(encounter.meeting().approach, shape) + zero,
        "slip_velocity_change": zero,
        "friction_work": zero,
        "collided": np.zeros(shape, dtype=bool) if shape else False,
    }


def rebounding(
    part: Encounter, contact: Contact, pair: Pair, restitution: Real
) -> tuple[Real, Real, Real]:
    """Return rebound rate (m/s), slip change (m/s) and friction work (J) by ``rebound``."""
    # From psi1 = 4 chi + 1 on bodies slip throughout, eq. (46), and the change of psi is
    # constant. So psi1 is cut there: it stays finite, with all digits, at any slip and friction.
    chi = pair.inertia_ratio
    end = 4.0 * chi + 1.0
    with np.errstate(all="ignore"):
        # m/s for each unit of psi, eq. (29)
        unit: Real = part.friction_coefficient * contact.approach / pair.stiffness_ratio
        # without slip and friction 0/0 is NaN, in place of which fmin takes the other number
        psi1: Real = np.fmin(np.divide(contact.slip, unit), end)
        psi1 = choose(contact.approach >= LEAST, psi1, 0.0)
        psi2: Real = rebound(psi1, chi, restitution=restitution)
        change = (psi2 - psi1) * unit
        work = -pair.tangential_mass * change * (contact.slip + 0.5 * change)
    return -restitution * contact.approach, change, choose(work <= 0.0, 0.0, work)


def _check(part: Encounter, impulse: Real, change: Real) -> None:
    """Refuse encounters whose numbers a float cannot hold, as ``Scene`` does."""
    if not every(impulse >= LEAST_IMPULSE):
        raise refuse(
            "sphere, velocity",
            float(np.min(impulse)),
            f"mass times speed of approach must be at least {LEAST_IMPULSE:g} N s",
            "give larger masses and speeds, or other units",
        )
    if not finite(change):
        raise refuse(
            "friction_coefficient",
            part.friction_coefficient,
            "with these velocities psi1 of eq. (29) cannot be held in floating point",
            "give 0 for no friction, or less",
        )


def strike(
    encounter: Encounter,
    answers: Array | None = None,
    *,
    restitution: Real = 1.0,
    strict: bool = False,
) -> Moved:
    """Return both bodies after an encounter; ``strict`` refuses bodies that separate.

    ``answers``, shape (3, encounters), are columns as of ``rebounding``, which answers by default.
    """
    shape = encounter.shape
    if not shape and answers is None:
        return _alone(encounter, restitution, strict)
    vectors = [np.empty((*shape, 3)) for _ in VELOCITIES]
    flat = [array.reshape(-1, 3) for array in vectors]
    numbers, collided = np.empty((3, *shape)), np.empty(shape, dtype=bool)
    columns, flags = numbers.reshape(3, -1), collided.reshape(-1)
    for where, part in encounter.parts():
        contact, pair = part.meeting(), part.pair
        meets: Mask = contact.approach >= LEAST
        met = every(meets)
        if strict and not met:
            raise encounter.separate()
        if answers is None:
            e = restitution if isinstance(restitution, float) else restitution.reshape(-1)[where]
            after, change, work = rebounding(part, contact, pair, e)
            _check(part, choose(meets, pair.normal_mass * contact.approach, 1.0), change)
        else:
            after, change, work = answers[:, where]
        if not met:
            after = np.where(meets, after, contact.approach)
            change, work = np.where(meets, change, 0.0), np.where(meets, work, 0.0)
        columns[0, where], columns[1, where], columns[2, where] = after, change, work
        flags[where] = meets
        push, drag = pair.normal_mass * (after - contact.approach), pair.tangential_mass * change
        _push([array[where] for array in flat], part, contact, push, drag)
    after, change, work = (lock_arrays(plain(each)) for each in numbers)
    return dict(
        zip(VELOCITIES, map(lock_arrays, vectors), strict=True),
        normal_velocity=after,
        slip_velocity_change=change,
        friction_work=work,
        collided=lock_arrays(collided) if shape else bool(collided),
    )


def turn_bodies(encounter: Encounter, moved: Moved, change: Real) -> Moved:
    """Return the bodies of ``strike`` after a change (rad/s) of the relative spin about the normal.

    The couple is opposite on both spheres: each takes its share by its inertia.
    """
    axis = np.stack(np.broadcast_arrays(*encounter.meeting().normal), axis=-1)
    about = np.asarray(change)[..., None] * axis
    share: Real = 1.0
    body, target = encounter.body, encounter.target
    if isinstance(body, Sphere) and isinstance(target, Sphere):
        own, other = (inverse_turning_mass(each, body.radius) for each in (body, target))
        share = np.asarray(own / (own + other))[..., None]
    spins = moved["spin"] + share * about, moved["target_spin"] - (1.0 - share) * about
    return moved | dict(zip(("spin", "target_spin"), map(lock_arrays, spins), strict=True))


def _alone(encounter: Encounter, restitution: Any, strict: bool) -> Moved:
    """Return both bodies after a single encounter, in plain numbers."""
    contact, pair = encounter.meeting(), encounter.pair
    _, _, approach, slip = contact
    collided, after, change, work = approach >= LEAST, approach, 0.0, 0.0
    normal_mass, tangential_mass = pair.normal_mass, pair.tangential_mass
    if collided:
        chi, unit = pair.inertia_ratio, encounter.friction_coefficient * approach
        unit /= pair.stiffness_ratio
        end = 4.0 * chi + 1.0
        psi1 = end if slip >= end * unit else slip / unit
        change = (rebound(psi1, chi, restitution=restitution) - psi1) * unit
        work = max(-tangential_mass * change * (slip + 0.5 * change), 0.0)
        after = -restitution * approach
        _check(encounter, normal_mass * approach, change)
    elif strict:
        raise encounter.separate()
    push, drag = normal_mass * (after - approach), tangential_mass * change
    velocity, spin, target_velocity, target_spin = _push_both(encounter, contact, push, drag)
    return {
        "velocity": velocity,
        "spin": spin,
        "target_velocity": target_velocity,
        "target_spin": target_spin,
        "normal_velocity": after,
        "slip_velocity_change": change,
        "friction_work": work,
        "collided": collided,
    }


def _push_both(part: Encounter, contact: Contact, push: Any, drag: Any) -> list[Array]:
    """Return ``VELOCITIES`` of a single encounter after both impulses, in N s."""
    (n1, n2, n3), (t1, t2, t3), _, _ = contact
    vectors = []
    for body, velocity, spin, sense in (
        (part.body, part.velocity, part.spin, 1.0),
        (part.target, part.target_velocity, part.target_spin, -1.0),
    ):
        if not isinstance(body, Sphere):
            vectors += [velocity, spin]
            continue
        (v1, v2, v3), (w1, w2, w3) = velocity.tolist(), spin.tolist()
        mass, radius, gyration = body.mass, body.radius, body.gyration_ratio
        ahead, aside = sense * push / mass, sense * drag / mass
        # divided step by step: the moment of inertia of a tiny body underflows
        turn = drag / mass / (gyration * gyration * radius)
        vectors += [
            three(
                v1 + (ahead * n1 + aside * t1),
                v2 + (ahead * n2 + aside * t2),
                v3 + (ahead * n3 + aside * t3),
            ),
            three(
                w1 + turn * (n2 * t3 - n3 * t2),
                w2 + turn * (n3 * t1 - n1 * t3),
                w3 + turn * (n1 * t2 - n2 * t1),
            ),
        ]
    return vectors


def _push(moved: list[Array], part: Encounter, contact: Contact, push: Real, drag: Real) -> None:
    """Write ``VELOCITIES`` after a normal impulse ``push`` and one along the slip, in N s."""
    (n1, n2, n3), (t1, t2, t3) = contact.normal, contact.along
    across = (n2 * t3 - n3 * t2, n3 * t1 - n1 * t3, n1 * t2 - n2 * t1)
    bodies: tuple[Any, ...] = (
        (part.body, part.velocity, part.spin, 1.0),
        (part.target, part.target_velocity, part.target_spin, -1.0),
    )
    pairs = ((moved[0], moved[1]), (moved[2], moved[3]))
    for (body, velocity, spin, sense), (to, turned) in zip(bodies, pairs, strict=True):
        if not isinstance(body, Sphere):
            to[:], turned[:] = velocity, spin
            continue
        ahead, aside = sense * push / body.mass, sense * drag / body.mass
        # divided step by step: the moment of inertia of a tiny body underflows
        turn = drag / body.mass / (body.gyration_ratio * body.gyration_ratio * body.radius)
        for k, (v, w) in enumerate(zip(components(velocity), components(spin), strict=True)):
            to[:, k] = v + (ahead * contact.normal[k] + aside * contact.along[k])
            turned[:, k] = w + turn * across[k]
