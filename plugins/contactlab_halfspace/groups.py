"""The impacts of a batch in groups that share their steps, each group followed over rings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.coupling import coupling_number
from contactlab.numeric.types import Array, Places, Real
from contactlab_halfspace.axisymmetric import STEPS, follow_all
from contactlab_halfspace.instants import Instants, instants, units
from contactlab_halfspace.march import Followed, follow, join_impacts
from contactlab_halfspace.modes import Modes, modes
from contactlab_halfspace.pressure import Answering, Prescribed

#: Steps from one ring to the next of vectors, and of pressure that answers to traction. With more
#: the error of the rings is larger than that of the steps.
VECTORS, ANSWERING = 1, 2
#: Least steps of an impact over the root of chi, or of chi_w, over half the rings too: with fewer
#: the swing of the stuck contact is not followed, and the error does not fall as 1/rings².
SWING = 22.0
#: Impacts followed together as vectors: as many as fit into the cache.
TOGETHER = 32
#: Effective Poisson's ratio below which tractions along one direction stay so.
ROUNDING = 1e-12


class Options(NamedTuple):
    """The parameters of the law, as in ``HalfSpace``."""

    rings: int
    angles: int
    coupling: str
    extrapolate: bool

    @property
    def spins(self) -> bool:
        """True if spin about the normal is answered."""
        return self.angles > 1 and self.coupling == "none"


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
    rim, turning : array
        w and chi_w of spin about the normal, theory §17, by the radius of this motion.
    """

    psi1: Array
    chi: Array
    poisson: Array
    drag: Array
    lift: Array
    stiffness: Array
    rim: Array
    turning: Array

    @classmethod
    def of(cls, normal: NormalMotion) -> Matter:
        """Return the numbers of the impacts of a normal motion, of shape () or (impacts,)."""
        scene = normal.scene
        pair, count = scene.pair, max(math.prod(scene.shape), 1)
        kappa: Real = pair.stiffness_ratio
        unit = units(normal)
        momentum = np.atleast_1d(pair.normal_mass * scene.normal_speed)
        inertia: Real = 0.5 * kappa * pair.normal_mass * pair.inverse_spin_mass
        columns = (
            scene.psi1,
            scene.chi,
            (2.0 - 2.0 * kappa) / (2.0 - kappa),
            coupling_number(scene),
            np.abs(scene.friction_coefficient * pair.dundurs_beta),
            unit.force * unit.time / momentum,
            scene.normal_spin * unit.length * scene.psi_scale if kinetics.turns(scene) else 0.0,
            inertia * (unit.length / pair.radius) ** 2,
        )
        return cls(*(np.broadcast_to(np.asarray(each, float), (count,)) for each in columns))


class Group(NamedTuple):
    """Impacts that share their steps.

    Attributes
    ----------
    items : array of int
        Their places among all impacts.
    normal, matter : NormalMotion, Matter
        Normal motion and numbers of these impacts.
    plain, spins : bool
        Whether tractions stay along one direction, and whether bodies spin about the normal.
    coupling : str
        The law's, ``"none"`` where nothing couples.
    parts : int
        Steps from one ring to the next.
    """

    items: NDArray[np.int64]
    normal: NormalMotion
    matter: Matter
    plain: bool
    spins: bool
    coupling: str
    parts: int

    def path(self, rings: int) -> Instants:
        """Return the normal motions without friction, over ``rings`` rings."""
        return instants(self.normal, rings, self.parts)

    def follow(self, rings: int, angles: int, *, fields: bool = False) -> Followed:
        """Return these impacts over ``rings`` rings, those together whose modes are the same.

        Parameters
        ----------
        rings, angles : int
        fields : bool
            Whether to keep tractions, slips and pressures; of one impact only.
        """
        path, matter = self.path(rings), self.matter
        if self.plain:
            numbers = matter.psi1, matter.chi, matter.stiffness
            return follow_all(rings, path, *numbers, fields=fields)
        both, drags = self.coupling == "two_way", self.coupling != "none"
        alike = np.stack((matter.poisson, matter.drag * drags, matter.lift * both))
        tables, which = np.unique(alike, axis=1, return_inverse=True)
        parts, places = [], []
        for number, (poisson, drag, lift) in enumerate(tables.T.tolist()):
            table = modes(rings, angles, poisson, drag, lift if both else None, self.spins)
            ours = np.flatnonzero(which.ravel() == number)
            for first in range(0, ours.size, TOGETHER):
                some = ours[first : first + TOGETHER]
                parts.append(self._follow(table, path.take(some), some, fields=fields))
                places.append(some)
        order = np.argsort(np.concatenate(places))
        return join_impacts(parts, order)

    def _follow(self, table: Modes, path: Instants, some: Places, *, fields: bool) -> Followed:
        """Return some of the impacts, whose modes are the same, followed together as vectors."""
        psi1, chi, _, _, _, stiffness, rim, turning = (column[some] for column in self.matter)
        kind = Answering if table.parts == 3 else Prescribed
        pressure = kind(table, path, stiffness)
        if not self.spins:
            return follow(pressure, psi1, chi, rim, turning, fields=fields)
        slip, hand = signs(psi1, rim)
        motion = follow(pressure, slip * psi1, chi, np.abs(rim), turning, fields=fields)
        return _mirror(motion, slip, hand)


def signs(psi1: Array, rim: Array) -> tuple[Array, Array]:
    """Return the signs of slips, and those of the spins seen along them."""
    slip = np.where(psi1 < 0.0, -1.0, 1.0)
    return slip, slip * np.copysign(1.0, rim)


def _mirror(motion: Followed, slip: Array, hand: Array) -> Followed:
    """Return impacts followed with positive slip and spin, with those of ``signs``."""
    # Friction is odd, and a mirror along the slip turns the spin: answers are odd to the last bit.
    parts = np.stack((slip, slip * hand))[:, :1, None]
    spin = None if motion.spin is None else slip * hand * motion.spin
    fields = [(traction * parts, slips * parts, p) for traction, slips, p in motion.fields]
    share = slip * motion.share
    return motion._replace(change=slip * motion.change, share=share, spin=spin, fields=fields)


def groups(options: Options, normal: NormalMotion) -> Iterator[Group]:
    """Iterate over the groups of the impacts of a normal motion, of shape () or (impacts,)."""
    matter = Matter.of(normal)
    drags = (matter.drag > 0.0) & (options.coupling != "none")
    spins = (matter.rim != 0.0) & options.spins
    plain = ~(drags | spins) & ((np.abs(matter.poisson) < ROUNDING) | (options.angles == 1))
    answering = drags & (options.coupling == "two_way")
    least = np.where(plain, STEPS, np.where(answering, ANSWERING, VECTORS))
    fewest = options.rings // 2 if options.extrapolate else options.rings
    swings = np.maximum(matter.chi, np.where(spins, matter.turning, 0.0))
    parts = [_parts(*each, fewest) for each in zip(swings, least.tolist(), strict=True)]
    kinds = np.stack((plain, drags, parts, spins))
    for key in np.unique(kinds, axis=1).T:
        items = np.flatnonzero((kinds == key[:, None]).all(axis=0))
        yield Group(
            items=items,
            normal=normal.take(items) if normal.scene.shape else normal,
            matter=Matter(*(column[items] for column in matter)),
            plain=bool(key[0]),
            spins=bool(key[3]),
            coupling=options.coupling if key[1] else "none",
            parts=int(key[2]),
        )


def _parts(chi: float, least: int, rings: int) -> int:
    """Return the steps from one ring to the next: ``least`` times a power of two."""
    wanted = SWING * math.sqrt(chi) / (2.0 * rings * least)
    return least * 2 ** max(math.ceil(math.log2(wanted)), 0) if wanted > 0.0 else least
