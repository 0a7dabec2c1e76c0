"""Several contacts at once: laws and plan of a gathering, and its bodies after the impact."""

from __future__ import annotations

from functools import lru_cache

import attrs
import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.gathering import Gathering
from contactlab.impact.gathering_scene import SPARSE
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.outcome.motion import Motion
from contactlab.registration.bring import state
from contactlab.registration.names import KINDS
from contactlab.registry import composition
from contactlab.registry.acceptance import accept
from contactlab.registry.bound import bind
from contactlab.registry.composition import Laws
from contactlab.registry.read_options import options_read
from contactlab.solve.coupled import Coupled
from contactlab.solve.gathering_plan import MICRON, GatheringPlan, gathering_plan


def way_of(gathering: Gathering, laws: Laws | None) -> Coupled:
    """Return the way in which a gathering is answered, or refuse laws that have no answer.

    ``laws`` are those of a simulation; None stands for the usual ones.
    """
    used, scene = _bind(gathering, _laws_of(gathering, laws))
    way = Coupled.of(..., scene, used)
    for law in way.laws.capability.refusing:
        accept(law, way.scene.central)
    return way


def bodies_after(gathering: Gathering, motion: Motion) -> tuple[Array, Array]:
    """Return velocities and spins of the bodies, shape (..., N, 3); NaN after a failure."""
    shape = (*gathering.shape, len(gathering.bodies), 3)
    told = motion.contacts
    if told is None:
        return np.full(shape, np.nan), np.full(shape, np.nan)
    lost = np.where(motion.status == Status.SUCCESS, 0.0, np.nan)[:, 0]
    after = gathering.assembly.after(told.impulse, told.pushed[:, 0] + lost)
    velocity, spin = ((each + lost[:, None, None]).reshape(shape) for each in after)
    return velocity, spin


def plan_of_gathering(
    gathering: Gathering,
    laws: Laws | None,
    way: Coupled | None = None,
    motion: Motion | None = None,
    *,
    history: bool | str = False,
) -> GatheringPlan:
    """Return the plan of a gathering, after a run with its ``way`` and its ``motion``."""

    def widen() -> Array:
        return _per_micron(gathering, laws)

    way = way_of(gathering, laws) if way is None else way
    return gathering_plan(gathering, way, motion, history_of(history), widen)


def history_of(history: bool | str) -> bool:
    """Return ``history``, or refuse a value that gatherings lack."""
    if history not in (True, False):
        rule = "must be True or False: fields are those of one contact"
        raise refuse("history", history, rule, "give history=True")
    return bool(history)


def _per_micron(gathering: Gathering, laws: Laws | None) -> Array:
    """Return the largest change of a velocity in m/s if any gap were a micron wider."""
    contacts = len(gathering.touches)
    at_once = contacts + 1 if contacts < SPARSE else 1
    wide = np.eye(contacts + 1)[:, 1:] * MICRON  # no change, then that of each contact
    found = [
        _with_gaps(gathering, laws, wide[first : first + at_once])
        for first in range(0, contacts + 1, at_once)
    ]
    velocity = np.concatenate(found)
    moved = np.linalg.norm(velocity[1:] - velocity[0], axis=-1)
    return np.asarray(moved.max(axis=(0, -1)))


def _with_gaps(gathering: Gathering, laws: Laws | None, wider: Array) -> Array:
    """Return velocities, (rows, ..., N, 3), with gaps that are wider by rows of C, in m."""
    rows = wider.T.reshape(*wider.T.shape, *(1 for _ in gathering.shape))
    touches = []
    for touch, more in zip(gathering.touches, rows, strict=True):
        gap = touch.gap + (0.0 if touch.loaded else 1.0) * more
        touches.append(attrs.evolve(touch, gap=gap))
    wide = attrs.evolve(gathering, touches=touches)
    with np.errstate(under="ignore"):
        _, motion = way_of(wide, laws).outcome(False, None)
    return bodies_after(wide, motion)[0]


def _laws_of(gathering: Gathering, laws: Laws | None) -> Laws:
    """Return laws beside which the restitutions of contacts stand as the normal law."""
    e = gathering.assembly.of_contacts("restitution")
    given = {} if laws is None else laws.by_kind()
    named = {kind: law for kind, law in given.items() if laws and kind in laws.named}
    if np.any(e != 1.0):
        if "normal" in named:
            k = int(np.argwhere(e != 1.0)[0][-1])
            rule = "stands in place of a normal law, and the simulation names one"
            remedy = "leave out normal of the simulation, or restitution of the contacts"
            value = gathering.touches[k].restitution
            raise refuse(f"touches[{k}].restitution", value, rule, remedy)
        one = float(e.flat[0])  # one motion scales to all contacts of one restitution
        alike = bool(np.all(e == one))
        if alike and not named:
            return _of_restitution(one, state())
        named["normal"] = composition.viscous(one if alike else e)
    return composition.compose(*(named.get(kind) for kind in KINDS))


@lru_cache(maxsize=16)
def _of_restitution(restitution: float, _: object) -> Laws:
    """Return the usual laws of one restitution; the plug-ins at hand are part of the key."""
    return composition.compose(composition.viscous(restitution), None, None)


def _bind(gathering: Gathering, laws: Laws) -> tuple[Laws, Scene]:
    """Return laws, and the scene with the options of each contact; refuse those of materials."""
    reads = any(each.material for law in laws for each in options_read(type(law)))
    for k, met in enumerate(gathering.assembly.met if reads else ()):
        if told := {**met.body.material.properties, **met.target.material.properties}:
            rule = "are read for one contact, and laws of a gathering read none"
            remedy = "give the options to the laws"
            raise refuse(f"touches[{k}]: properties of materials", told, rule, remedy)
    return bind(laws, gathering.scene)
