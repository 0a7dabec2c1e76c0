"""Simulated shots in pooltool: throw and cushions, by its models and by contactlab.

    python throw.py --figure throw.png

The cue ball starts a millimetre from the object ball, or from the cushion, without spin. Printed
are the throw over the cut angle, friction over mu times the normal impulse where balls slip
throughout, and the way off a cushion.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pooltool as pt
import pooltool.constants as const
from models import BallBall, resolver
from pooltool.physics.resolve.ball_ball.friction import AverageBallBallFriction
from pooltool.physics.resolve.ball_ball.frictional_inelastic import FrictionalInelastic
from pooltool.physics.resolve.ball_ball.frictional_mathavan import FrictionalMathavan
from pooltool.physics.resolve.ball_cushion.mathavan_2010.model import Mathavan2010Linear
from pooltool.physics.resolve.resolver import default_resolver

GAP = 1e-3  # m
#: pooltool's default first.
BALLS = {"default": FrictionalInelastic, "Mathavan": FrictionalMathavan, "contactlab": BallBall}


def simulated(balls: dict[str, pt.Ball], table: pt.Table, engine: Any, kind: pt.EventType) -> Any:
    """Return the first event of a kind in a simulated shot."""
    system = pt.System(cue=pt.Cue(cue_ball_id="cue"), table=table, balls=balls)
    done = pt.simulate(system, engine=pt.physics.PhysicsEngine(resolver=engine), t_final=0.1)
    return next(event for event in done.events if event.event_type == kind)


def moving(place: Any, direction: Any, speed: float, **params: float) -> pt.Ball:
    """Return a cue ball that slides without spin."""
    ball = pt.Ball.create("cue", xy=tuple(place), **params)
    ball.state.rvw[1] = [*(speed * direction), 0.0]
    ball.state.s = const.sliding
    return ball


def thrown(model: Any, cut_deg: float, speed: float, **params: float) -> tuple[float, float]:
    """Return the object ball's velocity along the line of centres and across it, in m/s.

    Positive across: towards the way of the cue ball.
    """
    table, cut = pt.Table.default(), math.radians(cut_deg)
    target = np.array([table.w / 2, table.l * 0.6])
    direction = np.array([math.sin(cut), math.cos(cut)])
    start = target - [0.0, 2.0 * pt.BallParams.default().R] - GAP * direction
    balls = {"cue": moving(start, direction, speed, **params)}
    balls["1"] = pt.Ball.create("1", xy=tuple(target), **params)
    engine = attrs.evolve(default_resolver(), ball_ball=model)
    event = simulated(balls, table, engine, pt.EventType.BALL_BALL)
    cue, one = (next(a for a in event.agents if a.id == name).final.state for name in balls)
    (x, y, _), velocity = one.rvw[0] - cue.rvw[0], one.rvw[1] / math.dist(one.rvw[0], cue.rvw[0])
    return float(velocity @ [x, y, 0.0]), float(velocity @ [y, -x, 0.0])


def throw(model: Any, cut_deg: float, speed: float) -> float:
    """Return the throw of the object ball off the line of centres, in degrees."""
    along, across = thrown(model, cut_deg, speed)
    return math.degrees(math.atan2(across, along))


def off_cushion(engine: Any, angle_deg: float, speed: float) -> float:
    """Return the angle to the normal of a straight cushion at which a ball leaves, in degrees."""
    table, angle = pt.Table.default(), math.radians(angle_deg)
    direction = np.array([math.cos(angle), math.sin(angle)])
    start = [table.w - pt.BallParams.default().R - 2.0 * GAP, table.l * 0.3]
    balls = {"cue": moving(start, direction, speed)}
    event = simulated(balls, table, engine, pt.EventType.BALL_LINEAR_CUSHION)
    out, along, _ = next(a for a in event.agents if a.id == "cue").final.state.rvw[1]
    return math.degrees(math.atan2(along, -out))


def draw(axes: Any) -> None:
    """Draw the throw over the cut angle under three models."""
    cuts = np.linspace(1.0, 60.0, 119)
    for (name, kind), line in zip(BALLS.items(), ("-", "--", "-"), strict=True):
        throws = [throw(kind(), cut, 1.34) for cut in cuts]
        label = name if kind is BallBall else f"pooltool, {name}"
        axes.plot(cuts, throws, line, label=label)
    axes.set(xlabel="cut angle (°)", ylabel="throw of the object ball (°)", xlim=(0, 60))
    axes.set_ylim(bottom=0.0)
    axes.legend()


def main() -> None:
    """Print three tables, and draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--figure", type=Path, help="picture of the throw, at 1.34 m/s")
    figure = parser.parse_args().figure
    print("throw (°)" + "".join(f"{name:>12}" for name in BALLS))
    for speed in (0.45, 1.34, 3.1):
        for cut in (5.0, 15.0, 30.0, 45.0, 60.0):
            throws = "".join(f"{throw(kind(), cut, speed):12.2f}" for kind in BALLS.values())
            print(f"{speed:4.2f} {cut:3.0f}°{throws}")
    print("\nfriction over mu times normal impulse, cut 60°, 1.34 m/s")
    for e in (1.0, 0.95, 0.8, 0.5):
        print(f"e = {e:4.2f}", end=" ")
        for kind in BALLS.values():
            along, across = thrown(kind(friction=AverageBallBallFriction()), 60.0, 1.34, e_b=e)
            print(f"{across / along / pt.BallParams.default().u_b:11.4f}", end=" ")
        print()
    default = default_resolver()
    mathavan = attrs.evolve(default, ball_linear_cushion=Mathavan2010Linear())
    print("\noff a cushion (°), 1.34 m/s")
    for angle in (10.0, 20.0, 30.0, 45.0, 60.0):
        angles = "".join(
            f"{off_cushion(each, angle, 1.34):12.2f}" for each in (default, mathavan, resolver())
        )
        print(f"{angle:8.0f}°{angles}")
    if figure:
        from contactlab.figures import save

        save(figure, draw)


if __name__ == "__main__":
    main()
