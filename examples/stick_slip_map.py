"""Where a contact sticks and where it slips: its state over radius and time at psi1 = 1.2.

Writes ``stick_slip_map.png`` in the current folder.
"""

from pathlib import Path

import contactlab
from contactlab.figures import draw_stick_slip, save

scene = contactlab.Scene.nondimensional(psi1=1.2, chi=1.4412)
simulation = contactlab.Simulation(
    tangential=contactlab.create("tangential.springs", springs=200),
    integrator=contactlab.create("integrator.symplectic", steps=800),
)
result = simulation.run(scene, history="fields").check()
history = result.history
fields = history.fields
time = history.time / result.motion.duration
in_contact = fields["stuck"] | (fields["slipping"] != 0)
for instant in (0.1, 0.3, 0.5, 0.7, 0.9):
    row = int(abs(time - instant).argmin())
    share = fields["stuck"][row].sum() / in_contact[row].sum()
    print(f"t/t_c = {instant}: {share:4.0%} of the springs in contact stick")
save(Path("stick_slip_map.png"), lambda axes: draw_stick_slip(axes, result))
