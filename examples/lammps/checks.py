"""Checks of ``mindlin_springs`` in LAMMPS: restart in mid-contact, newton, swapped grains, touch.

Each check prints the largest difference of two runs that must agree, over the largest speed, for
elastic springs and for springs with loss.

Examples
--------
  python checks.py --lmp build/lmp --two "mpirun -np 2 build/lmp"
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from engine import DUMP, Array, Engine, Grains, arguments, engine, folder, friction, read, write

YOUNG, POISSON, MU, RADIUS = 1e8, 0.3, 0.4, 0.01
MODEL = f"hertz/material {YOUNG:g} 0.8 {POISSON} {{}} damping tsuji"
#: Young's modulus and Poisson's ratio of two unlike materials.
UNLIKE = ((1e8, 0.2), (4e8, 0.45))


def cluster(count: int = 60, seed: int = 5) -> tuple[Grains, Array, Array]:
    """Return grains of two kinds that fly to the middle of a box, so that all collide for long."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(count ** (1 / 3)))
    place = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)[:count]
    position = place * 2.3 * RADIUS + random.uniform(-0.1, 0.1, (count, 3)) * RADIUS
    position -= position.mean(axis=0)
    position[:, 2] -= position[:, 2].min() - 1.3 * RADIUS
    velocity = random.normal(size=(count, 3)) * 0.5 - 25.0 * (position - position.mean(axis=0))
    spin = random.normal(size=(count, 3)) * 30.0
    diameter = 2.0 * RADIUS * random.uniform(0.8, 1.1, count)
    kind = random.integers(1, 3, count)
    grains = Grains(kind, diameter, np.full(count, 2500.0), position, velocity, spin)
    return grains, position.min(axis=0) - 0.2, position.max(axis=0) + 0.2


def script(
    lammps: Engine,
    *,
    newton: str = "off",
    law: str,
    coefficients: str = "",
    sort: bool = True,
    wall: str = "zplane 0 NULL",
) -> str:
    """Return the settings of a run, without its steps."""
    model = MODEL.format(friction(law, MU))
    style = lammps.wall.replace("gran", "gran/region") if "region" in wall else lammps.wall
    fix = f"fix w all {style} granular {model} {wall}" if wall else ""
    pairs = coefficients or f"pair_coeff * * {model}"
    return f"""
units si
atom_style sphere
boundary f f f
newton {newton}
comm_modify vel yes
{"" if sort else "atom_modify sort 0 0.0"}
{{begin}}
region floor plane 0 0 0 0 0 1
pair_style {lammps.pair}
{pairs}
{fix}
fix n all nve/sphere
timestep 4e-6
neigh_modify delay 0 every 1 check yes
thermo 100000
"""


STEPS = 8000


def run(lammps: Engine, text: str, grains: Grains, low: Array, high: Array) -> Array:
    """Return velocities and spins after STEPS steps."""
    low = np.array([low[0], low[1], 0.0])
    with folder() as name:
        write(grains, Path(name) / "data", low, high, kinds=2)
        lammps.run(text.replace("{begin}", "read_data data"), Path(name))
        return read(Path(name) / "out")


def whole(lammps: Engine, **options: Any) -> Array:
    """Return the answers of one run of STEPS steps."""
    grains, low, high = cluster()
    text = script(lammps, **options) + DUMP.format(every=STEPS) + f"run {STEPS}\n"
    return run(lammps, text, grains, low, high)


def unlike(law: str, mixed: bool) -> str:
    """Return lines for two unlike materials; their pair is mixed, or has its stiffnesses."""
    lines = [
        f"pair_coeff {kind} {kind} hertz/material {young:g} 0.8 {poisson} "
        f"{friction(law, MU)} damping tsuji"
        for kind, (young, poisson) in enumerate(UNLIKE, 1)
    ]
    if not mixed:
        normal = 4.0 / 3.0 / sum((1.0 - poisson**2) / young for young, poisson in UNLIKE)
        shear = sum(2.0 * (2.0 - poisson) * (1.0 + poisson) / young for young, poisson in UNLIKE)
        stiff = 8.0 / shear
        loss = stiff / (1.5 * normal) if law.startswith("lossy") else 0.0  # over 2 E*
        lines.append(
            f"pair_coeff 1 2 hertz {normal:.17g} 0.8 "
            f"tangential mindlin_springs {stiff:.17g} {loss:.17g} {MU} 8 damping tsuji"
        )
    return "\n".join(lines)


def refused(what: Callable[[], object], word: str) -> bool:
    """Return whether LAMMPS stops with an error that has a word."""
    try:
        what()
    except RuntimeError as error:
        return word in str(error)
    return False


def restarted(lammps: Engine, at: int, first: str, then: str) -> Array:
    """Return the answers of a run that is stopped while grains touch, and begun again."""
    grains, low, high = cluster()
    low = np.array([low[0], low[1], 0.0])
    with folder() as name:
        write(grains, Path(name) / "data", low, high, kinds=2)
        begun = script(lammps, law=first).replace("{begin}", "read_data data")
        lammps.run(begun + f"run {at}\nwrite_restart kept\n", Path(name))
        again = script(lammps, law=then).replace("{begin}", "read_restart kept")
        lammps.run(again + DUMP.format(every=STEPS) + f"run {STEPS - at}\n", Path(name))
        return read(Path(name) / "out")


def swapped(lammps: Engine, law: str) -> Array:
    """Return the answers of the same grains numbered backwards, in the order of the first run."""
    grains, low, high = cluster()
    columns: Any = [column[::-1] for column in grains]
    backwards = Grains(*columns)
    text = script(lammps, law=law, sort=False) + DUMP.format(every=STEPS) + f"run {STEPS}\n"
    return run(lammps, text, backwards, low, high)[::-1]


def touching(lammps: Engine, law: str) -> Array:
    """Return velocities of two grains at exact touch that slide on each other: no force, no NaN."""
    place = np.array([[0.0, 0.0, 0.1], [2.0 * RADIUS, 0.0, 0.1]])
    velocity = np.array([[0.0, 0.3, 0.0], [0.0, -0.3, 0.0]])
    numbers = np.full(2, 2.0 * RADIUS), np.full(2, 2500.0)
    grains = Grains(np.ones(2, int), *numbers, place, velocity, np.zeros((2, 3)))
    text = script(lammps, law=law, wall="") + DUMP.format(every=1) + "run 0\n"
    return run(lammps, text, grains, np.full(3, -0.1), np.full(3, 0.2))


def main() -> int:
    """Print each check for elastic springs and for springs with loss; return 1 if one fails."""
    parser = arguments(__doc__)
    parser.add_argument("--two", help="the command with two processes")
    given = parser.parse_args()
    lammps = engine(given)
    two = given.two and Engine(given.two, lammps.plugin)
    failed = [checked(lammps, two, law) for law in ("springs8", "lossy8")]
    return int(any(failed) | refusing(lammps))


def checked(lammps: Engine, two: Engine | None, law: str) -> bool:
    """Print what must agree under a law; return whether it does not."""
    base = whole(lammps, law=law)
    scale = np.abs(base[:, :3]).max()
    failed = False

    def hold(what: str, answers: Array, bound: float, of: Array = base) -> None:
        nonlocal failed
        gap = np.abs(answers[:, :3] - of[:, :3]).max() / scale
        failed |= not gap <= bound
        print(f"{law:10}{what:50} {gap:9.1e}  {'ok' if gap <= bound else f'above {bound:g}'}")

    for other in ("mindlin/force", "springs8"):
        if other == law:
            continue
        moved = np.abs(whole(lammps, law=other)[:, :3] - base[:, :3]).max() / scale
        print(f"{law:10}{f'for comparison: {other} instead':50} {moved:9.1e}")
        failed |= moved < 1e-3
    half = restarted(lammps, STEPS // 8, law, law)
    hold("restart in mid-contact (damping at whole steps)", half, 1e-3)
    hold("the wall as a region", whole(lammps, law=law, wall="region floor"), 1e-9)
    hold("newton on", whole(lammps, law=law, newton="on"), 1e-9)
    hold("grains numbered backwards", swapped(lammps, law), 1e-9)
    model = MODEL.format(friction(law, MU))
    pairs = "\n".join(f"pair_coeff {pair} {model}" for pair in ("1 1", "1 2", "2 2"))
    mixed = "\n".join(f"pair_coeff {pair} {model}" for pair in ("1 1", "2 2"))
    like = whole(lammps, law=law, coefficients=mixed)
    hold("unlike types left to mixing, like materials", like, 1e-9)
    every = whole(lammps, law=law, coefficients=pairs)
    hold("a line of coefficients for every pair of types", every, 1e-12)
    apart, left = (whole(lammps, law=law, coefficients=unlike(law, each)) for each in (False, True))
    hold("unlike materials left to mixing", left, 1e-9, of=apart)
    if two:
        hold("two processes, newton off", whole(two, law=law), 1e-9)
        hold("two processes, newton on", whole(two, law=law, newton="on"), 1e-9)
    kept = touching(lammps, law)
    still = np.isfinite(kept).all() and np.allclose(np.abs(kept[:, 1]), 0.3)
    print(f"{law:10}{'grains that just touch':50} {'ok' if still else kept}")
    return failed or not still


def refusing(lammps: Engine) -> bool:
    """Print what must be refused; return whether something is not."""
    model = MODEL.format("tangential mindlin_springs {}")
    refusals: Mapping[str, tuple[Callable[[], object], str]] = {
        f"restart of {first} with {then}": (
            partial(restarted, lammps, STEPS // 8, first, then), "history of another"
        )
        for first, then in (
            ("springs8", "springs4"), ("springs8", "springs12"), ("mindlin/force", "springs8"),
            ("mindlin_rescale", "springs8"),
        )
    } | {
        f"coefficients {words}": (
            partial(
                whole, lammps, law="springs8", coefficients=f"pair_coeff * * {model.format(words)}"
            ),
            told,
        )
        for words, told in (
            ("NULL 0 0.4 1e300", "must be even"), ("NULL 0 0.4 7", "must be even"),
            ("0 0 0.4 8", "kt must be positive"), ("NULL -2 0.4 8", "must not be negative"),
        )
    }  # fmt: skip
    failed = False
    for what, (act, word) in refusals.items():
        stopped = refused(act, word)
        failed |= not stopped
        print(f"{what:50} {'refused: ok' if stopped else 'not refused'}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
