"""Results made by hand: two balls whose reduced numbers are round, and answers that are given.

With nu = 0 and G = 1 GPa in both balls E* = G* = 1 GPa and kappa = 1. Masses of 2 kg make
M_n = 1 kg, and K = 1/2 makes M_t = 1/5 kg, chi = 5/2. At 2 m/s and mu = 1/2 psi is the slip
velocity in m/s.
"""

import numpy as np

from contactlab import Material, Scene, Sphere, Status
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import MARCHED, UNKNOWN, Clause, Plan, PlanColumns, Reason
from contactlab.outcome.result import ImpactResult

SOFT = Material(shear_modulus=1e9, poisson_ratio=0.0)
BALL = Sphere(0.5, SOFT, mass=2.0, gyration_ratio=0.5)
LAWS = {
    "normal": "hertz (contactlab 0.1.0)",
    "tangential": "springs (contactlab 0.1.0)",
    "integrator": "symplectic (contactlab 0.1.0)",
}


def scene(**changes):
    """Return the scene: v_x = 3 + 4/2 = 5 m/s."""
    given = {
        "friction_coefficient": 0.5, "normal_speed": 2.0, "tangential_velocity": 3.0, "spin": 4.0,
    }  # fmt: skip
    return Scene(BALL, BALL, **(given | changes))


def motion(shape=(), **changes):
    """Return a motion with e = 1/2, of which slip loses 2 m/s."""
    entries = {
        "slip_velocity_change": -2.0, "friction_work": 1.25, "shear_loss": 0.25, "duration": 1e-3,
        "normal_velocity": -1.0, "maximum_radius": 0.0125, "maximum_approach": 1e-3,
        "maximum_force": 100.0, "exchange": 0.0,
    }  # fmt: skip
    numbers = {name: changes.pop(name, value) for name, value in entries.items()}
    if shape:
        numbers = {
            name: np.array(np.broadcast_to(np.asarray(value, dtype=float), shape))
            for name, value in numbers.items()
        }
        changes.setdefault("status", np.full(shape, Status.SUCCESS, dtype=object))
        changes["status"] = np.array(changes["status"], dtype=object)
    return Motion(**numbers, **changes)


def plan(shape=(), *, error=0.01, marched=True, unchecked=False, cautions=()):
    """Return a plan of an error, of impacts whose books check nothing, and of cautions."""
    everywhere = np.ones(shape, dtype=bool)
    books = np.array(np.broadcast_to(unchecked, shape))
    code = np.where(books, 0, np.where(marched, MARCHED, UNKNOWN))
    error = np.array(np.broadcast_to(error, shape), dtype=float) if shape else error
    words = (
        (Clause("normal motion: Hertz", everywhere),),
        (Clause("books", books),) if books.any() else (),
        tuple(Clause(text, everywhere) for text in cautions),
    )
    return Plan(PlanColumns(code, error, (Reason("known", unchecked=True),)), words)


def result(given=None, *, planned=None, **changes):
    """Return a result; ``changes`` are entries of the motion, counters, history or an estimate."""
    given = scene() if given is None else given
    kept = {
        name: changes.pop(name) for name in ("history", "psi2_error_estimate") if name in changes
    }
    return ImpactResult(
        scene=given,
        plan=plan(given.shape) if planned is None else planned,
        motion=motion(given.shape, **changes),
        laws=LAWS,
        run_time=changes.pop("run_time", 0.0125),
        **kept,
    )
