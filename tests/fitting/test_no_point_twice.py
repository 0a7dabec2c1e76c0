"""A fit of an option of a law runs the impacts at no point twice."""

from typing import ClassVar

import attrs
import numpy as np

from contactlab import Simulation
from contactlab_fit import fit
from contactlab_fit.model import DIGITS
from tests.fitting.impacts import ANGLES, BODIES, restitution, table
from tests.laws.outside_laws import Walton


@attrs.frozen(kw_only=True)
class Counted(Walton):
    """Walton's law, which notes its option and the impacts each time that it is asked."""

    asked: ClassVar[list[tuple[float, bytes]]] = []

    def whole_impacts(self, scene, normal):
        self.asked.append((self.beta, scene.tangential_velocity.tobytes()))
        return Walton(beta=self.beta).whole_impacts(scene, normal)


def test_a_search_and_its_diagnosis_share_their_runs():
    """But for one run at the best value for its cautions, and those of impacts turned a little."""
    noise = 0.01 * np.random.default_rng(3).normal(size=len(ANGLES))
    values = restitution(0.2, laws=Simulation(tangential=Walton(beta=0.37))) + noise
    laws = Simulation(tangential=Counted(beta=0.2))
    found = fit(table(values), BODIES, parameters=["beta"], simulation=laws)
    best = float(f"{found['tangential.beta']:.{DIGITS}g}")
    assert abs(best - 0.37) < 0.2
    others = [asked for asked in Counted.asked if asked[0] != best]
    assert len({option for option, _ in others}) > 20
    assert len(others) - len(set(others)) <= 2
    alone = table(values)
    own = np.sin(np.radians(alone["angle_deg"])) * alone["speed (m/s)"]
    assert Counted.asked.count((best, own.tobytes())) <= 4
