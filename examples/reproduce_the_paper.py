"""Reproduce the paper: Figs 1 to 4 of Maw, Barber & Fawcett (1976), with words between.

The cells begin with ``# %%``, so that editors run them one by one. Writes ``figure-1.png`` to
``figure-4.png`` in the current folder; ``contactlab figures --out DIR`` writes the numbers too.
"""

# %%
# The laws are the paper's own: Hertz contact, annuli that stick or slip, even steps in time.
import functools
from pathlib import Path
from typing import Any

import numpy as np

from contactlab import Scene, Simulation, create, rebound
from contactlab.figures import draw_paper, save
from contactlab.study import SOLID_CHI, paper_data

paper = Simulation(
    tangential=create("tangential.annulus", annuli=20),
    integrator=create("integrator.paper", steps=200),
)


def numbers(figure: int) -> Any:
    """Return the curves of a figure of the paper."""
    return paper_data()[figure](paper)


def drawn(data: Any) -> Any:
    """Return the picture of a figure, which a notebook shows below its cell."""
    return save(Path(f"figure-{data.number}.png"), functools.partial(draw_paper, data=data))


# %%
# **Fig. 1: the tangential force over the contact.** Near the normal most of the contact sticks,
# the force swings as that of a spring, and changes its sign before the bodies part. The nearer
# to grazing the impact, the longer the contact slips, with mu times the normal force.
forces = numbers(1)
for curve in forces.curves:
    if curve.parameter == curve.parameter:  # the limit mu P belongs to no angle
        turn = curve.x[np.argmax(curve.y < 0.0)]
        print(f"psi1 = {curve.parameter:3.1f}: the force turns at {turn:.2f} of the contact")
drawn(forces)

# %%
# **Fig. 2: the rebound over the angle of incidence.** A negative psi2 means that the contact
# point leaves against the direction in which it arrived; that of rigid bodies stops instead.
# Beyond psi1 = 4 chi - 1 the contact slips to the end, and psi2 = psi1 - 4 chi.
psi1 = np.linspace(0.05, 7.0, 300)
psi2 = rebound(psi1, SOLID_CHI)
print(f"least psi2 = {psi2.min():.2f} at psi1 = {psi1[psi2.argmin()]:.2f}")
print(f"gross slip from psi1 = 4 chi - 1 = {4.0 * SOLID_CHI - 1.0:.2f} on")
drawn(numbers(2))

# %%
# **Fig. 3: where the mass is.** At the same psi1 = 1.2 a hollow sphere and one with a dense core
# differ: the less the moment of inertia, the greater chi, and the more often the force swings.
swings = numbers(3)
for curve in swings.curves:
    if curve.parameter == curve.parameter:
        turns = np.count_nonzero(np.diff(np.sign(curve.y[1:-1])))
        print(f"radius of gyration {curve.parameter:4.2f} R: turns of the force: {turns}")
drawn(swings)

# %%
# **Fig. 4: the rebound over chi.** The annuli of the paper lie within their numerical error of
# the exact curve. That error is no error of the model: it falls as one over the number of
# annuli.
scene = Scene.nondimensional(psi1=1.2, chi=SOLID_CHI)
exact = float(rebound(1.2, SOLID_CHI))
for annuli in (10, 20, 40):
    finer = Simulation(
        tangential=create("tangential.annulus", annuli=annuli),
        integrator=create("integrator.paper", steps=10 * annuli),
    )
    off = abs(finer.run(scene).check().psi2 - exact)
    print(f"{annuli:3d} annuli: {off:.4f} from the exact psi2 = {exact:.4f}")
drawn(numbers(4))
