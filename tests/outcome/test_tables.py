"""Tables for reading, row by row, of results made by hand."""

import math

import numpy as np
import pytest

from contactlab import HalfSpace, Scene, Status
from contactlab.outcome.tables import (
    CLOSED,
    answer,
    closing,
    largest_imbalance,
    number,
    scene_section,
    sections,
    sweep_section,
    time,
)
from tests.outcome.made import BALL, SOFT, plan, result, scene


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "-"), (math.nan, "-"), (np.float64("nan"), "-"), (1 / 3, "0.333333"), (-0.0, "0"),
        (-1e-300, "-1e-300"), (2, "2"), ("word", "word"), (np.float32(0.5), "0.5"),
        (math.inf, "inf"), (True, "True"),
    ],
)  # fmt: skip
def test_numbers_as_text(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (1.0, "1 s"), (0.9999, "1e+03 ms"), (0.5, "500 ms"), (1e-3, "1 ms"), (5e-4, "500 µs"),
        (1e-6, "1 µs"), (5e-7, "500 ns"), (0.0, "0 ns"), (61.25, "61.2 s"),
    ],
)  # fmt: skip
def test_times_as_text(seconds, text):
    assert time(seconds) == text


def test_the_answer():
    made = result(psi2_error_estimate=0.02)
    assert answer(made) == [
        ("psi2", "3"),
        ("numerical error of psi2", "about 0.02, estimated; at most 0.01, declared"),
        ("run time", "12.5 ms"),
    ]


def test_the_rows_of_a_scene():
    body = [["radius", "0.5", "m"], ["mass", "2", "kg"]]
    elastic = [["Young's modulus", "2e+09", "Pa"], ["Poisson's ratio", "0", "1"]]
    impact = [
        ["friction coefficient", "0.5", "1"], ["normal speed", "2", "m/s"],
        ["tangential velocity", "3", "m/s"], ["spin", "4", "rad/s"], ["psi1", "5", "1"],
        ["chi", "2.5", "1"],
    ]  # fmt: skip

    def rows(name, entries):
        return [[f"{name}: {entry}", *rest] for entry, *rest in entries]

    assert scene_section(scene()) == (
        ["", "value", "unit"],
        [*rows("sphere", body + elastic), *rows("struck sphere", body + elastic), *impact],
    )
    wall = scene_section(Scene(BALL, HalfSpace(SOFT), 0.5, 2.0)).rows
    assert wall[:6] == [*rows("sphere", body + elastic), *rows("half-space", elastic)]
    batch = scene(spin=[4.0, -4.0, 1.0], normal_speed=[2.0, 2.0, 2.0])
    assert ["spin", "-4 to 4", "rad/s"] in scene_section(batch).rows
    assert ["normal speed", "2", "m/s"] in scene_section(batch).rows
    bare = scene_section(Scene.nondimensional(psi1=3.0, chi=2.0)).rows
    assert bare == [
        ["friction coefficient", "1", "1"], ["normal speed", "1", "1"],
        ["tangential velocity", "3", "1"], ["spin", "0", "1"], ["psi1", "3", "1"],
        ["chi", "2", "1"],
    ]  # fmt: skip


def rounded(rows):
    return [[round(cell, 9) if isinstance(cell, float) else cell for cell in row] for row in rows]


def test_the_tables_of_an_impact():
    velocities, contact, energy = sections(result())
    angles = math.atan2(3.0, 2.0), math.atan2(2.8, -0.5)
    assert velocities.headings == ["", "before", "after", "unit"]
    assert rounded(velocities.rows) == [
        ["local angle psi", 5.0, 3.0, "1"],
        ["local tangential velocity", 5.0, 3.0, "m/s"],
        ["normal velocity", 2.0, 0.5, "m/s"],
        ["tangential velocity", 3.0, 2.8, "m/s"],
        ["spin", 4.0, 2.4, "rad/s"],
        ["angle of the path", *(round(math.degrees(angle), 9) for angle in angles), "deg"],
        ["target: normal velocity", 0.0, 1.5, "m/s"],
        ["target: tangential velocity", 0.0, 0.2, "m/s"],
        ["target: spin", 0.0, -1.6, "rad/s"],
    ]
    assert contact.headings == ["contact", "value", "unit"]
    assert rounded(contact.rows) == [
        ["chi", 2.5, "1"],
        ["normal restitution e", 0.5, "1"],
        ["tangential restitution e_t", 0.933333333, "1"],
        ["contact time", 0.001, "s"],
        ["largest contact radius", 0.0125, "m"],
        ["largest contact radius over R, C (9)", 0.05, "1"],  # R = 0.25 m
        ["largest normal force", 100.0, "N"],
    ]
    assert energy.headings == ["energy", "value", "unit"]
    assert rounded(energy.rows) == [
        ["start", 4.5, "J"],
        ["end", 1.4, "J"],
        ["loss of the normal motion", 1.5, "J"],
        ["friction work, added up", 1.5, "J"],
        ["imbalance", 0.1, "J"],
        ["imbalance / start", 0.022222222, "1"],
    ]
    closed = sections(result(planned=plan(unchecked=True)))[2]
    assert rounded(closed.rows[3:]) == [
        ["friction work, of the velocities", 1.5, "J"],
        ["imbalance", CLOSED, ""],
    ]


def test_the_tables_of_a_scene_without_bodies_have_no_units():
    bare = Scene.nondimensional(psi1=5.0, chi=2.5)
    velocities, contact, energy = sections(result(bare, friction_work=1.6))
    assert rounded(velocities.rows) == [
        ["local angle psi", 5.0, 3.0, "1"],
        ["local tangential velocity", 5.0, 3.0, "1"],
        ["normal velocity", 1.0, -1.0, "1"],
    ]
    assert [row[0] for row in contact.rows] == ["chi", "normal restitution e", "contact time"]
    assert {row[-1] for row in (*contact.rows, *energy.rows)} == {"1"}


def test_the_table_of_a_sweep():
    given = scene(tangential_velocity=[3.0, 3.0, -7.0])
    status = [Status.SUCCESS, Status.UNBALANCED, Status.SUCCESS]
    made = result(given, slip_velocity_change=[-2.0, -1.0, 2.0], status=status)
    varied = {"tangential_velocity": ("m/s", given.tangential_velocity)}
    table = sweep_section(made, varied)
    assert table.headings == [
        "tangential_velocity (m/s)", "psi1", "psi2", "normal_restitution",
        "tangential_restitution", "rebound_angle_deg (deg)", "rebound_spin (rad/s)",
        "friction_work (J)", "status",
    ]  # fmt: skip
    angles = [math.degrees(math.atan2(v, -0.5)) for v in (2.8, 2.9, -6.8)]
    assert rounded(table.rows) == rounded([
        [3.0, 5.0, 3.0, 0.5, 2.8 / 3.0, angles[0], 2.4, 1.5, "SUCCESS"],
        [3.0, 5.0, 4.0, 0.5, 2.9 / 3.0, angles[1], 3.2, 1.5, "UNBALANCED"],
        [-7.0, -5.0, -3.0, 0.5, 6.8 / 7.0, angles[2], 5.6, 1.5, "SUCCESS"],
    ])  # fmt: skip
    assert [row[1] for row in sweep_section(made, varied, most=2).rows] == [5.0, -5.0]
    bare = result(Scene.nondimensional(psi1=[1.0, 2.0], chi=1.0))
    assert sweep_section(bare, {"psi1": ("1", bare.scene.psi1)}).headings == [
        "psi1", "psi2", "normal_restitution", "friction_work", "status",
    ]  # fmt: skip


def test_the_largest_imbalance_of_a_batch():
    """Of 4.5 J at the start 1.6 J are lost by slip, and 1.5, 1.7 or 1.6 J are booked."""
    given = scene(spin=[4.0, 4.0, 4.0])

    def told(unchecked):
        work = [1.5, 1.75, 1.6]
        return largest_imbalance(
            result(given, friction_work=work, planned=plan((3,), unchecked=unchecked))
        )

    assert told(False) == "largest energy imbalance / start: 0.0333"
    assert told([False, True, False]) == (
        "largest energy imbalance / start: 0.0222; closed by construction, not checked: 1 of 3 "
        "impacts"
    )
    assert told(True) == "energy books: closed by construction, not checked: 3 of 3 impacts"


LAWS = (
    "laws",
    "hertz (contactlab 0.1.0) [normal], springs (contactlab 0.1.0) [tangential], symplectic "
    "(contactlab 0.1.0) [integrator]",
)
WELL = ("status", "The impact was followed from first touch to separation.")
NOT_FINITE = "A law returned a value that is not a finite number."


def test_the_last_lines_of_an_impact():
    assert closing(result()) == [LAWS, ("counters", "none"), WELL]
    counted = result(counters={"steps": 7, "solves": 2})
    assert closing(counted)[1] == ("counters", "7 steps, 2 solves")
    failed = result(status=Status.NON_FINITE, detail="At step 3.")
    assert closing(failed)[2:] == [("status", f"{NOT_FINITE} At step 3.")]


def test_the_last_lines_of_a_batch_count_its_failures():
    """Three sentences, the most frequent first, and how many more there are."""
    details = ["", "a", "b", "b", "c", "d", "e"]
    status = [Status.SUCCESS] + [Status.NON_FINITE] * 6
    given = scene(spin=np.full(7, 4.0))
    detail = np.array(details, dtype=object)
    assert closing(result(given, status=status, detail=detail)) == [
        LAWS,
        ("counters", "none"),
        ("run time", "12.5 ms for 7 impacts"),
        WELL,
        ("status", f"{NOT_FINITE} b (2 impacts)"),
        ("status", f"{NOT_FINITE} a"),
        ("status", f"{NOT_FINITE} c"),
        ("status", "... and 2 more sentences"),
    ]
    few = result(given.take(slice(1, 5)), status=status[1:5], detail=detail[1:5])
    assert [words for _, words in closing(few)[3:]] == [
        f"{NOT_FINITE} b (2 impacts)", f"{NOT_FINITE} a", f"{NOT_FINITE} c",
    ]  # fmt: skip
