"""One impact in six lines: a steel ball meets a steel block, 15 degrees off the normal.

Writes ``one_impact.png`` in the current folder: the tangential force over the contact.
"""

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere

steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
ball, block = Sphere(6.35e-3, steel), HalfSpace(steel)
scene = Scene(ball, block, 0.15, normal_speed=1.93, tangential_velocity=0.52)
simulation = Simulation(normal="hertz", tangential="annulus", integrator="symplectic")
result = simulation.run(scene, history=True)
print(result.check().plan)
print(f"psi1 = {result.psi1:.4f}, psi2 = {result.psi2:.4f}, spin {result.rebound_spin:.1f} rad/s")
result.plot(width="one").figure.savefig("one_impact.png", dpi=200)
