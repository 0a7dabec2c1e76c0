"""Normal laws with a dashpot whose restitution does not depend on the speed: linear, Tsuji's."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``normal.linear`` or ``normal.tsuji``."""
    from contactlab_laws.dashpot.law import Linear, Tsuji

    return {"normal.linear": Linear, "normal.tsuji": Tsuji}[name]
