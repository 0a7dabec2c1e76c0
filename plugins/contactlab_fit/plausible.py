"""Implausible numbers of measurements and of materials, and restitutions that laws lack."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from contactlab.contracts.law import claims
from contactlab.numeric.types import Array
from contactlab_fit import tabulated
from contactlab_fit.f_test import NUMERICAL
from contactlab_fit.measurements import Measurements
from contactlab_fit.outliers import impacts_in_words
from contactlab_fit.problem import Problem

#: Plausible ranges of parameters: from the lowest friction of lubricated solids to that of
#: rubber on a rough plate; the ratio of stiffnesses for Poisson's ratios from 0.5 to 0.
LIKELY = {
    "friction_coefficient": (0.01, 2.0, "slides on thin ice or sticks like soft rubber"),
    "stiffness_ratio": (0.66, 1.01, "has no Poisson's ratio from 0 to 0.5"),
    "normal.restitution": (0.1, 1.0, "hardly rebounds"),
}
#: Plausible magnitudes before the impact: least and greatest.
SET = {"speed": (1e-3, 300.0), "normal_speed": (1e-3, 300.0), "spin": (0.0, 1e5)}
RADIUS = (1e-6, 0.5)
#: Angles below this, in degrees, may be in radians.
RADIANS = 1.58
#: Possible restitutions with a margin for scatter, and the share outside that is reported.
BOUNDS, SHARE = {"normal_restitution": (-0.1, 1.1), "beta0": (-1.1, 1.1)}, 1 / 3
#: A mean restitution lies above or below 1 if scatter makes that with less than this chance.
DOUBT = 0.01
#: Quantities that tell the normal restitution; for its trend, least impacts, least range of a
#: column, and least change of the restitution.
OF_NORMAL = "normal_restitution", "rebound_normal_velocity"
FEWEST, VARIES, LEAST_TREND = 4, 0.1, 0.005
#: Ends of a table of the speed that is told, over those measured: a tilt that is looked for makes
#: impacts slower or faster.
BEYOND = 0.8, 1.2
#: Additional bounds without spin before the impact.
WITHOUT_SPIN = {"tangential_restitution": (-0.1, 1.1)}


def unlikely_numbers(problem: Problem, table: Measurements) -> list[str]:
    """Return a sentence for each column of implausible numbers."""
    scene, sentences = problem.model.setup.scene, []
    for name, (least, most) in SET.items():
        size = np.abs(table.given.get(name, np.zeros(0)))
        moving = size > 0.0
        off = np.flatnonzero(moving & ((size < least) | (size > most)))
        if not off.size:
            continue
        of_what = "" if off.size == np.sum(moving) else f" in {impacts_in_words(off)}"
        sentences.append(
            f"{name} of about {_middle(size[off]):.3g}{of_what} is unlikely: check the unit"
        )
    angle = table.given.get("angle_deg")
    if angle is not None and len(angle) > 2 and 0.3 < np.max(np.abs(angle)) < RADIANS:
        sentences.append(
            f"angle_deg lies between {angle.min():.3g} and {angle.max():.3g} degrees: it may be "
            "in radians"
        )
    if scene.sphere is not None:
        radius = _middle(np.ravel(scene.sphere.radius))
        if not RADIUS[0] < radius < RADIUS[1]:
            sentences.append(
                f"the radius of the sphere, {radius:.3g} m, is unlikely: check the unit"
            )
    bounds = BOUNDS | ({} if np.any(scene.spin) else WITHOUT_SPIN)
    for name, values in table.measured.items():
        if name not in bounds:
            continue
        least, most = bounds[name]
        outside = np.sum((values < least) | (values > most))
        if outside > SHARE * np.isfinite(values).sum():
            sentences.append(
                f"{name}: {outside} numbers lie outside {least:g} to {most:g}, which is "
                "impossible: "
                "check unit, sign and order of the columns"
            )
    return sentences


def _middle(numbers: Array) -> float:
    """Return the number in the middle, which stands in a row where a median may not."""
    return float(np.sort(numbers)[(len(numbers) - 1) // 2])


def restitutions(problem: Problem, table: Measurements) -> list[str]:
    """Return a sentence if the normal restitution is above 1, or below that of elastic laws."""
    scene, laws = problem.model.setup
    if scene.inverse_mass is not None:
        return []  # friction changes the approach too
    e = table.measured.get("normal_restitution")
    error = table.errors.get("normal_restitution")
    name = "normal_restitution"
    if e is None and (out := table.measured.get("rebound_normal_velocity")) is not None:
        name, error = "rebound_normal_velocity", table.errors.get("rebound_normal_velocity")
        first = scene.sphere if scene.encounter is None else scene.encounter.body
        assert first is not None  # measured scenes have bodies
        speed = np.asarray(scene.normal_speed)
        change = speed * (scene.pair.normal_mass / first.mass)  # less if the struck body moves off
        e, error = (speed - out) / change - 1.0, None if error is None else error / change
    if e is None:
        return []
    mean, off = _mean(e, error)
    if off > 0.0:
        return [
            f"{name}: the restitution is {mean:.3g}, above 1, but no law gains energy. Check the "
            "speeds, the angle and the spin"
        ]
    lossless = laws is None or "elastic_hertz" in claims(laws.normal)
    if off < 0.0 and mean > 0.0 and lossless:
        return [
            f"{name}: the restitution is {mean:.3g}, but these laws lose nothing: "
            + tabulated.fit_restitution(scene, [p.name for p in problem.model.parameters])
        ]
    return []


def trend_of_restitution(problem: Problem, values: Array) -> list[str]:
    """Return a sentence if the normal restitution follows the speed or angle, with a remedy.

    The trend is the line through the residuals that chance makes least.
    """
    from scipy.special import stdtr  # only a fit needs scipy

    scene = problem.model.setup.scene
    residuals = problem.residuals(values[None])
    names = [name for name in OF_NORMAL if name in residuals]
    if scene.inverse_mass is not None or scene.sphere is None or not names:
        return []
    (name, *_), speed = names, np.broadcast_to(scene.normal_speed, scene.shape)
    scale = 1.0 if name == OF_NORMAL[0] else -speed
    angle: Array = np.degrees(np.arctan2(np.abs(scene.tangential_velocity), speed))
    rows = np.isfinite(residuals[name][0])
    off, e = ((part / scale)[rows] for part in (residuals[name][0], problem.measured[name]))
    found: list[tuple[float, str, Array]] = []
    if rows.sum() < FEWEST or np.ptp(off) < LEAST_TREND:
        return []
    for column, x in (("the normal speed", speed[rows]), ("the angle of incidence", angle[rows])):
        if np.ptp(x) <= VARIES * np.max(np.abs(x)):
            continue
        r = float(np.corrcoef(x, off)[0, 1])
        freedom = len(x) - 2
        t = abs(r) * math.sqrt(freedom / max(1.0 - r * r, NUMERICAL))
        found.append((2.0 * float(stdtr(freedom, -t)), column, x))
    chance, column, x = min(found, key=lambda one: one[0], default=(1.0, "", e))
    if not chance < DOUBT:
        return []
    ends = float(x.min()), float(x.max())
    low, high = np.polyval(np.polyfit(x, e, 1), ends)
    takes = "fit the impacts at each angle alone, with # before the others"
    if max(low, high) > 1.0:
        takes = f"no law has more than 1: leave {name} out (--quantity), or check speeds and angles"
    elif any(chance < DOUBT and "speed" in column for chance, column, _ in found):
        speeds = BEYOND[0] * float(speed[rows].min()), BEYOND[1] * float(speed[rows].max())
        line = np.clip(np.polyval(np.polyfit(speed[rows], e, 1), speeds), 0.0, 1.0)
        pairs = ",".join(f"{v:.3g}:{one:.3g}" for v, one in zip(speeds, line, strict=True))
        takes = f"--restitution {pairs}, a table of the normal speed, takes it in place of one e"
    way, unit = "climbs" if high > low else "falls", "m/s" if "speed" in column else "degrees"
    return [
        f"{name}: the restitution {way} with {column}, from {low:.3g} at {ends[0]:.3g} to "
        f"{high:.3g} at {ends[1]:.3g} {unit}; {takes}"
    ]


def _mean(e: Array, error: Array | None) -> tuple[float, float]:
    """Return the mean of restitutions, and its distance from 1 if chance does not make that."""
    from scipy.special import ndtri, stdtrit  # only a fit needs scipy

    present = np.isfinite(e)
    e, number = e[present], int(present.sum())
    mean, reach = float(e.mean()), 0.0
    if error is not None:
        weights = error[present] ** -2.0
        mean = float(np.average(e, weights=weights))
        reach = float(ndtri(1.0 - DOUBT) / math.sqrt(weights.sum()))
    elif number > 1:
        reach = float(stdtrit(number - 1, 1.0 - DOUBT) * e.std(ddof=1) / math.sqrt(number))
    off = mean - 1.0
    return mean, off if abs(off) > max(reach, NUMERICAL) else 0.0


def unlikely_parameters(
    problem: Problem, intervals: Mapping[str, tuple[float, float]]
) -> list[str]:
    """Return a sentence for each parameter whose interval lies outside its plausible range."""
    columns = ", ".join([*problem.measured, "speed", "the radius"])
    return [
        f"{name} from {low:.3g} to {high:.3g} is unlikely, as of a pair that "
        f"{LIKELY[name][2]}: check the units of {columns}"
        for name, (low, high) in intervals.items()
        if name in LIKELY and (high < LIKELY[name][0] or low > LIKELY[name][1])
    ]
