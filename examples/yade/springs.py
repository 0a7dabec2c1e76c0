"""Friction with partial slip for YADE: contactlab's kernel, called once a step for every contact.

For a script that YADE runs. Give every material frictionAngle=0, so that YADE's own law
Law2_ScGeom_MindlinPhys_Mindlin makes the normal force only, and put after the interaction loop

    friction = Springs("build/libspringskernel.so", mu=0.3, springs=8)
    O.engines = [..., PyRunner(command="friction.step()", iterPeriod=1), NewtonIntegrator(...)]

Where the normal force is damped (``en`` or ``betan`` of Ip2_FrictMat_FrictMat_MindlinPhys), shear
shares the loss.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import yade
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = ctypes.POINTER(ctypes.c_double)


class Springs:
    """Friction of all contacts of spheres: a state of 2 + 3 N numbers for each, and a velocity.

    ``shear_loss`` is the relaxation time in shear over that in pressure: 1 the theory, 0 elastic.
    """

    def __init__(self, library: str, mu: float, springs: int = 8, shear_loss: float = 1.0) -> None:
        self._take = ctypes.CDLL(library).springs_step
        self._take.restype = ctypes.c_double
        self._take.argtypes = [Numbers, ctypes.c_int, Numbers, Numbers, *[ctypes.c_double] * 4]
        self._take.argtypes += [Numbers, ctypes.c_double, ctypes.c_double, Numbers, ctypes.c_double]
        self.mu, self.springs, self.shear_loss = mu, springs, shear_loss
        self.states: dict[tuple[int, int], Any] = {}
        self.work = 0.0

    def step(self) -> None:
        """Add the friction of every contact to the forces of this step."""
        states, self.states = self.states, {}
        for contact in yade.O.interactions:
            if not contact.isReal:
                continue
            both = min(contact.id1, contact.id2), max(contact.id1, contact.id2)
            # A contact that is over is forgotten here.
            state, before = states.get(both, (np.zeros(2 + 3 * self.springs), None))
            self.states[both] = state, self._one(*both, contact, state, before)

    def _one(
        self, first: int, second: int, contact: Any, state: Array, before: Array | None
    ) -> Array:
        """Add the friction of one contact, and return its slip velocity.

        The body of the smaller number comes first. Velocities are those of half a step ago: the
        slip is continued from that of the step before.
        """
        one, other = yade.O.bodies[first], yade.O.bodies[second]
        place = contact.geom.contactPoint
        arms = place - one.state.pos, place - other.state.pos
        slip = one.state.vel + one.state.angVel.cross(arms[0])
        slip -= other.state.vel + other.state.angVel.cross(arms[1])
        radius = one.shape.radius * other.shape.radius / (one.shape.radius + other.shape.radius)
        size = (radius * max(contact.geom.penetrationDepth, 0.0)) ** 0.5
        # 8 G*, 1/G* = sum (2 - nu)/G.
        soft = sum(
            2.0 * (2.0 - m.poisson) * (1.0 + m.poisson) / m.young for m in (one.mat, other.mat)
        )
        hard = 1.0 / sum((1.0 - m.poisson**2) / m.young for m in (one.mat, other.mat))
        modulus, phys = 8.0 / soft, contact.phys
        viscous = 2.0 * phys.betan * (_mass(one, other) * phys.kn) ** 0.5
        damping = self.shear_loss * modulus / (2.0 * hard) * viscous
        elastic = (phys.normalForce + phys.normalViscous).norm()
        sliding: Array = np.array(slip)
        velocity = sliding if before is None or state[0] == 0.0 else 1.5 * sliding - 0.5 * before
        moved, normal, force = sliding * yade.O.dt, np.array(contact.geom.normal), np.zeros(3)
        self.work += self._take(
            _numbers(state), self.springs, _numbers(moved), _numbers(normal), size,
            self.mu * phys.normalForce.norm(), radius, modulus, _numbers(force),
            self.mu * elastic, damping, _numbers(velocity), yade.O.dt,
        )  # fmt: skip
        push = yade.Vector3(*force.tolist())
        for number, sign, arm in ((first, 1.0, arms[0]), (second, -1.0, arms[1])):
            yade.O.forces.addF(number, sign * push)
            yade.O.forces.addT(number, arm.cross(sign * push))
        return sliding


def _mass(one: Any, other: Any) -> Any:
    """Return the mass of the pair, as YADE's damping takes it."""
    masses = [body.state.mass for body in (one, other) if body.dynamic]
    return (
        masses[0]
        if len(masses) == 1
        else one.state.mass * other.state.mass / (one.state.mass + other.state.mass)
    )


def _numbers(array: Array) -> Any:
    """Return an array as the kernel takes it."""
    return array.ctypes.data_as(Numbers)
