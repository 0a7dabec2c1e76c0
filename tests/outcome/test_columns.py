"""Every column of a result, worked out by hand, and the files that are made of them, as written."""

import json
import math

import numpy as np
import pytest

from contactlab import HalfSpace, Scene, Status
from contactlab.outcome.columns import (
    QUANTITIES,
    columns,
    csv_heading,
)
from contactlab.outcome.export import write_csv, write_history_csv, write_json, write_npz
from contactlab.outcome.history import History
from tests.outcome.made import BALL, LAWS, SOFT, plan, result, scene

#: Half of the loss of the approach, 3/2 m/s, goes to each ball. A drag of 0.2 kg times 2 m/s
#: changes the velocity of each by 0.2 m/s, and the spin by 0.4/(2 · 0.5² · 0.5) = 1.6 rad/s.
BY_HAND = {
    "psi1": ("1", 5.0),
    "chi": ("1", 2.5),
    "psi2": ("1", 3.0),
    "normal_speed": ("m/s", 2.0),
    "tangential_velocity": ("m/s", 3.0),
    "spin": ("rad/s", 4.0),
    "rebound_normal_velocity": ("m/s", 0.5),
    "rebound_tangential_velocity": ("m/s", 2.8),
    "rebound_spin": ("rad/s", 2.4),
    "target_rebound_normal_velocity": ("m/s", 1.5),
    "target_rebound_tangential_velocity": ("m/s", 0.2),
    "target_rebound_spin": ("rad/s", -1.6),
    "rebound_slip_velocity": ("m/s", 3.0),
    "normal_restitution": ("1", 0.5),
    "tangential_restitution": ("1", 2.8 / 3.0),
    "beta0": ("1", -0.6),
    "incidence_angle": ("rad", math.atan2(3.0, 2.0)),
    "rebound_angle": ("rad", math.atan2(2.8, -0.5)),
    "local_rebound_angle": ("rad", math.atan2(3.0, 1.0)),
    "contact_time": ("s", 1e-3),
    "normal_loss": ("J", 1.5),
    "friction_work": ("J", 1.25),
    "shear_loss": ("J", 0.25),
    "energy_imbalance": ("J", 0.1),
}


def test_the_columns_of_two_balls():
    """Slip loses 0.2 · 2 · (5 - 1) = 1.6 J: friction 1.25 J, shear 0.25 J, and 0.1 J unbooked."""
    made = result()
    found = {name: (unit, value) for name, unit, value in columns(made)}
    assert list(found) == [*BY_HAND, "status"]
    for name, (unit, value) in BY_HAND.items():
        assert found[name] == (unit, pytest.approx(value, rel=1e-14)), name
    assert found["status"] == ("", Status.SUCCESS)
    books = made.energy.to_dict()
    assert books == {
        "start": pytest.approx(4.5), "end": pytest.approx(1.4),
        "normal_loss": 1.5, "friction_work": 1.25, "shear_loss": 0.25, "checked": True,
        "imbalance": pytest.approx(0.1), "relative_imbalance": pytest.approx(0.1 / 4.5),
    }  # fmt: skip
    assert made.rebound_speed == pytest.approx(math.hypot(0.5, 2.8))
    assert made.psi_change == -2.0
    assert QUANTITIES["rebound_angle_deg"].read(made) == pytest.approx(
        math.degrees(math.atan2(2.8, -0.5))
    )


def test_the_columns_of_a_batch_are_those_of_its_impacts():
    given = scene(tangential_velocity=[3.0, 3.0, -7.0], spin=[4.0, 4.0, 4.0])
    made = result(given, slip_velocity_change=[-2.0, -2.0, 2.0])
    for name, (_, value) in BY_HAND.items():
        first = QUANTITIES[name].of(made)
        assert first.shape == (3,)
        assert first[:2] == pytest.approx([value, value], rel=1e-14), name
        assert QUANTITIES[name].of(made[1]) == pytest.approx(value, rel=1e-14)
    assert made[2].psi2 == pytest.approx(-3.0)
    assert made[2].target_rebound_spin == pytest.approx(1.6)


def test_what_a_scene_does_not_define_is_no_number():
    bare = Scene.nondimensional(psi1=[1.0, 2.0], chi=1.0)
    made = result(bare)
    undefined = [name for name, _, value in columns(made) if value is None]
    assert undefined == [
        "rebound_tangential_velocity", "rebound_spin", "target_rebound_normal_velocity",
        "target_rebound_tangential_velocity", "target_rebound_spin", "tangential_restitution",
        "rebound_angle",
    ]  # fmt: skip
    assert np.isnan(QUANTITIES["rebound_spin"].of(made)).tolist() == [True, True]
    assert QUANTITIES["rebound_angle_deg"].read(made) is None
    wall = result(Scene(BALL, HalfSpace(SOFT), 0.5, 2.0, 3.0))
    assert wall.target_rebound_normal_velocity == 0.0
    assert math.copysign(1.0, wall.target_rebound_tangential_velocity) == 1.0
    units = {name: QUANTITIES[name].unit_in(bare) for name in ("spin", "rebound_angle", "psi1")}
    assert units == {"spin": "1", "rebound_angle": "rad", "psi1": "1"}
    assert QUANTITIES["rebound_angle_deg"].unit_in(bare) == "deg"
    assert QUANTITIES["spin"].unit_in(scene()) == "rad/s"
    headings = [csv_heading(*given) for given in (("spin", "rad/s", bare), ("status", "", bare))]
    assert headings == ["spin (1)", "status"]


HISTORY = {
    "time": [1e-4, 5e-4], "approach": [1e-4, 1e-3], "normal_velocity": [1.5, 0.0],
    "normal_force": [50.0, 100.0], "contact_radius": [0.01, 0.0125], "slip_velocity": [4.5, 4.0],
    "tangential_force": [25.0, 40.0],
}  # fmt: skip


def course(**fields):
    return History(**{name: np.array(values) for name, values in HISTORY.items()}, fields=fields)


def test_a_result_as_json(tmp_path):
    planned = plan(error=0.01, cautions=("doubt: one",))
    made = result(
        planned=planned, psi2_error_estimate=0.02, counters={"steps": 7}, detail="",
        history=course(traction=np.array([1.0, math.nan])),
    )  # fmt: skip
    write_json(made, tmp_path / "a.json")
    text = (tmp_path / "a.json").read_text(encoding="utf-8")
    assert text.startswith('{\n  "psi1": 5.0,\n  "chi": 2.5,\n  "psi2": 3.0,\n')
    assert text.endswith("}\n")
    content = json.loads(text)
    rest = {name: content[name] for name in list(content)[len(BY_HAND) :]}
    assert rest == {
        "status": "SUCCESS",
        "detail": "",
        "psi2_error_estimate": 0.02,
        "restitution_error_estimate": None,
        "run_time_s": 0.0125,
        "energy": made.energy.to_dict(),
        "counters": {"steps": 7},
        "laws": LAWS,
        "plan": {
            "computed": ["normal motion: Hertz"],
            "left_out": [],
            "cautions": ["doubt: one"],
            "psi2_error": 0.01,
            "restitution_error": None,
        },
        "history": HISTORY | {"traction": [1.0, None]},
    }
    assert "history" not in made.to_dict()
    assert result().to_dict()["psi2_error_estimate"] is None


def test_a_result_as_csv(tmp_path):
    given = scene(tangential_velocity=[3.0, -7.0])
    failed = [Status.SUCCESS, Status.UNBALANCED]
    made = result(given, slip_velocity_change=[-2.0, math.nan], status=failed)
    write_csv(made, tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    names = [f"{name} ({unit})" for name, (unit, _) in BY_HAND.items()]
    assert lines[0] == ",".join([*names, "status"])
    first, second = (line.split(",") for line in lines[1:])
    assert [float(cell) for cell in first[:-1]] == pytest.approx(
        [value for _, value in BY_HAND.values()]
    )
    assert (first[-1], second[-1]) == ("SUCCESS", "UNBALANCED")
    assert second[:5] == ["-5.0", "2.5", "nan", "2.0", "-7.0"]


def test_a_history_as_csv_and_a_result_as_npz(tmp_path):
    made = result(history=course(traction=np.array([1.0, 2.0])))
    write_history_csv(made, tmp_path / "h.csv")
    assert (tmp_path / "h.csv").read_text(encoding="utf-8").splitlines() == [
        "time (s),approach (m),normal_velocity (m/s),normal_force (N),contact_radius (m),"
        "slip_velocity (m/s),tangential_force (N)",
        "0.0001,0.0001,1.5,50.0,0.01,4.5,25.0",
        "0.0005,0.001,0.0,100.0,0.0125,4.0,40.0",
    ]
    write_npz(made, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as content:
        kept = {name: content[name].tolist() for name in content.files}
    assert kept["status"] == ["SUCCESS"]
    assert kept["rebound_spin"] == [pytest.approx(2.4)]
    assert kept["history_traction"] == [1.0, 2.0]
    assert {name: kept[f"history_{name}"] for name in HISTORY} == HISTORY
    assert len(kept) == len(BY_HAND) + 1 + len(HISTORY) + 1
    words = "result: has no history of a single impact; run(scene, history=True)"
    both = {name: np.array([values, values]).T for name, values in HISTORY.items()}
    batch = result(scene(spin=[4.0, 4.0]), history=History(**both))
    for bad in (result(), batch):
        with pytest.raises(ValueError, match=" ") as caught:
            write_history_csv(bad, tmp_path / "no.csv")
        assert str(caught.value) == words
    assert not (tmp_path / "no.csv").exists()
    assert batch[1].history.time.tolist() == HISTORY["time"]
    assert batch[:1].history.time.shape == (2, 1)
    assert repr(batch.history) == "History(2 instants to 0.0005 s; no fields)"
    assert repr(made.history) == "History(2 instants to 0.0005 s; traction)"
