"""A contact of two springs with a slider: slip and stick of a whole impact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, Real, quantity, refuse
from contactlab_laws.stronge.lumped import Rebound, rebound

#: Bound of the imbalance of the energy books, over the energy at the start.
ROUNDING = 1e-9
#: Share by which the friction load's impulse may exceed that of the spring without a caution.
PULL = 1e-3
#: Above this ratio of the frequencies the oscillations of one impact are not followed: chi = 5e7.
MOST_FREQUENCY = 1e4


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
            unit: Any = scene.friction_coefficient * scene.normal_speed / ratio
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
            "lumped contact: springs independent of the contact's area, without partial slip, "
            "which moves psi2 of solid spheres by up to about 0.4 (model, not numerical error)"
        )
        return (lumped, *_pull(scene, normal))


def _pull(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution that the friction load exceeds the force of the normal spring."""
    momentum = scene.pair.normal_mass * (scene.normal_speed - normal.final_rate)
    largest = float(np.max(normal.total_load_impulse / momentum))
    if not largest > 1.0 + PULL:
        return ()
    return (
        f"lumped contact: its normal spring does not pull; the friction load of the normal law has "
        f"up to {largest:.3g} times the impulse (1 + e) M_n v1 of that spring (model, not "
        "numerical error)",
    )


def _of_each(incidence: Any, frequency: Any, bounce: Any, shape: tuple[int, ...]) -> Rebound:
    """Return change and work of all impacts, arrays of ``shape``, scaled as in ``lumped``."""
    columns = (incidence, frequency, bounce)
    rows = zip(*(np.broadcast_to(each, shape).ravel().tolist() for each in columns), strict=True)
    change, work = np.array([_of_one(*row) for row in rows]).T.reshape(2, *shape)
    return Rebound(change, work)


def _of_one(incidence: float, frequency: float, bounce: float) -> Rebound:
    if not 0.0 < incidence < np.inf:  # no slip, or no friction: answered by the base class
        return Rebound(0.0, 0.0)
    if not frequency <= MOST_FREQUENCY:
        why = f"must be at most {MOST_FREQUENCY:g}: each oscillation is followed"
        raise refuse("ratio of natural frequencies", frequency, why, "take tangential.fronts")
    return rebound(incidence, frequency, bounce)
