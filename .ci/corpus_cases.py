"""Cases of corpus.py: laws with options, scenes, encounters, commands, doors and fits."""

import functools
import itertools

import numpy as np

import contactlab as cl
from contactlab import study

STEEL, GLASS = cl.Material.named("steel"), cl.Material.named("soda-lime glass")
BALL, FLOOR = cl.Sphere(radius=0.01, material=STEEL), cl.HalfSpace(STEEL)
NORMAL = [
    ("hertz", {}), ("hunt_crossley", {"restitution": 0.8}), ("hunt_crossley", {"damping": 0.5}),
    ("kuwabara_kono", {}), ("kuwabara_kono", {"relaxation_time": 1e-6}), ("dmt", {}),
    ("walton_braun", {"restitution": 0.7}), ("thornton", {}), ("linear", {}), ("jkr", {}),
    ("thornton", {"yield_pressure": 1e9}), ("jkr", {"work_of_adhesion": 5.0}),
    ("linear", {"stiffness": 1e6}), ("tsuji", {"restitution": 0.6}),
]  # fmt: skip
#: Those at even places meet every normal law and integrator.
TANGENTIAL = [
    ("annulus", {"annuli": 10}), ("annulus", {"annuli": 12, "displacement": "mean"}),
    ("fronts", {}), ("fronts", {"table": False}), ("halfspace", {"rings": 6, "angles": 1}),
    ("halfspace", {"rings": 4, "angles": 2, "coupling": "one_way"}),
    ("linear_spring", {}), ("linear_spring", {"damping": 0.1}),
    ("mindlin_cap", {}), ("mindlin_cap", {"form": "increment"}),
    ("thornton_yin", {}), ("mindlin_cap", {"form": "displacement_rescaled"}),
    ("mindlin_deresiewicz", {}), ("mindlin_deresiewicz", {"components": 32}),
    ("springs", {"springs": 8}), ("springs", {"springs": 8, "grid": "doubling"}),
    ("stronge", {}), ("stronge", {"stiffness_ratio": 0.9}),
    ("walton", {"beta0": 0.3}), ("mindlin_cap", {"form": "increment_rescaled"}),
    ("frictionless", {}), ("coulomb", {}),
]  # fmt: skip
INTEGRATORS = [
    ("events", {}), ("paper", {"steps": 60}), ("symplectic", {"steps": 50}),
    ("adaptive", {"tolerance": 1e-2}),
]  # fmt: skip
#: Words of commands; a name after @ is a file in the folder examples.
COMMANDS = """
--version
guide
guide theory 5
guide choosing
materials
plugins list
materials steel --json
plugins show tangential.annulus --json
plugins show jkr
plugins check tangential.walton
plugins check normal.hertz
kernel --out k
cite @kharaz2001.toml
cite --tangential fronts,coulomb
explore --out e.html
run --psi1 1.2 --chi 1.44
run --psi1 1.2 --chi 1.44 --json
run @steel_ball.toml --tangential annulus --set tangential.annuli=10 --set integrator.steps=50
run --psi1 1.2 --chi 1.44 --figure f.png --history h.csv --out o.json
run --psi1 1.2 --chi 1.44 --stick-slip s.png
run @sweep.toml --out o.npz --figure f.svg
run @foot.toml --json --history h.csv
run @foot.toml --figure f.png
run @thrown_ball.toml --tangential coulomb
sweep --psi1 0:4:9 --chi 1:2:3 --csv
sweep --psi1 -3:4:9 --chi 1.44 --json --out o.csv
sweep @kharaz2001.toml --out o.json --resume
compare --psi1 1.2 --chi 1.44 --tangential fronts,coulomb,springs --json --figure f.png
compare @sweep.toml --tangential fronts,coulomb,stronge --figure f.png --width one
compare @kharaz2001.toml --figure f.pdf --style slides
compare @foot.toml --tangential fronts,coulomb
compare --psi1 1.2 --chi 1.44 --loops l.png --tangential springs,mindlin_cap --estimate-error
fit @kharaz2001.toml --quantity psi2
fit @kharaz2001.toml --fit friction_coefficient,stiffness_ratio --bootstrap 0 --json
fit @kharaz2001.toml --bootstrap 20 --figure f.png --residuals r.csv --tangential coulomb,exact
stability --quick --tangential walton --figure f.png --out s.csv
figures --out f --only 1,2,3,4 --set integrator.steps=100
bench --quick --tangential coulomb
report @steel_ball.toml --out r.html
report @kharaz2001.toml --out r.html
animate @thrown_ball.toml --ghost coulomb --out t.gif
animate @foot.toml --out f.gif
run
run nowhere.toml
run @sweep.toml --psi1 1
run --psi1 1
run --psi1 x --chi 1
run --psi1 1 --chi -2
rum
sweep --psi1 1:2 --chi 1
compare @foot.toml --all
fit @sweep.toml
run @steel_ball.toml --tangential annulus --set tangential.anuli=3
figures --out f --only 9
run @steel_ball.toml --tangential fronts --normal jkr
plugins show herz
guide thery
materials stel
explore --material wood
run @steel_ball.toml --out steel.txt
""".strip().splitlines()


def scenes():
    """Return single impacts, batches and grids, with bodies and without."""
    thrown = functools.partial(cl.Scene.at_angle, BALL, FLOOR, 0.2, speed=0.3)
    unlike = cl.Scene(cl.Sphere(0.02, GLASS), BALL, 0.1, normal_speed=0.5, tangential_velocity=0.1)
    plain = cl.Scene.nondimensional
    return {
        "thrown": thrown(angle_deg=20.0, spin=9.0), "unlike": unlike,
        "plain": plain(psi1=1.2, chi=1.44),
        "batch": plain(psi1=np.array([-3.0, 0.0, 0.4, 1.1, 9]), chi=np.array([1.4, 1.0, 2, 3, 1])),
        "angles": thrown(angle_deg=np.array([5.0, 30.0, 80.0])),
        "grid": cl.Scene.grid(BALL, cl.HalfSpace(GLASS), friction_coefficient=[0.1, 0.4],
                              normal_speed=1.0, tangential_velocity=[0.05, 0.3, 2.0]),
    }  # fmt: skip


def encounters():
    """Return meetings of spheres, rods, boxes and ellipsoids."""
    down, met = (0.0, 0.0, -1.0), cl.Encounter
    fall, parting, other = (0.3, 0.1, -1.0), (0.0, 0.0, 1.0), cl.Sphere(0.02, GLASS)
    made = {
        "sphere": met(BALL, FLOOR, 0.2, normal=down, velocity=fall, spin=(4.0, 5.0, 6.0)),
        "pair": met(BALL, other, 0.3, normal=(1, 1, 0), velocity=(1.0, 0.0, 0.2)),
        "apart": met(BALL, FLOOR, 0.2, normal=down, velocity=[fall, parting]),
    }
    bodies = {"rod": cl.shapes.rod(length=0.2, radius=0.01, material=STEEL, normal=down,
                                   axis=(0.3, 0, 1)),
              "box": cl.shapes.box(sides=(0.1, 0.2, 0.3), corner_radius=0.01, material=STEEL,
                                   normal=(0.1, 0.2, -1)),
              "egg": cl.shapes.ellipsoid(semi_axes=(0.02, 0.03, 0.02), material=GLASS,
                                         normal=(0.2, -0.3, -1))}  # fmt: skip
    for name, (body, contact) in bodies.items():
        made[name] = met(body, FLOOR, 0.3, normal=down, velocity=(0.5, 0.1, -1.0), contact=contact)
    return made


def doors():
    """Return calls of one argument, by the name of the door."""
    met = scenes()
    return {
        "radius": lambda v: cl.Sphere(v, STEEL), "mass": lambda v: cl.Sphere(1.0, STEEL, mass=v),
        "material": lambda v: cl.Material(young_modulus=v, poisson_ratio=0.3),
        "poisson": lambda v: cl.Material(young_modulus=1e9, poisson_ratio=v),
        "named": lambda v: cl.Material.named(v), "name": lambda v: cl.create(v),
        "friction": lambda v: cl.Scene(BALL, BALL, v, normal_speed=1.0),
        "speed": lambda v: cl.Scene(BALL, BALL, 0.3, normal_speed=v),
        "angle": lambda v: cl.Scene.at_angle(BALL, BALL, 0.3, speed=1.0, angle_deg=v),
        "plain": lambda v: cl.Scene.nondimensional(psi1=v, chi=1.0), "run": cl.Simulation().run,
        "grid": lambda v: cl.Scene.grid(chi=v, psi1=[1.0]), "sweep": cl.Simulation().sweep,
        "law": lambda v: cl.Simulation(tangential=v),
        "steps": lambda v: cl.create("integrator.paper", steps=v),
        "annuli": lambda v: cl.create("tangential.annulus", annuli=v),
        "e": lambda v: cl.create("normal.tsuji", restitution=v), "scene file": cl.read_scene,
        "normal": lambda v: cl.Encounter(BALL, BALL, 0.1, normal=v, velocity=(1.0, 0, 0)),
        "psi1": lambda v: cl.rebound(v, 1.44), "chi": lambda v: cl.rebound(1.0, v),
        "tolerance": lambda v: cl.rebound(1.0, 1.0, tolerance=v), "collide": cl.collide,
        "restitution": lambda v: cl.rebound(1.0, 1.0, restitution=v),
        "rod": lambda v: cl.shapes.rod(length=v, radius=0.1, material=STEEL, normal=(0, 0, -1),
                                       axis=(0, 0, 1)),
        "body": lambda v: cl.RigidBody(mass=v, principal=(1, 1, v), material=STEEL,
                                       curvature_radius=1.0),
        "lam": lambda v: cl.Scene.nondimensional(psi1=1.0, chi=1.0, lam=v, eta=0.1),
        "approach": lambda v: cl.load_path(met["unlike"], v, [0.0, 1.0]), "fit": cl.fit,
        "measured": lambda v: cl.fit({"angle_deg": [5, 10, 60, 70], "tangential_restitution": v},
                                     met["angles"].take(0)),
        "history": lambda v: cl.Simulation().run(met["plain"], history=v),
        "compare": lambda v: study.compare(met["batch"], {"a": v}),
    }  # fmt: skip


def fits():
    """Yield fits of three parameters to one set of measurements, by all and by one quantity."""
    data = {"angle_deg": [4, 9, 15, 25, 40, 60, 75.0], "rebound_spin (rpm)": [9e2] * 7,
            "tangential_restitution": [0.74, 0.66, 0.61, 0.62, 0.79, 0.9, 0.96]}  # fmt: skip
    thrown = cl.Scene.at_angle(BALL, cl.HalfSpace(GLASS), 0.1, speed=2.0, angle_deg=30.0)
    walton = cl.Simulation(tangential="walton")
    parameters = {"friction_coefficient": None, "stiffness_ratio": None}
    parameters["tangential.beta0"] = walton
    for (name, laws), only in itertools.product(parameters.items(), (None, [[*data][2]])):
        how = {"parameters": [name], "simulation": laws, "quantities": only, "bootstrap": 8}
        yield f"fit {name} {only}", functools.partial(cl.fit, data, thrown, **how)
