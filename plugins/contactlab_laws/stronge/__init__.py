"""A contact of two springs with a slider: slip and stick of a whole impact, in closed form.

Scaled: theta = Omega t, Omega² = k_n/M_n; psi = (k_t/k_n) v_x/(mu v1); forces in units of mu times
the greatest normal force; omega = sqrt(k_t/M_t)/Omega. Then psi' = -omega² f, in stick f' = psi, in
slip of sign s f = s p. ``stages`` follows one impact, ``batch`` many.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity, refuse
from contactlab.numeric.types import Real
from contactlab_laws.stronge.batch import rebounds
from contactlab_laws.stronge.stages import Rebound, rebound

#: Bound of the imbalance of the energy books, over the energy at the start.
ROUNDING = 1e-9
#: Share by which the friction load's impulse may exceed that of the spring without a caution.
PULL = 1e-3
#: Above this ratio of the frequencies the oscillations of one impact are not followed: chi = 5e7.
MOST_FREQUENCY = 1e4
#: Fewer impacts than this are computed one by one.
FEW = 100


@attrs.frozen(kw_only=True)
class Stronge(WholeImpactTangentialLaw):
    """The lumped contact: a normal and a tangential spring, the tangential one on a slider.

    The normal spring has k_n in compression and k_n/e² in restitution, e that of the normal
    law's motion; the tangential one k_t throughout. Between the changes of slip and stick
    the motion is one of sines and cosines, so nothing is marched. The contact sticks at first if
    v_x < mu v1 k_n/k_t. The true normal motion enters by e alone. The law gives no history.

    Parameters
    ----------
    stiffness_ratio : float, optional
        k_t/k_n, Stronge's 1/eta²; kappa of the bodies, Mindlin's ratio, if not given. With it
        the ratio of the natural frequencies is sqrt(2 chi).

    References
    ----------
    Stronge, Int. J. Impact Eng. 15 (1994) 435-450, doi:10.1016/0734-743X(94)80027-7; Stronge,
    Impact Mechanics (2nd ed., 2018), ch. 5.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"elliptic"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_reference": "one spring for the whole contact: there is no partial slip",
        "load_impulse": "the normal spring of the lumped contact does not pull",
    }

    stiffness_ratio: float | None = quantity("1", rule=POSITIVE, default=None)

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of rounding: slip and stick are closed forms."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the outcome of every impact."""
        pair = scene.pair
        ratio = pair.stiffness_ratio if self.stiffness_ratio is None else self.stiffness_ratio
        with np.errstate(all="ignore"):
            unit: Real = scene.friction_coefficient * scene.normal_speed / ratio
            incidence = np.abs(scene.slip_velocity) / unit
            frequency = np.sqrt(ratio * pair.normal_mass / pair.tangential_mass)
            # e from the velocities: adhesion changes the friction load's impulse.
            bounce = -normal.final_rate / scene.normal_speed
        change, work = _of_each(incidence, frequency, np.maximum(bounce, 0.0), scene.shape)
        answer = WholeImpact(
            where=True,
            slip_velocity_change=np.sign(scene.slip_velocity) * change * unit,
            friction_work=pair.tangential_mass * np.square(unit) * work,
            reason="two springs and a slider: sines and cosines between slip and stick",
            psi2_error=0.0,
        )
        return (*super().whole_impacts(scene, normal), answer)

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of a lumped contact and of a normal spring that does not pull."""
        lumped = (
            "model: lumped contact, two springs without partial slip. psi2 of solid spheres is off "
            "by up to 0.4."
        )
        return (lumped, *_pull(scene, normal))


def _pull(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution that the friction load exceeds the force of the normal spring."""
    momentum = scene.pair.normal_mass * (scene.normal_speed - normal.final_rate)
    largest = float(np.max(normal.total_load_impulse / momentum))
    if not largest > 1.0 + PULL:
        return ()
    return (
        "model: stronge's normal spring does not pull, but this normal law does. The impulse of "
        f"the friction load is up to {largest:.3g} times that of the spring.",
    )


def _of_each(incidence: Real, frequency: Real, bounce: Real, shape: tuple[int, ...]) -> Rebound:
    """Return change and work of all impacts, arrays of ``shape``, scaled as in this file's head."""
    columns = (np.broadcast_to(each, shape).ravel() for each in (incidence, frequency, bounce))
    incidence, frequency, bounce = columns
    found = np.zeros((2, incidence.size))
    # without slip or friction the base class answers
    which = np.flatnonzero((incidence > 0.0) & (incidence < np.inf))
    impacts = incidence[which], frequency[which], bounce[which]
    fast = impacts[1][~(impacts[1] <= MOST_FREQUENCY)]
    if fast.size:
        why = f"must be at most {MOST_FREQUENCY:g}: each oscillation is followed"
        raise refuse("ratio of natural frequencies", float(fast[0]), why, "take tangential.fronts")
    if which.size < FEW:
        rows = zip(*(each.tolist() for each in impacts), strict=True)
        found[:, which] = np.reshape([rebound(*row) for row in rows], (-1, 2)).T
    else:
        found[:, which] = rebounds(*impacts)
    return Rebound(*found.reshape(2, *shape))
