"""Thirty slips of a person: measurements by the exact law with scatter, and what was then done.

Each writes the CSV and the TOML file that a person would have. A slip counts as told only if one
sentence (a note of the fit, or its refusal) names the column or the impacts to look at.
"""

import re
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from contactlab import HalfSpace, Scene, Simulation, Sphere, create
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit import fit
from tests.fitting.impacts import STEEL

FRICTION, RESTITUTION = 0.12, 0.9
WIDE = np.array([3.0, 6.1, 9.2, 13.0, 17.1, 21.0, 26.2, 31.0, 38.1, 45.0, 55.2, 66.0])
TEN = np.delete(WIDE, [3, 8])
STEEP = np.linspace(48.0, 70.0, 10).round(1)
#: Relative scatter of what is measured, and of the speed of the shots.
SCATTER, SHOTS = 0.01, 0.02
RPM = 2.0 * np.pi / 60.0


class File(NamedTuple):
    """A table as a person has it, the bodies, and how it is fitted."""

    columns: dict[str, Any]
    radius: float = 0.01
    young_modulus: float = 207e9
    laws: Simulation | None = None
    parameters: tuple[str, ...] = ("friction_coefficient",)


def true(*names, series, seed, angles=WIDE, spin=None, friction=FRICTION, cartesian=False):
    """Return a true measurement of these quantities, rounded as people round."""
    rng = np.random.default_rng([series, seed])
    speeds = 2.0 * (1.0 + SHOTS * rng.uniform(-1.0, 1.0, len(angles))).round(3)
    radians = np.radians(angles)
    damped = "normal_restitution" in names
    scene = Scene(
        Sphere(0.01, STEEL), HalfSpace(STEEL), friction,
        speeds * np.cos(radians), speeds * np.sin(radians), 0.0 if spin is None else spin,
    )  # fmt: skip
    laws = Simulation(tangential="fronts")
    if damped:
        laws = Simulation(normal=create("normal.viscoelastic", restitution=RESTITUTION))
    rebounds = laws.sweep(scene).check()
    columns: dict[str, Any] = {"angle_deg": angles, "speed (m/s)": speeds}
    if cartesian:
        columns = {
            "normal_speed (m/s)": scene.normal_speed.round(4),
            "tangential_velocity (m/s)": scene.tangential_velocity.round(4),
        }
    if spin is not None:
        columns["spin (rad/s)"] = spin
    for name in names:
        values = QUANTITIES[name].of(rebounds)
        unit = QUANTITIES[name].unit
        column = name if unit == "1" or name.endswith("_deg") else f"{name} ({unit})"
        noise = SCATTER * np.abs(values).max() * rng.standard_normal(len(angles))
        columns[column] = np.array([float(f"{value:.4g}") for value in values + noise])
    fits = {}
    if damped:
        fits = {
            "laws": Simulation(normal="viscoelastic"),
            "parameters": ("friction_coefficient", "restitution"),
        }
    return File(columns, **fits)


def changed(file, heading, numbers, *, to=None):
    """Return a file with other numbers in a column, or another heading over them."""
    columns = {}
    for name, values in file.columns.items():
        if name != heading:
            columns[name] = values
            continue
        columns[to or name] = numbers(np.array(values)) if callable(numbers) else numbers
    return file._replace(columns=columns)


def exchanged(file, one, other):
    """Return a file with the numbers of two columns exchanged."""
    columns = dict(file.columns)
    columns[one], columns[other] = columns[other], columns[one]
    return file._replace(columns=columns)


def moved(rows, off):
    """Return a change of some rows (from 1) of a column by a number or numbers."""

    def change(values):
        values[np.array(rows) - 1] += off
        return values

    return change


def drifted(measured):
    """Return a series whose friction has halved after its first half: the plate was oiled."""
    order = np.random.default_rng(8).permutation(len(WIDE))
    before, after = (measured("rebound_spin", seed=28, friction=mu) for mu in (0.12, 0.06))
    half = np.arange(len(WIDE)) < len(WIDE) // 2
    spins = [one.columns["rebound_spin (rad/s)"][order] for one in (before, after)]
    columns = {name: values[order] for name, values in before.columns.items()}
    columns["rebound_spin (rad/s)"] = np.where(half, *spins)
    return before._replace(columns=columns)


E_T, E_N = "tangential_restitution", "normal_restitution"
ANGLE, SPIN = "rebound_angle_deg", "rebound_spin (rad/s)"
BACKSPIN = np.linspace(-150.0, 120.0, 12).round(1)
POINTS = r"impacts? .*"
#: What the refusal of a file begins with: its name tells nothing.
PATH = re.compile(r"^\S+\.(csv|toml): ")


def complement(values):
    return (90.0 - values).round(3)


def radians(values):
    return np.radians(values).round(4)


def slips(series=30):
    """Return by name: the file with the slip in it, and what one sentence has to name."""
    measured = partial(true, series=series)
    spinning = measured("rebound_spin", spin=BACKSPIN, seed=31)
    both = measured(ANGLE, seed=9)
    shifted = measured(E_T, seed=21).columns
    rows = list(zip(shifted["angle_deg"], shifted["speed (m/s)"], shifted[E_T], strict=True))
    cells = [f"{a},{v}".replace(".", ",", 2).split(",")[-2:] for a, v, _ in rows]
    comma = {
        "angle_deg": shifted["angle_deg"],
        "speed (m/s)": np.array([float(whole) for whole, _ in cells]),
        E_T: np.array([float(part) for _, part in cells]),
        "#remark": shifted[E_T],
    }
    return {
        "incidence in radians": (
            changed(measured(E_T, seed=1), "angle_deg", radians), "angle_deg"),
        "incidence in degrees, heading says radians": (
            changed(measured(E_T, seed=2), "angle_deg", WIDE, to="angle (rad)"), "angle"),
        "rebound angle in radians": (
            changed(measured(ANGLE, seed=3), ANGLE, radians), ANGLE),
        "spin in rpm": (
            changed(measured("rebound_spin", seed=4), SPIN, lambda v: (v / RPM).round(1)),
            "rebound_spin"),
        "spin in rad/s, heading says rpm": (
            changed(measured("rebound_spin", seed=5), SPIN, lambda v: v, to="rebound_spin (rpm)"),
            "rebound_spin"),
        "spin in rev/s, beside the rebound angle": (
            changed(measured(ANGLE, "rebound_spin", seed=6), SPIN,
                    lambda v: (v / (2.0 * np.pi)).round(2)), "rebound_spin"),
        "incidence from the surface": (
            changed(measured(E_T, seed=7), "angle_deg", complement), "angle_deg"),
        "rebound angle from the surface": (
            changed(measured(ANGLE, seed=8), ANGLE, complement), ANGLE),
        "both angles from the surface": (
            changed(changed(both, "angle_deg", complement), ANGLE, complement), "angle_deg"),
        "speed in mm/s, all in gross slip": (
            changed(measured("rebound_spin", angles=STEEP, seed=10), "speed (m/s)",
                    lambda v: 1e3 * v), r"speed|rebound_spin|friction_coefficient"),
        "speed in km/h, spin and e_t": (
            changed(measured(E_T, "rebound_spin", seed=11), "speed (m/s)",
                    lambda v: (3.6 * v).round(2)), r"\bspeed|rebound_spin"),
        "radius in mm": (
            measured("rebound_spin", E_T, seed=12)._replace(radius=10.0), "radius|rebound_spin"),
        "diameter for radius": (
            measured("rebound_spin", seed=13)._replace(radius=0.02), "radius|rebound_spin"),
        "sign of the spin": (
            changed(measured("rebound_spin", seed=14), SPIN, lambda v: -v), "rebound_spin"),
        "sign of the spin in three of twelve": (
            changed(measured("rebound_spin", seed=15), SPIN,
                    lambda v: v * np.where(np.isin(np.arange(12), [3, 7, 10]), -1.0, 1.0)),
            POINTS + r"\b4\b.*\b8\b.*\b11\b"),
        "normal and tangential speed exchanged": (
            exchanged(measured(E_T, seed=16, cartesian=True),
                      "normal_speed (m/s)", "tangential_velocity (m/s)"),
            "normal_speed|tangential_velocity"),
        "restitutions exchanged": (
            exchanged(measured(E_T, E_N, seed=17), E_T, E_N), f"{E_T}|{E_N}"),
        "three bad of ten, all too high": (
            changed(measured(E_T, angles=TEN, seed=18), E_T, moved([3, 5, 9], 0.12)),
            POINTS + r"\b3\b.*\b5\b.*\b9\b"),
        "three bad of ten, either way": (
            changed(measured(E_T, angles=TEN, seed=19), E_T, moved([2, 6, 8], [0.2, -0.15, -0.2])),
            POINTS + r"\b2\b.*\b6\b.*\b8\b"),
        "one gross outlier at the end": (
            changed(measured(E_T, angles=TEN, seed=20), E_T, moved([10], -0.4)),
            POINTS + r"\b10\b"),
        "decimal comma moves a column": (
            File(comma), E_T),
        "restitution in percent": (
            changed(measured(E_T, seed=22), E_T, lambda v: 100.0 * v), E_T),
        "rebounds a row too low": (
            changed(measured(E_T, seed=23), E_T, lambda v: np.roll(v, 1)), E_T),
        "angle of the contact point for that of the centre": (
            changed(measured("local_rebound_angle_deg", seed=24), "local_rebound_angle_deg",
                    lambda v: v, to=ANGLE), ANGLE),
        "restitution of slip for that of the centre": (
            changed(measured("beta0", seed=25), "beta0",
                    lambda v: v, to=E_T), E_T),
        "errors in percent": (
            measured(E_T, seed=26)._replace(
                columns=measured(E_T, seed=26).columns | {f"{E_T}_error": np.full(12, 1.0)}),
            f"{E_T}_error|errors given"),
        "protractor off by six degrees": (
            changed(measured(E_T, seed=27), "angle_deg", lambda v: v + 6.0), "angle_deg"),
        "the plate was oiled half way": (
            drifted(measured), POINTS + r"\band 7\b"),
        "spin before in rpm": (
            changed(spinning, "spin (rad/s)", (BACKSPIN / RPM).round(1)), r"(?<!rebound_)\bspin"),
        "sign of the spin before": (
            changed(spinning, "spin (rad/s)", -BACKSPIN), r"(?<!rebound_)\bspin"),
    }  # fmt: skip


class Answer(NamedTuple):
    """What came of a file: sentences; whether it was refused; whether its interval is wrong."""

    sentences: tuple[str, ...]
    refused: bool
    wrong: bool


def answer(file, folder):
    """Write the two files and fit them, as the command does."""
    table, bodies = folder / "impacts.csv", folder / "bodies.toml"
    lines = [",".join(map(str, row)) for row in zip(*file.columns.values(), strict=True)]
    table.write_text("\n".join([",".join(file.columns), *lines]) + "\n", encoding="utf-8")
    material = f"{{ young_modulus = {file.young_modulus}, poisson_ratio = 0.3, density = 7850.0 }}"
    bodies.write_text(
        f"[sphere]\nradius = {file.radius}\nmaterial = {material}\n"
        f'[target]\nkind = "half-space"\nmaterial = {material}\n[impact]\nspeed = 2.0\n',
        encoding="utf-8",
    )
    try:
        found = fit(table, bodies, parameters=list(file.parameters), simulation=file.laws)
    except ValueError as error:
        return Answer((str(error),), True, False)
    low, high = found.parameters["friction_coefficient"].interval
    return Answer(found.notes, False, not low <= FRICTION <= high)


def is_told(one, words):
    """Return whether one sentence names what to look at, its advice on further impacts apart.

    A sentence on single impacts does not tell of a column.
    """
    sentences = [re.sub(PATH, "", text).partition("; measure ")[0] for text in one.sentences]
    if not words.startswith(POINTS):
        sentences = [text for text in sentences if not re.search(r"impacts? \d", text)]
    return any(re.search(words, text) for text in sentences)


def kind(one, words):
    """Return how a slip went: told, silent, refused without the column, or other words."""
    if is_told(one, words):
        return "told"
    if one.refused:
        return "refused without naming it"
    if not one.sentences:
        return "silent and wrong" if one.wrong else "silent, truth inside"
    return "said something else"
