"""Integrators with even steps: the paper's scheme, a symplectic one, and error control of it."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``integrator.paper``, ``.symplectic`` or ``.adaptive``."""
    if name == "integrator.paper":
        from contactlab_laws.march.paper import PaperSteps

        return PaperSteps
    if name == "integrator.adaptive":
        from contactlab_laws.march.adaptive import Adaptive

        return Adaptive
    from contactlab_laws.march.symplectic import Symplectic

    return Symplectic
