"""How many panels an impact will need, and when it is given up."""

from __future__ import annotations

import math

PANEL_CAP = 3000
#: After this many panels the whole number is forecast, each time as many more are done. An impact
#: forecast to need more than HOPELESS times ``PANEL_CAP`` is given up: those that came to
#: the end, at chi from 1e4 to 1e6, had been forecast to need 1.2 times the cap at most.
FORECAST_EVERY, HOPELESS = 500, 1.5
#: Below this chi it is not oscillation that takes so many.
OFTEN = 1e3
TINY = 1e-300


def too_many(solves: int, begun: float, x: float, chi: float) -> str:
    """Return a complaint if an impact needs, or has taken, more panels than are allowed.

    Parameters
    ----------
    solves : int
        Panels solved on the way from phase ``begun`` to ``x``. They crowd where the contact is
        pressed most, about as sin x.
    begun, x : float
        Phase of the normal motion where the first panel began, and now.
    chi : float
        Inertia ratio, eq. (38), for the sentence.
    """
    if solves == 0 or (solves % FORECAST_EVERY and solves < PANEL_CAP):
        return ""
    done, left = math.cos(begun) - math.cos(x), 1.0 + math.cos(x)
    needed = solves * (1.0 + left / max(done, TINY))
    if solves < PANEL_CAP and needed <= HOPELESS * PANEL_CAP:
        return ""
    why = f"at chi = {chi:.3g} the contact oscillates too often, about sqrt(chi) times"
    if chi < OFTEN:
        why = "slip changes too often, or stick is lost within too short a time, to be followed"
    return (
        f"About {needed:.2g} panels would be needed, {PANEL_CAP} are allowed: {why}. A law of "
        "steps, such as springs under symplectic, can go on, with the error of its steps."
    )
