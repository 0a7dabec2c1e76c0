"""The result of an impact: velocities after it, status, energy books and cost."""

from __future__ import annotations

import html
from collections.abc import Mapping
from typing import TYPE_CHECKING

import attrs
import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import taken
from contactlab.numeric.checks import Real
from contactlab.numeric.names import attributes_told
from contactlab.outcome.answer import RunResult
from contactlab.outcome.energy import EnergyLedger, ledger
from contactlab.outcome.history import NO_HISTORY, History, NoHistory
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.figures.style import Width


@attributes_told
@attrs.frozen(kw_only=True, eq=False, repr=False)
class ImpactResult(RunResult):
    """Result of one impact, or of a batch: every quantity has the scene's shape.

    A batch can be indexed, sliced and iterated; each item is the result of one impact. Items keep
    the run time and the counters of the whole batch.

    Attributes
    ----------
    scene : Scene
    plan : Plan
    motion : Motion
        Normal and tangential motion, as the laws and the integrator returned them.
    run_time : float
        Wall-clock time of the run, in s; of a batch, for all its impacts.
    laws : mapping of str to str
        Names of the three laws with their versions.
    history : History or NoHistory
        Only on request; without, it is false and its attributes say what to write.
    psi2_error_estimate : float, array or None
        Estimate of the numerical error of psi2, only on request. The plan's cautions state
        model errors.
    """

    scene: Scene
    plan: Plan
    motion: Motion = attrs.field(repr=False)
    run_time: float = attrs.field(metadata={"unit": "s"})
    laws: Mapping[str, str]
    history: History | NoHistory = attrs.field(default=NO_HISTORY, repr=False)
    psi2_error_estimate: Real | None = attrs.field(default=None, repr=False)

    def _told(self) -> str:
        psi2 = np.asarray(self.psi2)
        if not self.scene.shape:
            return f"psi1={self.psi1:.6g}, chi={self.scene.chi:.6g}, psi2={psi2:.6g}"
        finite = psi2[np.isfinite(psi2)]
        ends = f" from {finite.min():.6g} to {finite.max():.6g}" if finite.size else " unknown"
        return f"{psi2.size} impacts, psi2{ends}"

    def _repr_html_(self) -> str:
        """Return ``str(self)`` as HTML for a notebook."""
        return f"<pre>{html.escape(str(self))}</pre>"

    @property
    def psi1(self) -> Real:
        """Local angle of incidence of the paper's eq. (29), without unit."""
        return self.scene.psi1

    @property
    def psi_change(self) -> Real:
        """psi2 - psi1, without the rounding error of a huge psi1."""
        return self.scene.psi(self.motion.slip_velocity_change)

    @property
    def psi2(self) -> Real:
        """Non-dimensional local angle of reflexion."""
        return self.scene.psi(self.rebound_slip_velocity)

    @property
    def rebound_slip_velocity(self) -> Real:
        """Local tangential velocity at the contact after the impact, in m/s."""
        return self.scene.slip_velocity + self.motion.slip_velocity_change

    @property
    def rebound_normal_velocity(self) -> Real:
        """Velocity of the sphere along the normal, in m/s; negative: away from the target."""
        speed, pair = self.scene.normal_speed, self.scene.pair
        share = 1.0 if self.scene.sphere is None else pair.normal_mass / self.scene.sphere.mass
        return speed - share * (speed - self.motion.normal_velocity)

    @property
    def rebound_tangential_velocity(self) -> Real | None:
        """Tangential velocity of the sphere's centre in m/s; None for a non-dimensional scene."""
        sphere = self.scene.sphere
        if sphere is None:
            return None
        share = self.scene.pair.tangential_mass / sphere.mass
        return self.scene.tangential_velocity + share * self.motion.slip_velocity_change

    @property
    def rebound_speed(self) -> Real | None:
        """Speed of the sphere's centre in m/s; None for a non-dimensional scene."""
        tangential = self.rebound_tangential_velocity
        return None if tangential is None else np.hypot(self.rebound_normal_velocity, tangential)

    @property
    def rebound_spin(self) -> Real | None:
        """Spin of the sphere in rad/s; None for a non-dimensional scene."""
        sphere = self.scene.sphere
        if sphere is None:
            return None
        inertia = sphere.mass * sphere.gyration_ratio**2 * sphere.radius
        share = self.scene.pair.tangential_mass / inertia
        return self.scene.spin + share * self.motion.slip_velocity_change

    @property
    def target_rebound_normal_velocity(self) -> Real | None:
        """Velocity of the target along the normal, in m/s; positive: away from the sphere.

        Velocities and spin of the target are 0 for a half-space, None without bodies.
        """
        motion, pair = self.motion, self.scene.pair
        return self._of_target(
            pair.normal_mass * (self.scene.normal_speed - motion.normal_velocity)
        )

    @property
    def target_rebound_tangential_velocity(self) -> Real | None:
        """Tangential velocity of the target's centre, in m/s, positive as that of the sphere."""
        return self._of_target(-self.scene.pair.tangential_mass * self.motion.slip_velocity_change)

    @property
    def target_rebound_spin(self) -> Real | None:
        """Spin of the target in rad/s, positive where it adds to the slip, as the sphere's."""
        turn = self.scene.pair.tangential_mass * self.motion.slip_velocity_change
        target = self.scene.target
        if isinstance(target, Sphere):
            turn = turn / (target.gyration_ratio**2 * target.radius)
        return self._of_target(turn)

    def _of_target(self, momentum: Real) -> Real | None:
        """Return ``momentum`` (N s) over the target's mass: 0 for a half-space."""
        target = self.scene.target
        if isinstance(target, Sphere):
            return momentum / target.mass
        return None if target is None else 0.0 * momentum + 0.0

    @property
    def normal_restitution(self) -> Real:
        """Coefficient of normal restitution, e = -v_z after / v_z before."""
        return -self.motion.normal_velocity / self.scene.normal_speed

    @property
    def tangential_restitution(self) -> Real | None:
        """e_t = centre's tangential velocity after over before; NaN where zero before."""
        after = self.rebound_tangential_velocity
        return None if after is None else _ratio(after, self.scene.tangential_velocity)

    @property
    def slip_restitution(self) -> Real:
        """Slip velocity after over before (psi2/psi1); NaN where zero before."""
        return _ratio(self.rebound_slip_velocity, self.scene.slip_velocity)

    @property
    def incidence_angle(self) -> Real:
        """Angle of the centre's path from the normal before the impact, in rad."""
        return _angle(self.scene.tangential_velocity, self.scene.normal_speed)

    @property
    def rebound_angle(self) -> Real | None:
        """Angle of the centre's path from the normal after the impact, in rad."""
        after = self.rebound_tangential_velocity
        return None if after is None else _angle(after, -self.rebound_normal_velocity)

    @property
    def local_rebound_angle(self) -> Real:
        """Angle of reflexion of the contact point, in rad: (39) with psi2 in place of psi1."""
        return _angle(self.rebound_slip_velocity, -self.motion.normal_velocity)

    @property
    def energy(self) -> EnergyLedger:
        """Energy books in J: energy before and after, losses, imbalance."""
        unchecked = self.plan.unchecked
        checked = not unchecked if isinstance(unchecked, bool) else ~unchecked
        return ledger(self.scene, self.motion, checked)

    def plot(
        self,
        x: str | None = None,
        y: str | None = None,
        *,
        axes: Axes | None = None,
        width: Width | None = None,
    ) -> Axes:
        """Return axes with ``y`` over ``x`` for a batch, forces over time for a single impact.

        Parameters
        ----------
        x, y : str, optional
            Columns of a written file, angles also in degrees: ``"psi1"``, ``"rebound_angle_deg"``.
        axes : Axes, optional
            Axes to draw on; a new figure of ``matplotlib.pyplot`` by default.
        width : {"one", "two"}, optional
            Columns of a page that a new figure fills.

        Raises
        ------
        ValueError
            If a quantity is unknown, or a single impact has no history.
        """
        from contactlab.figures.results import draw_result  # matplotlib only when drawing

        return draw_result(axes, self, x, y, width=width)

    def __getitem__(self, index: int | slice) -> ImpactResult:
        """Return the result of one impact of a batch, or of a slice."""
        part = super().__getitem__(index)
        estimate = taken(self.psi2_error_estimate, self.scene.shape, index)
        return attrs.evolve(part, psi2_error_estimate=estimate)


def _ratio(after: Real, before: Real) -> Real:
    """Return ``after / before``, NaN where ``before`` is zero."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.where(np.asarray(before) == 0.0, np.nan, np.divide(after, before))
    return float(ratio) if ratio.ndim == 0 else ratio


def _angle(tangential: Real, normal: Real) -> Real:
    """Return the angle from the normal in rad, a float for a single impact."""
    angle = np.arctan2(tangential, normal)
    return float(angle) if np.ndim(angle) == 0 else angle
