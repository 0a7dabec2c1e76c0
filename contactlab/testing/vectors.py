"""Checks of words of stepped laws: no need of the future, and vectors (theory §14)."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.contracts import CausalTangentialLaw, SteppedTangentialLaw, claims
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.types import Array
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import limits
from contactlab.testing.check import check, hold, within, worst
from contactlab.testing.load_paths import (
    Answers,
    Bench,
    Path,
    continue_from,
    drive,
    slack,
    straight,
    wandering,
)

#: Words of the laws that the checks apply to, with their values.
VECTORS = ("vectors", True)
ELLIPTIC = ("elliptic", True)
SEEDS = (41, 42, 43)
#: Rounding of forces over mu P_max, and of work.
ROUNDING = 1e-9
#: Zeta of a contact that friction has made deeper than the approach without it, and steps to it.
DEEP, STEPS = 2.25, 32
#: Slip that drags a force into its direction, over the slip at which gross slip begins.
DRAGGED = 40.0
#: G* along t2 over that along t1 of an elliptic contact; slip at which nearly all of it sticks,
#: over that at which gross slip begins, and the bound of the ratio of forces.
RATIO, LITTLE, NEAR = 1.2, 1e-3, 0.01
SHAPES: tuple[tuple[int, ...], ...] = ((), (3,))


@check(CausalTangentialLaw)
def begin_is_start(law: CausalTangentialLaw) -> None:
    """In a contact that grows no larger than expected `begin` and `start` give the same forces."""
    for shape in SHAPES:
        bench = Bench.of(shape)
        for seed in SEEDS:
            path = wandering(seed)
            begun = continue_from(law, bench, law.begin(bench.scene, bench.normal), path)
            gap = worst(begun.force - drive(law, bench, path).force)
            within(
                gap,
                slack(law),
                f"From the state of begin a random path (seed {seed}) gives forces {gap:.2g} "
                f"mu P_max off those from the state of start.",
            )


@check(CausalTangentialLaw)
def deeper_contact(law: CausalTangentialLaw) -> None:
    """A contact may grow and last beyond the approach without friction, and be made again."""
    bench = Bench.of()
    beyond = straight((0.0, DEEP), (4.0 * DEEP, DEEP), (4.0 * DEEP, 0.0), steps=STEPS)
    again = straight((0.0, 0.8), (0.5, 0.8), (0.5, 0.1), steps=STEPS)
    apart = Path(np.full(2, 4.0 * DEEP), np.full(2, -0.1))
    state = law.begin(bench.scene, bench.normal)
    first = continue_from(law, bench, state, again, count=STEPS)
    deep = continue_from(law, bench, state, beyond, count=STEPS)
    gap = abs(float(deep.force[2 * STEPS - 1]) - DEEP**1.5) / DEEP**1.5
    within(
        gap,
        slack(law, 1e-6),
        f"In a contact {DEEP} times as deep as without friction the force of gross slip is "
        f"{gap:.2g} off mu times the friction load.",
    )
    away = continue_from(law, bench, deep.state, apart, slip=4.0 * DEEP, count=STEPS)
    second = continue_from(law, bench, away.state, again, level=-0.1, count=STEPS)
    gap = worst(second.force - first.force)
    within(
        gap,
        slack(law),
        f"A second compression gives forces {gap:.2g} mu P_max off those of the first. ",
    )


@check(CausalTangentialLaw, word=VECTORS)
def vectors_rotate(law: CausalTangentialLaw) -> None:
    """A rotation of all vectors in the tangent plane rotates the forces (vector, 2)."""
    for shape in SHAPES:
        bench = Bench.of(shape)
        for seed in SEEDS:
            path, turn = _wandering(seed), _rotation(1.0 + seed)
            told = drive_vectors(law, bench, path)
            turned = drive_vectors(law, bench, Path(path.slip @ turn.T, path.level))
            gap = max(worst(turned.force - told.force @ turn.T), worst(turned.work - told.work))
            within(
                gap,
                ROUNDING,
                f"Rotated by {1 + seed} radians, a random path (seed {seed}) gives force or work "
                f"{gap:.2g} off.",
            )


@check(CausalTangentialLaw, word=VECTORS)
def vectors_turn(law: CausalTangentialLaw) -> None:
    """Under a steady drag the force comes to lie along the slip, at Coulomb's limit."""
    bench, level = Bench.of(), 0.8
    bound = slack(law, 1e-6)
    path = straight((0.0, level), (2.0, level), (2.0 + DRAGGED * level, level), steps=STEPS)
    for angle in (0.4, 1.6, 2.9):
        aside = np.maximum(path.slip - 2.0, 0.0)
        slip = np.stack((path.slip - aside, 0.0 * aside), axis=-1)
        slip += aside[:, None] * np.array((np.cos(angle), np.sin(angle)))
        force = drive_vectors(law, bench, Path(slip, path.level)).force[-1] / level**1.5
        gap = worst(force - np.array((np.cos(angle), np.sin(angle))))
        within(
            gap,
            bound,
            f"The slip turns by {angle} radians and goes on for {DRAGGED:g} times the slip at "
            f"which gross slip begins: F/(mu P) is {gap:.2g} off its direction. ",
        )


@check(CausalTangentialLaw, word=VECTORS)
def vector_limit(law: CausalTangentialLaw) -> None:
    """No force is longer than mu times the friction load, whichever way the slip turns."""
    bench = Bench.of((3,))
    for seed in SEEDS:
        path = _wandering(seed)
        size = np.linalg.norm(drive_vectors(law, bench, path).force, axis=-1)
        excess = worst(np.maximum(size - path.level[:, None] ** 1.5, 0.0))
        within(
            excess,
            slack(law),
            f"A force is {excess:.2g} mu P_max longer than mu times the friction load "
            f"(seed {seed}).",
        )


@check(CausalTangentialLaw, word=VECTORS)
def vectors_on_a_line(law: CausalTangentialLaw) -> None:
    """Vectors along t1 give the forces and the work of numbers, and no force along t2."""
    for shape in SHAPES:
        bench = Bench.of(shape)
        for seed in SEEDS:
            path = wandering(seed)
            numbers = continue_from(law, bench, law.begin(bench.scene, bench.normal), path)
            slip = np.stack((path.slip, 0.0 * path.slip), axis=-1)
            told = drive_vectors(law, bench, Path(slip, path.level))
            gap = max(
                worst(told.force[..., 0] - numbers.force),
                worst(told.force[..., 1]),
                worst(told.work - numbers.work),
            )
            within(
                gap,
                slack(law),
                f"A random path along t1 (seed {seed}) gives force or work {gap:.2g} off that of "
                f"numbers.",
            )


@check(SteppedTangentialLaw, word=ELLIPTIC)
def two_stiffnesses(law: SteppedTangentialLaw) -> None:
    """On an ellipse vectors meet the stiffness of each axis, and numbers that of t1."""
    for shape in SHAPES:
        circle = Bench.of(shape)
        pair = attrs.evolve(circle.scene.pair, cross_stiffness_ratio=RATIO)
        scene = attrs.evolve(circle.scene, pair=pair)
        bench = Bench.along(normal_motion(REGISTRY.create("normal.hertz"), scene))
        path = wandering(SEEDS[0])
        gap = worst(drive(law, bench, path).force - drive(law, circle, path).force)
        within(gap, slack(law), f"The stiffness of t2 moves forces along t1 by {gap:.2g} mu P_max.")
        if not isinstance(law, CausalTangentialLaw) or "vectors" not in claims(law):
            continue
        level, way = 0.8, np.array((0.6, 0.8))
        path = straight((0.0, level), (LITTLE, level), (DRAGGED, level), steps=STEPS)
        told = drive_vectors(law, bench, Path(path.slip[:, None] * way, path.level)).force
        ratio = told[2 * STEPS - 1, ..., 1] / told[2 * STEPS - 1, ..., 0] / (way[1] / way[0])
        within(
            worst(ratio / RATIO - 1.0),
            NEAR,
            f"Where the contact sticks, forces along t2 and t1 over the slips are in the ratio "
            f"{np.ravel(ratio)[0]:.4g}, not {RATIO:g}.",
        )
        gap = worst(told[-1] / level**1.5 - way)
        within(
            gap,
            slack(law, 1e-6),
            f"In gross slip F/(mu P) is {gap:.2g} off the direction of the slip.",
        )


def drive_vectors(law: CausalTangentialLaw, bench: Bench, path: Path) -> Answers:
    """Return the answers of ``law`` to slips of shape (K, 2); forces have the shape (K, ..., 2)."""
    limits.begin(f"a path of {len(path.slip)} vectors")
    state = law.begin(bench.scene, bench.normal, vectors=True)
    unit, duration = np.asarray(bench.slip)[..., None], lock_arrays(bench.time / len(path.slip))
    before, here = bench.contact(0.0), np.zeros(2)
    forces, works = [], []
    for slip, level in zip(path.slip, path.level.tolist(), strict=True):
        after = bench.contact(level)
        limits.DOING.steps += 1
        moved = lock_arrays(unit * (slip - here))
        increment = bench.increment(0.0, after, duration)._replace(
            displacement=moved, velocity=lock_arrays(moved / np.asarray(duration)[..., None])
        )
        response, state = law.advance(state, increment, before, after)
        force = np.asarray(response.force)
        hold(force.shape == moved.shape, f"A force has the shape {force.shape}, not {moved.shape}.")
        hold(np.all(response.settled), "The law found no answer on a path of vectors.")
        forces.append(force / np.asarray(bench.friction_force)[..., None])
        works.append(response.friction_work / (bench.friction_force * bench.slip))
        before, here = after, slip
    return Answers(np.array(forces), np.array(works), state)


def _wandering(seed: int) -> Path:
    """Return a random path whose slips are vectors, shape (K, 2)."""
    path = wandering(seed)
    return Path(np.stack((path.slip, wandering(seed + 100).slip), axis=-1), path.level)


def _rotation(angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin], [sin, cos]])
