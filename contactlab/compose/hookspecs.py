"""The only hook of a plug-in. It returns a class; it is never called in a step."""

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
        The entry point's name, kind and law: ``"tangential.annulus"``. A module with a single
        entry point may leave the argument out.

    Returns
    -------
    type
        A subclass of ``NormalLaw``, ``TangentialLaw`` or ``Integrator`` whose parameters are
        keyword arguments.
    """
