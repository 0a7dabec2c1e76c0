"""Impacts on bodies that move: columns of the laboratory, against collisions in space."""

import numpy as np
import pytest

import contactlab
from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    read_scene,
)
from contactlab.cli.main import main
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit import fit, read_measurements
from tests.longer import longer
from tests.present import of_commands

STEEL = Material.named("steel")
BALL, OTHER = Sphere(0.01, STEEL), Sphere(0.025, STEEL, mass=0.04)
FRICTION = 0.15
SPIN, TARGET_SPIN = 30.0, 40.0
ANGLES = np.array([5.0, 12.0, 20.0, 30.0, 45.0, 60.0])
SPEED, SURFACE = 2.0, np.array([-1.5, -0.4])


def columns(target):
    """Return what a camera at rest sees of a ball that meets a moving body: normal is -z."""
    angle, n = np.radians(ANGLES), len(ANGLES)
    velocity = SPEED * np.stack([np.sin(angle), 0 * angle, -np.cos(angle)], axis=-1)
    turning = isinstance(target, Sphere)
    spin2 = np.array([0.0, -TARGET_SPIN if turning else 0.0, 0.0])
    frame = np.array([SURFACE[1], 0.0, -SURFACE[0]])
    met = Encounter(
        BALL, target, friction_coefficient=FRICTION, normal=[0, 0, -1], velocity=velocity,
        spin=[0.0, -SPIN, 0.0], target_velocity=frame, target_spin=spin2,
    )  # fmt: skip
    after = contactlab.collide(met)
    # the surface of a sphere of radius R2 above which the normal points: centre + omega x R2 z
    rim = np.cross(spin2, [0, 0, target.radius])[0] if turning else 0.0
    return {
        "normal_speed (m/s)": -velocity[:, 2],
        "tangential_velocity (m/s)": velocity[:, 0],
        "spin (rad/s)": np.full(n, SPIN),
        "target_normal_velocity (m/s)": np.full(n, SURFACE[0]),
        "target_tangential_velocity (m/s)": np.full(n, SURFACE[1] + rim),
        "rebound_normal_velocity (m/s)": -after.velocity[:, 2],
        "rebound_tangential_velocity (m/s)": after.velocity[:, 0],
        "rebound_spin (rad/s)": -after.spin[:, 1],
    }


@pytest.mark.parametrize("target", [*longer(HalfSpace(STEEL)), OTHER], ids=["plate", "ball"])
def test_friction_of_a_struck_body_that_moves(target):
    data = columns(target)
    bodies = Scene(BALL, target, friction_coefficient=0.5, normal_speed=1.0)
    found = fit(data, bodies)
    assert found["friction_coefficient"] == pytest.approx(FRICTION, rel=2e-3)
    polar = {k: v for k, v in data.items() if "normal_v" not in k or k.startswith("target")}
    out_n, out_t = data["rebound_normal_velocity (m/s)"], data["rebound_tangential_velocity (m/s)"]
    del polar["rebound_tangential_velocity (m/s)"]
    del polar["normal_speed (m/s)"], polar["tangential_velocity (m/s)"]
    polar |= {"speed (m/s)": np.full(len(ANGLES), SPEED), "angle_deg": ANGLES,
              "rebound_speed (m/s)": np.hypot(out_n, out_t),
              "rebound_angle_deg": np.degrees(np.arctan2(out_t, -out_n))}  # fmt: skip
    again = fit(polar, bodies)
    assert again["friction_coefficient"] == pytest.approx(found["friction_coefficient"], rel=1e-6)


def test_a_ball_at_rest_struck_by_a_plate_is_a_ball_that_strikes_it():
    """Galileo: the same spin, velocities less by that of the plate."""
    v, angle = 3.0, np.radians([10.0, 25.0, 40.0])
    plate = HalfSpace(STEEL)
    scene = Scene(BALL, plate, 0.2, v * np.cos(angle), v * np.sin(angle))
    result = Simulation().sweep(scene)
    zero = np.zeros(3)
    read = read_measurements({
        "normal_speed (m/s)": zero, "tangential_velocity (m/s)": zero,
        "target_normal_velocity (m/s)": -v * np.cos(angle),
        "target_tangential_velocity (m/s)": -v * np.sin(angle),
        "rebound_tangential_velocity (m/s)": result.rebound_tangential_velocity - v * np.sin(angle),
    })  # fmt: skip
    np.testing.assert_allclose(read.given["speed"], v)
    np.testing.assert_allclose(read.given["angle_deg"], np.degrees(angle))
    np.testing.assert_allclose(
        read.measured["rebound_tangential_velocity"], result.rebound_tangential_velocity
    )


CLUB = """[sphere]
radius = 0.0213
mass = 0.0459
material = {{ young_modulus = 80e6, poisson_ratio = 0.45 }}
[target]
kind = "body"
mass = 0.2
principal = [2.5e-4, 4e-4, 3e-4]
curvature_radius = inf
material = "mild steel"
[impact]
normal = [-1, 0, 0]
along = [0, 0, 1]
target_contact = {contact}
{moving}
"""
FRAME = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]  # normal, along, normal x along
FACE = np.array([[-40.0, -4.0], [-41.0, -8.0], [-38.0, -12.0], [-40.0, -17.0], [-39.0, -24.0]])


def swings(contact, face, turning, ball_along=0.0):
    """Return the ball of CLUB after swings at it, along normal and tangent."""
    n, t, across = np.array(FRAME)
    ball = Sphere(0.0213, Material(young_modulus=80e6, poisson_ratio=0.45), mass=0.0459)
    club = RigidBody(
        mass=0.2, inertia=np.diag([2.5e-4, 4e-4, 3e-4]), curvature_radius=np.inf,
        material=Material.named("mild steel"),
    )  # fmt: skip
    met = Encounter(
        ball, club, 0.31, normal=n, velocity=np.outer(ball_along * np.ones(len(face)), t),
        target_contact=contact,
        target_velocity=face[:, :1] * n + face[:, 1:] * t, target_spin=turning * across,
    )  # fmt: skip
    after = contactlab.collide(met)
    return {
        "rebound_normal_velocity (m/s)": after.velocity @ n,
        "rebound_tangential_velocity (m/s)": after.velocity @ t,
        "rebound_spin (rad/s)": after.spin @ across,
    }


@pytest.mark.parametrize(
    ("contact", "turning", "told"),
    [
        pytest.param([0.02, *off], turning, told, marks=() if fast else pytest.mark.slow)
        for off in ([0.0, 0.0], [0.0, 0.01], [0.015, 0.0])
        for turning in (0.0, 60.0)
        for told in ("columns", "file")
        for fast in [off == [0.0, 0.01] and turning == 60.0]
    ],
)
def test_friction_of_a_ball_that_a_club_strikes(contact, turning, told, tmp_path):
    """In the middle of its face, below it, and off the toe, where slip turns; a club that turns."""
    rest = np.zeros(len(FACE))
    face, ball_along = FACE, rest
    if told == "file":
        face, ball_along = np.broadcast_to([-40.0, -2.0], FACE.shape), np.linspace(2.0, 20.0, 5)
    after = swings(contact, face, turning, ball_along)
    data = {"normal_speed (m/s)": rest, "tangential_velocity (m/s)": ball_along} | after
    moving = ""
    if told == "columns":
        data |= dict(zip(
            ("target_normal_velocity (m/s)", "target_tangential_velocity (m/s)",
             "target_spin (rad/s)"),
            (*face.T, rest + turning), strict=True,
        ))  # fmt: skip
    else:
        moving = (
            f"target_normal_velocity = {face[0, 0]}\n"
            f"target_tangential_velocity = {face[0, 1]}\ntarget_spin = {turning}"
        )
    path = tmp_path / "club.toml"
    path.write_text(CLUB.format(contact=contact, moving=moving), encoding="utf-8")
    found = fit(data, path)
    assert found["friction_coefficient"] == pytest.approx(0.31, rel=1e-6)
    assert not [note for note in found.notes if "restitution" in note]
    # rounding and scatter apart, the club of a file runs as that of the columns
    if told == "file":
        lab = f"normal_speed = 0.0\ntangential_velocity = {ball_along[0]}\n{moving}"
        lab += "\nfriction_coefficient = 0.31"
        path.write_text(CLUB.format(contact=contact, moving=lab), encoding="utf-8")
        scene = read_scene(path).scene
        result = Simulation().run(scene).check()
        u = face[0] + turning * np.array([-contact[2], -contact[0]])
        rebound = [result.rebound_normal_velocity + u[0], result.rebound_tangential_velocity + u[1]]
        expected = [after[f"rebound_{way}_velocity (m/s)"][0] for way in ("normal", "tangential")]
        assert rebound == pytest.approx(expected, rel=1e-9)
        spin = QUANTITIES["rebound_spin"].of(result)
        assert spin == pytest.approx(after["rebound_spin (rad/s)"][0], rel=1e-9)
        e_t = (expected[1] - u[1]) / (ball_along[0] - u[1])
        assert result.tangential_restitution == pytest.approx(e_t, rel=1e-9)


def test_columns_beside_a_scene_of_vectors_are_refused():
    """They would change its numbers, and not the velocities in space that go with them."""
    block = RigidBody(mass=1.0, inertia=np.eye(3), material=STEEL, curvature_radius=np.inf)
    met = Encounter(
        BALL, block, 0.2, normal=[0, 0, -1], velocity=[0.3, 0, -1.0], target_contact=[0, 0, 0.1]
    )
    data = {"speed (m/s)": [1.0, 1.0], "angle_deg": [9.0, 30.0], "beta0": [0.1, 0.5]}
    with pytest.raises(ValueError, match="give the TOML file of the bodies, with along"):
        fit(data, met.scene)


@pytest.mark.slow
def test_a_spinning_ball_that_is_struck():
    """Its surface moves against its spin, as the convention of spins that add to slip has it."""
    turning = columns(OTHER)
    rim = TARGET_SPIN * OTHER.radius
    data = dict(turning)
    data["target_tangential_velocity (m/s)"] = turning["target_tangential_velocity (m/s)"] + rim
    data["target_spin (rad/s)"] = np.full(len(ANGLES), TARGET_SPIN)
    bodies = Scene(BALL, OTHER, friction_coefficient=0.5, normal_speed=1.0)
    assert fit(data, bodies)["friction_coefficient"] == pytest.approx(
        fit(turning, bodies)["friction_coefficient"], rel=1e-9
    )
    with pytest.raises(ValueError, match="does not spin"):
        fit(data, Scene(BALL, HalfSpace(STEEL), friction_coefficient=0.5, normal_speed=1.0))


FIRST = {
    "ball": "[sphere]\nradius = 0.01\nmaterial = 'steel'\n",
    "rod": "[body]\nshape = 'rod'\nlength = 1.0\nradius = 0.02\nmaterial = 'steel'\n",
}
OF_THE_ROD = "normal = [0, 0, -1]\nalong = [1, 0, 0]\n"


@pytest.mark.parametrize("command", of_commands("fit", "compare", "report"))
@pytest.mark.parametrize("body", FIRST)
def test_a_half_space_does_not_spin_at_any_door_of_measurements(tmp_path, capsys, body, command):
    """Under a ball this was refused, under a rod it was passed over."""
    scene, data = tmp_path / "scene.toml", tmp_path / "spins.csv"
    scene.write_text(
        f"{FIRST[body]}[target]\nkind = 'half-space'\nmaterial = 'steel'\n[impact]\n"
        f"{OF_THE_ROD if body == 'rod' else ''}speed = 1.0\nangle_deg = 9.0\n"
        "friction_coefficient = 0.3\n", "utf-8",
    )  # fmt: skip
    data.write_text("angle_deg,target_spin (rad/s),beta0\n9,0,0.1\n20,30,0.3\n", "utf-8")
    out = ["--out", str(tmp_path / "page.html")] if command == "report" else []
    given = [str(data), str(scene)] if command == "fit" else [str(scene), "--measured", str(data)]
    assert main([command, *given, *out]) == 2
    told = "spins.csv: target_spin = 30.0: must be zero: a half-space does not spin"
    assert told in capsys.readouterr().err


@pytest.mark.slow
def test_a_spin_of_zero_is_that_of_a_half_space():
    data = columns(HalfSpace(STEEL))
    bodies = Scene(BALL, HalfSpace(STEEL), friction_coefficient=0.5, normal_speed=1.0)
    still = data | {"target_spin (rad/s)": np.zeros(len(ANGLES))}
    assert fit(still, bodies).parameters == fit(data, bodies).parameters


MOVING = {"speed (m/s)": [2.0], "angle_deg": [20.0], "target_normal_velocity (m/s)": [-1.0]}


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"target_normal_velocity (m/s)": [-1.0], "rebound_spin (rad/s)": [1.0]},
         "needs columns for the velocity"),
        (MOVING | {"rebound_angle_deg": [9.0]}, "are needed together"),
        (MOVING | {"local_rebound_angle_deg": [9.0]}, "is not the same to a struck body"),
        (MOVING | {"tangential_restitution": [0.9], "tangential_restitution_error": [0.1]},
         "cannot be taken to a moving body"),
        (MOVING | {"target_normal_velocity (m/s)": [9.0], "rebound_spin (rad/s)": [1.0]},
         "in impact 1 the bodies part"),
        (MOVING | {"target_normal_velocity": [9.0], "rebound_spin (rad/s)": [1.0]}, "has no unit"),
    ],
)  # fmt: skip
def test_what_cannot_be_taken_to_a_moving_body(columns, words):
    with pytest.raises(ValueError, match=words):
        read_measurements(columns)


def test_a_moving_body_beside_laws(tmp_path, capsys):
    """The scene has the relative speed; the angles are relative too."""
    data, scene = tmp_path / "club.csv", tmp_path / "club.toml"
    rows = "".join(f"0,0,{-3 * np.cos(a)},{-3 * np.sin(a)},{-40 * a}\n" for a in (0.2, 0.4, 0.6))
    heads = "normal_speed (m/s),tangential_velocity (m/s),target_normal_velocity (m/s)"
    data.write_text(
        f"{heads},target_tangential_velocity (m/s),rebound_spin (rad/s)\n{rows}", "utf-8"
    )
    scene.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'sphere'\nmass = 0.2\n"
        "radius = 1.0\nmaterial = 'steel'\n[impact]\nspeed = 3.0\nangle_deg = 10.0\n"
        "friction_coefficient = 0.2\n", "utf-8",
    )  # fmt: skip
    assert main(["compare", str(scene), "--measured", str(data), "--tangential", "springs"]) == 0
    assert "rebound_spin" in capsys.readouterr().out
