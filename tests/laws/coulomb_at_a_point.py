"""A set with Coulomb's law at every point: laws of partial slip under normal laws that dissipate.

``coulomb_at_a_point.csv`` holds the figures before and after: ``python -m
tests.laws.coulomb_at_a_point`` prints, for every pair of laws that fit, the largest difference of
psi2 from the law of the half-space along one direction over ``SCENES``.
"""

import numpy as np

import contactlab
from contactlab import Scene, Simulation
from contactlab.registry.composition import misfit
from tests.laws.normal_laws import in_si

#: psi1 and chi of the scenes: every pair.
PSI1 = (0.5, 1.0, 1.5, 2.0, 2.5, 3.5)
CHI = (0.8, 49 / 34, 1.8)

#: Normal laws: a name, and its option.
NORMAL = (
    ("hertz", {}),
    ("tsuji", {"restitution": 0.95}),
    ("tsuji", {"restitution": 0.8}),
    ("tsuji", {"restitution": 0.5}),
    ("hunt_crossley", {"restitution": 0.95}),
    ("hunt_crossley", {"restitution": 0.8}),
    ("hunt_crossley", {"restitution": 0.5}),
    ("kuwabara_kono", {"restitution": 0.95}),
    ("kuwabara_kono", {"restitution": 0.8}),
    ("kuwabara_kono", {"restitution": 0.5}),
    ("linear", {"restitution": 1.0}),
    ("linear", {"restitution": 0.8}),
    ("linear", {"restitution": 0.5}),
    ("walton_braun", {"restitution": 1.0}),
    ("walton_braun", {"restitution": 0.8}),
    ("walton_braun", {"restitution": 0.5}),
    ("thornton", {"yield_velocity": 0.3}),
    ("thornton", {"yield_velocity": 0.03}),
    ("jkr", {"work_of_adhesion": 1e-3}),
    ("jkr", {"work_of_adhesion": 2e-2}),
    ("dmt", {"work_of_adhesion": 1e-2}),
)

#: Tangential laws at resolutions of which half and all are extrapolated: option, count, order.
TANGENTIAL = {
    "springs": ("springs", 200, 2),
    "annulus": ("annuli", 100, 1),
}
#: Shear is elastic: springs that share a viscous loss solve another problem.
ELASTIC = {"springs": {"shear_loss": 0.0}, "annulus": {}}
#: Steps to a spring or an annulus.
STEPS = 4


def scene():
    """The scenes as a batch."""
    psi1, chi = np.meshgrid(PSI1, CHI)
    return in_si(Scene.nondimensional(psi1=psi1.ravel(), chi=chi.ravel()))


def reference(law):
    """psi2 of the scenes by the half-space, with Coulomb's law at every point."""
    half_space = contactlab.create("tangential.halfspace", angles=1, rings=64)
    return np.asarray(Simulation(normal=law, tangential=half_space).run(scene()).psi2)


def limit(law, name):
    """psi2 of the scenes under a tangential law, extrapolated in its resolution."""
    option, count, order = TANGENTIAL[name]
    found = []
    for parts in (count // 2, count):
        laws = {
            "normal": law,
            "tangential": contactlab.create(
                f"tangential.{name}", **{option: parts}, **ELASTIC[name]
            ),
            "integrator": contactlab.create("integrator.symplectic", steps=STEPS * parts),
        }
        found.append(np.asarray(Simulation(**laws).run(scene()).check().psi2))
    coarse, fine = found
    return fine + (fine - coarse) / (2**order - 1)


def pairs():
    """Iterate over (normal name, options, normal law, names of tangential laws that fit)."""
    for name, options in NORMAL:
        law = contactlab.create(f"normal.{name}", **options)
        fitting = [
            each
            for each in TANGENTIAL
            if misfit(law, contactlab.create(f"tangential.{each}")) is None
        ]
        yield name, options, law, fitting


def main():
    """Print the table."""
    print("normal,option,value,tangential,largest_difference")
    for name, options, law, fitting in pairs():
        known = reference(law)
        ((option, value),) = options.items() or (("", ""),)
        for each in fitting:
            largest = np.abs(limit(law, each) - known).max()
            print(f"{name},{option},{value},{each},{largest:.1e}", flush=True)


if __name__ == "__main__":
    main()
