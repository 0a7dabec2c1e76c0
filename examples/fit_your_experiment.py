"""Fit your experiment: friction from measured rebounds, and which law fits them best.

The cells begin with ``# %%``, so that editors run them one by one. Writes ``fit.png`` in the
current folder. ``contactlab fit impacts.csv bodies.toml`` does the same without Python.
"""

# %%
# The data: a row an impact, units in the headings. Instead of these lists the path of a CSV
# will do. The restitution of the tangential velocity of the centre is that of alumina spheres on
# glass, read off the figures of Kharaz, Gorham & Salman (2001); a heading that begins with #
# would not be read.
from pathlib import Path

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, fit
from contactlab.figures import draw_fits
from contactlab_fit import rank

impacts = {
    "angle_deg": [2.04, 3.95, 9.66, 20.1, 30.2, 39.4, 49.6, 59.9, 71.1, 79.2, 85.2],
    "speed (m/s)": [3.9] * 11,
    "tangential_restitution": [
        0.795, 0.746, 0.674, 0.597, 0.689, 0.773, 0.847, 0.902, 0.937, 0.970, 0.979,
    ],
}  # fmt: skip

# %%
# The bodies. The friction given here is where the search begins; what the table says of speed
# and angle takes the place of the velocities.
alumina = Material(young_modulus=380e9, poisson_ratio=0.23, density=4000)
glass = Material(young_modulus=70e9, poisson_ratio=0.25)
bodies = Scene(
    Sphere(2.5e-3, alumina), HalfSpace(glass), friction_coefficient=0.1, normal_speed=1.0
)
found = fit(impacts, bodies, parameters=["friction_coefficient"])
print(found)

# %%
# The interval tells of the scatter. It does not hold the error of the law, so fit other laws as
# well: the difference of their Akaike numbers ranks them (10 is beyond doubt), and the residuals
# show where each is off. That of the best law may still be wrong in a regular way: look at the
# picture.
laws = {
    "exact": None,
    "capped spring": Simulation(tangential="mindlin_cap", integrator="symplectic"),
    "rigid": Simulation(tangential="coulomb", integrator="symplectic"),
}
ranked = rank(impacts, bodies, laws)
fits = {one.name: one.fit for one in ranked if one.fit is not None}
for name, one in fits.items():
    friction = one["friction_coefficient"]
    rms = (one.residuals["tangential_restitution"] ** 2).mean() ** 0.5
    print(f"{name:14s} friction {friction:.4f}, rms residual {rms:.3f}")
draw_fits(Path("fit.png"), fits)
