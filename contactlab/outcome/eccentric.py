"""The result of an eccentric impact: velocities after it, status, energy books and history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.eccentric import EccentricMotion
from contactlab.contracts.status import Status
from contactlab.impact.eccentric import EccentricScene
from contactlab.numeric.checks import Real
from contactlab.outcome.answer import RunResult
from contactlab.outcome.energy import LARGEST_RESTITUTION, EnergyLedger
from contactlab.outcome.history import NO_HISTORY, EccentricHistory, NoHistory
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]


@attrs.frozen(kw_only=True, eq=False, repr=False)
class EccentricResult(RunResult):
    """Result of one eccentric impact, or of a batch: every quantity has the scene's shape.

    Attributes
    ----------
    scene : EccentricScene
    plan : Plan
    motion : EccentricMotion
        The motion as the laws returned it.
    run_time : float
        Wall-clock time of the run, in s.
    laws : mapping of str to str
        Names of the three laws with their versions.
    history : EccentricHistory or NoHistory
        Only on request.
    psi2_error_estimate : float, array or None
        Estimate of the numerical error of psi2, only on request; in space the length of a vector.
    """

    scene: EccentricScene
    plan: Plan
    motion: EccentricMotion
    run_time: float = attrs.field(metadata={"unit": "s"})
    laws: Mapping[str, str]
    history: EccentricHistory | NoHistory = NO_HISTORY
    psi2_error_estimate: Real | None = None

    def _told(self) -> str:
        if self.scene.shape:
            return f"{np.size(self.normal_velocity)} impacts"
        psi2 = np.array2string(np.asarray(self.psi2), precision=6)
        return f"normal_velocity={self.normal_velocity:.6g}, psi2={psi2}"

    @property
    def psi1(self) -> Any:
        """Scaled slip velocity before the impact, (...) in the plane, (..., 2) in space."""
        return self.scene.psi1

    @property
    def psi2(self) -> Any:
        """Scaled slip velocity after the impact, (...) in the plane, (..., 2) in space."""
        return self.scene.psi(self.slip_velocity)

    @property
    def slip_velocity(self) -> Array:
        """Slip velocity after the impact along t1 and t2, shape (..., 2), in m/s."""
        return np.asarray(self.scene.slip_velocity + self.motion.slip_velocity_change)

    @property
    def normal_velocity(self) -> Real:
        """Approach velocity of the contact points after the impact over that before, V2."""
        speed: Any = self.scene.normal_speed
        ratio = (speed + self.motion.velocity_change[..., 0]) / speed
        return float(ratio) if np.ndim(ratio) == 0 else ratio

    @property
    def normal_restitution(self) -> Real:
        """Speed at which the contact points part over that at which they met."""
        return -self.normal_velocity

    @property
    def compressions(self) -> Any:
        """How often the approach grew: 1, or more where friction pressed the bodies together."""
        return self.motion.compressions

    @property
    def impulse(self) -> Array:
        """Impulse on the target along n, t1 and t2, shape (..., 3), in N s."""
        return impulse(self.scene, self.motion)

    @property
    def energy(self) -> EnergyLedger:
        """Energy books in J, of the relative motion at the contact: ½ v·W⁻¹·v is its energy."""
        return ledger(self.scene, self.motion)

    def plot(self, *, axes: Axes | None = None, x: tuple[str, Any] | None = None) -> Axes:
        """Draw the path of slip of one impact, or V2 and psi2 of a batch over psi1.

        In the plane slip is drawn over the velocity of approach, in space slip along t2 over that
        along t1. One impact needs ``run(scene, history=True)``. ``x`` is a label and a value for
        each impact of a batch, in place of psi1.
        """
        from contactlab.figures.eccentric import draw_eccentric  # matplotlib only when drawing

        return draw_eccentric(axes, self, x)


def impulse(scene: EccentricScene, motion: EccentricMotion) -> Array:
    """Return the impulse on the target along n, t1 and t2, shape (..., 3), in N s."""
    change = motion.velocity_change[..., None]
    return np.asarray(-np.linalg.solve(scene.inverse_mass, change)[..., 0])


def ledger(scene: EccentricScene, motion: EccentricMotion) -> EnergyLedger:
    """Return the energy books in J of the relative motion at the contact."""
    with np.errstate(invalid="ignore", over="ignore"):
        start = scene.kinetic_energy(scene.velocity)
        mean = scene.velocity + 0.5 * motion.velocity_change
        lost = np.einsum("...i,...i->...", impulse(scene, motion), mean)
        lost = float(lost) if lost.ndim == 0 else lost
        return EnergyLedger(
            start=start,
            end=start - lost,
            normal_loss=motion.normal_loss,
            friction_work=motion.friction_work,
            imbalance=lost - (motion.normal_loss + motion.friction_work),
        )


def balanced(motion: EccentricMotion, scene: EccentricScene, bound: Any) -> EccentricMotion:
    """Return ``motion`` with status ``UNBALANCED`` where the energy books do not balance.

    The imbalance over the energy at the start exceeds ``bound``, or the bodies gain energy.
    """
    books = ledger(scene, motion)
    with np.errstate(invalid="ignore"):
        off: Any = np.abs(books.imbalance) > bound * books.start
        gains: Any = books.end > LARGEST_RESTITUTION**2 * books.start
    wrong = off | gains
    if not np.any(wrong):
        return motion
    share = np.abs(np.where(gains, books.end - books.start, books.imbalance)) / books.start
    sentence = f"Off by {float(np.max(share, where=wrong, initial=0.0)):.2g} of the energy."
    if not scene.shape:
        nothing = EccentricMotion.nothing((), Status.UNBALANCED, sentence)
        return attrs.evolve(nothing, counters=motion.counters)
    nothing = EccentricMotion.nothing((int(wrong.sum()),), Status.UNBALANCED, sentence)
    everywhere = np.ones(scene.shape, dtype=bool)
    return EccentricMotion.merged([(everywhere, motion), (wrong, nothing)], scene.shape)
