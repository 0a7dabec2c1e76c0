"""The errors of the table of restitutions, and the time of an impact."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import contactlab
from contactlab_laws.tables.file import read
from contactlab_laws.tables.restituted import SHIPPED, rebound
from contactlab_laws.tables.restituted_regions import REGIONS, border, bound_restitution_error
from contactlab_laws.viscoelastic.batch import extrapolate_steps
from contactlab_laws.viscoelastic.relaxation import number_of

#: Springs and steps in the comparison, more than those of the table.
GRID = {"springs": 200, "steps": 2400}
#: Restitutions that are drawn for each region, a third of them near 1.
DRAWS = 12
#: Impacts that are timed, and runs; the fastest run counts.
TIMED, RUNS = 100_000, 9


def verify(count: int, seed: int) -> int:
    """Print the errors against finer springs at random psi1, chi and e, region by region."""
    stored = read(SHIPPED)
    print(f"{SHIPPED}: contactlab {stored.version}, {stored.built}, {stored.checksum()[:12]}")
    draw, good = np.random.default_rng(seed), True
    size = max(count // DRAWS // len(REGIONS), 1)
    for region in REGIONS:
        rows: list[Any] = []
        for number in range(DRAWS):
            e = draw.uniform(0.001, 0.99)
            if number % 3 == 0:
                e = 1.0 - 10.0 ** draw.uniform(-2.0, -0.5)
            chi, u = draw.uniform(region.low, region.high, size), draw.random(size)
            psi1 = 1.0 + (border(chi, e) - 1.0) * u if region.slips else u
            found = rebound(psi1, chi, float(e))
            off = np.abs(found - extrapolate_steps(psi1, chi, number_of(float(e)), **GRID))
            declared = np.broadcast_to(bound_restitution_error(chi, e), size)
            rows += zip(off, declared, psi1, chi, np.full(size, e), strict=True)
        worst, bound, *at = max(rows)
        rms = float(np.sqrt(np.mean([row[0] ** 2 for row in rows])))
        kind = "slips first" if region.slips else "sticks"
        print(
            f"{kind}, chi {region.low:g} to {region.high:g}: largest {worst:.1e} (declared "
            f"{bound:.1e}) at psi1 = {at[0]:.4f}, chi = {at[1]:.4f}, e = {at[2]:.4f}; rms {rms:.1e}"
        )
        good = good and all(row[0] <= row[1] for row in rows)
    return 0 if good else 1


def bench() -> int:
    """Print nanoseconds of processor time an impact takes in bulk."""
    draw = np.random.default_rng(1)
    psi1, chi = draw.uniform(0.0, 8.0, TIMED), draw.uniform(0.8, 1.8, TIMED)
    for told, e in (("one e", 0.9), ("e each", draw.uniform(0.0, 1.0, TIMED))):
        seconds = []
        for _ in range(RUNS):
            began = time.process_time()
            contactlab.rebound(psi1, chi, restitution=e)
            seconds.append(time.process_time() - began)
        least = 1e9 * min(seconds) / TIMED
        print(f"{TIMED} impacts, {told}: {least:.0f} ns of processor time each")
    return 0
