"""A real ball beside elastic and rigid theory: the experiment of Kharaz, Gorham & Salman (2001).

An aluminium-oxide sphere meets glass at angles from 2 to 85 degrees. Beyond 30 degrees the
contact slips throughout, and the elastic and the rigid law agree; below, the rigid law
keeps 5/7 of the tangential velocity at every angle, and the measured share runs from 0.8 to 0.6.

Writes ``kharaz2001.png`` in the current folder.
"""

from importlib import resources
from pathlib import Path

from contactlab import Simulation, read_scene
from contactlab.figures import laws_over_sweep, save
from contactlab.study import compare

file = read_scene(Path(str(resources.files("contactlab.study"))) / "measured" / "kharaz2001.toml")
laws = ("fronts", "coulomb")
simulations = {law: Simulation(tangential=law) for law in laws}
comparison = compare(file, simulations)

print(file.title)
for agreement in comparison.agreements:
    for law in laws:
        where = agreement.where_largest(law)
        print(
            f"{agreement.measured.quantity:24s} {law:8s} rms {agreement.rms(law):.3f}, "
            f"largest {agreement.largest(law):.3f} at {where:.0f} degrees"
        )

restitution = comparison.agreements[0]
save(
    Path("kharaz2001.png"),
    lambda axes: laws_over_sweep(axes, comparison, "tangential_restitution", restitution),
)
