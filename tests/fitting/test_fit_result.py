"""The numbers of a fit, as attributes, as text and as plain numbers."""

import attrs
import numpy as np
import pytest

from contactlab_fit.fit_result import Estimate
from tests.fitting.made_fit import made
from tests.present import extra


def test_residuals_and_their_sizes():
    found = made()
    np.testing.assert_allclose(found.residuals["psi2"], [0.4, np.nan, -0.3])
    assert found.counts == {"psi2": 2, "rebound_spin": 3}
    assert found.rms == pytest.approx({"psi2": np.sqrt(0.125), "rebound_spin": np.sqrt(10.0 / 3.0)})
    assert found.largest == pytest.approx({"psi2": 0.4, "rebound_spin": 3.0})
    below = attrs.evolve(found, predicted=found.predicted | {"psi2": np.array([0.4, 0.0, 1.5])})
    assert below.largest["psi2"] == pytest.approx(2.5)  # of -2.5
    assert found["mu"] == 0.123456
    with pytest.raises(ValueError, match=r"^name = 'nu': was not fitted; fitted: mu$"):
        found["nu"]
    assert (found.reduced_chi_square, found.notes, found.samples) == (None, (), 0)


def test_a_fit_as_text():
    speed = attrs.evolve(
        made().parameters["mu"], name="normal.v", unit="m/s", value=2.0, standard_error=0.5,
        interval=(1.0, 3.0), bootstrap=(1.23456, 2.98765),
    )  # fmt: skip
    found = attrs.evolve(
        made(notes=("look",), cautions=("beware",)),
        parameters=made().parameters | {"normal.v": speed},
    )
    assert repr(found).splitlines() == [
        "Fit of 3 impacts to some laws",
        "  mu                       0.12346 ± 0.012, 95 % 0.1 to 0.2",
        "  normal.v                 2 m/s ± 0.5, 95 % 1 to 3 (bootstrap 1.235 to 2.988)",
        "  psi2                     rms 0.354, largest 0.4",
        "  rebound_spin             rms 1.83, largest 3",
        "  note: look",
        "  caution: beware",
    ]


def test_a_fit_as_plain_numbers():
    nan = Estimate(name="mu", unit="1", value=0.5, standard_error=np.nan,
                   interval=(np.nan, np.nan), bootstrap=(0.4, 0.6), robust=0.51)  # fmt: skip
    found = attrs.evolve(
        made(notes=("a", "b"), cautions=("c",), taken=("d",), samples=7, reduced_chi_square=np.nan),
        parameters={"mu": nan},
    )
    assert found.to_dict() == {
        "laws": "some laws",
        "parameters": {
            "mu": {"value": 0.5, "unit": "1", "standard_error": None, "interval_95": [None, None],
                   "bootstrap_95": [0.4, 0.6], "robust": 0.51}
        },
        "correlation": [[1.0]],
        "rms": found.rms,
        "largest": found.largest,
        "aic": -12.5,
        "reduced_chi_square": None,
        "given": {"psi1": [1.0, 2.0, 3.0]},
        "measured": {"psi2": [0.5, None, -1.0], "rebound_spin": [1.0, 2.0, 6.0]},
        "predicted": {"psi2": [0.1, 7.0, -0.7], "rebound_spin": [1.0, 1.0, 3.0]},
        "notes": ["a", "b"],
        "cautions": ["c"],
        "taken": ["d"],
        "samples": 7,
    }  # fmt: skip
    plain = made(reduced_chi_square=1.5).to_dict()
    assert plain["parameters"]["mu"]["bootstrap_95"] is None
    assert plain["parameters"]["mu"]["interval_95"] == [0.1, 0.2]
    assert (plain["reduced_chi_square"], plain["samples"]) == (1.5, 0)


def test_a_fit_in_a_notebook_and_as_a_figure():
    from matplotlib.figure import Figure

    found = made()
    assert found._repr_html_() == f"<pre>{found}</pre>"
    without = attrs.evolve(found, measurements=attrs.evolve(found.measurements, given={}))
    axes = without.plot("rebound_spin", axes=Figure().subplots())
    assert axes.lines[1].get_ydata() == pytest.approx(found.predicted["rebound_spin"])
    with pytest.raises(ValueError, match="quantity = 'spin': was not measured; there are psi2"):
        found.plot("spin")


@extra("pandas")
def test_a_fit_as_a_frame():
    found = made()
    frame = found.to_dataframe()
    assert frame["residual_rebound_spin"].tolist() == [0.0, 1.0, 3.0]
    assert frame["psi1"].tolist() == [1.0, 2.0, 3.0]
    assert frame.attrs["units"]["predicted_rebound_spin"] == "rad/s"
    assert frame.attrs["laws"] == "some laws"


@extra("xarray")
def test_a_fit_as_a_data_set():
    data = made().to_xarray()
    np.testing.assert_array_equal(data.psi2, [0.5, np.nan, -1.0])
    assert data.psi2.dims == ("impact",)
