"""A sound law of vectors, and laws that break one clause of eccentric impacts each."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import CausalTangentialLaw, TangentialResponse
from tests.testing.broken_laws import Sound


class Held(NamedTuple):
    stiffness: Any
    friction_coefficient: Any
    force: Any
    sides: Any = 1.0


@attrs.frozen(kw_only=True)
class SoundVector(Sound, CausalTangentialLaw):
    """A spring and a slider, of numbers or of vectors, which are cut to their limit."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"vectors", "elliptic"})

    def sides(self, scene):
        """Return the stiffness along t1 and t2 over that along t1."""
        return np.stack(np.broadcast_arrays(1.0, scene.pair.cross_stiffness_ratio), axis=-1)

    def begin(self, scene, normal, *, vectors=False):
        begun = self.start(scene, normal)
        if not vectors:
            return begun
        return Held(*begun._replace(force=np.zeros((*scene.shape, 2))), self.sides(scene))

    def trial(self, state, increment):
        moved = state.sides * increment.displacement
        return state.force + np.asarray(state.stiffness)[..., None] * moved

    def cut(self, trial, limit, state):
        size = np.linalg.norm(trial, axis=-1, keepdims=True)
        if np.all(state.sides == 1.0):
            return trial * np.minimum(1.0, limit / (size + (size == 0.0)))
        # the closest point in the energy of the spring, whose slip is along the force
        least, most = np.zeros(size.shape), 4.0 * size / np.maximum(limit, 1e-12 * size + 1e-300)
        for _ in range(100):
            g = 0.5 * (least + most)
            longer = np.linalg.norm(trial / (1.0 + g * state.sides), axis=-1, keepdims=True) > limit
            least, most = np.where(longer, g, least), np.where(longer, most, g)
        return np.where(size > limit, trial / (1.0 + most * state.sides), trial)

    def advance(self, state, increment, before, after):
        if not isinstance(state, Held):
            return super().advance(state, increment, before, after)
        trial = self.trial(state, increment)
        limit = np.asarray(state.friction_coefficient * after.friction_load)[..., None]
        force = self.cut(trial, limit, state)
        slip = (trial - force) / (state.sides * np.asarray(state.stiffness)[..., None])
        work = np.maximum(0.5 * ((force + state.force) * slip).sum(axis=-1), 0.0)
        return TangentialResponse(force, work[()]), state._replace(force=force)


class OneStiffness(SoundVector):
    """Takes an ellipse for a circle."""

    def sides(self, scene):
        return np.ones(2)


class SlipsByStiffness(SoundVector):
    """Is cut along its force, and comes to lie along the slip times the stiffness."""

    def cut(self, trial, limit, state):
        return super().cut(trial, limit, state._replace(sides=np.ones(2)))


class StifferAcross(SoundVector):
    """A spring that is stiffer along t2 while it sticks."""

    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})

    def trial(self, state, increment):
        moved = np.asarray(increment.displacement) * (1.0, 1.2)
        return super().trial(state, increment._replace(displacement=moved))

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        if not isinstance(state, Held):
            return response, new
        isotropic = SoundVector().advance(state, increment, before, after)
        slips = np.any(isotropic[0].friction_work > 0.0)
        return isotropic if slips else (response, new)


class KeepsItsDirection(SoundVector):
    """A force at its limit does not turn with the slip."""

    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})

    def cut(self, trial, limit, state):
        old = state.force
        size = np.linalg.norm(old, axis=-1, keepdims=True)
        ahead = (trial * old).sum(axis=-1, keepdims=True)
        stays = (np.linalg.norm(trial, axis=-1, keepdims=True) > limit) & (size > 0.0)
        kept = np.where(ahead < 0.0, -old, old) * (limit / (size + (size == 0.0)))
        return super().cut(np.where(stays, kept, trial), limit, state)


class LongWhereItTurns(SoundVector):
    """A force that is up to a fifth beyond its limit while the slip turns."""

    def cut(self, trial, limit, state):
        old, force = state.force, super().cut(trial, limit, state)
        sizes = np.linalg.norm(old, axis=-1) * np.linalg.norm(force, axis=-1)
        sine = (old[..., 0] * force[..., 1] - old[..., 1] * force[..., 0]) / (sizes + 1e-300)
        return force * (1.0 + 0.2 * np.abs(sine)[..., None])


class SofterAsVectors(SoundVector):
    """Other springs for vectors than for numbers."""

    def begin(self, scene, normal, *, vectors=False):
        state = super().begin(scene, normal, vectors=vectors)
        if not vectors:
            return state
        return state._replace(stiffness=0.8 * state.stiffness)


class SofterToBeginWith(SoundVector):
    """Another law from begin than from start."""

    def begin(self, scene, normal, *, vectors=False):
        state = super().begin(scene, normal, vectors=vectors)
        return state._replace(stiffness=0.8 * state.stiffness)


class Awaited(NamedTuple):
    own: Any
    most: Any
    contacts: int = 0


class Expecting(SoundVector):
    """Begins with something of the motion that it expects."""

    def begin(self, scene, normal, *, vectors=False):
        begun = super().begin(scene, normal, vectors=vectors)
        return begun if vectors else Awaited(begun, normal.maximum_force)

    def seen(self, state, before, after):
        return after

    def advance(self, state, increment, before, after):
        if not isinstance(state, Awaited):
            return super().advance(state, increment, before, after)
        after = self.seen(state, before, after)
        response, own = super().advance(state.own, increment, before, after)
        made = np.all(before.force == 0.0) and np.all(after.force > 0.0)
        return response, Awaited(own, state.most, state.contacts + int(made))


class ExpectsNoMore(Expecting):
    """Takes the largest force of the approach without friction for the largest of all."""

    def seen(self, state, before, after):
        return after._replace(friction_load=np.minimum(after.friction_load, state.most))


class ExpectsOneCompression(Expecting):
    """Has no friction once the bodies have parted."""

    def seen(self, state, before, after):
        parted = state.contacts > 1 or (state.contacts == 1 and np.all(before.force == 0.0))
        return after._replace(friction_load=0.0 * after.friction_load) if parted else after


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (SofterToBeginWith, "begin_is_start", "off those from the state of start"),
    (ExpectsNoMore, "deeper_contact", "the force of gross slip is 0.7"),
    (ExpectsOneCompression, "deeper_contact", "A second compression"),
    (StifferAcross, "vectors_rotate", "Rotated by 42 radians"),
    (KeepsItsDirection, "vectors_turn", "off its direction"),
    (LongWhereItTurns, "vector_limit", "longer than mu times the friction load"),
    (OneStiffness, "two_stiffnesses", "in the ratio 1, not 1.2"),
    (SlipsByStiffness, "two_stiffnesses", "off the direction of the slip"),
    (SofterAsVectors, "vectors_on_a_line", "off that of numbers"),
]
