"""What is no list of numbers is refused by the doors of measurements."""

import numpy as np
import pytest

from contactlab import Scene, Simulation, fit
from contactlab_fit import read_flight, read_measurements
from tests.present import extra

VALUES = [0.5, 1.25, 3.0]
MASKED = np.ma.array([0.5, 0.75, 1.0], mask=[0, 1, 0])
DOORS = {
    "psi2 = .*masked": lambda: read_measurements({"psi1": VALUES, "psi2": MASKED}),
    "psi1 = .*masked": lambda: read_measurements({"psi1": MASKED, "psi2": VALUES}),
    "psi2 = .*list of numbers": lambda: read_measurements(
        {"psi1": VALUES, "psi2": [[1.0], [1.0, 2.0]]}),
    "x .m. = .*masked": lambda: read_flight(
        {"t (s)": VALUES, "x (m)": MASKED, "y (m)": VALUES}),
}  # fmt: skip


@pytest.mark.parametrize("words", DOORS)
def test_what_is_no_number_is_refused(words):
    with pytest.raises(ValueError, match=words):
        DOORS[words]()


LIBRARIES = {
    "xarray": ("names", r"\.values"),
    "pandas": ("index", r"to_numpy\(\)"),
    "frame": ("columns", r"to_numpy\(\)"),
    "dask": ("not computed", r"compute\(\)"),
}


def labelled(library):
    """Return three lengths with the labels of a library."""
    if library == "xarray":
        return pytest.importorskip("xarray").DataArray(VALUES, dims="impact")
    if library == "dask":
        return pytest.importorskip("dask.array").from_array(np.array(VALUES))
    pandas = pytest.importorskip("pandas")
    if library == "frame":
        return pandas.DataFrame({"x": VALUES})
    return pandas.Series(VALUES, index=[7, 3, 5])


@extra("xarray")
@extra("pandas")
@extra("dask")
@pytest.mark.parametrize("library", LIBRARIES)
def test_a_column_refuses_labels_in_one_sentence(library):
    rule, remedy = LIBRARIES[library]
    with pytest.raises(ValueError, match=f"{rule}.*; .*{remedy}") as refusal:
        read_measurements({"psi1": labelled(library), "psi2": VALUES})
    assert "\n" not in str(refusal.value)


def test_a_law_whose_option_has_a_unit_needs_a_scene_with_units():
    bare = Scene.nondimensional(psi1=[1.2, 1.2], chi=1.4412)
    with pytest.raises(ValueError, match="jkr needs a scene with units"):
        fit({"psi2": [0.1, -0.1]}, bare, parameters=["work_of_adhesion"],
            simulation=Simulation(normal="jkr"))  # fmt: skip
