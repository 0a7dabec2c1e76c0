"""Swap one law for another: the same impact under three laws of friction."""

from contactlab import Scene, Simulation

scene = Scene.nondimensional(psi1=1.2, chi=1.4412)
print("law            psi2     friction work  energy out of balance")
for law in ("annulus", "coulomb", "frictionless"):
    result = Simulation(tangential=law, integrator="symplectic").run(scene).check()
    energy = result.energy
    print(f"{law:12s} {result.psi2:8.5f}  {energy.friction_work:12.5f}  {energy.imbalance:12.1e}")
