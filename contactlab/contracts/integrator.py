"""The contract of integrators, and the tangential motion that they return."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, ClassVar, NamedTuple, Self, TypeAlias

import attrs
import numpy as np

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.sampled_motion import NormalMotions
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import consecutive, filled, merged, spread
from contactlab.numeric.checks import Mask, Real

#: Impacts of a sweep that an integrator receives at a time, by default.
CHUNK = 1000


class Sample(NamedTuple):
    """One instant of an impact, as passed to an observer.

    Attributes
    ----------
    time : float or array, shape (...,)
        Time in s, 0 at first touch.
    approach, normal_velocity : float or array
        Approach in m and its rate in m/s, positive in compression.
    contact : NormalContact
        The normal contact.
    slip_velocity : float or array
        v_x in m/s.
    tangential_force : float or array
        F in N, positive where it opposes a positive slip velocity.
    fields : callable
        Returns the law's arrays over the contact radius; observers call it only if they keep them.
    """

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]]


#: Called with each instant; it must not change its argument. If its attribute ``stepwise`` is
#: False, it never calls ``Sample.fields``, and a law may take all steps in one call before.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False)
class TangentialMotion:
    """The tangential motion that an integrator returns; entries have the batch shape.

    Attributes
    ----------
    slip_velocity_change : float or array
        Change of v_x in m/s. It is not added to v_x, which may be so large that the sum would
        lose digits of the change.
    friction_work : float or array
        Friction work in J, summed over the answers of the tangential law.
    status : Status or array of Status
        How the run of each impact ended.
    detail : str or array of str
        What failed, at which step and time; empty on success. An integrator may give one
        sentence for a batch, which goes to the impacts that failed.
    counters : mapping of str to int
        Operations counted: ``steps``, ``evaluations``, ``rejected``, ...
    normal : NormalMotion, NormalMotions or None
        The normal motion that came of the friction, if the friction changes it. Restitution,
        duration and maxima of the result are then those of this motion, and the energy books take
        the dissipation that the normal law declares.
    """

    slip_velocity_change: Real
    friction_work: Real
    status: Any = Status.SUCCESS
    detail: Any = ""
    counters: Mapping[str, int] = attrs.field(factory=dict)
    normal: NormalMotion | NormalMotions | None = None

    def __attrs_post_init__(self) -> None:
        if isinstance(self.status, Status):
            return  # one impact: np.ndim is slower than this test
        if isinstance(self.detail, str) and np.ndim(self.status):
            details = filled("", np.shape(self.status))
            if self.detail:
                details[self.status != Status.SUCCESS] = self.detail
            object.__setattr__(self, "detail", details)

    @classmethod
    @cache
    def numbers(cls) -> tuple[str, ...]:
        """Return the names of the entries that are numbers."""
        fields: Any = attrs.fields(cls)
        no_numbers = ("status", "detail", "counters", "normal")
        return tuple(field.name for field in fields if field.name not in no_numbers)

    @classmethod
    def joined(cls, motions: Sequence[Self], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from the motions of consecutive parts of the batch.

        Parameters
        ----------
        motions : sequence of TangentialMotion
            Motions of single impacts or of batches, in the order of the impacts.
        shape : tuple of int
            Shape of the whole batch.
        """
        if len(motions) == 1 and shape and np.shape(motions[0].status) == shape:
            return motions[0]
        places = consecutive(np.size(motion.status) for motion in motions)
        return cls.merged(list(zip(places, motions, strict=True)), shape)

    @classmethod
    def merged(cls, parts: Sequence[tuple[Any, Self]], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from pairs of a place and the motion of its impacts.

        An impact in several parts has the motion of the last of these parts.

        Parameters
        ----------
        parts : sequence of (array of bool or slice, TangentialMotion)
            Masks of shape ``shape``, or slices of the batch in C order, each with the motion of
            its impacts.
        shape : tuple of int
            Shape of the whole batch.
        """
        counters: Counter[str] = Counter()
        for _, motion in parts:
            counters.update(motion.counters)
        entries: dict[str, Any] = {}
        for name in (*cls.numbers(), "status", "detail"):
            columns = [(where, getattr(motion, name)) for where, motion in parts]
            entries[name] = merged(columns, shape, float if name in cls.numbers() else object)
        normals = [(where, motion.normal) for where, motion in parts]
        if any(normal is not None for _, normal in normals):
            entries["normal"] = NormalMotions(shape, tuple(normals))
        return cls(**entries, counters=dict(counters))

    @classmethod
    def nothing(
        cls, shape: tuple[int, ...], status: Status, detail: str | Sequence[str] = ""
    ) -> Self:
        """Return the motion of impacts that were not computed: all numbers are NaN.

        Parameters
        ----------
        shape : tuple of int
            Batch shape.
        status : Status
            Status of all impacts.
        detail : str or sequence of str
            One sentence for all impacts, or one for each.
        """
        entries: dict[str, Any] = dict.fromkeys(cls.numbers(), spread(math.nan, shape))
        return cls(
            **entries,
            status=filled(status, shape),
            detail=detail if isinstance(detail, str) else np.array(detail, dtype=object),
        )

    def failing(self, where: Mask, status: Status, detail: Any) -> Self:
        """Return this motion with another status for the successful impacts that ``where`` marks.

        Parameters
        ----------
        where : bool or array of bool
            The impacts that fail; those that had failed before keep status and detail.
        status : Status
            New status.
        detail : str or array of str
            One sentence for all these impacts, or one for each impact of the batch.
        """
        statuses: Any = np.array(self.status, dtype=object)
        failing = np.asarray(where) & (statuses == Status.SUCCESS)
        if not failing.any():
            return self
        if not statuses.shape:
            return attrs.evolve(self, status=status, detail=detail)
        statuses[failing] = status
        return attrs.evolve(
            self, status=statuses, detail=np.where(failing, detail, self.detail).astype(object)
        )


class Integrator(Law):
    """Base of integrators, which follow the tangential motion along a normal motion.

    Contract
    --------
    1. ``integrate(normal, tangential, scene, observer)`` returns a ``TangentialMotion``. The
       method is pure. It never raises for a numerical failure; it returns a status and the
       motion so far.
    2. Every loop is bounded.
    3. ``observer`` is None or is called at increasing times. An observer changes no result.
    4. ``order`` is the declared order of convergence in the step, for smooth laws; None if the
       integrator takes no steps.
    5. A batch gives the same results as its impacts one by one. If an impact fails, the
       integrator may give the batch up; the simulation then runs each impact alone. An
       integrator with ``own_statuses`` does not give the batch up: its statuses hold for each
       impact alone.
    6. ``tangential_contract`` and ``normal_contract`` are the classes of laws that the
       integrator accepts.
    7. ``psi2_error`` is a bound of the numerical error of psi2, from the declaration of the
       tangential law; NaN, the default, means not declared.
    8. ``resolution`` is the name of the option, steps or tolerance, that controls the error. If
       the integrator refines by itself, ``resolution_for`` returns the value used; errors are
       estimated by doubling that value, not the option.

    Parameters of methods
    ---------------------
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    tangential : TangentialLaw
        The law that is run.
    scene : Scene
        One impact or a batch.
    """

    kind: ClassVar[str] = "integrator"
    tangential_contract: ClassVar[Any]  # a type; mypy allows no abstract one
    normal_contract: ClassVar[Any] = NormalLaw
    order: ClassVar[int | None] = None
    #: False if the impacts of a batch have different instants; batches then have no history.
    common_instants: ClassVar[bool] = True
    own_statuses: ClassVar[bool] = False

    @property
    def accuracy(self) -> float | None:
        """Controlled error of psi2 over max(1, abs(psi1)); None if no error is controlled."""
        return None

    def chunk(self, tangential: TangentialLaw) -> int:
        """Return the number of impacts that a sweep should pass at a time.

        Large chunks hide the cost of a call; small chunks lose little by an interruption.
        """
        return CHUNK

    def remarks(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> tuple[str, ...]:
        """Return sentences for the plan of these impacts; empty by default."""
        return ()

    def resolution_for(self, normal: NormalMotion, tangential: TangentialLaw, scene: Scene) -> Real:
        """Return the resolution used for each impact: by default the value of the option.

        Returns
        -------
        float or array
            0 if the integrator has no resolution.
        """
        return float(getattr(self, self.resolution)) if self.resolution else 0.0

    def psi2_error(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> Real:
        """Return the declared bound of the numerical error of psi2, of the batch shape.

        NaN, the default, means not declared.
        """
        return math.nan

    @abstractmethod
    def integrate(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the tangential motion from first touch to separation.

        Parameters
        ----------
        observer : callable, optional
            Called with a ``Sample`` at increasing times (clause 3).
        """
