"""The answer: velocities after the impact, its status, its energy books and its cost."""

from __future__ import annotations

import html
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import Real
from contactlab.outcome.energy import EnergyLedger, ledger
from contactlab.outcome.history import History
from contactlab.outcome.motion import Motion
from contactlab.outcome.numerical_error import error_cautions, error_words
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.figures.style import Width


class ImpactError(RuntimeError):
    """Raised by ``ImpactResult.check()`` for a run that did not succeed.

    ``status`` is that of the impact it tells of.
    """

    def __init__(self, sentence: str, status: Status) -> None:
        super().__init__(sentence, status)
        self.status = status

    def __str__(self) -> str:
        """Return the sentence alone."""
        return str(self.args[0])


@attrs.frozen(kw_only=True, eq=False, repr=False)
class ImpactResult:
    """Outcome of one impact, or of a batch: every entry has the scene's shape.

    A batch can be indexed, sliced and iterated; each item is the result of one impact. What is
    said of the whole batch stays: run time, counters, and the plan's sentences.

    Attributes
    ----------
    scene : Scene
    plan : Plan
    motion : Motion
        Normal and tangential motion, as the laws and the integrator returned them.
    run_time : float
        Wall-clock time of the whole run in s (of the whole batch).
    laws : mapping of str to str
        Names of the three laws with their versions.
    history : History or None
        Only if asked for.
    psi2_error_estimate : float, array or None
        Estimate of the numerical error of psi2, only if asked for; the model's errors are in the
        plan's cautions.
    """

    scene: Scene
    plan: Plan
    motion: Motion = attrs.field(repr=False)
    run_time: float = attrs.field(metadata={"unit": "s"})
    laws: Mapping[str, str]
    history: History | None = attrs.field(default=None, repr=False)
    psi2_error_estimate: Real | None = attrs.field(default=None, repr=False)

    def __repr__(self) -> str:
        """Return psi2, how it went and by what laws, on one line."""
        shape, psi2 = self.scene.shape, np.asarray(self.psi2)
        statuses = Counter(status.name for status in np.ravel(np.array(self.status, dtype=object)))
        laws = ", ".join(name.partition(" ")[0] for name in self.laws.values())
        if not shape:
            found = f"psi1={self.psi1:.6g}, chi={self.scene.chi:.6g}, psi2={psi2:.6g}"
        else:
            known = psi2[np.isfinite(psi2)]
            ends = f" from {known.min():.6g} to {known.max():.6g}" if known.size else " unknown"
            found = f"{psi2.size} impacts, psi2{ends}"
        told = ", ".join(f"{count} {name}" if shape else name for name, count in statuses.items())
        return f"ImpactResult({found}; {told}; {laws})"

    def __str__(self) -> str:
        """Return the line of ``repr``, the numerical error and every caution, a line each."""
        cautions = [*error_cautions(self), *map(str, self.plan.cautions)]
        lines = [repr(self), f"numerical error of psi2: {error_words(self)}"]
        return "\n".join([*lines, *(f"caution: {text}" for text in cautions)])

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the words of ``str``."""
        return f"<pre>{html.escape(str(self))}</pre>"

    @property
    def status(self) -> Any:
        """A ``Status``, or an array of them."""
        return self.motion.status

    @property
    def failures(self) -> dict[int, str]:
        """What went wrong: a sentence for each impact that failed, by its index in C order."""
        statuses, details = (
            np.ravel(np.asarray(entry, dtype=object))
            for entry in (self.motion.status, self.motion.detail)
        )
        return {
            index: f"{status.value} {detail}".strip()
            for index, (status, detail) in enumerate(zip(statuses, details, strict=True))
            if status is not Status.SUCCESS
        }

    @property
    def counters(self) -> Mapping[str, int]:
        """Work done: steps, evaluations, solves, rejected steps."""
        return self.motion.counters

    def check(self) -> ImpactResult:
        """Return this result if every impact succeeded.

        Raises
        ------
        ImpactError
            With the sentence of the first impact that failed.
        """
        for index, sentence in self.failures.items():
            where = f"impact {index}: " if self.scene.shape else ""
            status = np.ravel(np.asarray(self.status, dtype=object))[index]
            raise ImpactError(where + sentence, status)
        return self

    @property
    def psi1(self) -> Real:
        """Non-dimensional local angle of incidence (29)."""
        return self.scene.psi1

    @property
    def psi_change(self) -> Real:
        """psi2 - psi1, free of the rounding that a huge psi1 brings."""
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
        """Velocity of the target along the normal, in m/s; positive: away from where it was hit.

        0 for a half-space, None for a non-dimensional scene; so are the next two.
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
        """Return ``momentum`` (N s) over the mass of the target, without bound for a half-space."""
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
        """e_t = centre's tangential velocity after over before; NaN where that was zero."""
        after = self.rebound_tangential_velocity
        return None if after is None else _ratio(after, self.scene.tangential_velocity)

    @property
    def slip_restitution(self) -> Real:
        """Local tangential velocity after over before (psi2/psi1); NaN where that was zero."""
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
        """Angle of reflexion of the contact point, in rad: of psi2 as (39) is of psi1."""
        return _angle(self.rebound_slip_velocity, -self.motion.normal_velocity)

    @property
    def energy(self) -> EnergyLedger:
        """Energy before and after, friction work, and what does not add up."""
        return ledger(self.scene, self.motion)

    def plot(
        self,
        x: str | None = None,
        y: str | None = None,
        *,
        axes: Axes | None = None,
        width: Width | None = None,
    ) -> Axes:
        """Draw a batch as ``y`` over ``x``, a single impact as its forces over the contact.

        Parameters
        ----------
        x, y : str, optional
            Columns of the exports, angles also in degrees: ``"psi1"``, ``"rebound_angle_deg"``.
        axes : Axes, optional
            Where to draw; a new figure of ``matplotlib.pyplot`` by default.
        width : {"one", "two"}, optional
            Columns of a page that a new figure fills.

        Raises
        ------
        ValueError
            If a quantity is not known, or a single impact has no history.
        """
        from contactlab.figures.results import draw_result  # matplotlib only when drawing

        return draw_result(axes, self, x, y, width=width)

    def to_dataframe(self) -> Any:
        """Return a ``pandas.DataFrame``: a row an impact, units in ``.attrs["units"]``.

        The index has the axes of a ``Scene.grid``, or of a file's product; ``impact`` otherwise.
        """
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with units, its dimensions the axes of a ``Scene.grid``."""
        from contactlab.outcome.frames import to_xarray

        return to_xarray(self)

    def __len__(self) -> int:
        """Return the number of impacts of a batch."""
        if not self.scene.shape:
            raise TypeError("the result of a single impact has no length")
        return self.scene.shape[0]

    def __getitem__(self, index: int | slice) -> ImpactResult:
        """Return the result of one impact of a batch, or of those in a slice."""
        shape = self.scene.shape
        if not shape:
            raise TypeError("the result of a single impact cannot be indexed")
        if isinstance(index, bool) or not isinstance(index, int | np.integer | slice):
            raise TypeError(f"a result is indexed by a number or a slice, not {index!r}")
        if not np.size(np.arange(shape[0])[_slice(index)]):
            raise IndexError(f"{index}: there is no such impact, of {shape[0]}")

        history = self.history
        if history is not None:
            columns = {name: column[:, index] for name, column in history.columns().items()}
            fields = {name: field[:, index] for name, field in history.fields.items()}
            history = History(**columns, fields=fields)
        scene = self.scene.take(index)
        return attrs.evolve(
            self,
            scene=scene,
            plan=self.plan[index],
            motion=batch.taken(self.motion, shape, index),
            history=history,
            psi2_error_estimate=batch.taken(self.psi2_error_estimate, shape, index),
        )

    def __iter__(self) -> Iterator[ImpactResult]:
        """Iterate over the impacts of a batch."""
        return (self[index] for index in range(len(self)))


def _slice(index: int | slice) -> slice:
    """Return a slice of what ``index`` stands for: empty where there is no such item."""
    if isinstance(index, slice):
        return index
    return slice(index, index + 1 or None)


def _ratio(after: Real, before: Real) -> Real:
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.where(np.asarray(before) == 0.0, np.nan, np.divide(after, before))
    return float(ratio) if ratio.ndim == 0 else ratio


def _angle(tangential: Real, normal: Real) -> Real:
    angle = np.arctan2(tangential, normal)
    return float(angle) if np.ndim(angle) == 0 else angle
