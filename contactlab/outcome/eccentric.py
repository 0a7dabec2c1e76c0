"""The result of an eccentric impact: velocities after it, status, energy books and history."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.eccentric import EccentricMotion, EccentricSample
from contactlab.contracts.status import Status
from contactlab.impact.eccentric import EccentricScene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import Real
from contactlab.outcome.answer import Answer
from contactlab.outcome.columns import components
from contactlab.outcome.energy import LARGEST_RESTITUTION, EnergyLedger
from contactlab.outcome.history import NO_HISTORY, NoHistory
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]


#: Columns of a history.
UNITS = {
    "time": "s", "approach": "m", "normal_velocity": "m/s", "normal_force": "N",
    "contact_radius": "m", "slip_velocity": "m/s", "tangential_force": "N",
}  # fmt: skip


@attrs.frozen(kw_only=True, eq=False, repr=False)
class EccentricHistory:
    """Arrays over the instants of an eccentric impact, shape (K, ...), and (K, ..., 2) of vectors.

    Vectors have components along t1 and t2; a force that opposes the slip is positive.
    """

    time: Array
    approach: Array
    normal_velocity: Array
    normal_force: Array
    contact_radius: Array
    slip_velocity: Array
    tangential_force: Array

    #: An eccentric impact keeps no fields over the contact.
    fields: ClassVar[dict[str, Array]] = {}

    def columns(self) -> dict[str, Array]:
        """Return the columns with one number for each instant, by name."""
        found: dict[str, Array] = {}
        for name in UNITS:
            found |= components(name, getattr(self, name), self.time.shape)
        return found

    @staticmethod
    def unit(name: str) -> str:
        """Return the unit of a column."""
        return next(unit for column, unit in UNITS.items() if name.startswith(column))

    def __repr__(self) -> str:
        """Return the number of instants and the last time."""
        last = np.max(self.time, initial=0.0)
        return f"EccentricHistory({len(self.time)} instants to {last:.4g} s)"


class EccentricRecorder:
    """An observer that keeps every sample."""

    def __init__(self) -> None:
        self._rows: list[tuple[Any, ...]] = []

    def __call__(self, sample: EccentricSample) -> None:
        """Keep the sample of one instant."""
        time, approach, rate, contact, slip, force = sample
        self._rows.append((time, approach, rate, contact.force, contact.radius, slip, force))

    def history(self) -> EccentricHistory:
        """Return the history of the samples."""
        names = [field.name for field in attrs.fields(EccentricHistory)]
        columns = zip(*self._rows, strict=True) if self._rows else [()] * len(names)
        return EccentricHistory(
            **{name: np.array(column) for name, column in zip(names, columns, strict=True)}
        )


@attrs.frozen(kw_only=True, eq=False, repr=False)
class EccentricResult(Answer):
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
    """

    scene: EccentricScene
    plan: Plan
    motion: EccentricMotion
    run_time: float = attrs.field(metadata={"unit": "s"})
    laws: Mapping[str, str]
    history: EccentricHistory | NoHistory = NO_HISTORY

    def __repr__(self) -> str:
        """Return V2, psi2, statuses and laws on one line."""
        statuses = Counter(each.name for each in np.ravel(np.array(self.status, dtype=object)))
        laws = ", ".join(name.partition(" ")[0] for name in self.laws.values())
        shape = self.scene.shape
        told = f"{np.size(self.normal_velocity)} impacts"
        if not shape:
            psi2 = np.array2string(np.asarray(self.psi2), precision=6)
            told = f"normal_velocity={self.normal_velocity:.6g}, psi2={psi2}"
        outcome = ", ".join(f"{n} {name}" if shape else name for name, n in statuses.items())
        return f"EccentricResult({told}; {outcome}; {laws})"

    def _ends(self) -> tuple[Any, Any]:
        return self.motion.status, self.motion.detail

    @property
    def status(self) -> Any:
        """Status of the impact, or an array of statuses of the scene's shape."""
        return self.motion.status

    @property
    def cautions(self) -> list[str]:
        """Cautions of the plan."""
        return [*map(str, self.plan.cautions)]

    @property
    def counters(self) -> Mapping[str, int]:
        """Counts of steps, by name."""
        return self.motion.counters

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
        return np.asarray(self.scene.slip_velocity + self.motion.velocity_change[..., 1:])

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

    def to_dataframe(self) -> Any:
        """Return a ``pandas.DataFrame``, one row for each impact, as ``ImpactResult`` does."""
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with units."""
        from contactlab.outcome.frames import to_xarray

        return to_xarray(self)

    def plot(self, *, axes: Axes | None = None, x: tuple[str, Any] | None = None) -> Axes:
        """Draw the path of slip of one impact, or V2 and psi2 of a batch over psi1.

        In the plane slip is drawn over the velocity of approach, in space slip along t2 over that
        along t1. One impact needs ``run(scene, history=True)``. ``x`` is a label and a value for
        each impact of a batch, in place of psi1.
        """
        from contactlab.figures.eccentric import draw_eccentric  # matplotlib only when drawing

        return draw_eccentric(axes, self, x)

    def __len__(self) -> int:
        """Return the number of impacts of a batch."""
        if not self.scene.shape:
            raise TypeError("the result of a single impact has no length")
        return self.scene.shape[0]

    def __getitem__(self, index: int | slice) -> EccentricResult:
        """Return the result of one impact of a batch, or of a slice."""
        if not self.scene.shape:
            raise TypeError("the result of a single impact cannot be indexed")
        shape = self.scene.shape
        entries = {
            field.name: batch.taken(getattr(self.motion, field.name), shape, index)
            for field in attrs.fields(EccentricMotion)
            if field.name != "velocity_change"
        }
        change = self.motion.velocity_change[index]
        motion = EccentricMotion(velocity_change=change, **entries)
        return attrs.evolve(
            self,
            scene=self.scene.take(index),
            plan=self.plan[index],
            motion=motion,
            history=NO_HISTORY,
        )

    def __iter__(self) -> Iterator[EccentricResult]:
        """Iterate over the impacts of a batch."""
        return (self[index] for index in range(len(self)))


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
    nothing = EccentricMotion.nothing(scene.shape, Status.UNBALANCED, sentence)
    if not scene.shape:
        return attrs.evolve(nothing, counters=motion.counters)
    entries = {
        field.name: np.where(
            wrong[..., None] if field.name == "velocity_change" else wrong,
            getattr(nothing, field.name),
            getattr(motion, field.name),
        )
        for field in attrs.fields(EccentricMotion)
        if field.name != "counters"
    }
    return EccentricMotion(**entries, counters=motion.counters)
