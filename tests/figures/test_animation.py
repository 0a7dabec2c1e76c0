"""The moving picture: its frames, its clock, its colours and its file."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import contactlab
from contactlab import Encounter, Material, Simulation, Sphere, shapes
from contactlab.figures import animation
from contactlab.figures.animation_panels import Disc, Forces, Frame
from tests.figures.animated import FIELDS, impact


def test_forces_are_drawn_from_first_touch_up_to_the_instant():
    axes = Figure().subplots()
    forces = Forces(axes, impact())
    found = []
    for flight, instant in ((-1.0, 0), (0.0, 0), (0.0, 1), (0.0, 3), (1.0, 3)):
        forces.show(Frame("", flight, instant))
        found.append([len(line.get_xdata()) for line in axes.lines[-2:]])
    assert found == [[0, 0], [2, 1], [3, 1], [5, 1], [5, 1]]


@pytest.fixture
def small(monkeypatch):
    for name, value in (
        ("SIZE", (2.0, 1.0)), ("DOTS", 20), ("ARRIVING", 2), ("IN_CONTACT", 3), ("LEAVING", 2),
        ("SAMPLES", (0.0, 1.0)),
    ):  # fmt: skip
        monkeypatch.setattr(animation, name, value)


@pytest.mark.slow
def test_a_picture_moves_at_its_pace_for_ever(tmp_path, small, recwarn):
    seen = []
    path = tmp_path / "a.gif"
    animation.animate(path, impact(), ghosts={"g": impact()}, progress=lambda *n: seen.append(n))
    assert seen == [(done, 7) for done in range(1, 8)]
    with Image.open(path) as picture:
        assert (picture.format, picture.size) == ("GIF", (40, 20))
        assert picture.info["loop"] == 0
        assert picture.info["duration"] % 60 == 0
        assert picture.n_frames <= 7


@pytest.mark.slow
def test_a_law_without_fields_is_drawn_by_its_forces(tmp_path, small, recwarn):
    drawn = []
    for name, fields in (("forces", {}), ("disc", FIELDS)):
        animation.animate(tmp_path / f"{name}.gif", impact(fields=fields, sphere=False))
        with Image.open(tmp_path / f"{name}.gif") as picture:
            drawn.append(np.asarray(picture.convert("L")))
    assert (drawn[0] != drawn[1]).any()


@pytest.mark.parametrize("after", [0, 3])
def test_interrupted_frames_are_written_if_there_are_any(after, tmp_path):
    def frames(only):
        for number in range(len(only) or after):
            yield np.full((4, 4, 3), 10 * number, dtype=np.uint8)
        if not only:
            raise KeyboardInterrupt

    path = tmp_path / "a.gif"
    with pytest.raises(KeyboardInterrupt):
        animation.write_gif(path, frames, 7)
    assert path.exists() == bool(after)


def test_flat_colours_are_kept_exactly(tmp_path):
    """White, a light blue and a red, beside a run of greys, in the file."""
    frame = np.full((64, 64, 3), 255, dtype=np.uint8)
    frame[:16], frame[16:24] = (207, 227, 241), (213, 94, 1)
    frame[60:, :, :] = np.linspace(0, 190, 64)[None, :, None]
    animation.write_gif(tmp_path / "a.gif", lambda only: iter([frame] * (len(only) or 2)), 2)
    with Image.open(tmp_path / "a.gif") as picture:
        found = np.asarray(picture.convert("RGB"))
    np.testing.assert_array_equal(found[:60], frame[:60])
    assert np.abs(found[60:].astype(int) - frame[60:]).max() < 16


@pytest.mark.parametrize("fault", ["history", "shape", "empty"])
def test_what_is_no_single_impact_with_history_is_refused(fault, tmp_path):
    result = impact()
    if fault == "history":
        result.history = None
    elif fault == "shape":
        result.scene.shape = (3,)
    else:
        result.history.time = np.array([])
    with pytest.raises(ValueError, match="must have the history of a single impact"):
        animation.animate(tmp_path / "a.gif", result)


def test_an_elliptic_contact_is_drawn_as_an_ellipse():
    """A ball on a rod of its radius: semi-axes 1.2428 and 0.7837 of the circle as stiff."""
    steel = Material.named("steel")
    rod, touch = shapes.rod(
        length=0.2, radius=0.005, material=steel, normal=[0, 0, 1], axis=[1, 0, 0]
    )
    met = Encounter(
        Sphere(0.005, steel), rod, 0.2, normal=[0, 0, -1], velocity=[0.2, 0, -1],
        target_contact=touch,
    )  # fmt: skip
    springs = contactlab.create("tangential.springs", springs=20)
    march = contactlab.create("integrator.symplectic", steps=60)
    result = Simulation(tangential=springs, integrator=march).run(met.scene, history="fields")
    axes = Figure().subplots()
    disc = Disc(axes, result)
    (rim,) = axes.patches
    assert (rim.width, rim.height) == pytest.approx((2 * 1.2427543, 2 * 0.7836755), rel=1e-6)
    widest = int(np.argmax(result.history.contact_radius))
    disc.show(Frame("", 0.0, widest))
    drawn = np.any(disc.image.get_array() != 255, axis=-1)
    rows, columns = drawn.any(axis=1).sum(), drawn.any(axis=0).sum()
    assert columns / rows == pytest.approx(1.2427543 / 0.7836755, rel=0.05)
