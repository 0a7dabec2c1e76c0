"""contactlab as pooltool's collision models; run where pooltool is installed."""

import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[1] / "examples" / "pooltool"
PAGE = (FOLDER / "README.md").read_text("utf-8")


def test_the_page_lists_every_file():
    files = {path.name for path in FOLDER.iterdir() if path.is_file()} - {"README.md"}
    assert files == set(re.findall(r"^\| `(\w+\.py)` \|", PAGE, re.MULTILINE))


@pytest.fixture(scope="module")
def pooltool():
    """Return pooltool, with the example's modules beside it."""
    engine = pytest.importorskip(
        "pooltool", reason="pooltool is not installed: pip install pooltool-billiards"
    )
    sys.path.insert(0, str(FOLDER))
    yield engine
    sys.path.remove(str(FOLDER))
    for name in ("models", "throw"):
        sys.modules.pop(name, None)


pytestmark = pytest.mark.filterwarnings("ignore")  # of pooltool and what it imports


@pytest.mark.slow
def test_throw_in_a_simulated_shot(pooltool):
    """The default sticks as rigid balls do; elastic balls throw by tan(throw) = mu in slip.

    In stick the throw is between the rigid ball's and twice that, the most of any elastic law.
    """
    import throw

    rigid = math.degrees(math.atan(math.tan(math.radians(15.0)) / 7.0 / 0.975))
    models = [throw.BALLS[name] for name in ("default", "contactlab")]
    default, ours = (throw.throw(model(), 15.0, 1.34) for model in models)
    assert default == pytest.approx(rigid, abs=0.01)
    assert 1.3 * rigid < ours < 2.0 * rigid
    friction = throw.AverageBallBallFriction()
    mu = pooltool.BallParams.default().u_b
    for e in (1.0, 0.8, 0.5):
        ratios = []
        for model in models:
            along, across = throw.thrown(model(friction=friction), 60.0, 1.34, e_b=e)
            ratios.append(across / along / mu)
        assert ratios == pytest.approx([2.0 * e / (1.0 + e), 1.0], rel=1e-3)


@pytest.mark.slow
def test_a_break_loses_energy_in_every_collision(pooltool):
    from models import resolver

    shot = pooltool.System.example()
    shot.strike(V0=6.0, a=0.3)
    done = pooltool.simulate(shot, engine=pooltool.physics.PhysicsEngine(resolver=resolver()))
    kinds = {"ball_ball": 0, "ball_linear_cushion": 0}
    for event in done.events:
        if event.event_type.value not in kinds:
            continue
        kinds[event.event_type.value] += 1
        before, after = (
            sum(
                float((end.state.rvw[1] ** 2).sum())
                + 0.4 * end.params.R**2 * float((end.state.rvw[2] ** 2).sum())
                for agent in event.agents
                if (end := getattr(agent, which)) is not None and hasattr(end, "state")
            )
            for which in ("initial", "final")
        )
        assert after <= before * (1.0 + 1e-9)
    assert min(kinds.values()) > 0
    assert all(np.isfinite(ball.state.rvw).all() for ball in done.balls.values())
