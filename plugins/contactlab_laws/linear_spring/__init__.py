"""The linear spring with Coulomb's cap, and a dashpot beside it if asked for."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.linear_spring``."""
    from contactlab_laws.linear_spring.law import LinearSpring

    return LinearSpring
