"""Bad scene files: each refused by name, with what to do about it."""

from __future__ import annotations

import re

import pytest

import contactlab

GOOD = {
    "sphere.radius": "0.01",
    "sphere.material.young_modulus": "2e11",
    "sphere.material.poisson_ratio": "0.3",
    "sphere.material.density": "7800",
    "target.kind": '"half-space"',
    "target.material.young_modulus": "2e11",
    "target.material.poisson_ratio": "0.3",
    "impact.friction_coefficient": "0.1",
    "impact.speed": "2.0",
    "impact.angle_deg": "10.0",
}


def refusal(tmp_path, text):
    path = tmp_path / "bad.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape("bad.toml")) as caught:
        contactlab.read_scene(path)
    return str(caught.value).removeprefix(str(path))


def document(*, without=(), **changed):
    lines = {key: value for key, value in GOOD.items() if key not in without}
    lines |= {key.replace("__", "."): value for key, value in changed.items()}
    return "".join(f"{key} = {value}\n" for key, value in lines.items())


def test_the_good_document_is_good(tmp_path):
    path = tmp_path / "good.toml"
    path.write_text(document())
    assert contactlab.read_scene(path).scene.shape == ()


NOT_NUMBERS = ["nan", "inf", "-inf", '"five mm"', "true", "[1.0, 2.0]", "1979-05-27", "{a = 1}"]
NUMBERS = [key for key in GOOD if key != "target.kind"]


@pytest.mark.parametrize("value", NOT_NUMBERS)
@pytest.mark.parametrize("key", NUMBERS)
def test_not_a_finite_number(tmp_path, key, value):
    message = refusal(tmp_path, document(**{key: value}))
    assert key in message


@pytest.mark.parametrize(
    ("key", "value", "rule"),
    [
        ("sphere.radius", "0", "positive"),
        ("sphere.radius", "-0.01", "positive"),
        ("sphere.mass", "-1.0", "positive"),
        ("sphere.gyration_ratio", "1.5", "(0, 1]"),
        ("sphere.gyration_ratio", "0", "(0, 1]"),
        ("sphere.material.young_modulus", "-1", "positive"),
        ("sphere.material.poisson_ratio", "0.6", "[-1, 0.5]"),
        ("sphere.material.density", "0", "positive"),
        ("target.material.poisson_ratio", "-1.1", "[-1, 0.5]"),
        ("impact.friction_coefficient", "-0.1", "zero or positive"),
        ("impact.speed", "0.0", "positive"),
        ("impact.speed", "-2.0", "positive"),
        ("impact.angle_deg", "90", "between -90 and 90"),
        ("impact.angle_deg", "-100.0", "between -90 and 90"),
        ("target.kind", '"plane"', "half-space"),
        ("target.kind", "3", "half-space"),
    ],
)
def test_not_physical(tmp_path, key, value, rule):
    message = refusal(tmp_path, document(**{key: value}))
    assert key in message
    assert rule in message


@pytest.mark.parametrize(
    ("key", "nearest"),
    [
        ("sphere.raduis", "radius"),
        ("sphere.material.youngs_modulus", "young_modulus"),
        ("sphere.material.poisson", "poisson_ratio"),
        ("target.material.densty", "density"),
        ("impact.friction", "friction_coefficient"),
        ("impact.angle", "angle_deg"),
        ("sphre.radius", "sphere"),
        ("simulation.tangental", "tangential"),
        ("about.titel", "title"),
    ],
)
def test_unknown_key_with_the_nearest(tmp_path, key, nearest):
    message = refusal(tmp_path, document(**{key: "1"}))
    unknown = key if "sphre" not in key else "sphre"
    what = "table" if unknown == "sphre" else "key"
    assert f"{unknown}: unknown {what}; did you mean {nearest!r}?" in message


@pytest.mark.parametrize(
    ("missing", "named"),
    [
        (["sphere.radius"], "sphere.radius: is missing"),
        (["sphere.material.poisson_ratio"], "sphere.material.poisson_ratio: is missing"),
        (["sphere.material.young_modulus"], "sphere.material: give exactly one of shear_modulus"),
        (["sphere.material.density"], "give sphere.mass in kg, or sphere.material.density"),
        (["target.kind"], "target.kind: is missing"),
        ([key for key in GOOD if key.startswith("target")], "target: is missing"),
        ([key for key in GOOD if key.startswith("impact")], "impact: is missing"),
        ([key for key in GOOD if key.startswith("sphere")], "sphere: is missing"),
        (["impact.friction_coefficient"], "impact.friction_coefficient: is missing"),
        (["impact.speed"], "impact.speed: is missing"),
        (["impact.speed", "impact.angle_deg"], "impact.normal_speed: is missing"),
        (list(GOOD), "sphere: is missing"),
    ],
)
def test_missing(tmp_path, missing, named):
    assert named in refusal(tmp_path, document(without=missing))


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("impact.normal_speed = 1.0", "leave out one pair"),
        ("sphere.material.shear_modulus = 8e10", "exactly one of shear_modulus"),
        ("nondimensional.psi1 = 1.0", "leave out [sphere]"),
        ("target.radius = 0.1", "target.radius: unknown key"),
        ("impact.target_spin = 3.0", "target_spin = 3.0: must be zero: a half-space does not spin"),
        ("sweep.target_spin = [0, 3]", "target_spin = 3.0: must be zero: a half-space does not"),
    ],
)
def test_at_odds(tmp_path, line, named):
    assert named in refusal(tmp_path, document() + line)


@pytest.mark.parametrize(
    ("sweep", "named"),
    [
        ("angle_deg = 3.0", "sweep.angle_deg"),
        ("angle_deg = []", "sweep.angle_deg"),
        ("angle_deg = [1.0, nan]", "sweep.angle_deg"),
        ("angle_deg = [1.0, true]", "sweep.angle_deg"),
        ("angle_deg = [[1.0], [2.0]]", "sweep.angle_deg"),
        ('angle_deg = ["a"]', "sweep.angle_deg"),
        ("angle_deg = [1.0, 95.0]", "impact.angle_deg"),
        ("friction_coefficient = [0.1, -0.1]", "impact.friction_coefficient"),
        ("angle_deg = [1.0, 2.0]\nspeed = [1.0]", "angle_deg 2, speed 1"),
        ("angel_deg = [1.0]", "'angle_deg'"),
        ("psi1 = [1.0]", "angle_deg"),
        ("'impact.speed' = [1.0]\nspeed = [1.0]", "the same entry"),
        ("sphere.radius = [0.0]", "sphere.radius"),
        ("angle_deg = {start = 0, stop = 5}", "sweep.angle_deg.count"),
        ("angle_deg = {start = 0, stop = 5, count = 1}", "sweep.angle_deg.count"),
        ("angle_deg = {start = 0, stop = 5, count = 2.5}", "sweep.angle_deg.count"),
        ("angle_deg = {start = 0, end = 5, count = 2}", "sweep.angle_deg.end"),
    ],
)
def test_bad_sweep(tmp_path, sweep, named):
    assert named in refusal(tmp_path, document() + f"[sweep]\n{sweep}\n")


MEASURED = {
    "quantity": '"psi2"', "against": '"angle_deg"', "source": '"x"', "x": "[1]", "values": "[1]",
}  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"quantity": '"psi3"'}, "measured[0].quantity"),
        ({"quantity": "3"}, "measured[0].quantity"),
        ({"against": '"angel"'}, "measured[0].against"),
        ({"values": "[1.0, 2.0]"}, "x 1, values 2"),
        ({"values": "[nan]"}, "measured[0].values"),
        ({"error": "[-1.0]"}, "measured[0].error"),
        ({"source": None}, "measured[0].source: is missing"),
        ({"x": None, "values": None}, "either x and values"),
        ({"readings": "[]"}, "either x and values"),
        ({"x": None, "values": None, "readings": "[{by = 'me', point = [1]}]"}, "readings[0].x"),
        ({"colour": '"red"'}, "measured[0].colour"),
    ],
)
def test_bad_measured_values(tmp_path, changed, named):
    lines = {key: value for key, value in (MEASURED | changed).items() if value is not None}
    text = "[[measured]]\n" + "\n".join(f"{key} = {value}" for key, value in lines.items())
    assert named in refusal(tmp_path, document() + text)


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("simulation.tangential = 3", "simulation.tangential"),
        ("simulation.options = 3", "simulation.options"),
        ("simulation.options.tangental.annuli = 3", "simulation.options.tangental.annuli"),
        ("simulation.options.tangential = 3", "simulation.options.tangential"),
        ("sweep = 3", "sweep"),
        ("measured = 3", "measured"),
        ("about = 3", "about"),
        ("about.title = 3", "about.title"),
        ("nondimensional = 3", "nondimensional"),
    ],
)
def test_wrong_kind_of_thing(tmp_path, line, named):
    assert named in refusal(tmp_path, document() + line)


def test_malformed_file_names_the_line(tmp_path):
    assert refusal(tmp_path, "[sphere]\nradius = \n").startswith(", line 2, column")
    assert refusal(tmp_path, "[sphere]\nradius = [1.0,\n\n").startswith(", line ")
    assert "line 3" in refusal(tmp_path, "[sphere]\nradius = 1.0\nradius = 2.0\n")


def test_unreadable_files(tmp_path):
    with pytest.raises(ValueError, match=r"nowhere\.toml: no such file"):
        contactlab.read_scene(tmp_path / "nowhere.toml")
    with pytest.raises(ValueError, match="cannot be read"):
        contactlab.read_scene(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b"# \xe9\n")
    with pytest.raises(ValueError, match="UTF-8"):
        contactlab.read_scene(tmp_path / "latin.toml")


def test_entry_given_in_code_is_checked_too(tmp_path):
    path = tmp_path / "good.toml"
    path.write_text(document())
    file = contactlab.read_scene(path)
    with pytest.raises(ValueError, match=r"impact\.angle_deg"):
        file.scene_at(angle_deg=[1.0, float("nan")])
    with pytest.raises(ValueError, match="did you mean 'angle_deg'"):
        file.scene_at(angle=[1.0])


def test_numbers_too_large_to_compute_with(tmp_path):
    message = refusal(tmp_path, document(**{"sphere.radius": "1e200"}))
    assert "sphere" in message
    assert "too large" in message or "finite" in message


@pytest.mark.parametrize("name", ["psi1", "chi", "nondimensional.psi1"])
def test_a_number_of_no_bodies_beside_bodies_is_refused_as_it_was_written(tmp_path, name):
    told = refusal(tmp_path, document() + f"[sweep]\n{name} = [1.0, 2.0]\n")
    assert f": {name}: is a number of a scene without bodies, and [sphere] is one of" in told
    assert "vary angle_deg" in told
    swept = document(without=("impact.angle_deg",)) + "[sweep]\nangle_deg = [1.0, 2.0]\n"
    (tmp_path / "good.toml").write_text(swept, encoding="utf-8")
    assert contactlab.read_scene(tmp_path / "good.toml").scene.shape == (2,)  # the remedy
