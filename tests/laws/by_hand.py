"""Normal impacts integrated by the tests themselves, in units of mass, speed and R of 1."""

from scipy.integrate import solve_ivp


def rebound(force, *, method="DOP853"):
    """Return e of z'' = -force(z, z') from z = 0, z' = 1 until the force vanishes on the way out.

    Independent of contactlab's own solver: another method at tighter tolerances will do.
    """

    def released(_, state):
        return force(*state) if state[1] < 0.0 else 1.0

    released.terminal = True

    def slope(_, state):
        return [state[1], -force(*state)]

    found = solve_ivp(
        slope, (0.0, 1e9), [0.0, 1.0], method=method, events=released, rtol=1e-12, atol=1e-15
    )
    assert found.status == 1
    return -found.y_events[0][0, 1]
