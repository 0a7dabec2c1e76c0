"""Fit your experiment: friction from measured rebounds, and which law fits them best.

The cells begin with ``# %%``, so that editors run them one by one. Writes ``fit.png`` in the
current folder. ``contactlab fit impacts.csv bodies.toml`` does the same without Python.
"""

# %%
# The data: a row an impact, units in the headings. The path of a CSV file will do instead.
# The restitution of the tangential velocity of the centre is that of alumina spheres on glass,
# read off the figures of Kharaz, Gorham & Salman (2001); a heading that begins with # would not
# be read.
from pathlib import Path

import numpy as np

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, fit
from contactlab.figures.fitting import draw_fits
from contactlab.fitting import rank

impacts = {
    "angle_deg": np.array(
        [
            2.0350333333333332,
            3.949666666666667,
            9.656,
            20.104766666666666,
            30.235066666666665,
            39.4099,
            49.61463333333334,
            59.930800000000005,
            71.0693,
            79.2277,
            85.1683,
        ]
    ),
    "speed (m/s)": np.full(11, 3.9),
    "tangential_restitution": np.array(
        [
            0.7945933333333333,
            0.7455400000000001,
            0.6736066666666667,
            0.5973866666666666,
            0.6887133333333333,
            0.77256,
            0.8473733333333332,
            0.90166,
            0.93657,
            0.96952,
            0.97941,
        ]
    ),
}

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
for one in ranked:
    friction = one.fit["friction_coefficient"]
    rms = (one.fit.residuals["tangential_restitution"] ** 2).mean() ** 0.5
    print(f"{one.name:14s} friction {friction:.4f}, rms residual {rms:.3f}")
draw_fits(Path("fit.png"), {one.name: one.fit for one in ranked})
