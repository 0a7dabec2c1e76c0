"""The errors of the table of Tsuji's law, and the time of an impact."""

from __future__ import annotations

import time

import numpy as np

from contactlab.compose.rebound import DAMPED_ERROR, DAMPED_RESTITUTION
from contactlab_laws.tables.damped import CHI, SHIPPED, rebound, tsuji
from contactlab_laws.tables.file import read
from table_builders.damped.build import by_half_space

#: Rings in the comparison, more than those of the table.
RINGS = 128
#: Impacts that are timed, and runs; the fastest run counts.
TIMED, RUNS = 1_000_000, 5
#: Restitutions that are drawn, with a batch of impacts for each.
DRAWS = 12
#: psi1 of a draw is at most this.
LARGEST = 9.0


def verify(count: int, seed: int) -> int:
    """Print the errors against more rings at random psi1, chi and e, a third of them near 1."""
    stored = read(SHIPPED)
    print(f"{SHIPPED}: contactlab {stored.version}, {stored.built}, {stored.checksum()[:12]}")
    draw = np.random.default_rng(seed)
    worst = 0.0
    for number in range(DRAWS):
        e = float(draw.uniform(DAMPED_RESTITUTION, 1.0))
        if number % 3 == 0:
            e = 1.0 - 10.0 ** float(draw.uniform(-5.0, -1.0))
        size = max(count // DRAWS, 1)
        psi1, chi = draw.uniform(0.0, LARGEST, size), draw.uniform(*CHI, size)
        off = np.abs(rebound(psi1, chi, e) - by_half_space(tsuji(e), psi1, chi, rings=RINGS))
        at = int(off.argmax())
        worst = max(worst, float(off[at]))
        rms = float(np.sqrt(np.mean(off**2)))
        print(
            f"e = {e:.6f}: largest {off[at]:.1e} at psi1 = {psi1[at]:.4f}, chi = {chi[at]:.4f}; "
            f"rms {rms:.1e}"
        )
    print(f"largest {worst:.1e}, declared {DAMPED_ERROR:.0e}")
    return 0 if worst <= DAMPED_ERROR else 1


def bench() -> int:
    """Print nanoseconds of processor time an impact takes in bulk."""
    draw = np.random.default_rng(1)
    psi1, chi = draw.uniform(0.0, LARGEST, TIMED), draw.uniform(*CHI, TIMED)
    seconds = []
    for _ in range(RUNS):
        began = time.process_time()
        rebound(psi1, chi, 0.9)
        seconds.append(time.process_time() - began)
    print(f"{TIMED} impacts: {1e9 * min(seconds) / TIMED:.0f} ns of processor time each")
    return 0
