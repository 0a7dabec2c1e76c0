"""The result of an impact: velocities after it, status, energy books and cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, Self, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Details, Status, Statuses
from contactlab.impact import kinetics
from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import equal, of_each, plain, take
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import AnyArray, Array, Each, Json, Real
from contactlab.outcome.answer import Answer, tell_statuses
from contactlab.outcome.energy import EnergyLedger, ledger
from contactlab.outcome.history import NO_HISTORY, History, NoHistory
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.outcome.sheet import Sheet
    from contactlab.outcome.style import Width

    class StatusOf(Protocol):
        """The status of a result, by the kind of its numbers."""

        @overload
        def __get__(self, result: ImpactResult[float], owner: object = ..., /) -> Status: ...
        @overload
        def __get__(
            self, result: ImpactResult[Array], owner: object = ..., /
        ) -> NDArray[np.object_]: ...
        @overload
        def __get__(self, result: ImpactResult[Real], owner: object = ..., /) -> Statuses: ...


@tell_attributes
@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)  # frozen slots are slow to fill
class ImpactResult(Answer, Generic[Each]):
    """Result of one impact, or of a batch: every quantity has the scene's shape.

    A batch can be indexed, sliced and iterated; each item is the result of one impact. Items keep
    the run time and the counters of the whole batch.

    To type checkers the numbers of ``ImpactResult[float]``, of a ``Scene[float]``, are floats, and
    those of a batch, an ``ImpactResult[Array]``, are arrays. An item of a batch, and the result of
    an ``Encounter``'s scene, they take for either: of bodies in space psi is a vector. A program
    that knows may say so: ``result: ImpactResult[float] = simulation.run(scene)``.
    ``status`` is a ``Status``, or an array of them.

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
        Estimate of the numerical error of psi2, only on request; in space of the length of the
        error. The plan's cautions state model errors.
    restitution_error_estimate : float, array or None
        Estimate of the numerical error of ``normal_restitution``, with that of psi2.
    """

    scene: Scene
    plan: Plan
    motion: Motion[Each] = attrs.field(repr=False)
    run_time: float = attrs.field(metadata={"unit": "s"})
    laws: Mapping[str, str]
    history: History | NoHistory = attrs.field(default=NO_HISTORY, repr=False)
    psi2_error_estimate: Each | Any = attrs.field(default=None, repr=False)
    restitution_error_estimate: Each | Any = attrs.field(default=None, repr=False)

    def __repr__(self) -> str:
        """Return the answer, statuses and laws on one line."""
        laws = ", ".join(
            "+".join(name.partition(" ")[0] for name in names.split(" and "))
            for names in self.laws.values()
        )
        return f"ImpactResult({self._tell()}; {tell_statuses(self.status)}; {laws})"

    def _tell(self) -> str:
        """Return the words of ``repr`` on the answer."""
        scene, psi2 = self.scene, np.asarray(self.psi2)
        if scene.shape:
            finite, what = psi2, "psi2"
            if psi2.ndim > len(scene.shape):
                finite, what = np.asarray(kinetics.size_of(scene, psi2)), "abs(psi2)"
            finite = finite[np.isfinite(finite)]
            span = f" from {finite.min():.6g} to {finite.max():.6g}" if finite.size else " unknown"
            return f"{np.size(self.motion.status)} impacts, {what}{span}"
        told = kinetics.groups(scene)
        if told.pop("eta", None) is not None:
            del told["rho"]
            told["normal_restitution"] = self.normal_restitution
        words = (
            f"{name}={_tell_numbers(value)}" for name, value in (told | {"psi2": psi2}).items()
        )
        return ", ".join(words)

    def __eq__(self, other: object) -> bool:
        """Return whether all but the run times is equal, NaN where NaN is."""
        if not isinstance(other, ImpactResult):
            return NotImplemented
        mine, its = (
            (one.scene, one.plan.columns, one.plan.to_dict(), one.motion, one.laws, one.history,
             one.psi2_error_estimate, one.restitution_error_estimate)
            for one in (self, other)
        )  # fmt: skip
        return equal(mine, its)

    __hash__ = None  # type: ignore[assignment]

    @property
    def psi1(self) -> Each:
        """Local angle of incidence of the paper's eq. (29), without unit."""
        return of_each(self.scene.psi1, self.scene.shape)  # type: ignore[return-value]

    @property
    def psi_change(self) -> Each:
        """psi2 - psi1, without the rounding error of a huge psi1."""
        return self.scene.psi(self.motion.slip_velocity_change)  # type: ignore[return-value]

    @property
    def psi2(self) -> Each:
        """Non-dimensional local angle of reflexion; a vector (..., 2) in space."""
        return self.scene.psi(self.rebound_slip_velocity)  # type: ignore[return-value]

    @property
    def compressions(self) -> Each:
        """How often the approach grew: 1, or more where friction pressed the bodies together."""
        return self.motion.compressions  # type: ignore[return-value]

    @property
    def impulse(self) -> Array:
        """Impulse on the target along n, t1 and t2, shape (..., 3), in N s."""
        motion = self.motion
        return kinetics.impulse(self.scene, motion.normal_velocity, motion.slip_velocity_change)

    @property
    def couple(self) -> Each:
        """Angular impulse on the target about the normal, of the batch shape, in N m s."""
        inertia = kinetics.normal_inertia(self.scene)
        return -inertia * self.motion.normal_spin_change  # type: ignore[return-value]

    @property
    def normal_velocity(self) -> Each:
        """Rate of approach of the contact points after the impact, in m/s; negative: they part."""
        return self.motion.normal_velocity

    @property
    def rebound_slip_velocity(self) -> Each:
        """Slip velocity at the contact after the impact in m/s; along t1 and t2 in space."""
        return self.scene.slip_velocity + self.motion.slip_velocity_change  # type: ignore[return-value]

    @property
    def rebound_normal_velocity(self) -> Each | Any:
        """Velocity of the sphere along the normal, in m/s; negative: away from the target.

        None for bodies that are no spheres, unless the scene has a tangent ``along``: see
        ``velocity_in_space`` and ``normal_velocity``.
        """
        speed, pair = self.scene.normal_speed, self.scene.pair
        if self.scene.frame is not None:
            return None if self.scene.along is None else _see(self.scene, self.velocity_in_space)[0]
        share = 1.0 if self.scene.sphere is None else pair.normal_mass / self.scene.sphere.mass
        return speed - share * (speed - self.motion.normal_velocity)

    @property
    def rebound_tangential_velocity(self) -> Each | Any:
        """Tangential velocity of the sphere's centre in m/s; None for a non-dimensional scene."""
        sphere = self.scene.sphere
        if sphere is None:
            return None if self.scene.along is None else _see(self.scene, self.velocity_in_space)[1]
        share = self.scene.pair.tangential_mass / sphere.mass
        return self.scene.tangential_velocity + share * self.motion.slip_velocity_change

    @property
    def rebound_speed(self) -> Each | Any:
        """Speed of the sphere's centre in m/s; None for a non-dimensional scene."""
        tangential = self.rebound_tangential_velocity
        if tangential is None:
            return None
        return plain(np.hypot(self.rebound_normal_velocity, tangential))

    @property
    def velocity_in_space(self) -> Array | Any:
        """Velocity in space of the first body of an encounter, shape (..., 3), in m/s; else None.

        Bodies that are no spheres have it, unless they are of several kinds in a batch, or their
        scene was given another speed; of spheres see ``Collision.velocity``.
        """
        return self._in_space("velocity")

    @property
    def target_velocity_in_space(self) -> Array | Any:
        """Velocity in space of the target of an encounter, as ``velocity_in_space``."""
        return self._in_space("target_velocity")

    def _in_space(self, name: str) -> Array | None:
        """Return a vector after the impact of bodies that are no spheres; None without them."""
        encounter, axes = self.scene.encounter, self.scene.frame
        if axes is None or encounter is None:
            return None
        before = encounter.meeting()
        slip = kinetics.size_of(self.scene, np.asarray(self.scene.slip_velocity))
        speeds = self.scene.normal_speed, slip
        if not all(map(np.allclose, (before.approach, before.slip), speeds)):
            return None
        from contactlab.impact.body_contact import push_bodies  # spheres need none of this

        return push_bodies(encounter, axes, self.impulse, self.couple)[name]

    @property
    def rebound_spin(self) -> Each | Any:
        """Spin of the sphere in rad/s; of other bodies a vector (..., 3), None without bodies."""
        sphere = self.scene.sphere
        if sphere is None:
            return self._in_space("spin")
        inertia = sphere.mass * sphere.gyration_ratio**2 * sphere.radius
        share = self.scene.pair.tangential_mass / inertia
        return self.scene.spin + share * self.motion.slip_velocity_change

    @property
    def rebound_normal_spin(self) -> Each:
        """Spin about the normal of the first body over the target after the impact, in rad/s.

        By the right-hand rule about the normal into the target. A law that does not answer spin
        about the normal leaves the spin before, and the plan cautions.
        """
        axes = self.scene.frame
        if axes is None:
            return self.scene.normal_spin + self.motion.normal_spin_change  # type: ignore[return-value]
        own, target = self._in_space("spin"), self._in_space("target_spin")
        assert own is not None
        assert target is not None
        relative = own - target
        spin = np.einsum("...i,...i->...", relative, axes[..., 0, :])
        return plain(spin)  # type: ignore[return-value]

    @property
    def w2(self) -> Each:
        """W = kappa omega_n a/(mu v1) of the spin about the normal after the impact, theory §17."""
        return kinetics.rim(self.scene, self.rebound_normal_spin)  # type: ignore[return-value]

    @property
    def target_rebound_normal_velocity(self) -> Each | Any:
        """Velocity of the target along the normal, in m/s; positive: away from the sphere.

        Velocities and spin of the target are 0 for a half-space, None without bodies.
        """
        motion, pair = self.motion, self.scene.pair
        return self._of_target(
            pair.normal_mass * (self.scene.normal_speed - motion.normal_velocity)
        )

    @property
    def target_rebound_tangential_velocity(self) -> Each | Any:
        """Tangential velocity of the target's centre, in m/s, positive as that of the sphere."""
        return self._of_target(-self.scene.pair.tangential_mass * self.motion.slip_velocity_change)

    @property
    def target_rebound_spin(self) -> Each | Any:
        """Spin of the target in rad/s, positive where it adds to the slip, as the sphere's."""
        if self.scene.sphere is None:
            return self._in_space("target_spin")
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
        return None if target is None else 0.0 * momentum + 0.0  # no -0

    @property
    def normal_restitution(self) -> Each:
        """Coefficient of normal restitution, e = -v_z after / v_z before."""
        return -self.motion.normal_velocity / self.scene.normal_speed  # type: ignore[return-value]

    @property
    def tangential_restitution(self) -> Each | Any:
        """e_t = tangential velocity of the centre after over before; NaN if zero before."""
        after, before = self.rebound_tangential_velocity, self.scene.tangential_velocity
        if self.scene.along is not None:
            before = _see(self.scene, self.scene.encounter.velocity)[1]
        return None if after is None else _ratio(after, before)

    @property
    def beta0(self) -> Each:
        """-psi2/psi1, minus the slip velocity after over before; NaN if zero before."""
        scene = self.scene
        slips = self.rebound_slip_velocity, scene.slip_velocity
        after, before = (kinetics.along_slip(scene, slip) for slip in slips)
        return _ratio(0.0 - after, before)  # no -0

    @property
    def incidence_angle(self) -> Each:
        """Angle of the centre's path from the normal before the impact, in rad."""
        scene = self.scene
        if scene.along is not None:
            normal, along = _see(scene, scene.encounter.velocity)
            return _angle(along, normal)
        speed = kinetics.along_slip(scene, scene.tangential_velocity)
        return of_each(_angle(speed, scene.normal_speed), scene.shape)  # type: ignore[return-value]

    @property
    def rebound_angle(self) -> Each | Any:
        """Angle of the centre's path from the normal after the impact, in rad."""
        after = self.rebound_tangential_velocity
        return None if after is None else _angle(after, -self.rebound_normal_velocity)

    @property
    def local_rebound_angle(self) -> Each:
        """Angle of reflexion of the contact point, in rad: (39) with psi2 in place of psi1."""
        after = kinetics.along_slip(self.scene, self.rebound_slip_velocity)
        return _angle(after, -self.motion.normal_velocity)

    @property
    def energy(self) -> EnergyLedger[Each]:
        """Energy books in J: energy before and after, losses, imbalance."""
        unchecked = self.plan.unchecked
        checked = not unchecked if isinstance(unchecked, bool) else ~unchecked
        return ledger(self.scene, self.motion, checked)

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw ``y`` over ``x`` for a batch, by default psi2; forces over time for one impact."""
        from contactlab.outcome.result_figure import draw_result  # matplotlib only when drawing

        return draw_result(axes, self, x, y, width=width)

    def _first_lines(self) -> list[str]:
        from contactlab.outcome.numerical_error import error_words  # for words alone

        return [repr(self), f"numerical error of psi2: {error_words(self)}"]

    def _statuses(self) -> tuple[Statuses, Details]:
        return self.motion.status, self.motion.detail

    if TYPE_CHECKING:
        status: ClassVar[StatusOf]
    else:

        @property
        def status(self):
            """Status of the impact, or an array of statuses of the scene's shape."""
            return self.motion.status

    @property
    def counters(self) -> Mapping[str, int]:
        """Counts of steps, evaluations, solves and rejected steps, by name."""
        counters: Mapping[str, int] = self.motion.counters
        return counters

    @property
    def cautions(self) -> list[str]:
        """Cautions that ``str`` shows: about the numerical error, then those of the plan."""
        from contactlab.outcome.numerical_error import error_cautions  # for words alone

        return [*error_cautions(self), *map(str, self.plan.cautions)]

    def _sheet(self) -> Sheet:
        """Return the columns that the scene defines, over the axes of a grid, or counted."""
        from contactlab.outcome.columns import columns, unit_in
        from contactlab.outcome.sheet import Sheet, batch_axes, names_of

        scene, units = self.scene, {}
        found: dict[str, AnyArray] = {}
        axes = dict(scene.axes) or batch_axes(scene.shape)
        for name, unit, values in columns(self):
            if values is None:  # a scene without bodies
                continue
            units[name] = unit_in(unit, scene) if unit else ""
            if name not in axes:
                own = name == "status"
                found[name] = names_of(self.status, scene.shape) if own else np.asarray(values)
        shape = tuple(np.size(axis) for axis in scene.axes.values()) or scene.shape
        found = {
            name: np.broadcast_to(values, scene.shape).reshape(shape)
            for name, values in found.items()
        }
        return Sheet(found, units, axes, shape, dict(self.laws))

    def to_dict(self) -> dict[str, Json]:
        """Return the result without its history as plain numbers, lists and text."""
        from contactlab.outcome.columns import columns, json_value

        numbers = {name: json_value(values) for name, _, values in columns(self)}
        return numbers | {
            "detail": json_value(self.motion.detail),
            "psi2_error_estimate": json_value(self.psi2_error_estimate),
            "restitution_error_estimate": json_value(self.restitution_error_estimate),
            "run_time_s": self.run_time,
            "energy": self.energy.to_dict(),
            "counters": dict(self.counters),
            "laws": dict(self.laws),
            "plan": self.plan.to_dict(),
        }

    def __len__(self) -> int:
        """Return the number of impacts of a batch."""
        if not self.scene.shape:
            raise TypeError("the result of a single impact has no length")
        return int(self.scene.shape[0])

    @overload
    def __getitem__(self, index: int) -> ImpactResult: ...
    @overload
    def __getitem__(self, index: slice) -> Self: ...
    def __getitem__(self, index: int | slice) -> ImpactResult:
        """Return the result of one impact of a batch, or of a slice."""
        shape = self.scene.shape
        if not shape:
            raise TypeError("the result of a single impact cannot be indexed")
        if isinstance(index, bool) or not isinstance(index, int | np.integer | slice):
            raise TypeError(f"a result is indexed by a number or a slice, not {index!r}")
        places = index if isinstance(index, slice) else slice(index, index + 1 or None)
        if not np.size(np.arange(shape[0])[places]):
            raise IndexError(f"{index}: is out of range for a batch of {shape[0]} impacts")
        history = self.history
        return attrs.evolve(
            self,
            scene=self.scene.take(index),
            plan=self.plan[index],
            motion=take(self.motion, shape, index),
            history=history.part(index) if history else history,
            psi2_error_estimate=take(self.psi2_error_estimate, shape, index),
            restitution_error_estimate=take(self.restitution_error_estimate, shape, index),
        )

    def __iter__(self) -> Iterator[ImpactResult]:
        """Iterate over the impacts of a batch."""
        return (self[index] for index in range(len(self)))


def _tell_numbers(value: Real) -> str:
    """Return a number, or the numbers of a vector or tensor."""
    return (
        f"{value:.6g}" if np.ndim(value) == 0 else np.array2string(np.asarray(value), precision=6)
    )


def _see(scene: Scene, velocity: Array) -> tuple[Any, Any]:
    """Return a velocity in space as ``body_contact.seen`` does, of an encounter alone."""
    from contactlab.impact.body_contact import resolve_velocity  # spheres need none of this

    return resolve_velocity(scene, velocity)


def _ratio(after: Real, before: Real) -> Any:
    """Return ``after / before``, NaN where ``before`` is zero."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.where(np.asarray(before) == 0.0, np.nan, np.divide(after, before))
    return plain(ratio)


def _angle(tangential: Real, normal: Real) -> Any:
    """Return the angle from the normal in rad, a float for a single impact."""
    return plain(np.arctan2(tangential, normal))
