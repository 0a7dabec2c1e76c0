"""Three impacts, two rigid laws, and a measured series beside them, as in a scene file."""

from contactlab import Simulation

LAWS = {"rigid": Simulation(tangential="coulomb"), "smooth": Simulation(tangential="frictionless")}
SWEEP = """
[nondimensional]
chi = 1.0
[sweep]
psi1 = [0.5, 2.0, 6.0]
"""
SERIES = """
[[measured]]
quantity = "psi2"
against = "psi1"
x = [1.0, 8.0]
values = [0.1, 3.5]
source = "made up"
"""
#: Of the series, which it follows.
ERRORS = "error = [0.0, 0.2]\n"
