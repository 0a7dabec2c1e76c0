"""Map of stick and slip over radius and time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from numpy.typing import NDArray

from contactlab.numeric.checks import refuse
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.style import LAW_COLOURS, TIME_LABEL

#: Colours of the states of an annulus, in the order of their numbers in the map.
STATES = {"slip, backward": LAW_COLOURS[1], "stick": "#C4C4C4", "slip, forward": LAW_COLOURS[0]}
NO_CONTACT = "#FFFFFF"


def draw_stick_slip(axes: Axes, result: ImpactResult) -> Axes:
    """Draw stick and slip over the contact of one impact, ``run(scene, history="fields")``.

    Raises
    ------
    ValueError
        For a batch, or without the fields ``radius``, ``stuck`` and ``slipping``.
    """
    history = result.history
    single = bool(history) and not result.scene.shape
    if not history or not single or not {"radius", "stuck", "slipping"} <= set(history.fields):
        raise refuse(
            "result",
            result,
            "must have the fields radius, stuck and slipping of a single impact",
            "run(scene, history='fields') with a law of partial slip, such as the default for "
            "spheres or springs for any body; an impact without slip velocity may have no fields",
        )
    time = history.time / result.motion.duration
    radius = history.fields["radius"][0] / result.motion.maximum_radius
    state = number_states(history.fields["stuck"], history.fields["slipping"])
    colours = ListedColormap([*STATES.values(), NO_CONTACT])
    norm = BoundaryNorm(np.arange(-0.5, 4.0), 4)
    axes.pcolormesh(time, radius, state.T, cmap=colours, norm=norm, shading="nearest")
    axes.set_xlabel(TIME_LABEL)
    axes.set_ylabel(r"radius over largest contact radius $r/a$")
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    present = [name for number, name in enumerate(STATES) if np.any(state == number)]
    patches = [Patch(color=STATES[name], label=name) for name in present]
    axes.legend(handles=patches, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(patches))
    return axes


def number_states(stuck: NDArray[np.bool_], slipping: NDArray[np.int8]) -> NDArray[np.int_]:
    """Return the place in ``STATES`` of each annulus at each instant; 3 out of contact.

    ``slipping`` is the sign of the traction where an annulus slips, else 0.
    """
    return np.where(stuck, 1, np.where(slipping == 0, 3, slipping + 1))
