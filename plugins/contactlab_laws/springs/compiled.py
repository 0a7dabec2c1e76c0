"""Springs by ``contactlab_march.h``, what it knows of them: the same numbers as by Python."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    AllStepsResponse,
    Ends,
    NormalMotion,
    Steps,
    TangentialMotion,
    faults,
    shares_loss,
)
from contactlab.contracts.law import Law
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat, spread_object
from contactlab.numeric.types import Array, Real
from contactlab_laws.compiled import library
from contactlab_laws.march.coupled import DEEPEST, TOO_DEEP, Division, tell_too_long

#: Numbers of a contact, of an end, of a step of a known motion, and of an impact along it.
CONTACT, END, SAMPLE, IMPACT = 16, 17, 7, 7
#: Statuses of scenes.
LONG, NONE, DEEP, INPUT = 1, 2, 3, 4
#: Springs that are moved in a call, a third of a second at most: Ctrl-C is heard between two calls.
AT_A_TIME = 1e6


def knows(law: Law, normal: Law, integrator: Law | None = None) -> bool:
    """Return whether these are laws that are compiled."""
    from contactlab_laws.hertz import Hertz
    from contactlab_laws.march.schemes import Symplectic
    from contactlab_laws.springs.law import Springs
    from contactlab_laws.viscoelastic.law import Viscoelastic

    # a law that is derived from them may answer otherwise
    known = type(law) is Springs and type(normal) in (Hertz, Viscoelastic)
    return known and type(integrator) in (Symplectic, type(None))


def march(
    scene: Scene,
    normal: NormalMotion,
    law: Any,
    divided: Division,
    refused: tuple[Status, str | NDArray[np.object_]],
) -> TangentialMotion | None:
    """Return the motion of ``march_coupled``; None where Python has to follow an impact."""
    if (found := library()) is None or not knows(law, normal.law):
        return None
    shape = scene.shape
    items, axes = math.prod(shape), 1 if scene.planar else 2
    loss, springs = shares_loss(law, normal.law), law.even_springs()
    if not loss and "elastic_hertz" not in normal.claims:
        return None
    c = _contacts(scene, normal, law, loss=loss)
    row, column = np.array([0, 1], np.intc), np.array([0], np.intc)
    numbers = np.empty((4, items))
    for place, each in enumerate((divided.step, divided.leading, divided.most)):
        numbers[place] = np.broadcast_to(each, shape).ravel()
    numbers[3] = np.broadcast_to(DEEPEST**0.4 * np.asarray(normal.maximum_approach), shape).ravel()
    inverse: Any = scene.inverse_mass
    block = np.ascontiguousarray(np.broadcast_to(inverse, (*shape, 3, 3)), dtype=np.float64)
    end, steps, status = np.empty((items, END)), np.empty(items), np.empty(items, np.intc)
    left = np.zeros(found.contactlab_march_room(1, springs) // 8 + 1)
    arguments = (
        items, 1, c.ctypes.data, row.ctypes.data, column.ctypes.data, block.ctypes.data, axes,
        springs, int(loss), *(each.ctypes.data for each in numbers), AT_A_TIME, left.ctypes.data,
        end.ctypes.data, steps.ctypes.data, status.ctypes.data,
    )  # fmt: skip
    while found.contactlab_march_scenes(*arguments) < items:
        pass
    left_out = np.isnan(numbers[0])
    if np.any((status == INPUT) & ~left_out):
        return None
    lost = status != 0
    end[lost] = math.nan
    ended, detail = spread_object(Status.SUCCESS, shape), spread_object("", shape)
    if lost.any():
        told = _tell(law, divided, refused, end, steps, status, shape)
        ended, detail = (np.array(each, dtype=object).reshape(shape)[()] for each in told)
    return _motion(c, end, axes, shape, ended, detail, int(steps.max()))


def _contacts(scene: Scene, normal: NormalMotion, law: Any, *, loss: bool) -> Array:
    """Return the contacts at first touch, rows as of ``contactlab_march_contact``."""
    pair: Any = scene.pair
    c = np.zeros((*scene.shape, CONTACT))
    c[..., 0] = scene.normal_speed
    if scene.planar:
        c[..., 1] = scene.slip_velocity
    else:
        c[..., 1:3] = scene.slip_velocity
    columns = (
        scene.friction_coefficient, pair.radius, pair.effective_modulus,
        2.0 * pair.effective_shear_modulus,
        1.0 if scene.planar else pair.cross_stiffness_ratio,
        normal.maximum_radius, scene.normal_speed,
    )  # fmt: skip
    for place, value in enumerate(columns, start=7):
        c[..., place] = value
    if loss:
        parts: Any = normal.law.start(normal.scene)  # type: ignore[attr-defined]
        c[..., 14], c[..., 15] = parts.time, law.shear_loss
    return c


def _motion(
    c: Array, end: Array, axes: int, shape: tuple[int, ...], status: Any, detail: Any, steps: int
) -> TangentialMotion:
    """Return what the library left as a motion."""
    end = end.reshape(*shape, END)

    def column(place: int) -> Real:
        return np.ascontiguousarray(end[..., place]) if shape else float(end[place])

    slip: Any = column(1) if axes == 1 else np.ascontiguousarray(end[..., 1:3])
    rate: Any = c[..., 0] + end[..., 0]
    ends = column(9), rate if shape else float(rate), *map(column, (10, 11, 12, 8, 13))
    return TangentialMotion(
        slip_velocity_change=slip,
        friction_work=column(6),
        shear_loss=column(7),
        normal=Ends(*ends),
        status=status,
        detail=detail,
        counters={"steps": steps},
    )


def _tell(
    law: Law,
    divided: Division,
    refused: tuple[Status, Any],
    end: Array,
    steps: Array,
    status: NDArray[np.intc],
    shape: tuple[int, ...],
) -> tuple[list[Status], list[str]]:
    """Return statuses of impacts and sentences on them."""
    longest, said = (np.broadcast_to(each, shape).ravel() for each in (divided.longest, refused[1]))
    told = []
    for place, each in enumerate(status.tolist()):
        if each == LONG:
            words = tell_too_long(float(longest[place]), int(end[place, 13]))
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


def advance_all(
    springs: int, scene: Scene, scales: Any, steps: Steps, columns: tuple[Array, ...]
) -> AllStepsResponse | None:
    """Return the forces of impacts along known motions that differ in scale only; or None.

    ``columns`` are b² and the pressure of each step, shape (K,), over the largest radius and over
    that of the contact of this radius; with loss b², the excess, and the relaxation time in s of
    the first impact.
    """
    if (found := library()) is None:
        return None
    shape, lossy = scene.shape, len(columns) == 3
    count, items = len(steps.kick), math.prod(shape)
    drift, kick, load, limit = (
        np.asarray(each).reshape(count, -1)[:, 0]
        for each in (steps.drift, steps.kick, steps.friction_load, steps.contact.friction_load)
    )
    table, one = np.zeros((count, SAMPLE)), np.empty((items, IMPACT))
    unit = flat(np.asarray(steps.drift)[-1], shape)  # times of impacts that are alike go with it
    table[:, 0], table[:, 1], table[:, 2] = drift / unit[0], kick / unit[0], columns[0]
    one[:, 0], one[:, 3] = flat(scene.slip_velocity, shape), flat(scales.force, shape)
    one[:, 4], one[:, 5] = unit, flat(scene.pair.tangential_mass, shape)
    one[:, 6] = flat(scales.displacement, shape)
    if lossy:
        peak = flat(scales.normal_force, shape)[0]
        table[:, 3], table[:, 4] = load / peak, limit / peak
        table[:, 5], table[:, 6] = columns[1], columns[2] / unit[0]
        one[:, 1] = one[:, 2] = unit
    else:
        table[:, 3] = columns[1]
        one[:, 1] = unit * one[:, 6]
        one[:, 2] = unit * one[:, 3] / one[:, 5]
    out, forces = np.empty((items, 2)), np.empty((items, count))
    left = np.zeros(found.contactlab_march_room(1, springs) // 8 + 1)
    arguments = (
        items, springs, int(lossy), table.ctypes.data, count, one.ctypes.data, AT_A_TIME,
        left.ctypes.data, out.ctypes.data, forces.ctypes.data,
    )  # fmt: skip
    while found.contactlab_march_paths(*arguments) < items:
        pass
    out *= flat(scales.metres if lossy else scales.work, shape)[:, None]
    if not shape:
        return AllStepsResponse(forces[0], float(out[0, 0]), True, float(out[0, 1]))
    work, loss = (np.ascontiguousarray(each).reshape(shape) for each in out.T)
    return AllStepsResponse(np.ascontiguousarray(forces.T).reshape(count, *shape), work, True, loss)
