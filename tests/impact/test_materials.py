"""Materials by name: every number has a source, and is a material's."""

import math
import re

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Sphere, read_scene
from contactlab.impact import material as materials


def test_there_are_some_twenty_and_the_usual_ones():
    assert len(materials.names()) >= 20
    assert {"steel", "soda-lime glass", "alumina", "nylon", "rubber"} <= set(materials.names())


@pytest.mark.parametrize("name", materials.names())
def test_an_entry_is_a_solid_with_its_sources(name):
    one = materials.entry(name)
    made = Material.named(name)
    assert made == one.material()
    assert made.young_modulus == pytest.approx(one.young_modulus, rel=1e-15)
    assert 1e6 <= one.young_modulus <= 1e12
    assert 0.1 <= one.poisson_ratio <= 0.5
    assert 900.0 <= one.density <= 22_600.0
    for source in (one.elastic_source, one.density_source, one.yield_source or one.density_source):
        for part in source.split("; "):
            assert part.partition(",")[0] in materials.references(), part


def test_every_work_is_cited_and_given_in_full():
    cited = {
        part.partition(",")[0]
        for one in materials.entries()
        for source in (
            one.elastic_source,
            one.density_source,
            one.yield_source or one.density_source,
        )
        for part in source.split("; ")
    }
    named = {key for one in materials.entries() for key in re.findall(r"\w+", one.note)}
    assert set(materials.references()) == (cited | named) & set(materials.references())
    assert all(re.search(r"\b(19|20)\d\d\b", text) for text in materials.references().values())


@pytest.mark.parametrize(
    ("name", "speed"),
    [("steel", 5150.0), ("aluminium alloy", 5090.0), ("brass", 3450.0), ("copper", 3820.0),
     ("titanium", 5160.0), ("tungsten", 4610.0), ("soda-lime glass", 5270.0), ("lead", 1190.0),
     ("polyethylene", 1060.0)],
)  # fmt: skip
def test_sound_in_a_thin_rod_has_its_speed(name, speed):
    """sqrt(E/rho) within 10 %, by speeds of sound in rods that are no source of the table."""
    one = materials.entry(name)
    assert (one.young_modulus / one.density) ** 0.5 == pytest.approx(speed, rel=0.1)


@pytest.mark.parametrize("kind", [list, tuple, np.array])
def test_what_is_not_known_of_some_is_nan_in_any_array(kind):
    several = Material(shear_modulus=8e10, poisson_ratio=0.3, density=kind([7850.0, math.nan]))
    assert np.isnan(several.density).tolist() == [False, True]


@pytest.mark.parametrize(
    "density",
    [
        math.nan,
        [math.nan, -1.0],
        np.array(["7850", "nan"]),
        np.array([None, 1.0]),
        ["a"],
        [[1.0], 2],
    ],
)
def test_what_is_no_density_is_refused(density):
    with pytest.raises(ValueError, match="density = "):
        Material(shear_modulus=8e10, poisson_ratio=0.3, density=density)


@pytest.mark.parametrize("name", ["Steel", "SODA lime_glass", " soda-lime  glass"])
def test_capitals_hyphens_and_blanks_make_no_difference(name):
    assert Material.named(name) in (Material.named("steel"), Material.named("soda-lime glass"))


@pytest.mark.parametrize(
    ("name", "words"),
    [("steal", "did you mean 'steel'"), ("glass", "'soda-lime glass' or 'borosilicate glass'"),
     ("unobtainium", "known: steel"), ("", "no such material"),
     ("glass beads", "did you mean 'soda-lime glass'"), ("wood", "give your own: Material("),
     (7, "must be the name")],
)  # fmt: skip
def test_an_unknown_name_is_refused_with_the_nearest(name, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        Material.named(name)


def test_a_scene_file_may_name_a_material(tmp_path):
    path = tmp_path / "named.toml"
    text = (
        "[sphere]\nradius = 0.01\nmaterial = '{}'\n[target]\nkind = 'half-space'\n"
        "material = 'soda-lime glass'\n[impact]\nfriction_coefficient = 0.1\nnormal_speed = 1.0\n"
    )
    path.write_text(text.format("steel"), encoding="utf-8")
    file = read_scene(path)
    assert file.scene.sphere == Sphere(0.01, Material.named("steel"))
    assert file.scene.target == HalfSpace(Material.named("soda-lime glass"))
    softer = file.scene_at(**{"sphere.material.young_modulus": [1e11, 2e11]})
    assert softer.shape == (2,)
    path.write_text(text.format("steal"), encoding="utf-8")
    with pytest.raises(ValueError, match=r"sphere\.material: name = 'steal'.*'steel'"):
        read_scene(path)
