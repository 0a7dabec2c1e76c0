"""The linear spring and slider of Cundall & Strack, for contactlab."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.cundall``."""
    from contactlab_cundall.law import CundallStrack

    return CundallStrack
