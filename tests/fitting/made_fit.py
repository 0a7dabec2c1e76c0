"""A fit that was made by hand: three impacts, two quantities, one parameter."""

import numpy as np

from contactlab_fit import read_measurements
from contactlab_fit.fit_result import Estimate, Fit


def made(**more):
    measured = {"psi1": [1.0, 2.0, 3.0], "psi2": [0.5, np.nan, -1.0], "rebound_spin (rad/s)":
                [1.0, 2.0, 6.0]}  # fmt: skip
    estimate = Estimate(
        name="mu", unit="1", value=0.123456, standard_error=0.0123, interval=(0.1, 0.2)
    )
    return Fit(
        parameters={"mu": estimate},
        correlation=np.ones((1, 1)),
        laws="some laws",
        measurements=read_measurements(measured),
        predicted={"psi2": np.array([0.1, 7.0, -0.7]), "rebound_spin": np.array([1.0, 1.0, 3.0])},
        aic=-12.5,
        impacts=dict,
        **more,
    )
