"""Forces along a prescribed approach and tangential displacement, as on a testing machine."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults
from contactlab.contracts.law import claims
from contactlab.contracts.normal import NormalLaw, unfollowed_rate
from contactlab.contracts.restitution import LEAST_RESTITUTION
from contactlab.contracts.status import Details, Statuses
from contactlab.contracts.tangential import SteppedTangentialLaw, TangentialLaw
from contactlab.impact.cautions import of_ellipse, path_cautions
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.checks import Rule, of_kind, real, refuse
from contactlab.numeric.types import Array, Json, Numbers
from contactlab.outcome.answer import Answer
from contactlab.outcome.columns import json_value
from contactlab.outcome.sheet import Sheet, batch_axes, names_of
from contactlab.paths.path_steps import Followed, Points, follow_path
from contactlab.registry import composition
from contactlab.registry.acceptance import accept
from contactlab.registry.bound import bind_laws
from contactlab.registry.law_words import name_of, tell_assumptions
from contactlab.solve.solve import refuse_gathering
from contactlab.solve.unfollowed import refusal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.outcome.style import Width

#: Columns of a path that the laws return.
COLUMNS = ("normal_force", "friction_force", "friction_load", "contact_radius", "friction_work")
#: Units of the columns of a path.
UNITS = {
    "time": "s", "approach": "m", "displacement": "m", "normal_force": "N", "friction_force": "N",
    "friction_load": "N", "contact_radius": "m", "friction_work": "J", "work": "J", "status": "",
}  # fmt: skip
#: Time of a step over the duration of an elastic impact, if no times are given: viscous forces are
#: then below the rounding of elastic ones.
SLOW = 1e12
GROWING = Rule(
    lambda time: np.ndim(time) > 0 and bool((np.diff(time, axis=0) > 0.0).all()),
    "must grow along its first axis",
)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class LoadPath(Answer):
    """Forces of a contact along a path, at its K points; arrays of shape (K, ...).

    The axes behind the first are those of a batch of paths. A force after a failure is NaN.

    Attributes
    ----------
    scene : Scene
        Bodies and friction, one for each path of a batch.
    normal, tangential : law
        The laws.
    time : array
        Time of each point in s.
    approach, displacement : array
        The path, in m.
    normal_force, friction_force : array
        P and F in N; F is positive where it opposes a positive displacement.
    friction_load : array
        The normal force that Coulomb's limit is taken of, in N.
    contact_radius : array
        In m.
    friction_work : array
        Friction work since the first point, in J.
    status : Status, or array of Status
        Whether the path of each contact was followed to its end.
    detail : str
        What failed; empty on success.
    """

    scene: Scene
    normal: NormalLaw
    tangential: SteppedTangentialLaw
    time: Array
    approach: Array
    displacement: Array
    normal_force: Array
    friction_force: Array
    friction_load: Array
    contact_radius: Array
    friction_work: Array
    status: Statuses
    detail: str
    _states: tuple[Any, ...] = attrs.field(repr=False)

    def _statuses(self) -> tuple[Statuses, Details]:
        return self.status, self.detail

    @property
    def cautions(self) -> list[str]:
        """Doubts about the model: of the friction law on such paths, and of the bodies."""
        deepest = float(np.nanmax(self.approach, initial=0.0))
        round_ = [law for law in (self.normal, self.tangential) if "elliptic" not in claims(law)]
        return [
            *self.tangential.path_cautions(),
            *tell_assumptions(self.normal, self.tangential),
            *(text for law in round_ for text in of_ellipse(self.scene, name_of(law))),
            *path_cautions(self.scene, deepest, plastic="plastic" in claims(self.normal)),
        ]

    def __repr__(self) -> str:
        """Return the number of points, the laws and the status."""
        laws = f"{type(self.normal).__name__}, {type(self.tangential).__name__}"
        statuses = dict.fromkeys(np.ravel(np.array(self.status, dtype=object)))
        words = ", ".join(status.name for status in statuses)
        return f"LoadPath({len(self.approach)} points, shape {self.scene.shape}; {laws}; {words})"

    @property
    def work(self) -> Array:
        """Work done on the contact by the displacement since the first point, in J.

        The trapezium rule over the points. Work beyond the friction work is in the springs;
        negative work is energy that the law makes.
        """
        mean = 0.5 * (self.friction_force[1:] + self.friction_force[:-1])
        done = np.cumsum(mean * np.diff(self.displacement, axis=0), axis=0)
        return np.concatenate((np.zeros_like(self.displacement[:1]), done))

    @cached_property
    def fields(self) -> dict[str, NDArray[Any]]:
        """Arrays of the tangential law at each point (traction, stuck, ...), by name.

        Empty if a law raised.
        """
        each = [self.tangential.fields(state) for state in self._states]
        names = each[0] if each else ()
        return {name: np.array([fields[name] for fields in each]) for name in names}

    def _sheet(self) -> Sheet:
        shape = np.shape(self.time)
        names = UNITS.keys() - {"status"}
        found = {name: getattr(self, name) for name in UNITS if name in names}
        found["status"] = names_of(self.status, shape[1:])
        about = {"normal": name_of(self.normal), "tangential": name_of(self.tangential)}
        return Sheet(found, UNITS, batch_axes(shape[:1], "point") | batch_axes(shape[1:], "path"),
                     shape, about, "point")  # fmt: skip

    def to_dict(self) -> dict[str, Json]:
        """Return columns, fields of the law and cautions as plain lists and text."""
        fields = {name: json_value(each) for name, each in self.fields.items()}
        told = {"status": json_value(self.status), "detail": self.detail}
        return super().to_dict() | fields | told | {"cautions": self.cautions}

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column over another, by default friction force over displacement."""
        from contactlab.outcome.sheet_figure import draw_sheet  # matplotlib only when drawing

        names = x or "displacement", y or "friction_force"
        return draw_sheet(axes, self._sheet(), *names, width=width, course=True)


def load_path(
    scene: Scene,
    approach: Numbers,
    displacement: Numbers,
    *,
    normal: str | NormalLaw = composition.DEFAULT_NORMAL,
    tangential: str | TangentialLaw = composition.ON_A_PATH,
    time: Numbers | None = None,
) -> LoadPath:
    """Return the forces of a contact that is moved along a prescribed path.

    The surfaces touch at approach 0 without traction, and are pressed to the first point without
    slip: only differences of ``displacement`` matter. Each point is the end of one step of the
    law, so the path should have as many points as an impact has steps, some hundred.

    Parameters
    ----------
    scene : Scene
        Bodies and friction coefficient. The velocities are not used, but by normal laws whose
        parameters depend on the normal speed.
    approach : array, shape (K,) or (K, ...)
        Approach of the bodies in m, positive in compression.
    displacement : array, shape (K,) or (K, ...)
        Tangential displacement of the bodies in m, far from the contact; of bodies of any shape
        along t1 of their scene.
    normal : str or NormalLaw
        Hertz's law by default.
    tangential : str or SteppedTangentialLaw
        A law that answers to a step; ``springs`` by default.
    time : array, shape (K,) or (K, ...), optional
        Time of each point in s. By default the path is slow: no force depends on a rate.

    Returns
    -------
    LoadPath
        Its arrays have the shape (K, ...), the axes after the first those of the paths and of
        ``scene`` together.

    Raises
    ------
    ValueError
        If an array is not finite or the shapes do not broadcast, if the times do not grow, or if
        the laws do not fit or need a march.

    Examples
    --------
    >>> import numpy as np
    >>> from contactlab import Material, Scene, Sphere, load_path
    >>> ball = Sphere(0.01, Material.named("steel"))
    >>> scene = Scene(ball, ball, 0.3, normal_speed=1.0)
    >>> path = load_path(scene, np.full(101, 1e-6), np.linspace(0.0, 1e-6, 101))
    >>> (path.friction_force / (0.3 * path.normal_force))[[20, 100]].round(3)
    array([0.697, 1.   ])
    """
    of_kind("scene", scene, Scene, remedy="make one: Scene(...)")
    refuse_gathering(scene)
    first, second, scene = _laws(scene, normal, tangential)
    laws = first, second
    points, origin, scene = _path(scene, approach, displacement, time)
    columns, states, status, detail = _follow_parts(laws, scene, points)
    return LoadPath(
        scene=scene,
        normal=laws[0],
        tangential=laws[1],
        time=lock_arrays(points.time + origin),
        approach=lock_arrays(points.approach),
        displacement=points.displacement,
        **{name: lock_arrays(column) for name, column in columns.items()},
        status=status,
        detail=detail,
        states=states,
    )


def _laws(
    scene: Scene, normal: object, tangential: object
) -> tuple[NormalLaw, SteppedTangentialLaw, Scene]:
    """Return the laws of a path, with options from the materials, and the scene; or refuse them."""
    first = composition.law("normal", normal)
    second = composition.law("tangential", tangential)
    rule = "must be a law of steps, a SteppedTangentialLaw"
    of_kind("tangential", second, SteppedTangentialLaw, rule=rule, remedy="use springs or annulus")
    if (complaint := composition.misfit(first, second)) is not None:
        raise ValueError(complaint)
    (first, second), scene = bind_laws((first, second), scene)
    for law in (first, second):
        accept(law, scene)
    if (rate := unfollowed_rate(first, scene)) is not None:
        raise refusal(rate, scene, "along a path", f"take at least {LEAST_RESTITUTION}")
    return first, second, scene


def _path(
    scene: Scene, approach: Numbers, displacement: Numbers, time: Numbers | None
) -> tuple[Points, Array, Scene]:
    """Return the points of a path, the time of first touch, and the scene of the paths' shape."""
    remedy = "give the path in m, a number for each point"
    given = {"approach": real("approach", approach, remedy=remedy)}
    given["displacement"] = real("displacement", displacement, remedy=remedy)
    if time is not None:
        given["time"] = real("time", time, rule=GROWING, remedy="in s")
    entries = {name: np.asarray(entry) for name, entry in given.items()}
    for name, entry in entries.items():
        if not entry.ndim:
            rule = "must be an array, shape (K,) or (K, ...)"
            raise refuse(name, given[name], rule, f"for one point give [{given[name]}]")
    told = ", ".join(f"{name} {entry.shape}" for name, entry in entries.items())
    count = len(entries["approach"])
    if any(len(entry) != count for entry in entries.values()):
        raise ValueError(f"{told}: must have the same number of points along the first axis")
    try:
        shape = np.broadcast_shapes(scene.shape, *(each.shape[1:] for each in entries.values()))
    except ValueError:
        raise ValueError(
            f"{told}, scene {scene.shape}: the axes after the first must broadcast with the "
            "scene's; a batch of N paths has arrays of shape (K, N)"
        ) from None
    if scene.shape != shape:
        speed = np.array(np.broadcast_to(scene.normal_speed, shape))
        scene = attrs.evolve(scene, normal_speed=speed)
    depth, moved, *times = (
        np.broadcast_to(
            each.reshape(count, *(1,) * (1 + len(shape) - each.ndim), *each.shape[1:]),
            (count, *shape),
        )
        for each in entries.values()
    )
    if times:
        first = times[0][1] - times[0][0] if count > 1 else hertz_scales(scene).duration
        origin = np.asarray(times[0][0] - first)  # first pressing at the rate of the first step
        return Points(times[0] - origin, depth, moved), origin, scene
    step = SLOW * np.asarray(hertz_scales(scene).duration)
    even = step * np.arange(1, count + 1).reshape(-1, *(1,) * len(shape))
    return Points(np.broadcast_to(even, depth.shape), depth, moved), 0.0 * step, scene


def _follow_parts(
    laws: tuple[NormalLaw, SteppedTangentialLaw], scene: Scene, points: Points
) -> Followed:
    """Return the answers of the laws; a law that raises fails only the paths on which it does."""
    try:
        return follow_path(*laws, scene, points)
    except faults.LawFaultError as fault:
        if not scene.shape:
            nothing = np.full(points.time.shape, math.nan)
            return Followed(dict.fromkeys(COLUMNS, nothing), (), fault.status, fault.detail)
    each = {
        place: _follow_parts(
            laws, scene.take(place), Points(*(column[(slice(None), *place)] for column in points))
        )
        for place in np.ndindex(scene.shape)
    }
    columns = {name: np.empty(points.time.shape) for name in COLUMNS}
    status = np.empty(scene.shape, dtype=object)
    for place, one in each.items():
        status[place] = one.status
        for name, column in columns.items():
            column[(slice(None), *place)] = one.columns[name]
    detail = next(one.detail for one in each.values() if one.detail)
    return Followed(columns, (), status, detail)
