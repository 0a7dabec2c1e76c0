"""What the guards cost: an annulus run with them and without, in turn, in one process.

``python tests/compose/guards.py`` prints a line for each scheme and incidence.
"""

import os

if __name__ == "__main__":  # and not where a test imports it: processes of later tests inherit it
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: a small matrix, one thread

import contextlib
import time
from unittest import mock

import contactlab
from contactlab import Scene, Simulation
from contactlab.compose import solve as outcome
from contactlab_laws.march import march

REPEATS = 150
SCHEMES = {"paper": 500, "symplectic": 200}
INCIDENCES = (0.5, 1.2, 2.0, 3.0)


def _first(first, *_):
    return first


def _nothing(*_):
    return None


@contextlib.contextmanager
def without():
    """Replace every guard on the way of an annulus run by nothing."""
    with (
        mock.patch.object(outcome, "sound", _first),
        mock.patch.object(outcome, "balanced", _first),
        mock.patch.object(march, "_unsound", _nothing),
    ):
        yield


def cost(run, repeats=REPEATS):
    """Return the least CPU time of ``run()`` in s, with the guards and without, taken in turn."""
    guarded = bare = float("inf")
    for _ in range(repeats):
        started = time.process_time()
        run()
        guarded = min(guarded, time.process_time() - started)
        with without():
            started = time.process_time()
            run()
            bare = min(bare, time.process_time() - started)
    return guarded, bare


def main():
    for name, steps in SCHEMES.items():
        march_scheme = contactlab.create(f"integrator.{name}", steps=steps)
        together = Simulation(tangential="annulus", integrator=march_scheme)
        for psi1 in INCIDENCES:
            scene = Scene.nondimensional(psi1=psi1, chi=1.4412)
            guarded, bare = cost(lambda scene=scene, together=together: together.run(scene))
            share = 100.0 * (guarded / bare - 1.0)
            print(
                f"{name:10} {steps} steps, psi1 {psi1}: {1e3 * bare:.2f} ms, guards {share:.1f} %"
            )


if __name__ == "__main__":
    main()
