"""A fit of an option of a law runs the impacts at no point twice."""

from typing import ClassVar

import attrs
import numpy as np

from contactlab import Simulation, fit
from contactlab.fitting.model import DIGITS
from tests.fitting.impacts import ANGLES, BODIES, restitution, table
from tests.laws.outside_laws import Walton


@attrs.frozen(kw_only=True)
class Counted(Walton):
    """Walton's law, which notes each of its options that it is asked with."""

    asked: ClassVar[list[float]] = []

    def whole_impacts(self, scene, normal):
        self.asked.append(self.beta)
        return Walton(beta=self.beta).whole_impacts(scene, normal)


def test_a_search_and_its_diagnosis_share_their_runs():
    """But for one run at the best value for its cautions, and those of impacts turned a little."""
    noise = 0.01 * np.random.default_rng(3).normal(size=len(ANGLES))
    values = restitution(0.2, laws=Simulation(tangential=Walton(beta=0.37))) + noise
    laws = Simulation(tangential=Counted(beta=0.2))
    found = fit(table(values), BODIES, parameters=["beta"], simulation=laws)
    best = float(f"{found['tangential.beta']:.{DIGITS}g}")
    assert abs(best - 0.37) < 0.2
    others = [value for value in Counted.asked if value != best]
    assert len(set(others)) > 20
    assert len(others) - len(set(others)) <= 2
    assert Counted.asked.count(best) <= 4
