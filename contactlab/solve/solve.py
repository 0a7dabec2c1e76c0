"""The outcome of a scene under three laws: plan and motion, each impact solved in its own way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contactlab.contracts.motion import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns
from contactlab.registration.names import KINDS
from contactlab.registry.acceptance import accept
from contactlab.registry.composition import Laws, versions
from contactlab.solve.decoupled import Decoupled
from contactlab.solve.way import Way


def ways(laws: Laws, scene: Scene, *, as_one: bool = False) -> list[Way]:
    """Return the ways in which a scene is solved; ``as_one`` is that of ``kinetics.parts``."""
    refuse_gathering(scene)
    found: list[Way] = []
    # Where slip turns laws are asked first: their refusal and its remedy hold for the batch.
    for where, part in reversed(kinetics.parts(scene, as_one=as_one)):
        if part.inverse_mass is not None:
            from contactlab.solve.coupled import Coupled  # spheres need none of this

            found.append(Coupled.of(where, part, laws))
        elif laws.capability.unfollowed is None:
            found.append(Decoupled(where, part, laws))
        else:
            from contactlab.solve.unfollowed import follow_apart  # most laws need none

            found += [Decoupled(*each, laws) for each in follow_apart(laws, where, part)]
    found.reverse()
    for way in found:
        if way.laws.capability.unnamed:
            from contactlab.solve.resolution import with_resolutions  # most laws have none

            return [each for way in found for each in with_resolutions(way, as_one=as_one)]
    return found


def refuse_gathering(scene: Scene) -> None:
    """Refuse the scene of a gathering, which is no batch of impacts."""
    if scene.links is not None:
        rule = "is that of a gathering, whose contacts move one another"
        raise refuse("scene", scene, rule, "collide(gathering, simulation) answers it")


def accept_scene(laws: Laws, scene: Scene, *, as_one: bool = False) -> list[Way]:
    """Return the ways in which a scene is solved, or refuse one that a law cannot run."""
    if laws.capability.unasked and scene.inverse_mass is None:
        return [Decoupled(..., scene, laws)]
    found = ways(laws, scene, as_one=as_one)
    for way in found:
        _, part, used = way
        for law in used.capability.refusing:
            accept(law, part.central)
        if used.capability.unfollowed is not None:
            from contactlab.solve.unfollowed import refuse_march  # most laws need none

            refuse_march(way, history=as_one)
    return found


def versions_of(found: Sequence[Way]) -> dict[str, str]:
    """Return name and version of each law by kind, of several in one scene with "and"."""
    if len(found) == 1:
        laws = found[0].laws
        return versions(laws.normal, laws.tangential, laws.integrator)
    used = [versions(*way.laws) for way in found]
    return {kind: " and ".join(dict.fromkeys(each[kind] for each in used)) for kind in KINDS}


@np.errstate(under="ignore")  # small numbers may vanish
def outcome(
    found: Sequence[Way], scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion]:
    """Return columns of the plan, and motion, of a scene whose ways were ``found``.

    A law that raises costs its impacts only. Numbers of failed impacts stay as the laws left them.
    A history of a batch is refused if its impacts have instants of their own.
    """
    if len(found) == 1:
        columns, motion = found[0].outcome(history, recorder)
        return columns, found[0].in_axes(motion, scene)
    pieces = []
    for way in found:
        columns, motion = way.outcome(history, recorder)
        pieces.append((way.where, columns, way.in_axes(motion, scene.take(way.where))))
    return (
        PlanColumns.merge([(where, columns) for where, columns, _ in pieces], scene.shape),
        Motion.merge([(where, motion) for where, _, motion in pieces], scene.shape),
    )


@np.errstate(under="ignore")
def prepare(
    found: Sequence[Way], scene: Scene, history: bool | str
) -> tuple[PlanColumns, list[tuple[Way, NormalMotion]]]:
    """Return the columns of the plan, without a march, and the normal motion of each way."""
    parts, normals = [], []
    for way in found:
        prepared = way.prepare(history)
        parts.append((way.where, prepared.columns))
        normals.append((way, prepared.normal))
    columns = parts[0][1] if len(parts) == 1 else PlanColumns.merge(parts, scene.shape)
    return columns, normals
