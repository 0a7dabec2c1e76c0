"""Error bands: each lies around its own curve, as wide as the numerical error on either side."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

import contactlab
from contactlab import Scene, Simulation
from contactlab.figures.comparison import all_laws
from contactlab.outcome.style import error_band
from contactlab.scene_file import read_scene
from contactlab.study.comparison import compare
from contactlab.study.comparison_figure import laws_over_sweep

#: Not in order: a band must follow the order of its curve.
PSI1 = [2.0, 0.5, 1.2]
#: Names of two annulus laws.
ROUGH = ("two", "three")


def edges(band):
    """Return (x, lower, upper) of a band, sorted by x."""
    corners = band.get_paths()[0].vertices
    x = np.unique(corners[:, 0])
    ends = [corners[corners[:, 0] == one, 1] for one in x]
    return x, np.array([end.min() for end in ends]), np.array([end.max() for end in ends])


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    path = tmp_path_factory.mktemp("bands") / "rough.toml"
    path.write_text(f"[nondimensional]\nchi = 1.4\n[sweep]\npsi1 = {PSI1}\n", encoding="utf-8")
    rough = {
        name: Simulation(tangential=contactlab.create("tangential.annulus", annuli=annuli))
        for name, annuli in zip(ROUGH, (2, 3), strict=True)
    }
    laws = {"exact": Simulation(), **rough}
    return compare(read_scene(path), laws, estimate_error=True)


def test_a_band_has_the_error_on_either_side_of_its_curve():
    axes = Figure().subplots()
    x, middle, half = np.arange(3.0), np.array([1.0, -2.0, 0.5]), np.array([0.3, np.nan, 0.1])
    error_band(axes, x, middle, half, {"color": "red", "label": "error"})
    (band,) = axes.collections
    found = edges(band)
    np.testing.assert_allclose(found[1], middle - np.nan_to_num(half))
    np.testing.assert_allclose(found[2], middle + np.nan_to_num(half))
    assert band.get_label() == "error"


def test_the_band_of_a_result_lies_around_its_psi2():
    rough = Simulation(tangential=contactlab.create("tangential.annulus", annuli=3))
    result = rough.run(Scene.nondimensional(psi1=PSI1, chi=1.4), estimate_error=True)
    axes = result.plot(axes=Figure().subplots())
    (band,) = axes.collections
    order = np.argsort(PSI1)
    x, lower, upper = edges(band)
    np.testing.assert_array_equal(x, np.sort(PSI1))
    np.testing.assert_allclose(lower, (result.psi2 - result.psi2_error_estimate)[order])
    np.testing.assert_allclose(upper, (result.psi2 + result.psi2_error_estimate)[order])


def check_bands(axes, compared, middles):
    """Each band lies around one of the curves named, in its colour, with that law's error."""
    bands = {tuple(band.get_facecolor()[0][:3]): edges(band) for band in axes.collections}
    assert len(bands) == len(middles) == 2
    lines = {line.get_label(): line for line in axes.lines}
    order = np.argsort(PSI1)
    for name, middle in middles.items():
        half = compared.band("psi2", name)[order]
        assert half.max() > 0.01
        close = [
            colour
            for colour, (x, lower, upper) in bands.items()
            if np.allclose(x, np.sort(PSI1))
            and np.allclose(lower, middle[order] - half)
            and np.allclose(upper, middle[order] + half)
        ]
        assert len(close) == 1
        if name in lines:
            assert close[0] == pytest.approx(to_rgb(lines[name].get_color()))


@pytest.mark.slow
def test_bands_of_laws_over_a_sweep_lie_around_their_own_curves(compared):
    axes = laws_over_sweep(Figure().subplots(), compared, "psi2")
    check_bands(axes, compared, {name: compared.values("psi2", name) for name in ROUGH})


@pytest.mark.slow
def test_bands_of_all_laws_lie_around_values_above_and_differences_below(compared):
    upper, lower = all_laws(*Figure().subplots(2), compared, "psi2")
    check_bands(upper, compared, {name: compared.values("psi2", name) for name in ROUGH})
    check_bands(lower, compared, {name: compared.difference("psi2", name) for name in ROUGH})
