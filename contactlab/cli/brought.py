"""Lists and checks of plug-ins other than laws, on the command line."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Entry, Material
from contactlab.impact.scene import Scene
from contactlab.registration.hooks import PluginError, guard
from contactlab.registration.installed import PluginWarning
from contactlab.registration.manager import MANAGER, Told
from contactlab.registration.names import COMMAND, PluginInfo

if TYPE_CHECKING:
    from contactlab.study.validation import Finding

T = TypeVar("T")

#: Kinds whose hooks may return nothing for the reference impacts.
SILENT = ("cautions", "options")
#: Arguments of the hooks that have some.
NORMAL = np.array([0.0, 0.0, -1.0])


class Checked(NamedTuple):
    """One thing that a plug-in brought, and its fault; empty without a fault."""

    name: str
    complaint: str


def reference() -> Scene:
    """Return a batch of two impacts of a steel ball."""
    steel = Material.named("steel")
    ball, plane = Sphere(radius=0.01, material=steel), HalfSpace(steel)
    return Scene.at_angle(ball, plane, 0.2, speed=1.0, angle_deg=np.array([20.0, 60.0]))


def items(info: PluginInfo) -> list[Told]:
    """Return what one plug-in brings of its kind.

    Raises
    ------
    PluginError
        If it is broken.
    """
    MANAGER.load(info.kind)
    MANAGER.plugin(info)
    arguments: dict[str, Any] = {}
    if info.kind == "cases":
        from contactlab.study.bench_methods import methods

        arguments = {"method": methods(None)[0], "quick": True}
    if info.kind == "cautions":
        from contactlab.runs.simulation import Simulation

        arguments = {"scene": reference(), "laws": Simulation().laws}
    if info.kind == "options":
        arguments = {"command": "run", "parser": argparse.ArgumentParser()}
    told = MANAGER.gather(info.kind, **arguments)
    error = MANAGER.faults.get(info.qualified)
    if error is not None:
        raise error
    return [each for each in told if each.info.module == info.module]


def title(item: object) -> str:
    """Return the name of a thing."""
    for attribute in ("name", "label", "__name__"):
        if isinstance(name := getattr(item, attribute, None), str):
            return name
    return str(item)


def check(info: PluginInfo) -> Iterator[Checked]:
    """Check each thing that a plug-in brings, alone."""
    if info.kind == COMMAND:
        yield Checked(info.name, _complaint(_command, info))
        return
    seen: set[str] = set()
    for told in items(info):
        name = title(told.item)
        complaint = _complaint(CHECKS[info.kind], told.item) if info.kind in CHECKS else ""
        twice = f"{name} is brought twice" if name in seen else ""
        seen.add(name)
        yield Checked(name, complaint or twice)
    if not seen:
        silent = info.kind in SILENT
        yield Checked(info.name, "" if silent else "brings nothing: the hook returned None or []")


def _complaint(check: Callable[[T], str], item: T) -> str:
    try:
        with guard(title(item), "raised"):
            return check(item)
    except PluginError as error:
        return str(error)


def _command(info: PluginInfo) -> str:
    found = MANAGER.ask(info, parser=argparse.ArgumentParser())
    return "" if callable(found) else f"returned {found!r}, which runs no command"


def _material(item: object) -> str:
    if not isinstance(item, Entry):
        return f"is {type(item).__name__}, no materials.Entry"
    item.material()
    return "" if item.elastic_source and item.density_source else "has no sources"


def _column(item: object) -> str:
    from contactlab.outcome.columns import Column, fault_of
    from contactlab.runs.simulation import Simulation

    if not isinstance(item, Column):
        return f"is {type(item).__name__}, no Column"
    if fault := fault_of(item):
        return fault
    alone_only = "history" in item.needs  # a batch may have no history

    def read(scene: Scene) -> object:
        return item.read(Simulation().run(scene, history=alone_only).check())

    for scene in (reference(), Scene.nondimensional(psi1=[0.5, 3.0], chi=1.44)):
        each = [scene.take(place) for place in range(scene.shape[0])]
        with warnings.catch_warnings():
            warnings.simplefilter("error", PluginWarning)  # a function that fails is told here
            value = read(each[0] if alone_only else scene)
            if value is None or not item.unit or alone_only:
                continue
            together = np.asarray(value, dtype=float)
            if together.shape[: len(scene.shape)] not in ((), scene.shape):
                return f"has shape {together.shape} for impacts of shape {scene.shape}"
            for place, one in enumerate(each):
                alone = np.asarray(read(one), dtype=float)
                both = np.broadcast_to(together, scene.shape)[place] if together.ndim < 2 else alone
                if not np.allclose(alone, both, rtol=1e-12, equal_nan=True):
                    return f"gives {alone!r} for one impact and {both!r} for the same in a batch"
    return ""


def _shape(item: object) -> str:
    from contactlab.impact.rigid_body import RigidBody
    from contactlab.impact.shapes import Shape

    if not isinstance(item, Shape):
        return f"is {type(item).__name__}, no Shape"
    if not item.example:
        return "has no example, so it was not made"
    tilted = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])
    upright = tilted[:, 2] if item.oriented == "axis" else tilted
    steel = Material.named("steel")
    made: tuple[Any, ...] = item.make(
        **item.example, material=steel, normal=NORMAL, **{item.oriented: upright}
    )
    body, contact = made[0], made[1]
    if not isinstance(body, RigidBody):
        return f"makes {type(body).__name__}, no RigidBody"
    return "" if float(np.dot(contact, NORMAL)) > 0.0 else "has its contact on the wrong side"


def _case(item: Any) -> str:
    make = getattr(item, "make", None) or item.scene.make
    try:
        made = make()
    except ValueError:
        return ""  # a refusal is an outcome
    return "" if isinstance(made, Scene) else f"makes {type(made).__name__}, no Scene"


def _finding(item: Callable[[], Finding]) -> str:
    found = item()
    return "" if found.ok else f"{found.what}: {found.difference:.2g}, bound {found.bound:.2g}"


def _measured(item: object) -> str:
    from contactlab.scene_file import SceneFile
    from contactlab.study.evidence import Slopes, Source

    if not isinstance(item, Source | Slopes):
        return f"is {type(item).__name__}, no Source and no Slopes"
    file = item.read()
    if isinstance(file, SceneFile) and not file.measured:
        return "has no measured values"
    return "" if file.citation else "has no citation"


def _caution(item: object) -> str:
    return "" if isinstance(item, str) else f"is {item!r}, no sentence"


CHECKS: dict[str, Callable[[Any], str]] = {
    "materials": _material, "columns": _column, "shapes": _shape, "cases": _case,
    "checks": _finding, "measurements": _measured, "cautions": _caution,
}  # fmt: skip
