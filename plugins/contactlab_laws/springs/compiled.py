"""Springs that ``contactlab_march.h`` marches: the same numbers as in Python."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple, Protocol, TypeGuard, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    AllStepsResponse,
    CausalTangentialLaw,
    Ends,
    NormalMotion,
    Steps,
    TangentialMotion,
    faults,
    shares_loss,
)
from contactlab.contracts.contacts import Contacts
from contactlab.contracts.law import Law
from contactlab.contracts.status import Details, Status, Statuses
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat, lock_arrays, spread, spread_object
from contactlab.numeric.types import AnyArray, Array, Real
from contactlab.numeric.vectors import over
from contactlab_laws.compiled import library
from contactlab_laws.jaeger.partial_slip import Scales
from contactlab_laws.march.contacts import tell_still_closing
from contactlab_laws.march.coupled_steps import DEEPEST, TOO_DEEP, Division, tell_too_long
from contactlab_laws.springs import viscous

Word = TypeVar("Word", Status, str)

#: Numbers of a contact, of an end, of a step of a known motion, and of an impact along it.
CONTACT, END, SAMPLE, IMPACT = 17, 22, 7, 7
#: Gap and pull of one contact alone, and its block of W by rows: starts and columns.
STILL = (0.0, 0.0, 0.0, 0.0)
ONE_BLOCK, FIRST_COLUMN = np.array([0, 1], np.intc), np.zeros(1, np.intc)
#: Contacts of gatherings all of whose blocks are marched: to look for zeros takes longer.
FEW = 3
#: Names of the classes that are compiled: to compare names loads none that nobody uses.
LAW = "contactlab_laws.springs.law.Springs"
COMPILED = {
    LAW, "contactlab_laws.hertz.Hertz", "contactlab_laws.viscoelastic.law.Viscoelastic",
    "contactlab_laws.march.schemes.Symplectic",
}  # fmt: skip
#: Statuses of scenes.
LONG, NONE, DEEP, INPUT = 1, 2, 3, 4
#: Springs that are moved in a call, a third of a second at most: Ctrl-C is heard between two calls.
AT_A_TIME = 1e6
#: Rounding over the largest number up to which steps of impacts count as alike: that of a contact
#: from a table.
ROUNDING = 4e-13


class _Springs(Protocol):
    """The entries of springs that the march reads; their own module imports this one."""

    @property
    def shear_loss(self) -> float: ...

    def even_springs(self) -> int: ...


def knows(law: Law, normal: Law | None, integrator: Law | None = None) -> TypeGuard[_Springs]:
    """Return whether a march of these laws is compiled; None stands for any normal law.

    Derived laws may answer otherwise.
    """
    asked = [_name(each) for each in (law, normal, integrator) if each is not None]
    return _name(law) == LAW and COMPILED.issuperset(asked)


def _name(law: Law) -> str:
    return f"{type(law).__module__}.{type(law).__qualname__}"


def march(
    scene: Scene,
    normal: NormalMotion,
    law: CausalTangentialLaw,
    divided: Division,
    refused: tuple[Status, str | NDArray[np.object_]],
) -> TangentialMotion | None:
    """Return the motion of ``march_coupled``; None where Python has to follow an impact."""
    bundle: Law = law
    if (found := library()) is None or not knows(bundle, normal.law):
        return None
    batch, links = kinetics.batch_of(scene), scene.links
    axes, springs = 1 if scene.planar else 2, bundle.even_springs()
    items, loss = math.prod(batch), shares_loss(law, normal.law)
    if not loss and "elastic_hertz" not in normal.claims:
        return None
    contacts = 1 if links is None else scene.shape[-1]
    c = _contacts(scene, normal, bundle.shear_loss if loss else None)
    row, column, block = _blocks(scene, contacts)
    deepest = np.asarray(spread(DEEPEST**0.4 * normal.maximum_approach, scene.shape))
    numbers = np.empty((3, items))
    for place, each in enumerate((divided.step, divided.leading, divided.most)):
        numbers[place] = _first(each, scene).ravel() if scene.shape else each
    end, steps, status = np.empty((*scene.shape, END)), np.empty(items), np.empty(items, np.intc)
    left = np.zeros(found.contactlab_march_room(contacts, springs) // 8 + 1)
    arguments = (
        items, contacts, c.ctypes.data, row.ctypes.data, column.ctypes.data, block.ctypes.data,
        axes, springs, int(loss), int(links is None), *(each.ctypes.data for each in numbers),
        deepest.ctypes.data, AT_A_TIME, left.ctypes.data, end.ctypes.data, steps.ctypes.data,
        status.ctypes.data,
    )  # fmt: skip
    while found.contactlab_march_scenes(*arguments) < items:
        pass
    statuses: Statuses = spread_object(Status.SUCCESS, scene.shape)
    details: Details = spread_object("", scene.shape)
    if status.any():
        if np.any((status == INPUT) & ~np.isnan(numbers[0])):
            return None
        told = _tell(law, divided, refused, end.reshape(items, contacts, END), steps, status, scene)
        statuses, details = _of_contacts(told[0], scene), _of_contacts(told[1], scene)
        end[_of_contacts(status, scene) != 0] = math.nan
    counters = {"steps": int(steps.max())}
    if not scene.shape:
        return _single(scene, c.item(0), end.tolist(), (statuses, details), counters)
    return _motion(scene, c[..., 0], end, (statuses, details), counters)


def _first(value: Real | str | NDArray[np.object_], scene: Scene) -> NDArray[Any]:
    """Return numbers of the batch shape; the contacts of a gathering share one number."""
    whole = over(np.asarray(value), scene.shape)
    return whole if scene.links is None else whole[..., 0]


@overload
def _of_contacts(words: list[Word], scene: Scene) -> Word | NDArray[np.object_]: ...
@overload
def _of_contacts(words: NDArray[np.intc], scene: Scene) -> NDArray[np.intc]: ...
def _of_contacts(words: list[Word] | NDArray[np.intc], scene: Scene) -> Word | AnyArray:
    """Return entries of the scenes of a flat batch for each of their contacts."""
    kind = object if isinstance(words, list) else None
    told = np.array(words, dtype=kind).reshape(kinetics.batch_of(scene))
    if scene.links is None:
        return told[()]
    return np.array(np.broadcast_to(told[..., None], scene.shape))


def _motion(
    scene: Scene,
    rate: Array,
    end: Array,
    told: tuple[Statuses, Details],
    counters: dict[str, int],
) -> TangentialMotion:
    """Return the motion by the ends of contacts, rows as of ``contactlab_march_end``."""
    columns = np.ascontiguousarray(end.transpose(end.ndim - 1, *range(end.ndim - 1)))
    slip = columns[1] if scene.planar else np.array(end[..., 1:3])
    duration, radius, approach, force, turns = columns[9:14]
    contacts = None
    if scene.links is not None:
        contacts = Contacts(
            impulse=np.array(end[..., 3:6]),
            moment=np.array(end[..., 19:22]),
            pushed=columns[18],
            touches=columns[14],
            first=columns[15],
            last=columns[16],
            dissipation=columns[8],
        )
    statuses, details = told
    return TangentialMotion(
        slip_velocity_change=slip,
        friction_work=columns[6],
        shear_loss=columns[7],
        normal=Ends(duration, rate + columns[0], radius, approach, force, columns[8], turns),
        status=statuses,
        detail=details,
        counters=counters,
        contacts=contacts,
    )


def _single(
    scene: Scene,
    rate: float,
    end: list[float],
    told: tuple[Statuses, Details],
    counters: dict[str, int],
) -> TangentialMotion:
    """Return the motion of one impact, as of ``_motion``: plain numbers are faster."""
    change, along, across, _, _, _, work, shear, loss, duration, radius, approach, force, turns = (
        end[:14]
    )
    return TangentialMotion(
        slip_velocity_change=along if scene.planar else np.array((along, across)),
        friction_work=work,
        shear_loss=shear,
        normal=Ends(duration, rate + change, radius, approach, force, loss, turns),
        status=told[0],
        detail=told[1],
        counters=counters,
    )


def _contacts(scene: Scene, normal: NormalMotion, shear_loss: float | None) -> Array:
    """Return the contacts at the start, rows as of ``contactlab_march_contact``."""
    pair = scene.pair
    columns = (
        scene.friction_coefficient, pair.radius, pair.effective_modulus,
        2.0 * pair.effective_shear_modulus,
        1.0 if scene.planar else pair.cross_stiffness_ratio,
        normal.maximum_radius, scene.normal_speed,
    )  # fmt: skip
    loss: tuple[Real, Real] = (0.0, 0.0)
    if shear_loss is not None:
        parts: Any = normal.law.start(normal.scene)  # type: ignore[attr-defined]
        loss = parts.time, shear_loss
    if not scene.shape:  # plain numbers are faster
        slip: Any = scene.slip_velocity
        slip = (slip, 0.0) if scene.planar else slip.tolist()
        return np.array((scene.normal_speed, *slip, *STILL, *columns, *loss, 0.0))
    c = np.zeros((*scene.shape, CONTACT))
    if scene.links is not None:
        c[..., :3], c[..., 3], c[..., 4:7] = (
            scene.links.velocity, scene.links.gap, scene.links.pull
        )  # fmt: skip
        c[..., 16] = scene.links.loaded
    else:
        c[..., 0] = scene.normal_speed
        if scene.planar:
            c[..., 1] = scene.slip_velocity
        else:
            c[..., 1:3] = scene.slip_velocity
    for place, value in enumerate((*columns, *loss), start=7):
        c[..., place] = value
    return c


def _blocks(scene: Scene, contacts: int) -> tuple[NDArray[np.intc], NDArray[np.intc], Array]:
    """Return W as blocks of 3 x 3 that are not zero in all scenes, by rows: starts, columns, W."""
    if scene.links is None:
        inverse = scene.inverse_mass
        assert inverse is not None
        block = np.ascontiguousarray(over(inverse, (*scene.shape, 3, 3)), dtype=float)
        return ONE_BLOCK, FIRST_COLUMN, block
    W = scene.links.inverse_mass
    if not isinstance(W, np.ndarray):
        W = W.tobsr((3, 3))
        starts, columns = (each.astype(np.intc) for each in (W.indptr, W.indices))
        return starts, columns, np.ascontiguousarray(W.data, dtype=float)
    full = W.reshape(-1, contacts, 3, contacts, 3).swapaxes(2, 3)
    if contacts <= FEW:
        return *_all_blocks(contacts), np.ascontiguousarray(full, dtype=float)
    kept = np.asarray(full.any(axis=(0, 3, 4)))
    np.fill_diagonal(kept, True)
    starts = np.concatenate(([0], np.cumsum(kept.sum(axis=1)))).astype(np.intc)
    rows, columns = np.nonzero(kept)
    return starts, columns.astype(np.intc), np.ascontiguousarray(full[:, rows, columns])


@cache
def _all_blocks(contacts: int) -> tuple[NDArray[np.intc], NDArray[np.intc]]:
    """Return starts and columns of all blocks of a few contacts."""
    starts = np.arange(0, contacts * (contacts + 1), contacts, dtype=np.intc)
    return lock_arrays(starts), lock_arrays(np.tile(np.arange(contacts, dtype=np.intc), contacts))


def _tell(
    law: Law,
    divided: Division,
    refused: tuple[Status, str | NDArray[np.object_]],
    end: Array,
    steps: Array,
    status: NDArray[np.intc],
    scene: Scene,
) -> tuple[list[Status], list[str]]:
    """Return statuses of scenes and sentences on them."""
    longest, said = (_first(each, scene).ravel() for each in (divided.longest, refused[1]))
    told = []
    for place, each in enumerate(status.tolist()):
        if each == LONG:
            if scene.links is None:
                words = tell_too_long(float(longest[place]), int(end[place, 0, 13]))
            else:
                pulled = bool(scene.links.pull.any())
                words = tell_still_closing(end[place, :, 14], end[place, :, 17] > 0.0, pulled)
            told.append((Status.NOT_SEPARATED, words))
        elif each == NONE:
            words = faults.sentence(law, "velocity is not finite", int(steps[place]))
            told.append((Status.NON_FINITE, words))
        elif each == DEEP:
            told.append((Status.UNRESOLVED, TOO_DEEP))
        else:
            told.append((refused[0], said[place]) if each else (Status.SUCCESS, ""))
    statuses, details = zip(*told, strict=True)
    return list(statuses), list(details)


class Path(NamedTuple):
    """Steps of impacts along known motions, rows of shape (K, items), or (K, 1) of all alike.

    Attributes
    ----------
    drift, kick : array
        In s.
    edge : array
        b² over the square of the unit of length.
    load : array
        Without loss the pressure, of the contact over that of Hertz's of this radius; with loss the
        mean friction load in units of force.
    limit, excess, time : array
        With loss: the friction load, the excess, and the relaxation time in s.
    """

    drift: Array
    kick: Array
    edge: Array
    load: Array
    limit: Array | None = None
    excess: Array | None = None
    time: Array | None = None


def advance_all(springs: int, scene: Scene, scales: Scales, path: Path) -> AllStepsResponse | None:
    """Return the forces of impacts along known motions; None without a compiled library."""
    if (found := library()) is None:
        return None
    shape, lossy, count = scene.shape, path.time is not None, len(path.drift)
    items = math.prod(shape)
    unit = path.drift.max(axis=0)  # times of impacts that are alike go with it
    unit = np.broadcast_to(np.where(unit > 0.0, unit, 1.0), items)
    impacts = np.empty((items, IMPACT))
    force, scale = flat(scales.force, shape), flat(scales.displacement, shape)
    mass = flat(scene.pair.tangential_mass, shape)
    columns = flat(scene.slip_velocity, shape), unit, unit, force, unit, mass, scale
    for place, column in enumerate(columns):
        impacts[:, place] = column
    if not lossy:
        impacts[:, 1] *= scale
        impacts[:, 2] *= force / mass
    rows = [path.drift / unit, path.kick / unit, path.edge, path.load]
    if path.limit is not None and path.excess is not None and path.time is not None:
        rows += [path.limit, path.excess, path.time / unit]
    out, forces = np.empty((items, 2)), np.empty((items, count))
    together = items if all(map(_alike, rows)) else 1
    room = found.contactlab_march_room(1, springs) // 8 + 1
    for first in range(0, items, together):
        table, left = np.zeros((count, SAMPLE)), np.zeros(room)
        for place, row in enumerate(rows):
            table[:, place] = row[:, min(first, row.shape[1] - 1)]
        arguments = (
            together, springs, int(lossy), table.ctypes.data, count, impacts[first:].ctypes.data,
            AT_A_TIME, left.ctypes.data, out[first:].ctypes.data, forces[first:].ctypes.data,
        )  # fmt: skip
        while found.contactlab_march_paths(*arguments) < together:
            pass
    out *= flat(scales.metres if lossy else scales.work, shape)[:, None]
    if not shape:
        return AllStepsResponse(forces[0], float(out[0, 0]), True, float(out[0, 1]))
    work, loss = (np.ascontiguousarray(each).reshape(shape) for each in out.T)
    return AllStepsResponse(np.ascontiguousarray(forces.T).reshape(count, *shape), work, True, loss)


def _alike(rows: Array) -> bool:
    """Return whether all impacts agree, to rounding, in each step."""
    near = np.abs(rows - rows[:, :1]) <= ROUNDING * np.abs(rows).max(initial=0.0)
    return rows.shape[1] == 1 or bool(near.all())


def path_of(state: viscous.State, scene: Scene, steps: Steps) -> Path:
    """Return the steps of springs that share the loss of the normal law."""
    count, shape = len(steps.kick), scene.shape

    def rows(column: Real) -> Array:
        table: Array = np.asarray(column)
        if table.size == count:
            return table.reshape(count, 1)
        return np.broadcast_to(table, (count, *shape)).reshape(count, -1)

    contact = viscous.read_contact(state, steps.contact, (steps.approach, steps.rate), rows)
    unit = np.reshape(state.scales.normal_force, (1, -1))
    return Path(
        drift=rows(steps.drift),
        kick=rows(steps.kick),
        edge=contact.edge,
        load=rows(steps.friction_load) / unit,
        limit=rows(steps.contact.friction_load) / unit,
        excess=contact.excess,
        time=contact.time,
    )


def path_without_loss(scales: Scales, steps: Steps) -> Path:
    """Return the steps of springs without loss."""
    count = len(steps.kick)
    radius = np.asarray(steps.contact.radius / scales.radius)
    pressure = np.asarray(scales.pressure(radius, steps.contact.friction_load))
    drift, kick, radius, pressure = (
        np.asarray(each).reshape(count, -1) for each in (steps.drift, steps.kick, radius, pressure)
    )
    return Path(drift, kick, np.square(radius), pressure)
