"""Problems whose model is a straight line: closed forms for all that a fit computes."""

import attrs
import numpy as np

from contactlab_fit.parameters import LawOption
from contactlab_fit.problem import Problem

X = np.array([1.0, 2.0, 3.0, 4.0])


def option(name, least=-np.inf, most=np.inf, starts=(0.0,)):
    return LawOption(name=name, least=least, most=most, starts=starts, kind="normal", option=name)


@attrs.frozen
class Line:
    """A model of two quantities, y = a x + b and z = c a: closed forms for all."""

    parameters: tuple
    x: np.ndarray = attrs.field(default=X)
    calls: list = attrs.field(factory=list)

    def predict(self, points, quantities):
        self.calls.append(len(points))
        padded = np.hstack([points, np.zeros((len(points), 1))])
        a, b = padded[:, :1], padded[:, 1:2]
        known = {
            "y": a * self.x + b,
            "z": 3.0 * a + 0.0 * self.x,
            "q": (a**2 - 1.0) ** 2 + 0.0 * self.x,
        }
        return {name: known[name] for name in quantities}


A, B = option("a", starts=(0.0, 1.0, 2.0)), option("b", starts=(-1.0, 1.0))


def line(measured, *parameters, errors=None, x=X):
    model = Line(parameters or (A, B), x)
    return Problem(model=model, measured=measured, errors=errors or {})
