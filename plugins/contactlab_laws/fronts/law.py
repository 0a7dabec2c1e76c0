"""The law of the slip front."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
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
from contactlab.contracts.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab_laws.jaeger.gross_slip import gross_slip
from contactlab_laws.tables.elastic import ERROR, rebound
from contactlab_laws.tables.regions import LARGEST_CHI

#: Why an impact is not followed.
REASON = "psi2 is tabulated; a history, or a tolerance below 1e-9, follows the impact"


#: Error of impacts that are followed where none is asked for.
FOLLOWED = 1e-9


@attrs.frozen(kw_only=True)
class Fronts(PathTangentialLaw, Tabulated):
    """The continuum limit of the annulus law, with no discretisation.

    Where the contact sticks and where it slips is a short list of fronts; between changes
    of regime their motion is smooth (theory §§4 and 5). Up to chi = 2.5 psi2 is a table of psi1
    and chi, and impacts are followed only for a history or a tolerance below 1e-9.

    Parameters
    ----------
    table : bool
        Take whole impacts from the table where it answers; False solves every impact.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    Ciavarella, J. Appl. Mech. 65 (1998) 998-1003, and Jaeger, J. Tribol. 120 (1998) 677-684:
    tangential loading from superposed normal contacts, of which the springs are one form.
    """

    elliptic: ClassVar[bool] = True
    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip"})
    needs: ClassVar[frozenset[str]] = frozenset({"elastic_hertz"})
    together: ClassVar[bool] = True
    linear_below: ClassVar[float] = 1e-8
    rebound = staticmethod(rebound)

    table: bool = flag(default=True)

    def books_bound(self, scene: Scene) -> Real:
        """Return 1e-8; the largest found in 20,000 impacts was 1e-10, next to ``psi1`` = 1."""
        return 1e-8

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return gross slip where (44) and (46) say so, and the rest from the table."""
        chi: Any = scene.chi
        psi1: Any = scene.psi1
        tabulated = self.table and (chi <= LARGEST_CHI) & (abs(psi1) < 4.0 * LARGEST_CHI)
        if not scene.shape and tabulated and psi1 and abs(psi1) < max(1.0, 4.0 * chi - 1.0):
            return (_from_table(scene, psi1, chi, where=True),)
        closed = (*super().whole_impacts(scene, normal), *gross_slip(scene, normal))
        if tabulated is False:
            return closed
        if scene.shape:
            # ``closed`` answers the other impacts; there psi1 may be infinite.
            chi, psi1 = np.broadcast_arrays(chi, psi1)
            if not np.all(tabulated):
                chi, psi1 = np.where(tabulated, chi, 1.0), np.where(tabulated, psi1, 0.0)
        return (*closed, _from_table(scene, psi1, chi, where=tabulated))

    def needs_no_march(self, scene: Scene, accuracy: float | None) -> bool:
        """Return whether the table, or a closed form, answers for all impacts."""
        exact_enough = accuracy is None or accuracy >= ERROR
        return self.table and exact_enough and bool(np.all(scene.chi <= LARGEST_CHI))

    def psi2_error(self, scene: Scene, normal: NormalMotion, steps: Any) -> Real:
        """Return 0: there is no discretisation."""
        return 0.0

    def path(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> Iterator[Stretch]:
        """Yield stretches of stick, edge slip and gross slip."""
        from contactlab_laws.fronts.central import stretches  # not for those the table answers

        return stretches(velocity, inertia, motion, tolerance)

    def impacts_together(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of planar impacts, each followed from event to event."""
        from contactlab_laws.fronts.together import motion

        return motion(scene, normal, accuracy, observer)

    def errors_together(self, scene: Scene, accuracy: float | None) -> tuple[Real, Real]:
        """Return the accuracy that is aimed at, over max(1, psi1), for both."""
        error = FOLLOWED if accuracy is None else accuracy
        return error * psi_magnitude(scene), error


def _from_table(scene: Scene, psi1: Any, chi: Any, *, where: Any) -> WholeImpact:
    """Return the answer of the table."""
    magnitude: Any = np.maximum(1.0, abs(psi1)) if scene.shape else max(1.0, abs(psi1))
    return from_change(
        scene,
        where=where,
        psi_change=rebound(psi1, chi) - psi1,
        psi2_error=ERROR * magnitude,
        reason=REASON,
        counter="tabulated",
    )
