"""Friction with partial slip for YADE: contactlab's kernel, called once a step for every contact.

For a script that YADE runs. Give every material frictionAngle=0, so that YADE's own law
Law2_ScGeom_MindlinPhys_Mindlin makes the normal force only, and put after the interaction loop

    friction = Springs("build/libspringskernel.so", mu=0.3, springs=8)
    O.engines = [..., PyRunner(command="friction.step()", iterPeriod=1), NewtonIntegrator(...)]
"""

import ctypes

import numpy as np
import yade

Numbers = ctypes.POINTER(ctypes.c_double)


class Springs:
    """Friction of all contacts of spheres: a state of 2 + 3 N numbers for each."""

    def __init__(self, library, mu, springs=8):
        self._take = ctypes.CDLL(library).springs_step
        self._take.restype = ctypes.c_double
        self._take.argtypes = [Numbers, ctypes.c_int, Numbers, Numbers, *[ctypes.c_double] * 4]
        self._take.argtypes += [Numbers]
        self.mu, self.springs, self.states, self.work = mu, springs, {}, 0.0

    def step(self):
        """Add the friction of every contact to the forces of this step."""
        states, self.states = self.states, {}
        for contact in yade.O.interactions:
            if not contact.isReal:
                continue
            both = min(contact.id1, contact.id2), max(contact.id1, contact.id2)
            new = np.zeros(2 + 3 * self.springs)
            # A contact that is over is forgotten here.
            state = self.states[both] = states.get(both, new)
            self._one(*both, contact, state)

    def _one(self, first, second, contact, state):
        """Add the friction of one contact; the body of the smaller number comes first."""
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
        moved, normal, force = (
            np.array(slip * yade.O.dt),
            np.array(contact.geom.normal),
            np.zeros(3),
        )
        self.work += self._take(
            _numbers(state), self.springs, _numbers(moved), _numbers(normal), size,
            self.mu * contact.phys.normalForce.norm(), radius, 8.0 / soft, _numbers(force),
        )  # fmt: skip
        force = yade.Vector3(*force.tolist())
        for number, sign, arm in ((first, 1.0, arms[0]), (second, -1.0, arms[1])):
            yade.O.forces.addF(number, sign * force)
            yade.O.forces.addT(number, arm.cross(sign * force))


def _numbers(array):
    """Return an array as the kernel takes it."""
    return array.ctypes.data_as(Numbers)
