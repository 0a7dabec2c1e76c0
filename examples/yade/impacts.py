"""Impacts of pairs of like spheres in YADE, for rebounds.py, which writes and reads its files.

yade -n -x impacts.py PAIRS LIBRARY SPRINGS       (SPRINGS 0: YADE's own friction)
"""

import json
import math
import sys
from pathlib import Path

import yade
from springs import Springs  # beside this file, whose folder rebounds.py puts on PYTHONPATH
from yade import O, utils

pairs, library, springs = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
given = json.loads(pairs.read_text())
O.dt = given["time_step"]
for k, pair in enumerate(given["pairs"]):
    material = yade.FrictMat(
        young=given["young"], poisson=pair["poisson"], density=pair["density"],
        frictionAngle=0.0 if springs else math.atan(given["mu"]),
    )  # fmt: skip
    for sign in (-1.0, 1.0):  # they meet along x, and slide along y
        ball = utils.sphere((0, 0, 0), given["radius"], material=material)
        ball.state.pos = (
            sign * (given["radius"] + 0.5 * pair["gap"]),
            0.1 * (k % 40),
            0.1 * (k // 40),
        )
        ball.state.vel = (
            -0.5 * sign * pair["speed"],
            -0.5 * sign * pair["slip"] * (1 - pair["share"]),
            0,
        )
        ball.state.angVel = (0, 0, 0.5 * pair["slip"] * pair["share"] / given["radius"])
        O.bodies.append(ball)

friction = Springs(library, given["mu"], springs)
O.engines = [
    yade.ForceResetter(),
    yade.InsertionSortCollider([yade.Bo1_Sphere_Aabb()]),
    yade.InteractionLoop(
        [yade.Ig2_Sphere_Sphere_ScGeom()],
        [yade.Ip2_FrictMat_FrictMat_MindlinPhys(betan=given["betan"], betas=given["betan"])],
        [yade.Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    yade.PyRunner(command="friction.step()", iterPeriod=1, dead=not springs),
    yade.NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
O.run(given["steps"], True)
answers = [[*b.state.vel, *b.state.angVel] for b in O.bodies]
pairs.with_suffix(".out").write_text(json.dumps({"bodies": answers, "work": friction.work}))
