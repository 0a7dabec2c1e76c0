"""Draws of made-up measurements with fixed seeds: 200 of normal scatter, 100 with outliers."""

from typing import NamedTuple

import attrs
import numpy as np

from contactlab import HalfSpace, Scene, Simulation, Sphere, create
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit import fit
from tests.fitting.impacts import STEEL

CLEAN, WITH_OUTLIERS = 200, 100
#: An outlier is drawn with this many times the scatter, and this share of impacts are such.
WILD, SHARE = 8.0, 0.1
MEASURED = (
    ("tangential_restitution",), ("rebound_angle_deg",), ("rebound_spin",),
    ("tangential_restitution", "rebound_spin"), ("rebound_angle_deg", "rebound_spin"),
    ("rebound_tangential_velocity",),
)  # fmt: skip
BOTH = ("friction_coefficient", "stiffness_ratio")
KAPPA = 14 / 17
BODIES = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1.0, 1.0)


class Draw(NamedTuple):
    """Columns of a measurement, the parameters to fit, and their true values."""

    columns: dict
    truth: dict
    outliers: tuple


def heading(name):
    return f"{name} ({QUANTITIES[name].unit})"


def draw(seed, *, outliers, restitution=1.0, tilt=0.0, only=None):
    """Return a measurement of 8 to 40 impacts: scatter of 0.3 to 3 % of the greatest value.

    ``tilt`` is added to the angles in the columns; ``only`` names the parameters to fit.
    """
    rng = np.random.default_rng([19, seed])
    count = int(rng.integers(8, 41))
    friction = float(rng.uniform(0.05, 0.3))
    angles = np.sort(rng.uniform(3.0, 75.0, count)).round(1)
    speeds = (rng.uniform(0.5, 5.0) * rng.uniform(0.97, 1.03, count)).round(3)
    radians = np.radians(angles)
    scene = attrs.evolve(
        BODIES,
        friction_coefficient=friction,
        normal_speed=speeds * np.cos(radians),
        tangential_velocity=speeds * np.sin(radians),
    )
    rebounds = Simulation(tangential="fronts").sweep(scene).check()
    if restitution < 1.0:
        law = create("normal.viscoelastic", restitution=restitution)
        rebounds = Simulation(normal=law).sweep(scene).check()
    columns = {"angle_deg": angles + tilt, "speed (m/s)": speeds}
    bad = rng.random(count) < SHARE if outliers else np.zeros(count, dtype=bool)
    if outliers and not bad.any():
        bad[rng.integers(count)] = True
    stated = rng.random() < 0.2
    for name in MEASURED[int(rng.integers(len(MEASURED)))]:
        true = QUANTITIES[name].of(rebounds)
        scatter = float(np.exp(rng.uniform(np.log(0.003), np.log(0.03)))) * np.abs(true).max()
        noise = scatter * rng.standard_normal(count) * np.where(bad, WILD, 1.0)
        columns[heading(name)] = true + noise
        if stated:
            columns[f"{name}_error ({QUANTITIES[name].unit})"] = np.full(count, scatter)
    truth = {"friction_coefficient": friction}
    if rng.random() < 1 / 3:
        truth["stiffness_ratio"] = KAPPA
    truth = {name: truth[name] for name in only or truth}
    return Draw(columns, truth, tuple((np.flatnonzero(bad) + 1).tolist()))


def draws():
    """Yield the 300 draws, those of normal scatter first."""
    for seed in range(CLEAN + WITH_OUTLIERS):
        yield draw(seed, outliers=seed >= CLEAN)


class Outcome(NamedTuple):
    """Whether each interval holds the truth, by parameter, and what was said."""

    covered: dict
    notes: tuple
    cautions: tuple = ()


def outcome(one):
    """Return how the fit of a draw went; nothing is covered where it is refused.

    A refusal of what the data cannot determine is no word on the measurement.
    """
    try:
        found = fit(one.columns, BODIES, parameters=list(one.truth))
    except ValueError as error:
        told, undetermined, _ = str(error).rpartition("the data do not determine")
        return Outcome({}, (told,) if told or not undetermined else ())
    held = {
        name: found.parameters[name].interval[0] <= truth <= found.parameters[name].interval[1]
        for name, truth in one.truth.items()
    }
    return Outcome(held, found.notes, found.cautions)


def figures(outcomes):
    """Return shares: intervals that hold the truth, and draws whose measurement is accused."""
    held = [value for one in outcomes for value in one.covered.values()]
    return float(np.mean(held)), float(np.mean([bool(one.notes) for one in outcomes]))
