"""Plug-ins that were written for an earlier contactlab: what still runs, and what is refused."""

from __future__ import annotations

import re

#: Messages of errors about modules and names that this version does not have.
MISSING = (
    re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>contactlab[\w.]*)'"),
    re.compile(r"No module named '(?P<module>contactlab\.[\w.]*)'"),
    re.compile(r"module '(?P<module>contactlab[\w.]*)' has no attribute '(?P<name>\w+)'"),
)
REMEDY = "`contactlab guide version-2` says what has changed and what to write"


def other_version(error: BaseException) -> str | None:
    """Return the sentence for an error of an import from contactlab; None for any other error."""
    if not isinstance(error, ImportError | AttributeError):
        return None
    for pattern in MISSING:
        if (match := pattern.search(str(error))) is not None:
            parts = match.groupdict()
            wanted = f"{parts['name']} of {parts['module']}" if "name" in parts else parts["module"]
            return (
                f"was written for another version of contactlab: it uses {wanted}, which is not "
                f"there; {REMEDY}"
            )
    return None
