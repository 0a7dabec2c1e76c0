"""Compose the paper's model, swap its friction law, and compare: the same impacts under three.

The paper's model is Hertz's normal law, friction on concentric annuli, and the paper's own steps.
Rigid Coulomb friction is one word away. The default solves the paper's equations exactly.

Writes ``law_swap.png`` in the current folder: what the three say of all angles.
"""

import numpy as np

from contactlab import Scene, Simulation, compare

scene = Scene.nondimensional(psi1=np.linspace(0.0, 7.0, 71), chi=1.4412)
paper = Simulation(normal="hertz", tangential="annulus", integrator="paper")
rigid = Simulation(normal="hertz", tangential="coulomb")
laws = compare(scene, {"exact": Simulation(), "paper": paper, "rigid": rigid})
print(*(f"{law} {laws.values('psi2', law)[12]:.4f}" for law in laws.names))
laws.plot().figure.savefig("law_swap.png")
