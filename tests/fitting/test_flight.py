"""Impacts from films, made up by parabolas and by collisions that a fit does not compute with."""

import json

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Sphere
from contactlab.cli.main import main
from contactlab_fit import fit, read_flight
from contactlab_fit.beside import as_target_sees

G, RATE, NOISE = 9.80665, 240.0, 1e-3
FRICTION = 0.12
BALL, PLATE = Sphere(0.02, Material.named("steel")), HalfSpace(Material.named("steel"))
BODIES = Scene(BALL, PLATE, friction_coefficient=0.5, normal_speed=1.0)
HEADINGS = ("t (s)", "x (m)", "y (m)", "angle (deg)")


def legs(speeds, restitution):
    """Return (start, velocity x, y upwards, spin) of each flight of a ball that bounces five times.

    It touches first at time 0.
    """
    found = [(-0.12, *speeds, 0.0)]
    time, (vx, vy), spin = 0.0, speeds, 0.0
    for _ in range(5):
        met = Encounter(BALL, PLATE, friction_coefficient=FRICTION, normal=[0, -1, 0],
                        velocity=[vx, -abs(vy), 0], spin=[0, 0, spin])  # fmt: skip
        after = contactlab.collide(met, restitution=restitution)
        (vx, vy, _), spin = after.velocity, after.spin[2]
        found.append((time, vx, vy, spin))
        time += 2.0 * vy / G
    return found


def film(seed, noise=NOISE, restitution=1.0):
    """Return two throws of five bounces each: frames, and numbers before and after each impact."""
    generator = np.random.default_rng(seed)
    parts, impacts = [], []
    for throw, speeds in enumerate(((1.5, -1.6), (-0.9, -1.8))):
        flights = legs(speeds, restitution)
        t = np.arange(-0.12 + generator.uniform(0.0, 1.0 / RATE), flights[-1][0] + 0.2, 1.0 / RATE)
        x, y, angle = np.zeros((3, len(t)))
        place = turned = 0.0
        for k, (start, vx, vy, spin) in enumerate(flights):
            end = flights[k + 1][0] if k < 5 else np.inf
            now = (t >= start) & (t < end)
            dt = t[now] - (start if k else 0.0)  # the first flight ends at 0
            x[now], angle[now] = place + vx * dt, turned + spin * dt
            y[now] = BALL.radius + vy * dt - 0.5 * G * dt**2
            if 0 < k < 5:
                place, turned = place + vx * (end - start), turned + spin * (end - start)
                impacts.append(((vx, vy, spin), flights[k + 1][1:]))
            elif k == 0:
                impacts.append(((vx, -vy, spin), flights[1][1:]))
        x, y = (c + generator.normal(0.0, noise, len(t)) for c in (x, y))
        angle = angle + generator.normal(0.0, noise / BALL.radius, len(t))
        parts.append(np.stack([t + 100.0 * throw, x, y, np.degrees(angle) % 360.0]))
    return dict(zip(HEADINGS, np.concatenate(parts, axis=1), strict=True)), np.array(impacts)


def test_a_film_without_noise_gives_the_velocities_to_the_last_digits():
    frames, impacts = film(1, noise=0.0)
    found = read_flight(frames)
    columns = found.given | found.measured
    before, after = impacts[:, 0].T, impacts[:, 1].T
    assert len(found) == 10
    for name, expected in {
        "tangential_velocity": before[0], "normal_speed": before[1], "spin": before[2],
        "rebound_tangential_velocity": after[0], "rebound_normal_velocity": -after[1],
        "rebound_spin": after[2],
    }.items():  # fmt: skip
        np.testing.assert_allclose(columns[name], expected, rtol=1e-9, atol=1e-9)
    (note,) = found.notes
    assert note.startswith("normal_restitution of the bounces: ")


@pytest.mark.parametrize("restitution", [1.0, pytest.param(0.85, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_friction_lies_within_its_interval_from_ten_bounces_at_240_frames(restitution):
    """With noise of 1 mm; of twelve such films 95 % should hold it."""
    names = ["friction_coefficient", "restitution"][: 1 + (restitution < 1.0)]
    inside = []
    for seed in range(12):
        found = fit(read_flight(film(seed, restitution=restitution)[0]), BODIES, parameters=names)
        low, high = found.parameters["friction_coefficient"].interval
        assert high - low < 0.15 * FRICTION
        inside.append(low < FRICTION < high)
    assert sum(inside) >= 9


@pytest.mark.slow
def test_the_errors_are_those_of_many_films():
    """Of what is measured less what would follow from the flight before: no impact changes it."""
    found = [read_flight(film(seed)[0]) for seed in range(60)]
    pairs = {"rebound_tangential_velocity": "tangential_velocity", "rebound_spin": "spin",
             "rebound_normal_velocity": "normal_speed"}  # fmt: skip
    for name, before in pairs.items():
        change = np.array([each.measured[name] - each.given[before] for each in found])
        told = np.mean([each.errors[name] for each in found], axis=0)
        ratio = np.std(change, axis=0) / told
        assert np.all((ratio > 0.7) & (ratio < 1.35)), (name, ratio)


def test_a_third_coordinate_and_other_headings(tmp_path):
    """The way over the floor is turned by 30 degrees from x; a flight has no more friction."""
    frames, _ = film(3, noise=0.0)
    t, x, y, _ = frames.values()
    plain = read_flight({"t (s)": t, "x (m)": x, "y (m)": y})
    path = tmp_path / "film.csv"
    turned = np.stack([1e3 * t, 1e3 * x * np.cos(0.5), -1e3 * y, 1e3 * x * np.sin(0.5)], axis=-1)
    np.savetxt(path, turned, header="frame time [ms],cx [mm],cy [mm],z (mm)", comments="",
               delimiter=",")  # fmt: skip
    names = {"frame time [ms]": "t", "cx [mm]": "x", "cy [mm]": "-y"}
    found = read_flight(path, columns=names)
    for name, values in (plain.given | plain.measured).items():
        np.testing.assert_allclose((found.given | found.measured)[name], values, rtol=1e-6)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"y (m)": None}, "y: is missing; a film needs the columns"),
        ({"x (m)": None, "x": 1.0}, "heading 'x': has no unit; write 'x .m.', or .mm."),
        ({"y (m)": None, "y (furlongs)": 1.0}, "is in furlongs, which is not known here"),
        ({"y (m)": -1.0}, "y: the flights are no parabolas.*grows upwards"),
        ({"y (m)": 1e-2}, "y: the flights fall with 0.0981 m/s².*its unit, the frame rate"),
        ({"t (s)": 0.0}, "t: does not grow"),
        ({"x (m)": 1.0 + 0.0j}, "x .m. = .*: must be a list of numbers"),
    ],
)
def test_films_that_cannot_be_read(change, words):
    frames, _ = film(3)
    made = {}
    for name, values in frames.items():
        if (factor := change.get(name, 1.0)) is not None:
            made[name] = factor * values
    made |= {name: frames["y (m)"] for name in change if name not in frames}
    with pytest.raises(ValueError, match=words):
        read_flight(made)


def test_a_scale_off_by_five_percent_and_short_flights_are_told():
    frames, _ = film(3)
    _, note = read_flight(frames | {"y (m)": 1.05 * frames["y (m)"]}).notes
    assert note.startswith("the flights fall with 10.3 m/s² in place of 9.81")
    few = {
        name: values[: np.flatnonzero(frames["t (s)"] > 0.01)[0]] for name, values in frames.items()
    }
    with pytest.raises(ValueError, match="no bounce has 5 frames"):
        read_flight(few)


def without_angle(frames):
    return {name: values for name, values in frames.items() if not name.startswith("angle")}


def test_without_an_angle_spins_follow_from_the_moment_about_the_contact():
    """As those of the film with one, for a ball thrown with the spin of the scene."""
    frames, impacts = film(1, noise=0.0)
    found = as_target_sees(read_flight(without_angle(frames)), BODIES)
    np.testing.assert_allclose(found.given["spin"], impacts[:, 0, 2], rtol=1e-8, atol=1e-8)
    assert as_target_sees(found, BODIES) is found or list(
        as_target_sees(found, BODIES).given
    ) == list(found.given)
    along = read_flight(without_angle(frames)).only(["rebound_tangential_velocity"])
    np.testing.assert_array_equal(as_target_sees(along, BODIES).given["spin"], found.given["spin"])
    spun = as_target_sees(read_flight(without_angle(frames)), attrs.evolve(BODIES, spin=3.0))
    np.testing.assert_allclose(spun.given["spin"], found.given["spin"] + 3.0, atol=1e-8)
    assert "before the first bounce" in "".join(found.taken)
    assert "before the first bounce" not in "".join(spun.taken)


def test_a_film_without_an_angle_has_the_friction():
    """Taken for 0 before each bounce, the spins gave half of it."""
    frames, _ = film(6, noise=3e-4, restitution=0.85)
    names = ["friction_coefficient", "restitution"]
    found = fit(read_flight(without_angle(frames)), BODIES, parameters=names)
    low, high = found.parameters["friction_coefficient"].interval
    assert low < FRICTION < high
    assert high - low < 0.03 * FRICTION
    assert not any(one.startswith("spin = 0 rad/s before each") for one in found.taken)


def test_of_a_ball_that_nobody_saw_before_its_first_bounce_the_spin_is_not_taken():
    frames, _ = film(1, noise=0.0)
    late = (frames["t (s)"] > -0.01) & (frames["t (s)"] < 50.0)
    one = {name: values[late] for name, values in without_angle(frames).items()}
    seen = frames["t (s)"] > 50.0
    both = {
        name: np.concatenate([one[name], values[seen]])
        for name, values in without_angle(frames).items()
    }
    found = as_target_sees(read_flight(both), BODIES)
    assert list(np.isnan(found.measured["rebound_tangential_velocity"])) == [True] * 4 + [False] * 5
    assert any("bounces of unknown spin" in note for note in found.notes)
    assert list(as_target_sees(read_flight(one), BODIES).measured) == ["rebound_normal_velocity"]


def test_only_of_a_ball_on_a_floor_the_spin_follows(tmp_path):
    table = read_flight(without_angle(film(1)[0]))
    balls = Scene(BALL, BALL, friction_coefficient=0.5, normal_speed=1.0)
    rod = tmp_path / "rod.toml"
    rod.write_text(
        "[body]\nshape = 'rod'\nlength = 0.1\nradius = 0.01\ntilt_deg = 30\n"
        "material = 'steel'\n[target]\nkind = 'half-space'\nmaterial = 'steel'\n"
        "[impact]\nnormal = [0, 0, -1]\nalong = [1, 0, 0]\n",
        encoding="utf-8",
    )
    for scene in (balls, rod):
        with pytest.raises(ValueError, match=r"angle: is missing.*add a column angle"):
            fit(table, scene)


def test_a_film_of_one_vertical_has_a_restitution():
    """Its column of zeros has no scatter to weigh it by."""
    frames, _ = film(4, restitution=0.9)
    frames["x (m)"] = np.zeros_like(frames["x (m)"])
    found = fit(read_flight(frames), BODIES, parameters=["restitution"],
                quantities=["rebound_normal_velocity"])  # fmt: skip
    assert found["normal.restitution"] == pytest.approx(0.9, abs=0.01)
    assert "rebound_tangential_velocity is left out" in found.notes[0]


def test_the_command(tmp_path, capsys):
    path, bodies = tmp_path / "film.csv", tmp_path / "bodies.toml"
    frames, _ = film(5, restitution=0.85)
    np.savetxt(path, np.stack([*frames.values()], axis=-1), delimiter=",", comments="",
               header=",".join(HEADINGS))  # fmt: skip
    bodies.write_text("[sphere]\nradius = 0.02\nmaterial = 'steel'\n[target]\n"
                      "kind = 'half-space'\nmaterial = 'steel'\n", encoding="utf-8")  # fmt: skip
    command = [
        "fit",
        "--flight",
        str(path),
        str(bodies),
        "--fit",
        "friction_coefficient,restitution",
    ]
    assert main([*command, "--bootstrap", "0", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert any(one.startswith("gravity = 9.80665") for one in content["taken"])
    found = content["parameters"]
    low, high = found["friction_coefficient"]["interval_95"]
    assert low < FRICTION < high
    low, high = found["normal.restitution"]["interval_95"]
    assert low < 0.85 < high
    assert main([*command[:3], str(path), str(bodies)]) == 2
    assert "--flight gives the impacts already" in capsys.readouterr().err
    assert main([*command, "--columns", "t,x,y,angle"]) == 2
    assert "name them by --column 'HEADING=x'" in capsys.readouterr().err


PIXEL = 4e-4


@pytest.fixture
def phone():
    """Return a film as a phone makes it, speeds, restitution, and rows as a tracker writes them.

    Places are in pixels and y grows downwards; the ball is held before its fall and rests at last.
    """
    generator = np.random.default_rng(11)
    e, rate = 0.6, 120.0
    first = np.sqrt(2.0 * G * 0.5)
    speeds = first * e ** np.arange(4)
    starts = 0.4 + first / G + np.concatenate([[0.0], np.cumsum(2.0 * speeds[1:] / G)])
    t = np.arange(0.0, starts[-1] + 0.4, 1.0 / rate)
    y = np.where(t < 0.4, 0.5, 0.5 - 0.5 * G * (t - 0.4) ** 2)
    for start, speed in zip(starts[:-1], speeds[1:], strict=True):
        now = t >= start
        y[now] = speed * (t[now] - start) - 0.5 * G * (t[now] - start) ** 2
    y[t >= starts[-1]] = 0.0
    x = np.where(t < 0.4, 0.0, 0.3 * (t - 0.4))
    px = 900.0 - y / PIXEL + generator.normal(0.0, 0.2, t.size)
    frames = {
        "frame": np.arange(t.size, dtype=float),
        "x (px)": x / PIXEL + generator.normal(0.0, 0.2, t.size),
        "y (px)": px,
    }  # fmt: skip
    rows = zip(*(values.tolist() for values in frames.values()), strict=True)
    return frames, speeds[:3], e, [",".join(map(repr, row)) for row in rows]


def test_a_film_in_pixels_finds_its_scale_and_leaves_out_what_is_no_flight(phone):
    frames, speeds, e, _ = phone
    found = read_flight(frames, frame_rate=120.0)
    ratio = found.measured["rebound_normal_velocity"] / -found.given["normal_speed"]
    assert np.abs(ratio[:2]) == pytest.approx(e, abs=0.01)
    assert found.given["normal_speed"][:2] == pytest.approx(speeds[:2], rel=0.02)
    told = " ".join(found.notes)
    assert "1 px is 0.4" in told
    assert "y grows downwards, and is turned" in told
    assert "frames before the ball is let go are left out" in told
    assert "after it has come to rest" in told


@pytest.mark.parametrize(
    ("head", "columns", "change"),
    [
        (["mass_A,,", "frame,x (px),y (px)"], None, str),
        (["Frame,X1,Y1", "Tracks 1 to 1"], {"Frame": "frame", "X1": "x (px)", "Y1": "y (px)"}, str),
        ([], ["frame", "x (px)", "y (px)"], str),
        (["frame;x (px);y (px)"], None, lambda row: row.replace(",", ";").replace(".", ",")),
        (["frame\tx (px)\ty (px)"], None, lambda row: row.replace(",", "\t")),
    ],
)
def test_films_are_read_as_trackers_write_them(phone, tmp_path, head, columns, change):
    frames, _, _, rows = phone
    path = tmp_path / "film.csv"
    path.write_text("\n".join([*head, *map(change, rows)]), encoding="utf-8")
    found = read_flight(path, columns=columns, frame_rate=120.0)
    same = read_flight(frames, frame_rate=120.0)
    for name, values in same.measured.items():
        np.testing.assert_allclose(found.measured[name], values, rtol=1e-12)


def test_frames_need_their_rate_and_places_one_unit(phone):
    frames, *_ = phone
    with pytest.raises(ValueError, match="frame: needs the frames a second; give --fps 240"):
        read_flight(frames)
    with pytest.raises(ValueError, match="frame_rate = 0"):
        read_flight(frames, frame_rate=0.0)
    mixed = {name.replace("x (px)", "x (m)"): values for name, values in frames.items()}
    with pytest.raises(ValueError, match="some are in pixels and some are not"):
        read_flight(mixed, frame_rate=120.0)
    still = frames | {"y (px)": np.full(len(frames["frame"]), 5.0)}
    with pytest.raises(ValueError, match=r"y .px.: no flight"):
        read_flight(still, frame_rate=120.0)
