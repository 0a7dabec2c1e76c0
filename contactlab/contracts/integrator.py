"""The contract of an integrator: the tangential motion along a normal motion."""

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
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import filled, merged, spread
from contactlab.numeric.checks import Mask, Real

#: Impacts of a sweep handed over together, unless the integrator says otherwise.
CHUNK = 1000


class Sample(NamedTuple):
    """One instant of an impact, as handed to an observer.

    Attributes
    ----------
    time : float or array, shape (...,)
        In s, 0 at first touch.
    approach, normal_velocity : float or array
        In m and m/s, positive in compression.
    contact : NormalContact
    slip_velocity : float or array
        In m/s.
    tangential_force : float or array
        In N, positive where it opposes a positive slip velocity.
    fields : callable
        Returns the law's arrays over the radius; asked only if wanted.
    """

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]]


#: Called with each instant; it must not change anything it is given.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False)
class TangentialMotion:
    """What an integrator returns; entries have the batch shape.

    Attributes
    ----------
    slip_velocity_change : float or array
        Change of v_x in m/s. Kept apart from v_x, which may be so large that the
        change would be lost in it.
    friction_work : float or array
        In J, added up by the tangential law.
    status : Status or array of Status
    detail : str or array of str
        What went wrong, where and when; empty on success. Of a batch an integrator may give
        one sentence: it goes to the impacts that failed.
    counters : mapping of str to int
        Work done: ``steps``, ``evaluations``, ``rejected``, ...
    """

    slip_velocity_change: Real
    friction_work: Real
    status: Any = Status.SUCCESS
    detail: Any = ""
    counters: Mapping[str, int] = attrs.field(factory=dict)

    def __attrs_post_init__(self) -> None:
        if isinstance(self.status, Status):
            return  # one impact: NumPy takes longer to say so
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
        others = ("status", "detail", "counters")
        return tuple(field.name for field in fields if field.name not in others)

    @classmethod
    def joined(cls, motions: Sequence[Self], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from those of its impacts, or of parts of them.

        Parameters
        ----------
        motions : sequence of TangentialMotion
            In the order of the impacts.
        shape : tuple of int
            Of the whole.
        """
        if len(motions) == 1 and shape and np.shape(motions[0].status) == shape:
            return motions[0]
        counters: Counter[str] = Counter()
        for motion in motions:
            counters.update(motion.counters)
        entries: dict[str, Any] = {}
        for name in (*cls.numbers(), "status", "detail"):
            kind = float if name in cls.numbers() else object
            parts = [np.ravel(np.asarray(getattr(each, name), dtype=kind)) for each in motions]
            entries[name] = np.concatenate(parts).reshape(shape)
        return cls(**entries, counters=dict(counters))

    @classmethod
    def merged(cls, parts: Sequence[tuple[Any, Self]], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from pairs of a mask and the motion of its impacts.

        An impact in several parts has the motion of the last.

        Parameters
        ----------
        parts : sequence of (array of bool, TangentialMotion)
            Masks of shape ``shape``, and motions of as many impacts.
        shape : tuple of int
            Of the whole.
        """
        counters: Counter[str] = Counter()
        for _, motion in parts:
            counters.update(motion.counters)
        entries: dict[str, Any] = {}
        for name in (*cls.numbers(), "status", "detail"):
            columns = [(where, getattr(motion, name)) for where, motion in parts]
            entries[name] = merged(columns, shape, float if name in cls.numbers() else object)
        return cls(**entries, counters=dict(counters))

    @classmethod
    def nothing(
        cls, shape: tuple[int, ...], status: Status, detail: str | Sequence[str] = ""
    ) -> Self:
        """Return the motion of impacts of which nothing is known: NaN throughout.

        Parameters
        ----------
        shape : tuple of int
        status : Status
        detail : str or sequence of str
            A sentence, or one for each impact.
        """
        entries: dict[str, Any] = dict.fromkeys(cls.numbers(), spread(math.nan, shape))
        return cls(
            **entries,
            status=filled(status, shape),
            detail=detail if isinstance(detail, str) else np.array(detail, dtype=object),
        )

    def failing(self, where: Mask, status: Status, detail: Any) -> Self:
        """Return this motion with ``status`` and ``detail`` on the successes that ``where`` marks.

        ``detail`` is a sentence, or an array of one for each impact.

        Parameters
        ----------
        where : bool or array of bool
        status : Status
        detail : str or array of str
            A sentence, or one for each impact.
        """
        statuses: Any = np.array(self.status, dtype=object)
        fallen = np.asarray(where) & (statuses == Status.SUCCESS)
        if not fallen.any():
            return self
        if not statuses.shape:
            return attrs.evolve(self, status=status, detail=detail)
        statuses[fallen] = status
        return attrs.evolve(
            self, status=statuses, detail=np.where(fallen, detail, self.detail).astype(object)
        )


class Integrator(Law):
    """An integrator of the tangential motion along a normal motion that is given.

    Contract
    --------
    1. ``integrate(normal, tangential, scene, observer)`` returns a ``TangentialMotion``. It is
       pure; it never raises for a numerical failure, but returns a status with the motion so
       far.
    2. Every loop is bounded.
    3. ``observer`` is None or is called at increasing times; having one changes no result.
    4. ``order`` is the order of convergence in the step that the class declares for smooth
       laws; None where there are no steps.
    5. Batch shapes pass through: a batch gives what its impacts give one by one. Where one
       fails the batch may be given up, a simulation then hands over each by itself; not with
       ``own_statuses``, which says that a failure within a batch is that of the impact alone.
    6. ``tangential_contract`` and ``normal_contract`` are the classes of the laws that it runs.
    7. ``psi2_error`` is a bound of the numerical error of psi2, from what the tangential law
       declares; NaN, the default, where nothing is declared.
    8. ``resolution`` is the name of the option, steps or tolerance, that the error falls with.
       One that raises it by itself where it is too low says so by ``resolution_for``: errors
       are estimated by doubling what an impact got, not what was asked for.
    """

    kind: ClassVar[str] = "integrator"
    tangential_contract: ClassVar[Any]  # a type; mypy allows no abstract one
    normal_contract: ClassVar[Any] = NormalLaw
    order: ClassVar[int | None] = None
    #: False if each impact of a batch has instants of its own: no history of a batch then.
    common_instants: ClassVar[bool] = True
    own_statuses: ClassVar[bool] = False

    @property
    def accuracy(self) -> float | None:
        """Error of psi2 over max(1, abs(psi1)) that it keeps to in time; None without control."""
        return None

    def chunk(self, tangential: TangentialLaw) -> int:
        """Return how many impacts a sweep should hand over at a time.

        Enough to hide the cost of a call, few enough that an interruption loses little.

        Parameters
        ----------
        tangential : TangentialLaw
            The law that is run.
        """
        return CHUNK

    def remarks(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> tuple[str, ...]:
        """Return what a plan should say of these impacts: sentences, none by default.

        Parameters
        ----------
        normal : NormalMotion
            Of all impacts of ``scene``.
        tangential : TangentialLaw
        scene : Scene
            One impact or a batch.
        """
        return ()

    def resolution_for(self, normal: NormalMotion, tangential: TangentialLaw, scene: Scene) -> Real:
        """Return the resolution that each impact gets: that of the option, unless overridden.

        Parameters
        ----------
        normal : NormalMotion
            Of all impacts of ``scene``.
        tangential : TangentialLaw
        scene : Scene
            One impact or a batch.

        Returns
        -------
        float or array
            0 of an integrator without one.
        """
        return float(getattr(self, self.resolution)) if self.resolution else 0.0

    def psi2_error(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> Real:
        """Return the declared numerical error of psi2.

        Parameters
        ----------
        normal : NormalMotion
            Of all impacts of ``scene``.
        tangential : TangentialLaw
            The law that is run.
        scene : Scene
            One impact or a batch.
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
        normal : NormalMotion
            Already made, of the same impacts.
        tangential : TangentialLaw
            Of the class ``tangential_contract``.
        scene : Scene
            One impact, or a batch.
        observer : callable, optional
            Called with a ``Sample`` at increasing times (clause 3).
        """
