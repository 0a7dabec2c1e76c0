"""Impacts of a batch, each followed over rings: as many at once as share their steps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import NormalMotion
from contactlab.impact.coupling import coupling_number
from contactlab_laws.halfspace.axisymmetric import STEPS, follow_all
from contactlab_laws.halfspace.course import Course, course, units
from contactlab_laws.halfspace.hemispheres import Array
from contactlab_laws.halfspace.march import follow
from contactlab_laws.halfspace.modes import modes
from contactlab_laws.halfspace.pressure import Answering, Prescribed

#: Steps from one ring to the next of vectors, and of pressure that answers to traction. With more
#: the error of the rings is larger than that of the steps.
VECTORS, ANSWERING = 1, 2
#: Least steps of an impact over sqrt(chi), over half the rings too: with fewer the swing of the
#: stuck contact is not followed, and the error does not fall as 1/rings².
SWING = 22.0

#: Effective Poisson's ratio below which tractions along one direction stay so.
ROUNDING = 1e-12


class Matter(NamedTuple):
    """The dimensionless numbers of each impact of a batch, arrays of shape (impacts,).

    Attributes
    ----------
    psi1, chi : array
        Dimensionless angle of incidence, and inertia ratio.
    poisson : array
        The effective Poisson's ratio, from kappa = 2(1-nu)/(2-nu).
    drag, lift : array
        Lam = kappa beta/mu, and mu beta.
    stiffness : array
        Unit of force times that of time over M_n v1.
    """

    psi1: Array
    chi: Array
    poisson: Array
    drag: Array
    lift: Array
    stiffness: Array

    @classmethod
    def of(cls, normal: NormalMotion) -> Matter:
        """Return the numbers of the impacts of a normal motion, of shape () or (impacts,)."""
        scene = normal.scene
        pair, count = scene.pair, max(math.prod(scene.shape), 1)
        kappa: Any = pair.stiffness_ratio
        unit = units(normal)
        momentum = np.atleast_1d(pair.normal_mass * scene.normal_speed)
        columns = (
            scene.psi1,
            scene.chi,
            (2.0 - 2.0 * kappa) / (2.0 - kappa),
            coupling_number(scene),
            np.abs(scene.friction_coefficient * pair.dundurs_beta),
            unit.force * unit.time / momentum,
        )
        return cls(*(np.broadcast_to(np.asarray(each, float), (count,)) for each in columns))


class Impacts(NamedTuple):
    """Impacts followed to their end at K instants after first touch, in dimensionless units.

    Attributes
    ----------
    change : array, shape (impacts,)
        Change of psi since first touch at the end of the impact.
    work : array, shape (impacts,)
        Friction work over M_t times the square of the unit of velocity.
    residual : array, shape (impacts,)
        Largest residual of the steps, over the largest pressure; 0 where none is left.
    impulse, share : array, shape (K + 1, impacts)
        Impulse of the friction load over M_n v1, and F over mu times the friction load.
    path : Course
        The normal motions without friction.
    departures : array, shape (3, K + 1, impacts), or None
        Departures of approach, rate and force from ``path``; None unless traction changes the
        pressure.
    """

    change: Array
    work: Array
    residual: Array
    impulse: Array
    share: Array
    path: Course
    departures: Array | None = None


class Options(NamedTuple):
    """The parameters of the law, as in ``HalfSpace``."""

    rings: int
    angles: int
    coupling: str
    extrapolate: bool


class Kinds(NamedTuple):
    """How each impact is followed; arrays of shape (impacts,).

    Attributes
    ----------
    plain : array of bool
        With tractions along one direction.
    dragged : array of bool
        With coupling.
    parts : array of int
        Steps from one ring to the next.
    """

    plain: NDArray[np.bool_]
    dragged: NDArray[np.bool_]
    parts: NDArray[np.int64]


def kinds(options: Options, matter: Matter) -> Kinds:
    """Return how each impact is followed."""
    dragged = (matter.drag > 0.0) & (options.coupling != "none")
    plain = ~dragged & ((np.abs(matter.poisson) < ROUNDING) | (options.angles == 1))
    answering = dragged & (options.coupling == "two_way")
    least = np.where(plain, STEPS, np.where(answering, ANSWERING, VECTORS))
    fewest = options.rings // 2 if options.extrapolate else options.rings
    parts = [parts_of(*each, fewest) for each in zip(matter.chi, least, strict=True)]
    return Kinds(plain, dragged, np.array(parts))


def followed(
    options: Options, normal: NormalMotion, matter: Matter
) -> Iterator[tuple[NDArray[np.int64], Impacts, Impacts | None, bool]]:
    """Yield impacts that share their steps: indices, impacts, impacts over half the rings, coupled.

    Parameters
    ----------
    options : Options
        Options of the law.
    normal : NormalMotion
        Normal motion of the impacts, of shape () or (impacts,).
    matter : Matter
        Dimensionless numbers of the impacts.
    """
    plain, drags, parts = kinds(options, matter)
    for key in np.unique(np.stack((plain, drags, parts)), axis=1).T.tolist():
        items = np.flatnonzero((plain == key[0]) & (drags == key[1]) & (parts == key[2]))
        mine = normal.take(items) if normal.scene.shape else normal
        ours = Matter(*(column[items] for column in matter))
        coupling = options.coupling if key[1] else "none"
        both: list[Impacts] = []
        for rings in (options.rings, options.rings // 2)[: 2 if options.extrapolate else 1]:
            if key[0]:
                both.append(along_one_direction(mine, ours, rings, key[2]))
            else:
                both.append(vectors(mine, ours, rings, options.angles, key[2], coupling))
        yield items, both[0], both[1] if options.extrapolate else None, bool(key[1])


def parts_of(chi: float, least: int, rings: int) -> int:
    """Return the steps from one ring to the next: ``least`` times a power of two."""
    wanted = SWING * math.sqrt(chi) / (2.0 * rings * least)
    return int(least) * 2 ** max(math.ceil(math.log2(wanted)), 0) if wanted > 0.0 else int(least)


def along_one_direction(normal: NormalMotion, matter: Matter, rings: int, parts: int) -> Impacts:
    """Return impacts whose tractions are along one direction, functions of the radius."""
    path = course(normal, rings, parts)
    motion = follow_all(rings, path, matter.psi1, matter.chi, matter.stiffness)
    return Impacts(
        change=motion.change[-1],
        work=motion.work,
        residual=np.zeros(motion.work.shape),
        impulse=np.broadcast_to(path.impulse, motion.share.shape),
        share=motion.share,
        path=path,
    )


def vectors(
    normal: NormalMotion, matter: Matter, rings: int, angles: int, parts: int, coupling: str
) -> Impacts:
    """Return impacts with tractions as vectors, one after the other."""
    path = course(normal, rings, parts)
    kept, departures = [], []
    for item in range(len(matter.psi1)):
        pressure = pressure_of(path, matter, item, rings, angles, coupling)
        if isinstance(pressure, Answering):
            departures.append((pressure.approach, pressure.rate, pressure.excess))
        kept.append(follow(pressure, float(matter.psi1[item]), float(matter.chi[item])))
    return Impacts(
        change=np.array([each.change[-1] for each in kept]),
        work=np.array([each.work for each in kept]),
        residual=np.array([each.residual for each in kept]),
        impulse=np.stack([each.impulse for each in kept], axis=1),
        share=np.stack([each.share for each in kept], axis=1),
        path=path,
        departures=np.stack(departures, axis=-1) if departures else None,
    )


def pressure_of(
    path: Course, matter: Matter, item: int, rings: int, angles: int, coupling: str
) -> Prescribed:
    """Return the pressure of one impact over the rings."""
    drag = 0.0 if coupling == "none" else float(matter.drag[item])
    lift = float(matter.lift[item]) if coupling == "two_way" else None
    table = modes(rings, angles, float(matter.poisson[item]), drag, lift)
    mine = path._replace(
        **{
            name: column[:, [item if column.shape[1] > 1 else 0]]
            for name, column in path._asdict().items()
            if column.ndim == 2
        }
    )
    kind = Prescribed if lift is None else Answering
    return kind(table, mine, float(matter.stiffness[item]))
