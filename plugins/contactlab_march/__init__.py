"""Integrators with even steps: the paper's scheme, a symplectic one, and error control of it."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``integrator.paper``, ``.symplectic`` or ``.adaptive``."""
    if name == "integrator.paper":
        from contactlab_march.paper import PaperSteps

        return PaperSteps
    if name == "integrator.adaptive":
        from contactlab_march.adaptive import Adaptive

        return Adaptive
    from contactlab_march.symplectic import Symplectic

    return Symplectic
