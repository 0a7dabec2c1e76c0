"""Integrators with fixed steps: the paper's explicit steps, and a symplectic scheme."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``integrator.paper`` or ``integrator.symplectic``."""
    if name == "integrator.paper":
        from contactlab_march.paper import PaperSteps

        return PaperSteps
    from contactlab_march.symplectic import Symplectic

    return Symplectic
