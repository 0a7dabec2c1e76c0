"""Number and length of steps in which normal and friction law march together."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from contactlab.contracts import CausalTangentialLaw, NormalMotion, Scene, judges
from contactlab.contracts.status import Status, succeeded
from contactlab.impact import kinetics
from contactlab.impact.hertz import DURATION_CONSTANT
from contactlab.numeric.arrays import choose, greater, lesser, quotient
from contactlab.numeric.types import Mask, Real
from contactlab.numeric.vectors import entry, square_root
from contactlab_laws.march import contacts
from contactlab_laws.march.division import resolving

#: A contact that lasts longer than so many approaches without friction is given up, each as long as
#: that of a contact that friction holds: 1/sqrt(free share) as long as one that slips freely. None
#: of 1,500 random bodies with mu from 0.3 to 30 lasted longer than 2.3; the share counts from
#: ``LEAST_SHARE``.
LONGEST, LEAST_SHARE = 6.0, 0.01
#: Share of the steps that grow evenly at first touch, where forces that depend on rates go as the
#: root of time.
LEADING = 0.4
#: Energy of the deepest contact that is followed, over that of the approach without friction.
DEEPEST = 1e10
#: Sentence on an impact that grows deeper.
TOO_DEEP = "Friction presses the contact deeper than the steps resolve."


def find_least_steps(scene: Scene, normal: NormalMotion, law: CausalTangentialLaw) -> Real:
    """Return the least steps in the approach without friction that resolve every oscillation."""
    # omega² <= k_n W_nn + k_t tr W_tt; both stiffnesses grow as the contact radius, and the energy
    # bounds the radius.
    normal_stiffness = 2.0 * scene.pair.effective_modulus * normal.maximum_radius
    tangential = judges.stiffness_of(law, normal.scene, normal)
    if scene.links is not None:
        return _find_largest_need(scene, normal, law, (normal_stiffness, tangential))
    W = scene.inverse_mass
    assert W is not None
    inertia = entry(W, 1, 1)
    if not scene.planar:
        inertia = inertia + scene.pair.cross_stiffness_ratio * entry(W, 2, 2)
    omega = np.sqrt(normal_stiffness * entry(W, 0, 0) + tangential * inertia)
    return resolving(omega * approach_duration(normal) * deepest(scene) ** 0.1, law)


def _find_largest_need(
    scene: Scene, normal: NormalMotion, law: CausalTangentialLaw, stiffness: tuple[Real, Real]
) -> Real:
    """Return the least steps in the shortest contact of a gathering, for each of its contacts."""
    assert scene.links is not None
    pressed, dragged = stiffness
    sides = pressed, dragged, np.asarray(scene.pair.cross_stiffness_ratio) * dragged
    wide = contacts.join(sides, scene.shape)
    omega = np.sqrt(scene.links.fastest(wide * np.asarray(deepest(scene) ** 0.2)[..., None]))
    return resolving(np.broadcast_to(omega * _count_duration(scene, normal), scene.shape), law)


def _come_to_an_end(normal: NormalMotion) -> Mask:
    """Return the impacts whose approach without friction came to an end."""
    if isinstance(normal.status, Status):
        return normal.status is Status.SUCCESS
    return np.asarray(np.asarray(normal.status, dtype=object) == Status.SUCCESS)


def approach_duration(normal: NormalMotion) -> Real:
    """Return the duration of the approach without friction in s, in which steps are counted.

    An approach that never ends counts as Hertz's impact that is as deep.
    """
    if succeeded(normal.status):
        return normal.duration
    ended = _come_to_an_end(normal)
    as_deep = DURATION_CONSTANT * normal.maximum_approach / normal.scene.normal_speed
    return np.where(ended, normal.duration, np.minimum(normal.duration, as_deep))


def _count_duration(scene: Scene, normal: NormalMotion) -> Real:
    """Return the duration in s that is divided in steps, the shortest in a gathering."""
    duration = approach_duration(normal)
    return duration if scene.links is None else np.min(duration, axis=-1, keepdims=True)


def deepest(scene: Scene) -> Real:
    """Return a bound of zeta^2.5, the energy in the normal contact over that of the approach."""
    if scene.links is not None:
        approach = 0.5 * scene.pair.normal_mass * np.square(scene.normal_speed)
        most: Real = np.clip(scene.links.energy / approach, 1.0, DEEPEST)
        return most
    speed = scene.normal_speed
    alone = 0.5 * scene.pair.normal_mass * (speed * speed)
    held = quotient(1.0, greater(1.0 - kinetics.sizes(scene)[0], 0.0))
    bound = lesser(kinetics.energy_at_start(scene) / alone, held)
    return lesser(greater(bound, 1.0), DEEPEST)


class Division(NamedTuple):
    """Steps of impacts, numbers or arrays of the batch shape.

    Attributes
    ----------
    step : float or array
        Width in s; NaN where an impact is not followed.
    leading : float or array
        So many steps grow evenly at first, where forces depend on rates.
    longest : float or array
        Approaches without friction after which an impact of one contact is given up.
    most : float or array
        Steps after which it is.
    """

    step: Real
    leading: Real
    longest: Real
    most: Real


def divide(scene: Scene, normal: NormalMotion, count: Real, usual: float) -> Division:
    """Return the steps of impacts, ``count`` and ``usual`` as of ``march_coupled``."""
    with np.errstate(invalid="ignore"):
        followed = np.isfinite(count)
        step = choose(followed, _count_duration(scene, normal) / count, math.nan)
    leading = np.ceil(LEADING * count)
    if scene.links is not None:
        most = contacts.most_steps(scene, approach_duration(normal), step)
        return Division(step, leading, math.inf, most)
    longest = LONGEST / square_root(greater(kinetics.free_share(scene), LEAST_SHARE))
    # steps raised for a contact that grows without end are no reason to follow it longer
    lasting = choose(_come_to_an_end(normal), count, lesser(count, usual))
    return Division(step, leading, longest, longest * lasting)


def tell_too_long(longest: float, compressions: int) -> str:
    """Return the sentence on an impact that is given up as it lasts too long."""
    return (
        f"After {longest:.3g} durations of the approach without friction and {compressions} "
        f"compression{'s' * (compressions > 1)}."
    )
