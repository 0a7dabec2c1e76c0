"""The half-space against exact torsion, for ``contactlab validate``."""

from collections.abc import Callable

import numpy as np

from contactlab.impact.scene import Scene
from contactlab.registration.hooks import hookimpl
from contactlab.runs.simulation import Simulation
from contactlab.study.validation import Finding, finding

#: Pure torsion: spin and inertia ratio in its own unit, 1 - nu/2 times w and chi_w, and the spin
#: after the impact, to 1e-9 by springs and by integrals (theory §17).
TORSION = (
    (0.2, 0.05, 0.145379967), (0.5, 0.05, 0.408654101), (1.0, 0.1, 0.792230865),
    (2.0, 0.05, 1.894555291), (0.5, 0.3, -0.02858620),
)  # fmt: skip
TORSION_BOUND, TORSION_POISSON = 1e-3, 0.3


@hookimpl
def contactlab_checks() -> list[Callable[[], Finding]]:
    """Return the comparison."""
    return [_torsion]


def _torsion() -> Finding:
    before, inertia, after = np.transpose(TORSION)
    unit = 1.0 - 0.5 * TORSION_POISSON
    entries = {"poisson_ratio": TORSION_POISSON, "spin": before / unit}
    scene = Scene.nondimensional(psi1=0.0, chi=1.0, spin_inertia=inertia / unit, **entries)
    w2 = Simulation(tangential="halfspace").sweep(scene).w2
    return finding(
        "halfspace: pure spin", "5 values of exact torsion", unit * w2 - after, TORSION_BOUND
    )
