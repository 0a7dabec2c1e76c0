"""Encounters by the vectors of a file."""

import pytest

import contactlab
from tests.collisions.test_collision import meeting

VECTORS = """
[sphere]
radius = 0.01
material = {young_modulus = 208e9, poisson_ratio = 0.3, density = 7850}
[target]
kind = "half-space"
material = {young_modulus = 70e9, poisson_ratio = 0.2, density = 2500}
[impact]
friction_coefficient = 0.2
normal = [0, 0, -1]
velocity = [0.5, 0, -1]
spin = [0, -20, 0]
"""


def test_a_file_may_give_vectors(tmp_path):
    path = tmp_path / "vectors.toml"
    path.write_text(VECTORS)
    file = contactlab.read_scene(path)
    assert file.encounter == meeting()
    assert hash(file.encounter) == hash(meeting())
    assert file.encounter != meeting(spin=(0.0, -20.0, 1.0))
    assert file.scene == meeting().scene


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("velocity = [0.5, 0, -1]", "velocity = [1, 2]", "impact.velocity"),
        ("normal = [0, 0, -1]", "", "impact.normal: is missing"),
        ("normal = [0, 0, -1]", "normal = [0, 0, 1]", "bodies separate"),
        ("spin = [0, -20, 0]", "spin = 20", "impact.spin"),
        ("spin = [0, -20, 0]", "speed = 20", "leave them out, or speed"),
        ("spin = [0, -20, 0]", "target_spin = [0, 1, 0]", "impact.target_spin"),
        ("velocity = [0.5, 0, -1]", "velocities = [0.5, 0, -1]", "did you mean 'velocity'"),
        ("[impact]", "[sweep]\nspin = [1, 2, 3]\n[impact]", "impact.spin"),
    ],
)
def test_what_a_file_of_vectors_refuses(old, new, words, tmp_path):
    path = tmp_path / "vectors.toml"
    path.write_text(VECTORS.replace(old, new))
    with pytest.raises(ValueError, match=words):
        contactlab.read_scene(path)
