"""Whole-impact answers: changes of slip velocity without a march."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status, Statuses
from contactlab.impact.scene import Scene
from contactlab.numeric.array_api import Library, Traced
from contactlab.numeric.arrays import choose, fill, magnitude
from contactlab.numeric.types import Array, Mask, Real


@attrs.frozen(kw_only=True, eq=False, slots=False)  # frozen slots are slow to fill
class WholeImpact:
    """Whole-impact answer of a law for some impacts of a batch.

    The answer follows from the scene and the normal motion alone.

    Attributes
    ----------
    where : bool or array of bool
        The impacts that the answer holds for; broadcasts to the batch shape, as do
        ``slip_velocity_change`` and ``friction_work``.
    slip_velocity_change : float or array
        Change of v_x in m/s; arbitrary where ``where`` is False.
    friction_work : float or array
        Friction work in J, at least 0.
    shear_loss : float or array
        Energy lost in shear in J, at least 0, as of springs that relax.
    reason : str
        Why these impacts need no march, for the plan: ``"friction coefficient 0"``.
    course : callable, optional
        ``course(load_impulse, friction_load)`` returns the change of slip velocity (m/s) and
        the tangential force (N) at the instants that have this integral of the friction load
        and this friction load. Without it impacts that can be marched are marched for a history;
        in the history of other impacts slip velocity and force are NaN.
    fields : callable, optional
        ``fields(load_impulse)`` returns named arrays over the contact at the instant that has this
        integral of the friction load; their shapes begin with the batch shape. A history with
        fields calls it.
    psi2_error : float or array
        Bound of the numerical error of psi2, rounding aside; 0 for a closed form. NaN, the
        default, means not declared. An impact that can be marched is marched where the bound
        exceeds the error that the integrator controls.
    status : Status or array of Status
        How the run of each impact ended; a failed impact has meaningless numbers.
    detail : str
        What failed; empty on success.
    normal : NormalMotion, optional
        The normal motion that came of the friction, of all impacts of the batch; None if friction
        does not change it.
    balanced : bool
        True if ``friction_work`` and ``shear_loss`` are the energy that the change of slip
        velocity takes: the energy books close by construction, and check nothing.
    counter : str or None
        Name under which the result counts the impacts, ``"tabulated"``; None for no count.
    normal_spin_change : float or array
        Change of the spin about the normal in rad/s, of a law with the word ``normal_spin``; its
        friction work is part of ``friction_work``.
    """

    where: Mask
    slip_velocity_change: Real
    friction_work: Real
    reason: str
    course: Callable[[Any, Any], tuple[Any, Any]] | None = None
    fields: Callable[[Any], Mapping[str, NDArray[Any]]] | None = None
    psi2_error: Real = math.nan
    status: Statuses = Status.SUCCESS
    detail: str = ""
    normal: NormalMotion | None = None
    balanced: bool = False
    counter: str | None = None
    normal_spin_change: Real = 0.0
    shear_loss: Real = 0.0

    @property
    def counters(self) -> Mapping[str, int]:
        """The counters of one impact."""
        return {} if self.counter is None else {self.counter: 1}


class Tabulated(ABC):
    """Capability of a law: psi2 as a function of psi1 and chi, by which ``rebound`` answers.

    Its table is for chi in ``chi_range``.
    """

    chi_range: ClassVar[tuple[float, float]]

    @staticmethod
    @abstractmethod
    def rebound_error(*impact: Real) -> Real:
        """Return the bound of the error of psi2 over max(1, abs(psi1)).

        Parameters
        ----------
        *impact : float or array
            chi, and restitutions of a law that takes them.
        """

    @staticmethod
    @abstractmethod
    def rebound(*impact: Any, **options: Any) -> Any:
        """Return psi2, an odd function of psi1 to the last bit.

        Parameters
        ----------
        *impact : float or array
            psi1 and chi: checked numbers of one shape within the range of the law; of a law that
            takes them, restitutions from 0 to 1, 1 excluded: a float, or an array of that shape.
        **options
            ``derivatives``: True for (psi2, d psi2/d psi1, d psi2/d chi), and d psi2/d e after
            them of a law that takes restitutions; arrays only.
        """

    @staticmethod
    def table_of_arrays() -> Mapping[str, Any]:
        """Return the arrays of numbers and of integers that ``rebound_of_arrays`` needs."""
        raise NotImplementedError("this law has no table for arrays of other libraries")

    @staticmethod
    def rebound_of_arrays(
        xp: Library, tables: Mapping[str, Traced], *impact: Traced, **options: Any
    ) -> Traced:
        """Return psi2 by functions of the array API standard, for libraries that trace.

        Parameters
        ----------
        xp : module
            Functions of the array API standard.
        tables : mapping of str to array
            Those of ``table_of_arrays``, as arrays of that library.
        *impact : array
            As in ``rebound``, of one shape and type. Out of the range of the law psi2 is NaN.
        **options
            ``joined``: False if no restitution is near 1, so that the law may leave out what joins
            it to elastic impacts. ``with_slopes(value, slopes, fixed)`` returns the function
            ``value``; a library that compiles takes its derivatives from the list ``slopes`` by
            each argument but the first ``fixed`` ones.
        """
        raise NotImplementedError("this law has no table for arrays of other libraries")

    def solved(self, psi1: Array, chi: Array) -> Array | None:
        """Return psi2 - psi1 beyond the table; None, the default, where impacts are marched.

        Parameters
        ----------
        psi1, chi : array, shape (impacts,)
            psi1 at least 0.
        """
        return None


def from_change(
    scene: Scene,
    *,
    where: Mask,
    psi_change: Real,
    psi2_error: Real,
    reason: str,
    counter: str | None = None,
    in_shear: Real | None = None,
) -> WholeImpact:
    """Return the answer of impacts from their change of psi alone.

    Friction takes the tangential energy that shear leaves, and the energy books close by
    construction.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    where : bool or array of bool
        The impacts that the answer holds for.
    psi_change : float or array
        psi2 - psi1; arbitrary where ``where`` is False.
    psi2_error : float or array
        Bound of the numerical error of psi2.
    reason : str
        Why these impacts need no march, for the plan.
    counter : str, optional
        Name under which the result counts the impacts.
    in_shear : float or array, optional
        Energy lost in shear, over m_t (mu v1/kappa)²/2.
    """
    unit = scene.friction_coefficient * scene.normal_speed / scene.pair.stiffness_ratio
    change = psi_change * unit
    lost = -scene.pair.tangential_mass * change * (scene.slip_velocity + 0.5 * change)
    lost = choose(lost < 0.0, 0.0, lost)
    shear: Real = 0.0
    if in_shear is not None:
        shear = in_shear * unit * (0.5 * scene.pair.tangential_mass * unit)
        shear = choose(shear > lost, lost, shear)
    entries = {
        "where": where,
        "slip_velocity_change": change,
        "friction_work": lost - shear,
        "reason": reason,
        "course": None,
        "fields": None,
        "psi2_error": psi2_error,
        "status": Status.SUCCESS,
        "detail": "",
        "normal": None,
        "balanced": True,
        "counter": counter,
        "normal_spin_change": 0.0,
        "shear_loss": shear,
    }
    return fill(WholeImpact, entries)


def sliding(
    scene: Scene, normal: NormalMotion, *, where: Mask, reason: str, stops: bool
) -> WholeImpact:
    """Return the answer for impacts whose tangential force is mu times the friction load.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    where : bool or array of bool
        The impacts that the answer holds for.
    reason : str
        Why these impacts need no march, for the plan.
    stops : bool
        If True the force ends when the slip velocity reaches zero, as between rigid bodies. If
        False it acts until separation, as in gross slip of an elastic contact, eq. (45).
    """
    friction, mass = scene.friction_coefficient, scene.pair.tangential_mass
    slip = scene.slip_velocity
    speed = magnitude(slip)

    def after(impulse: Real, lesser: Callable[..., Real]) -> tuple[Real, Real]:
        """Return the speed lost in m/s, and the friction work in J, after ``impulse`` in N s."""
        lost = impulse / mass
        if stops:
            # If friction stops the slip, the slip velocity after is exactly zero.
            lost, impulse = lesser(lost, speed), lesser(impulse, mass * speed)
        # Force over load is constant: work = impulse times the mean of first and last velocity.
        return lost, impulse * (speed - 0.5 * lost)

    if scene.shape:
        sense = np.sign(slip)
        with np.errstate(all="ignore"):
            lost, work = after(friction * normal.total_load_impulse, np.minimum)
    else:  # plain numbers, several times as fast
        sense = float((slip > 0.0) - (slip < 0.0))
        lost, work = after(friction * float(normal.total_load_impulse), _lesser)

    def course(load_impulse: Real, load: Real) -> tuple[Real, Real]:
        change = friction * load_impulse / mass
        acting: Real | Mask = 1.0
        if stops:
            acting = change < speed
            change = np.minimum(change, speed)
        return -sense * change, sense * friction * load * acting

    return WholeImpact(
        where=where,
        slip_velocity_change=-sense * lost,
        friction_work=work,
        reason=reason,
        course=course,
        psi2_error=0.0,
    )


def _lesser(first: float, second: float) -> float:
    """Return the lesser of two numbers; NaN if the first is NaN."""
    return second if first > second else first


def no_force(scene: Scene, *, where: Mask, reason: str) -> WholeImpact:
    """Return the answer for impacts without tangential force.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    where : bool or array of bool
        The impacts that the answer holds for.
    reason : str
        Why these impacts need no march, for the plan.
    """

    def course(load_impulse: Real, load: Real) -> tuple[Real, Real]:
        zero = 0.0 * (scene.slip_velocity + load_impulse + load)
        return zero, zero

    return WholeImpact(
        where=where,
        slip_velocity_change=0.0,
        friction_work=0.0,
        reason=reason,
        course=course,
        psi2_error=0.0,
    )
