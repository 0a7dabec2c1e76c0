"""The outcome of a gathering: velocities of all bodies, impulses and work of each contact."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.status import Details, Status, Statuses, Word, succeeded
from contactlab.contracts.tangential_motion import Sample
from contactlab.impact.gathering import Body, Gathering
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import shape_as
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import Array, Json, Real
from contactlab.outcome.answer import Answer, tell_statuses
from contactlab.outcome.columns import components, json_value
from contactlab.outcome.energy import EnergyLedger, ledger
from contactlab.outcome.history import NO_HISTORY, History, NoHistory, Recorder
from contactlab.outcome.motion import Motion, without_failures
from contactlab.outcome.sheet import (
    MOST_TOLD,
    Sheet,
    along_axes,
    batch_axes,
    moving,
    names_of,
)
from contactlab.registry.composition import versions
from contactlab.runs.simulation import Simulation
from contactlab.solve.coupled import Coupled
from contactlab.solve.gathering import bodies_after, history_of, plan_of_gathering, way_of
from contactlab.solve.gathering_plan import GatheringPlan

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame
    from xarray import Dataset

    from contactlab.outcome.style import Width

#: Numbers of a result for each contact, by name and unit.
OF_CONTACTS = (
    ("normal_velocity", "m/s"), ("first_touch", "s"), ("last_touch", "s"), ("touches", "1"),
    ("duration", "s"), ("maximum_force", "N"), ("maximum_radius", "m"), ("friction_work", "J"),
    ("shear_loss", "J"), ("normal_loss", "J"),
)  # fmt: skip
#: Vectors for each body, and for each contact.
VECTORS_OF_BODIES = (("velocity", "m/s"), ("spin", "rad/s"))
VECTORS_OF_CONTACTS = (("impulse", "N s"), ("slip_velocity", "m/s"))


@tell_attributes
@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)
class GatheringResult(Answer):
    """All bodies after a gathering of N bodies at C contacts, in the batch shape ``(...)``.

    ``result["ball"]`` is the body of that name or place as it moves afterwards.

    Attributes
    ----------
    gathering : Gathering
    simulation : Simulation or None
        The laws; None if the restitutions of the contacts take the place of laws.
    laws : mapping of str to str
        Names of the three laws with their versions.
    run_time : float
        Wall-clock time in s; of a batch, for all its gatherings.
    history : History or NoHistory
        Only on request; its columns have an axis of contacts.
    """

    gathering: Gathering
    simulation: Simulation | None
    laws: Mapping[str, str]
    run_time: float = attrs.field(metadata={"unit": "s"})
    history: History | NoHistory = attrs.field(default=NO_HISTORY, repr=False)
    _way: Coupled = attrs.field(repr=False)
    _motion: Motion = attrs.field(repr=False)

    @property
    def _scene(self) -> Scene:
        return self._way.scene

    @cached_property
    def plan(self) -> GatheringPlan:
        """The plan: statements and cautions; its ``per_micron`` is computed when it is read."""
        laws = None if self.simulation is None else self.simulation.laws
        told = bool(self.history)
        return plan_of_gathering(self.gathering, laws, self._way, self._motion, history=told)

    def _shape(self, value: Real, *trailing: int) -> Array:
        """Return an entry of each gathering in the batch shape."""
        return np.asarray(value).reshape(*self.gathering.shape, *trailing)

    def _of_contacts(self, value: Real, *trailing: int) -> Array:
        """Return an entry of each contact in the batch shape, NaN if the gathering failed."""
        lost = np.where(self._motion.status == Status.SUCCESS, 0.0, np.nan)
        whole = np.broadcast_to(value, (*self._scene.shape, *trailing))
        lost = lost.reshape(*lost.shape, *(1 for _ in trailing))
        return np.asarray(self._shape(whole + lost, self._scene.shape[-1], *trailing))

    def _read_contacts(self, name: str, *trailing: int) -> Array:
        """Return an entry of the march's ``Contacts``."""
        told = self._motion.contacts
        value = np.nan if told is None else getattr(told, name)
        return self._of_contacts(value, *trailing)

    @cached_property
    def _after(self) -> tuple[Array, Array]:
        """Velocities and spins of the bodies, shape (..., N, 3)."""
        return bodies_after(self.gathering, self._motion)

    @property
    def velocity(self) -> Array:
        """Velocities of the centres of mass, shape (..., N, 3), in m/s."""
        return self._after[0]

    @property
    def spin(self) -> Array:
        """Spins, shape (..., N, 3), in rad/s."""
        return self._after[1]

    def __getitem__(self, body: str | int) -> Body:
        """Return a body by its name or place, with its velocity and spin after the impact."""
        names = self.gathering.names or range(len(self.gathering.bodies))
        if isinstance(body, bool) or body not in names:
            known = ", ".join(map(repr, names))
            raise refuse("body", body, "is the name of no body", f"there are {known}")
        k = list(names).index(body)
        after: dict[str, Any] = {"velocity": self.velocity[..., k, :], "spin": self.spin[..., k, :]}
        return attrs.evolve(self.gathering.bodies[k], **after)

    @cached_property
    def frame(self) -> Array:
        """n, t1 and t2 of each contact as rows, shape (..., C, 3, 3)."""
        axes = self.gathering.assembly.axes
        shaped: Array = self._shape(axes, axes.shape[1], 3, 3)
        return shaped

    @property
    def impulse(self) -> Array:
        """Impulse on the first body of each contact, shape (..., C, 3), in N s."""
        impulse: Array = -np.einsum(
            "...ia,...i->...a", self.frame, self._read_contacts("impulse", 3)
        )
        return impulse

    @property
    def psi1(self) -> Array:
        """Slip at the start along t1 and t2, shape (..., C, 2), in the unit mu v1/kappa.

        v1 is the largest rate of approach of the gathering at the start.
        """
        return self._of_contacts(self._scene.psi1, 2)

    @property
    def psi2(self) -> Array:
        """Slip at the end along t1 and t2, shape (..., C, 2), in the unit of ``psi1``."""
        return self._of_contacts(self._scene.psi(self._slip), 2)

    @property
    def _slip(self) -> Array:
        """Slip velocity at the end along t1 and t2, in m/s."""
        return np.asarray(self._scene.slip_velocity + self._motion.slip_velocity_change)

    @property
    def slip_velocity(self) -> Array:
        """Velocity of the first surface over the second at the end, in the tangent plane.

        Shape (..., C, 3), in m/s.
        """
        slip = self._of_contacts(self._slip, 2)
        return np.asarray(np.einsum("...ia,...i->...a", self.frame[..., 1:, :], slip))

    @property
    def normal_velocity(self) -> Array:
        """Rate of approach at the end, shape (..., C), in m/s; negative: the surfaces part."""
        return self._of_contacts(self._motion.normal_velocity)

    @property
    def first_touch(self) -> Array:
        """Time of the first touch, shape (..., C), in s; NaN of a contact that never closed."""
        return self._read_contacts("first")

    @property
    def last_touch(self) -> Array:
        """Time at which a contact was last closed, shape (..., C), in s."""
        return self._read_contacts("last")

    @property
    def touches(self) -> Array:
        """How often the surfaces met, shape (..., C); 0 of a contact that never closed."""
        return self._read_contacts("touches")

    @property
    def duration(self) -> Array:
        """Time for which the contact was closed, in whole steps, shape (..., C), in s."""
        return self._of_contacts(self._motion.duration)

    @property
    def maximum_force(self) -> Array:
        """Greatest normal force, shape (..., C), in N."""
        return self._of_contacts(self._motion.maximum_force)

    @property
    def maximum_radius(self) -> Array:
        """Greatest contact radius, shape (..., C), in m."""
        return self._of_contacts(self._motion.maximum_radius)

    @property
    def friction_work(self) -> Array:
        """Friction work of each contact, shape (..., C), in J."""
        return self._of_contacts(self._motion.friction_work)

    @property
    def shear_loss(self) -> Array:
        """Loss in shear of each contact, shape (..., C), in J."""
        return self._of_contacts(self._motion.shear_loss)

    @property
    def normal_loss(self) -> Array:
        """Energy that the normal law of each contact took, shape (..., C), in J."""
        return self._read_contacts("dissipation")

    @property
    def energy(self) -> EnergyLedger:
        """The energy books of each gathering, in J, of the batch shape.

        The start is the energy of the relative motion at the contacts, the end what their forces
        leave; constant forces do work beside it.
        """
        books, shape = ledger(self._scene, self._motion), self.gathering.shape
        entries = {
            field.name: shape_as(np.asarray(getattr(books, field.name)), shape)
            for field in attrs.fields(EnergyLedger)
        }
        return EnergyLedger(**entries)

    @property
    def status(self) -> Statuses:
        """A ``Status``, or an array of the batch shape."""
        status: Statuses = self._of_gatherings(self._motion.status)
        return status

    def _of_gatherings(self, words: Word | NDArray[np.object_]) -> Word | NDArray[np.object_]:
        """Return a status or sentence of each gathering, which its contacts share."""
        whole = np.broadcast_to(np.asarray(words, dtype=object), self._scene.shape)
        each: Word | NDArray[np.object_] = whole[:, 0].reshape(self.gathering.shape)[()]
        return each

    def _statuses(self) -> tuple[Statuses, Details]:
        return self.status, self._of_gatherings(self._motion.detail)

    @property
    def cautions(self) -> list[str]:
        """Cautions of the plan."""
        return [*map(str, self.plan.cautions)]

    def __repr__(self) -> str:
        """Return how many bodies and contacts there are, velocities of one, and the statuses."""
        bodies, contacts = len(self.gathering.bodies), len(self.gathering.touches)
        told = f"{bodies} bodies, {contacts} contacts"
        if self.gathering.shape:
            told = f"{np.prod(self.gathering.shape)} gatherings of {told}"
        return f"GatheringResult({told}; {tell_statuses(self.status)})"

    def _first_lines(self) -> list[str]:
        """Return ``repr``, and how the bodies move, of a batch in its first gathering."""
        bodies = len(self.gathering.bodies)
        names = [*self.gathering.names] or [f"bodies[{k}]" for k in range(bodies)]
        first = (0,) * len(self.gathering.shape)
        where = f"gathering {', '.join(map(str, first))}, " if first else ""
        told = [
            moving(f"{where}{name}", self.velocity[(*first, k)], self.spin[(*first, k)])
            for k, name in enumerate(names[:MOST_TOLD])
        ]
        if len(told) < math.prod(self.velocity.shape[:-1]):
            told.append("  ... and more: to_dataframe()")
        return [repr(self), *told]

    def to_dict(self) -> dict[str, Json]:
        """Return the vectors of bodies and the numbers of contacts as plain lists."""
        names = (
            *VECTORS_OF_BODIES,
            *VECTORS_OF_CONTACTS,
            ("psi1", "1"),
            ("psi2", "1"),
            *OF_CONTACTS,
        )
        told: dict[str, Any] = {name: json_value(getattr(self, name)) for name, _ in names}
        if self.gathering.names:
            told["bodies"] = [*self.gathering.names]
        status, detail = map(json_value, self._statuses())
        told |= {"status": status, "detail": detail, "laws": dict(self.laws)}
        return told | {"energy": self.energy.to_dict(), "plan": self.plan.to_dict()}

    def _sheet(self, rows: str = "bodies") -> Sheet:
        """Return one row for each body, or for each contact, of each gathering."""
        gathering = self.gathering
        if rows not in ("bodies", "contacts"):
            raise refuse("rows", rows, "must be 'bodies' or 'contacts'")
        of_bodies = rows == "bodies"
        names: list[str] = [f"touches[{k}]" for k in range(len(gathering.touches))]
        if of_bodies:
            names = [*gathering.names] or [str(k) for k in range(len(gathering.bodies))]
        shape = (*gathering.shape, len(names))
        found: dict[str, Any] = {}
        units = {"status": ""}
        for name, unit in VECTORS_OF_BODIES if of_bodies else VECTORS_OF_CONTACTS:
            found |= along_axes(name, getattr(self, name))
            units |= dict.fromkeys(found.keys() - units.keys(), unit)
        if not of_bodies:
            for name in ("psi1", "psi2"):
                found |= dict(components(name, getattr(self, name), shape))
            units |= dict.fromkeys(found.keys() - units.keys(), "1")
            found |= {name: getattr(self, name) for name, _ in OF_CONTACTS}
            units |= dict(OF_CONTACTS)
        status = names_of(self.status, gathering.shape)
        found["status"] = np.broadcast_to(status[..., None], shape)
        last = {"body" if of_bodies else "contact": np.array(names)}
        axes = batch_axes(gathering.shape, "gathering") | last
        return Sheet(found, units, axes, shape, self.laws)

    def to_dataframe(self, rows: Literal["bodies", "contacts"] = "bodies") -> DataFrame:
        """Return a ``pandas.DataFrame``, one row for each body or each contact.

        Parameters
        ----------
        rows : {"bodies", "contacts"}

        Raises
        ------
        ValueError
            For other rows.
        """
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self._sheet(rows))

    def to_xarray(self) -> Dataset:
        """Return an ``xarray.Dataset`` of bodies and contacts, each a dimension."""
        from contactlab.outcome.frames import to_xarray

        bodies = to_xarray(self._sheet("bodies"))
        return to_xarray(self._sheet("contacts")).drop_vars("status").merge(bodies)

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column of bodies over another, by default the forces of each contact."""
        if x is not None or y is not None:
            return super()._draw(axes, x, y, width)
        if not self.history:
            remedy = "ask for one: collide(gathering, history=True)"
            raise refuse("result", self, "has no history to draw", remedy)
        return self.history.plot(axes=axes, width=width)


def collide_all(
    gathering: Gathering, simulation: Simulation | None, *, history: bool = False
) -> GatheringResult:
    """Return the outcome of a gathering, under its restitutions or the laws of a simulation."""
    history = history_of(history)
    started = time.perf_counter()
    way = way_of(gathering, None if simulation is None else simulation.laws)
    scene = way.scene
    recorder = _ContactsRecorder((*gathering.shape, scene.shape[-1])) if history else None
    with np.errstate(under="ignore"):
        _, motion = way.outcome(history, recorder)
    contacts = motion.contacts
    if not succeeded(motion.status):
        motion = attrs.evolve(without_failures(motion), contacts=contacts)
    return GatheringResult(
        gathering=gathering,
        simulation=simulation,
        laws=versions(*way.laws),
        run_time=time.perf_counter() - started,
        history=NO_HISTORY if recorder is None else recorder.history(),
        way=way,
        motion=motion,
    )


class _ContactsRecorder(Recorder):
    """A recorder of contacts, whose samples have an axis of gatherings before that of contacts."""

    def __call__(self, sample: Sample) -> None:
        """Keep the sample of one instant, over one axis."""
        time, approach, rate, contact, slip, force, *_ = sample
        time, approach, rate = (_flat(each) for each in (time, approach, rate))
        flat = NormalContact(*(_flat(each) for each in contact))
        slip, force = (np.asarray(each).reshape(-1, 2) for each in (slip, force))
        super().__call__(Sample(time, approach, rate, flat, slip, force))

    def history(self) -> History:
        """Return the history, whose last axis are the contacts."""
        return attrs.evolve(super().history(), last_axis="contact")


def _flat(value: Real) -> Real:
    """Return numbers of gatherings and contacts over one axis."""
    return value if np.ndim(value) == 0 else np.reshape(value, -1)
