"""A ball thrown at the floor in pymunk, whose bounce contactlab.collide computes in a callback.

Run with ``python ball_in_pymunk.py``. pymunk is a game engine in the plane: its bodies have the
radius, mass and moment of inertia that they are given, here those of a sphere.
"""

import math
from typing import Any

import pymunk

from contactlab import Encounter, HalfSpace, Material, Sphere, collide

RUBBER = Material.named("rubber")
BALL, FLOOR = Sphere(0.025, RUBBER, mass=0.065), HalfSpace(RUBBER)
FRICTION, RESTITUTION = 0.8, 0.9
ROUND, FLAT = 1, 2  # collision types
SLOW = 0.05  # m/s of approach, below which pymunk keeps the contact, and the ball rests


def bounce(arbiter: Any, _space: Any, _data: Any) -> None:
    """Give a ball that meets the floor its velocity and spin after the impact."""
    body, normal = arbiter.shapes[0].body, arbiter.contact_point_set.normal
    arbiter.process_collision = body.velocity.dot(normal) < SLOW
    if arbiter.process_collision:
        return
    met = Encounter(
        BALL, FLOOR, FRICTION, normal=(*normal, 0.0),
        velocity=(*body.velocity, 0.0), spin=(0.0, 0.0, body.angular_velocity),
    )  # fmt: skip
    made = collide(met, restitution=RESTITUTION)
    body.velocity, body.angular_velocity = tuple(made.velocity[:2]), made.spin[2]


def thrown(
    velocity: tuple[float, float], spin: float, *, ours: bool = True, gravity: float = 9.81
) -> tuple[Any, Any]:
    """Return a space with a floor and the body of a ball that flies towards it."""
    space = pymunk.Space()
    space.gravity = 0.0, -gravity
    body = pymunk.Body(BALL.mass, 0.4 * BALL.mass * BALL.radius**2)
    body.position, body.velocity, body.angular_velocity = (0.0, 0.2), velocity, spin
    ball = pymunk.Circle(body, BALL.radius)
    floor = pymunk.Segment(space.static_body, (-100.0, 0.0), (100.0, 0.0), 0.0)
    for shape, kind in ((ball, ROUND), (floor, FLAT)):
        shape.collision_type, shape.friction = kind, math.sqrt(FRICTION)
        shape.elasticity = math.sqrt(RESTITUTION)
    space.add(body, ball, floor)
    if ours:
        space.on_collision(ROUND, FLAT, pre_solve=bounce)
    return space, body


if __name__ == "__main__":
    for ours, name in ((False, "pymunk"), (True, "contactlab")):
        space, body = thrown((2.0, -4.4), 150.0, ours=ours)
        while body.velocity.y < 0.0:
            space.step(1e-4)
        (along, up), spin = body.velocity, body.angular_velocity
        print(f"{name:10} {along:6.2f} m/s along, {up:.2f} up, {spin:7.1f} rad/s")
