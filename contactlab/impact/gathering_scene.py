"""The contacts of a gathering as one system: frames, W, the scene, and bodies after impulses."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any, Protocol

import numpy as np

from contactlab.impact import inverse_mass
from contactlab.impact.bodies import Pair
from contactlab.impact.body_contact import (
    Frame,
    Side,
    add_coupling,
    changes_of,
    elastic_numbers,
    frame,
    sides,
)
from contactlab.impact.encounter import Encounter
from contactlab.impact.links import Inverse, Links, energy_of
from contactlab.impact.scene import Scene, of_bodies
from contactlab.numeric.arrays import change_entries, lock_arrays
from contactlab.numeric.checks import first_of, refuse
from contactlab.numeric.types import Array, Real
from contactlab.numeric.vectors import components, dot, join_components, moving

#: Contacts of one gathering from which W is kept by its blocks that are not zero.
SPARSE = 100
#: Most memory of the inverse masses of a batch.
MOST_BYTES = 4e9
#: Largest approach over the largest speed at a contact up to which nothing approaches.
RESTS = 1e-9
#: Numbers of a pair that follow from two materials and the gap; those that only ellipses have.
ELASTIC = ("radius", "effective_modulus", "effective_shear_modulus", "dundurs_beta")
OF_ELLIPSES = ("cross_stiffness_ratio", "axis_ratio")


class _Given(Protocol):
    """A gathering, which imports this module: bodies, and the contacts between them."""

    @property
    def bodies(self) -> tuple[Any, ...]: ...
    @property
    def touches(self) -> tuple[Any, ...]: ...
    @property
    def places(self) -> tuple[tuple[int, int | None], ...]: ...
    @property
    def shape(self) -> tuple[int, ...]: ...
    def alone(self, contact: int) -> Encounter: ...


class Assembly:
    """The contacts of a batch of gatherings, over one flat axis of ``count`` gatherings.

    Attributes
    ----------
    gathering : Gathering
    count : int
    frames : list of Frame
        The frame of each contact: arrays of shape (count,), or floats of one gathering.
    reaches : list of dict
        For each body a dict from contact to the body as that contact has it.
    """

    def __init__(self, gathering: _Given) -> None:
        self.gathering = gathering
        self.count = math.prod(gathering.shape)
        self._wide = gathering.shape
        self.met = [self._flat_encounter(k) for k in range(len(gathering.touches))]
        self.frames: list[Frame] = []
        self.reaches: list[dict[int, Side]] = [{} for _ in gathering.bodies]
        for k, encounter in enumerate(self.met):
            normal = encounter.unit_normal()
            bodies = sides(encounter, normal)
            try:
                found = frame(encounter, bodies, normal)
            except ValueError as error:
                raise ValueError(f"touches[{k}]: {error}") from None
            self.frames.append(found)
            for side in bodies:
                at = gathering.places[k][side.sense < 0.0]
                assert at is not None  # a half-space has no side
                self.reaches[at][k] = side

    def _flat_encounter(self, contact: int) -> Encounter:
        """Return the encounter of a contact in each gathering; of one in plain numbers."""
        alone = self.gathering.alone(contact)
        if not self.gathering.shape:
            return alone
        velocity = np.broadcast_to(alone.velocity, (*self._wide, 3))
        spread = change_entries(alone, velocity=velocity, shape=self._wide)
        return spread.take(np.full(self._wide, True)) if len(self._wide) > 1 else spread

    def flat(self, value: Real, *trailing: int) -> Array:
        """Return numbers of each gathering, shape (count, *trailing)."""
        whole = np.empty((*self.gathering.shape, *trailing), dtype=np.asarray(value).dtype)
        whole[...] = value
        return whole.reshape(self.count, *trailing)

    def of_contacts(self, entry: str) -> Array:
        """Return an entry of every contact, shape (count, C)."""
        given = [getattr(touch, entry) for touch in self.gathering.touches]
        if not self.gathering.shape:  # some microseconds less
            return np.array([given])
        return np.stack([self.flat(each) for each in given], axis=-1)

    def of_bodies(self, entry: str) -> Array:
        """Return vectors of every body, shape (count, N, 3)."""
        bodies = self.gathering.bodies
        return np.stack([self.flat(getattr(body, entry), 3) for body in bodies], axis=1)

    @property
    def axes(self) -> Array:
        """n, t1 and t2 of each contact as rows, shape (count, C, 3, 3)."""
        return self._joined("axes")

    def _joined(self, entry: str) -> Array:
        """Return vectors or tensors of the frames, shape (count, C, ...)."""
        parts = [getattr(each, entry) for each in self.frames]
        if not self.gathering.shape:
            return np.array([parts])
        return np.stack([join_components(each, (self.count,)) for each in parts], axis=1)

    def scene(self) -> Scene:
        """Return the scene of the contacts, or refuse one in which nothing approaches."""
        gathering = self.gathering
        velocity = self._joined("velocity")
        fast = self._fastest(velocity)
        own = self._joined("inverse_mass")
        W = self._inverse_mass(own)
        pull = self._pull()
        loaded = self._find_loads(pull)
        links = Links(
            inverse_mass=W,
            velocity=velocity,
            gap=self.of_contacts("gap"),
            pull=pull,
            loaded=loaded,
            energy=energy_of(W, velocity),
        )
        for alone in own[0] if self.count == 1 else (own,):  # plain numbers are faster
            inverse_mass.check(alone)
        tangential = 0.5 * (own[..., 1, 1] + own[..., 2, 2])
        masses = {"normal_mass": 1.0 / own[..., 0, 0], "tangential_mass": 1.0 / tangential}
        shape = self.count, len(gathering.touches)
        arrays = {
            "friction_coefficient": self.of_contacts("friction_coefficient"),
            "normal_speed": np.array(np.broadcast_to(fast, shape)),
            "tangential_velocity": velocity[..., 1:],
            "inverse_mass": own,
            "_index": np.arange(math.prod(shape)).reshape(shape),
        }
        pair = Pair.of_numbers(masses | self._numbers())
        entries: dict[str, object] = {"pair": pair, "planar": False, "links": links, "shape": shape}
        return of_bodies(entries | {name: lock_arrays(each) for name, each in arrays.items()})

    def _fastest(self, velocity: Array) -> Array:
        """Return v1, the largest rate of approach, shape (count, 1)."""
        fast = velocity[..., 0].max(axis=-1, keepdims=True)
        least = RESTS * np.abs(velocity).max(axis=(-1, -2))[..., None]
        if (slow := ~(fast > least)).any():
            where = np.argwhere(slow[:, 0].reshape(self.gathering.shape))
            least = velocity[np.flatnonzero(slow)[0], :, 0]
            k = int(least.argmax())
            rule = (
                f"nothing approaches{first_of(where)}: its rate of approach in m/s is the largest"
            )
            remedy = "give velocities by which at least one contact closes, or turn its normal"
            raise refuse(f"touches[{k}]", float(least[k]), rule, remedy)
        return np.asarray(fast)

    def _numbers(self) -> dict[str, Array]:
        """Return the entries of ``Pair`` that materials and gaps give, shape (count, C)."""
        found = [
            elastic_numbers(met, each.gap) for met, each in zip(self.met, self.frames, strict=True)
        ]
        names = [*ELASTIC, *(name for name in OF_ELLIPSES if any(name in one for one in found))]
        columns = {name: [one.get(name, 1.0) for one in found] for name in names}
        if not self.gathering.shape:
            return {name: np.array([column]) for name, column in columns.items()}
        return {name: join_components(column, (self.count,)) for name, column in columns.items()}

    def _inverse_mass(self, own: Array) -> Inverse:
        """Return W, dense for few contacts and batches, else sparse, by the blocks of contacts."""
        contacts = len(self.frames)
        blocks: dict[tuple[int, int], Any] = {(k, k): own[:, k] for k in range(contacts)}
        for reaches in self.reaches:
            for one, other in combinations(sorted(reaches), 2):
                rows: list[list[Real]] = [[0.0] * 3 for _ in range(3)]
                pair = ((reaches[k], self.frames[k].axes) for k in (one, other))
                add_coupling(rows, *pair)
                block = join_components(rows, (self.count,))
                blocks[one, other] = blocks.get((one, other), 0.0) + block
        if self.count > 1 or contacts < SPARSE:
            self._check_memory()
            W = np.zeros((self.count, contacts, 3, contacts, 3))
            for (one, other), block in blocks.items():
                W[:, one, :, other] = block
                if one != other:
                    W[:, other, :, one] = np.swapaxes(block, -1, -2)
            return W.reshape(self.count, 3 * contacts, 3 * contacts)
        sparse: Inverse = _sparse({place: block[0] for place, block in blocks.items()}, contacts)
        return sparse

    def _check_memory(self) -> None:
        """Refuse a batch whose inverse masses fill the memory."""
        needed = 8.0 * self.count * (3 * len(self.frames)) ** 2
        if needed > MOST_BYTES:
            rule = f"{self.count} gatherings of {len(self.frames)} contacts take {needed:.2g} bytes"
            raise refuse("shape", self.gathering.shape, rule, "give fewer at a time")

    def _pull(self) -> Array:
        """Return the accelerations of approach and slip by constant forces, (count, C, 3)."""
        pull = np.zeros((self.count, len(self.frames), 3))
        for held, reaches in zip(self.gathering.bodies, self.reaches, strict=True):
            if not moving(held.force):
                continue
            force = components(self.flat(held.force, 3))
            for k, side in reaches.items():
                for row, axis in enumerate(self.frames[k].axes):
                    pull[:, k, row] += side.sense * dot(axis, force) / side.body.mass
        return pull

    def _find_loads(self, pull: Array) -> Array:
        """Return which contacts carry the forces, or refuse forces that press none of them."""
        loaded = self.of_contacts("loaded")
        for k in np.flatnonzero(loaded.any(axis=0)).tolist():
            places = [place for place in self.gathering.places[k] if place is not None]
            if not any(self.gathering.bodies[place].force.any() for place in places):
                rule = "needs a force that presses the contact"
                remedy = "give Body(force=[0, 0, -m g]), or leave loaded out"
                raise refuse(f"touches[{k}].loaded", True, rule, remedy)
            if not np.all(pull[:, k, 0] > 0.0):
                rule = "the force lifts the contact"
                raise refuse(
                    f"touches[{k}].loaded", True, rule, "turn force or normal, or leave it out"
                )
        return loaded

    def after(self, impulse: Array, time: Real) -> tuple[Array, Array]:
        """Return velocities and spins after impulses on the second bodies, and constant forces.

        ``impulse`` is in N s along the axes, (count, C, 3), ``time`` that of the forces in s,
        (count,).
        """
        axes = self.axes
        after = {entry: self.of_bodies(entry) for entry in ("velocity", "spin")}
        for place, body in enumerate(self.gathering.bodies):
            pushed = self.flat(body.force, 3) * np.asarray(time)[:, None]
            after["velocity"][:, place] += pushed / self.flat(body.shape.mass)[:, None]
        for k, met in enumerate(self.met):
            for side, changes in changes_of(met, axes[:, k], impulse[:, k]):
                moved = self.gathering.places[k][side.sense < 0.0]
                for entry, change in changes.items():
                    after[entry][:, moved] += join_components(change, (self.count,))
        return after["velocity"], after["spin"]


def _sparse(blocks: dict[tuple[int, int], Array], contacts: int) -> Any:
    """Return W of one gathering from its blocks that are not zero."""
    from scipy import sparse  # only of many contacts

    places = np.array([*blocks, *((d, c) for c, d in blocks if c != d)])
    values = np.array([*blocks.values(), *(b.T for (c, d), b in blocks.items() if c != d)])
    rows, columns = np.broadcast_arrays(
        3 * places[:, :1, None] + np.arange(3)[:, None], 3 * places[:, 1:, None] + np.arange(3)
    )
    size = (3 * contacts, 3 * contacts)
    return sparse.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=size)
