"""Numbers of a scene file with their unit, as "1.45 in", beside the same numbers in SI."""

import numpy as np
import pytest

from contactlab import read_scene

FILE = """
[sphere]
radius = {radius}
mass = {mass}
[sphere.material]
young_modulus = {young}
poisson_ratio = 0.3
[target]
kind = "half-space"
[target.material]
young_modulus = 70e9
poisson_ratio = 0.25
[impact]
friction_coefficient = 0.1
speed = {speed}
angle_deg = {angle}
spin = {spin}
[sweep]
speed = {speeds}
"""
PLAIN = {
    "radius": "0.0368", "mass": "0.145", "young": "2e11", "speed": "44.704", "angle": "30.0",
    "spin": "209.43951023931953", "speeds": "[10.0, 22.352]",
}  # fmt: skip


@pytest.fixture
def read(tmp_path):
    """Return a function that reads the file with some numbers written otherwise."""

    def reading(content=FILE, **changed):
        path = tmp_path / "scene.toml"
        path.write_text(content.format(**PLAIN | changed), encoding="utf-8")
        return read_scene(path)

    return reading


@pytest.mark.parametrize(
    ("key", "value", "plain"),
    [
        ("radius", '"1.45 in"', 1.45 * 0.0254),
        ("radius", '"36.8mm"', 0.0368),
        ("mass", '"5.25 oz"', 5.25 * 0.028349523125),
        ("mass", '"1.45e2 g"', 0.145),
        ("young", '"200 GPa"', 2e11),
        ("angle", '"0.5 rad"', float(np.degrees(0.5))),
        ("angle", '"30 °"', 30.0),
        ("spin", '"2000 rpm"', 2000.0 * 2.0 * np.pi / 60.0),
        ("speeds", '["10 m/s", "50 mph"]', None),
        ("speeds", '{start = "10 m/s", stop = "50 mph", count = 2}', None),
    ],
)
def test_a_number_with_a_unit_is_that_number_in_si(read, key, value, plain):
    scene = read(**{key: value}).scene
    same = read(**({key: repr(plain)} if plain is not None else {"speeds": "[10.0, 22.352]"})).scene
    for name in ("normal_speed", "tangential_velocity", "spin"):
        found, expected = getattr(scene, name), getattr(same, name)
        np.testing.assert_allclose(found, expected, rtol=1e-15)
    np.testing.assert_allclose(scene.psi1, same.psi1, rtol=1e-14)


def test_numbers_of_shapes_have_units_too(read):
    rod = """
[body]
shape = "rod"
length = {length}
radius = {thickness}
tilt_deg = "40 deg"
[body.material]
young_modulus = "200 GPa"
poisson_ratio = 0.3
density = {density}
[target]
kind = "half-space"
[target.material]
young_modulus = 70e9
poisson_ratio = 0.25
[impact]
friction_coefficient = 0.1
velocity = ["1 m/s", 0, "-100 cm/s"]
normal = [0, 0, -1]
"""
    plain = {"length": "0.2", "thickness": "0.01", "density": "7800"}
    written = {"length": '"20 cm"', "thickness": '"10 mm"', "density": '"7.8 g/cm3"'}
    one, other = (read(rod, **each).encounter for each in (plain, written))
    assert other.velocity.tolist() == [1.0, 0.0, -1.0]
    assert other.body.mass == pytest.approx(one.body.mass, rel=1e-14)
    np.testing.assert_allclose(other.contact, one.contact, rtol=1e-14)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("radius", '"1.45"', r"sphere.radius = '1.45': .*write 1.45 without quotes in m"),
        ("radius", '"2 kg"', "kg is the unit of another quantity; give it in m, mm, cm, in or ft"),
        ("speed", '"100 furlongs"', "furlongs is not known here; give it in m/s, mm/s"),
        ("speeds", '["10 m/s", "5 m"]', r"sweep.speed\[1\] = '5 m': m is the unit of another"),
        ("radius", '"large"', "sphere.radius = 'large': must be a real number"),
        ("radius", '"-1 in"', "radius = -0.0254: must be positive"),
    ],
)
def test_another_unit_is_one_sentence(read, key, value, words):
    with pytest.raises(ValueError, match=words) as refused:
        read(**{key: value})
    assert len(str(refused.value).splitlines()) == 1


def test_a_number_without_a_unit_takes_none(read):
    with pytest.raises(ValueError, match="s is the unit of another quantity; write a plain number"):
        read(FILE.replace("friction_coefficient = 0.1", 'friction_coefficient = "0.1 s"'))
