"""The one hook of a plug-in. Hooks only hand out classes; none is called in a step."""

from __future__ import annotations

import pluggy

PROJECT = "contactlab"

hookspec = pluggy.HookspecMarker(PROJECT)
#: Marks a plug-in's implementation: ``@contactlab.hookimpl``.
hookimpl = pluggy.HookimplMarker(PROJECT)


@hookspec(firstresult=True)
def contactlab_law(name: str) -> type | None:
    """Return the class of the law called ``name``, or None.

    Parameters
    ----------
    name : str
        The entry point's name, kind and law: ``"tangential.annulus"``. A module that is
        listed under one name only may leave the argument out.

    Returns
    -------
    type
        A subclass of ``NormalLaw``, ``TangentialLaw`` or ``Integrator``; its parameters
        are keyword arguments.
    """
