"""contactlab as the collision models of pooltool: ball on ball, and ball on cushion.

Radius, mass, friction and restitution are those of pooltool's balls. Of the materials only
Poisson's ratios and the ratio of Young's moduli count.
"""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
import pooltool.constants as const
from pooltool.objects.ball.datatypes import Ball, BallState
from pooltool.physics.resolve.ball_ball.core import CoreBallBallCollision
from pooltool.physics.resolve.ball_ball.friction import AlciatoreBallBallFriction
from pooltool.physics.resolve.ball_cushion.core import (
    CoreBallCCushionCollision,
    CoreBallLCushionCollision,
)
from pooltool.physics.resolve.resolver import Resolver, default_resolver

from contactlab import Collision, Encounter, HalfSpace, Material, Sphere, collide

RESIN = Material.named("phenolic resin")
CUSHION = HalfSpace(Material.named("rubber"))


def sphere(ball: Ball) -> Sphere:
    """Return a ball as contactlab's sphere."""
    return Sphere(ball.params.R, RESIN, mass=ball.params.m)


def sliding(ball: Ball, velocity: Any, spin: Any) -> BallState:
    """Return a ball after a collision; pooltool 0.6 keeps balls on the cloth."""
    place = ball.state.rvw[0]
    return BallState(np.array([place, [velocity[0], velocity[1], 0.0], spin]), const.sliding)


@attrs.define
class BallBall(CoreBallBallCollision):
    """Ball on ball with partial slip, by a friction model of pooltool."""

    friction: Any = attrs.field(factory=AlciatoreBallBallFriction)

    def solve(self, ball1: Ball, ball2: Ball) -> tuple[Ball, Ball]:
        """Give both balls their states after the collision."""
        (place, velocity, spin), (other, *motion) = ball1.state.rvw, ball2.state.rvw
        met = Encounter(
            sphere(ball1), sphere(ball2), self.friction.calculate_friction(ball1, ball2),
            normal=other - place, velocity=velocity, spin=spin,
            target_velocity=motion[0], target_spin=motion[1],
        )  # fmt: skip
        e = (ball1.params.e_b + ball2.params.e_b) / 2.0
        made = collide(met, restitution=e, separating="pass")
        ball1.state = sliding(ball1, made.velocity, made.spin)
        ball2.state = sliding(ball2, made.target_velocity, made.target_spin)
        return ball1, ball2


def off_cushion(ball: Ball, cushion: Any) -> Collision:
    """Return the collision of a ball with a cushion, which it meets above its middle."""
    _, velocity, spin = ball.state.rvw
    normal = cushion.get_normal_3d(ball.xyz)
    normal = normal if np.dot(normal, velocity) > 0.0 else -normal
    met = Encounter(
        sphere(ball), CUSHION, ball.params.f_c, normal=normal, velocity=velocity, spin=spin
    )
    return collide(met, restitution=ball.params.e_c, separating="pass")


class _OffCushion:
    """A ball off a cushion with partial slip."""

    def solve(self, ball: Ball, cushion: Any) -> tuple[Ball, Any]:
        """Give the ball its state after the collision."""
        made = off_cushion(ball, cushion)
        ball.state = sliding(ball, made.velocity, made.spin)
        return ball, cushion


class LinearCushion(_OffCushion, CoreBallLCushionCollision):
    """A ball off a straight cushion with partial slip."""


class CircularCushion(_OffCushion, CoreBallCCushionCollision):
    """A ball off the corner of a cushion with partial slip."""


def resolver() -> Resolver:
    """Return pooltool's default resolver with contactlab's collisions."""
    return attrs.evolve(
        default_resolver(),
        ball_ball=BallBall(),
        ball_linear_cushion=LinearCushion(),
        ball_circular_cushion=CircularCushion(),
    )
