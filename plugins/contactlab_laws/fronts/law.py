"""The law of the slip front."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    Cost,
    CoupledTangentialLaw,
    Errors,
    NormalMotion,
    Observer,
    PathTangentialLaw,
    Stretch,
    Tabulated,
    TangentialMotion,
    WholeImpact,
    flag,
    from_change,
)
from contactlab.impact.error_model import psi_magnitude
from contactlab.impact.hertz import slips_throughout
from contactlab.impact.scene import Scene
from contactlab.numeric.array_api import Library, Traced
from contactlab.numeric.arrays import greater, magnitude, spread
from contactlab.numeric.types import Array, Mask, Real
from contactlab_laws.compiled import library
from contactlab_laws.fronts import compiled
from contactlab_laws.jaeger.partial_slip import gross_slip
from contactlab_laws.tables.elastic import ERROR, rebound
from contactlab_laws.tables.regions import LARGEST_CHI

#: Impacts of a block: as many as fit into the cache if none is followed; so few that an
#: interruption loses little if none has an answer from the table.
WHOLE_IMPACTS, FOLLOWED_AT_A_TIME, FEW = 1 << 14, 1000, 20
#: Reason of impacts that are not followed.
REASON = "psi2 comes from a table; ask for a history to step"
#: Default error of impacts that are followed.
FOLLOWED = 1e-9
#: Error over max(1, psi1) of whole impacts by the compiled solver, from so large a chi on times chi
#: over it, as the contact oscillates; and why they are not followed.
COMPILED, HEAVY = 1e-11, 1e4
SOLVED = "psi2 is solved by the compiled law; a history follows the impact"


@attrs.frozen(kw_only=True)
class Fronts(PathTangentialLaw, CoupledTangentialLaw, Tabulated):
    """The continuum limit of the annulus law, with no discretisation.

    Where the contact sticks and where it slips is a short list of fronts; between changes
    of regime their motion is smooth (theory §§4 and 5). Up to chi = 2.5 psi2 is a table of psi1
    and chi, beyond it the compiled solver answers, and impacts are followed for a history, a
    tolerance below 1e-9, or where there is no such solver.

    Parameters
    ----------
    table : bool
        Take whole impacts from the table where it answers, and beyond it from the compiled solver
        if there is one; False follows every impact.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    Ciavarella, J. Appl. Mech. 65 (1998) 998-1003, and Jaeger, J. Tribol. 120 (1998) 677-684:
    tangential loading from superposed normal contacts, of which the springs are one form.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip", "elliptic"})
    needs: ClassVar[frozenset[str]] = frozenset({"elastic_hertz"})
    chi_range: ClassVar[tuple[float, float]] = math.ulp(0.0), LARGEST_CHI
    rebound = staticmethod(rebound)

    @staticmethod
    def rebound_error(*_: object) -> Real:
        """Return the bound of the table."""
        return ERROR

    @staticmethod
    def table_of_arrays() -> Mapping[str, Any]:
        """Return the elastic table."""
        from contactlab_laws.tables import traced  # only for arrays of other libraries

        return traced.elastic_constants()

    @staticmethod
    def rebound_of_arrays(
        xp: Library, tables: Mapping[str, Traced], *impact: Traced, **options: Any
    ) -> Traced:
        """Return psi2 of psi1 and chi."""
        from contactlab_laws.tables import traced

        return traced.rebound(xp, tables, *impact, with_slopes=options["with_slopes"])

    table: bool = flag(default=True)

    def books_bound(self, scene: Scene) -> Real:
        """Return 1e-8; the largest found in 20,000 impacts was 1e-10, next to ``psi1`` = 1."""
        return 1e-8

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return gross slip where (44) and (46) say so, and the rest from the table."""
        chi: Real = scene.chi
        psi1: Real = scene.psi1
        tabulated = self.table and (chi <= LARGEST_CHI) & (magnitude(psi1) < 4.0 * LARGEST_CHI)
        if not scene.shape and tabulated and psi1 and not slips_throughout(psi1, chi):
            return (_from_table(scene, psi1, chi, where=True),)
        closed = (*super().whole_impacts(scene, normal), *gross_slip(scene, normal))
        if self.table and not np.all(tabulated):
            closed = (*closed, *_solve_in_c(scene, np.logical_not(tabulated)))
        if not np.any(tabulated):
            return closed
        if scene.shape:
            # ``closed`` answers the other impacts; there psi1 may be infinite.
            chi, psi1 = np.broadcast_arrays(chi, psi1)
            if not np.all(tabulated):
                chi, psi1 = np.where(tabulated, chi, 1.0), np.where(tabulated, psi1, 0.0)
        return (*closed, _from_table(scene, psi1, chi, where=tabulated))

    def solved(self, psi1: Array, chi: Array) -> Array | None:
        """Return psi2 - psi1 by the compiled law; None unless it answers for all impacts."""
        if library() is None:
            return None
        slips = slips_throughout(psi1, chi)
        change, _, known = compiled.central(np.where(slips, 0.5, psi1), chi)
        return np.where(slips, -4.0 * chi, change) if known.all() else None

    def cost(self, scene: Scene, accuracy: float | None) -> Cost:
        """Return a large block if no impact is followed, a small one if the table answers none."""
        by_table, known = bool(np.all(scene.chi <= LARGEST_CHI)), library() is not None
        least = ERROR if by_table else COMPILED
        if self.table and (by_table or known) and (accuracy is None or accuracy >= least):
            block = WHOLE_IMPACTS
        else:
            block = FEW if accuracy is not None and accuracy < ERROR else FOLLOWED_AT_A_TIME
        return Cost(block, compiled.tell(), not known)

    def errors(
        self, scene: Scene, normal: NormalMotion, steps: Real, accuracy: float | None = None
    ) -> Errors:
        """Return 0, as nothing is discretised; of both motions together, the accuracy aimed at."""
        if scene.inverse_mass is None:
            return Errors(0.0)
        error = FOLLOWED if accuracy is None else accuracy
        return Errors(error * psi_magnitude(scene), error)

    def path(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> Iterator[Stretch]:
        """Yield stretches of stick, edge slip and gross slip."""
        from contactlab_laws.fronts.central import stretches  # not for those the table answers

        return stretches(velocity, inertia, motion, tolerance)

    def solve_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of planar impacts, each followed from event to event."""
        from contactlab_laws.fronts.coupled import motion

        return motion(scene, normal, accuracy or FOLLOWED, observer)


def _solve_in_c(scene: Scene, where: Mask) -> tuple[WholeImpact, ...]:
    """Return the answers of the compiled law to central impacts."""
    if library() is None:
        return ()
    columns = np.broadcast_arrays(scene.psi1, scene.chi, where)
    psi1, chi, wanted = (np.ravel(column) for column in columns)
    slips = slips_throughout(psi1, chi)  # a closed form, psi1 may be infinite
    places = np.flatnonzero(wanted & ~slips & (psi1 != 0.0))
    if not places.size:
        return ()
    change, work, known = np.zeros((3, psi1.size))
    change[places], work[places], known[places] = compiled.central(psi1[places], chi[places])
    pair, mu, speed = scene.pair, scene.friction_coefficient, scene.normal_speed
    unit: Real = mu * speed / pair.stiffness_ratio
    energy: Real = 1.25 * mu * unit * pair.normal_mass * speed  # 2.5 rho v1²/(2 W_nn), theory §14
    error = COMPILED * np.maximum(1.0, np.abs(np.where(known, psi1, 0.0)))
    error = error * np.maximum(1.0, chi / HEAVY)
    shaped = (spread(each.reshape(scene.shape), scene.shape) for each in (change, work, error))
    moved, worked, declared = shaped
    return (
        WholeImpact(
            where=known.reshape(scene.shape) > 0.0 if scene.shape else bool(known[0]),
            slip_velocity_change=moved * unit,
            friction_work=worked * energy,
            reason=SOLVED,
            psi2_error=declared,
            counter="solved",
        ),
    )


def _from_table(scene: Scene, psi1: Real, chi: Real, *, where: Mask) -> WholeImpact:
    return from_change(
        scene,
        where=where,
        psi_change=rebound(psi1, chi) - psi1,
        psi2_error=ERROR * greater(magnitude(psi1), 1.0),
        reason=REASON,
        counter="tabulated",
    )
