"""Things that plug-ins bring, by name: each name means one thing of one distribution.

The names of things follow the rule of laws: ``distribution:name`` is unique, ``name`` alone means
contactlab's own, else that of the only distribution that offers it; if several do, it is refused.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from contactlab.numeric.names import quote
from contactlab.registration.hooks import HOOKS, PluginError
from contactlab.registration.manager import MANAGER, Told
from contactlab.registration.names import BLOCK_VARIABLE, HERE, PROJECT

T = TypeVar("T")
_KEPT: dict[str, tuple[object, dict[str, Any]]] = {}


def state() -> object:
    """Return a value that changes when plug-ins come, go or are blocked."""
    return MANAGER.changes, os.environ.get(BLOCK_VARIABLE, "")


def own_first(kind: str) -> bool:
    """Return whether contactlab's own things of a kind keep their names, whatever is installed.

    A plug-in of this program that answers too, or a blocked plug-in, takes them.
    """
    return not (os.environ.get(BLOCK_VARIABLE) or MANAGER.answers_here(HOOKS[kind]))


def sound(
    kind: str, of: type[T], fault: Callable[[T], str] = lambda _: "", **arguments: Any
) -> list[Told]:
    """Return what plug-ins bring of a kind; warn of what is faulty or not of the class ``of``.

    ``fault`` returns what is wrong with a thing of another distribution, or nothing.
    """
    found = []
    for told in MANAGER.gather(kind, **arguments):
        rule = ""
        if not isinstance(told.item, of):
            rule = f"which is no {of.__name__}"
        elif told.info.distribution != PROJECT:
            rule = fault(told.item)
        if not rule:
            found.append(told)
            continue
        what = quote(getattr(told.item, "name", told.item))
        MANAGER.tell(told.info, PluginError(f"{told.info.source} brought {what}, {rule}"))
    return found


def by_name(
    kind: str,
    of: type[T],
    key: Callable[[T], str],
    *,
    fault: Callable[[T], str] = lambda _: "",
    again: bool = True,
) -> Mapping[str, T]:
    """Return what plug-ins bring of a kind by name; warn once of what ``sound`` leaves out.

    A name of several distributions other than contactlab is left out, and each is under its name
    with the distribution before it. A name that one distribution brings twice is left out, and
    told. With ``again``, what was installed meanwhile is looked for.
    """
    MANAGER.load(kind, again=again)
    before, kept = _KEPT.get(kind, (None, {}))
    if before == state():
        return kept
    offers: dict[str, list[Told]] = {}
    for told in sound(kind, of, fault):
        offers.setdefault(key(told.item), []).append(told)
    found: dict[str, T] = {}
    for name, several in offers.items():
        rivals = _drop_repeated(name, several)
        one = find_thing(rivals)
        if one is not None:
            found[name] = one.item
        for rival in rivals:
            if rival is not one:
                found[f"{rival.info.distribution}:{name}"] = rival.item
    _KEPT[kind] = state(), found
    return found


def _drop_repeated(name: str, several: list[Told]) -> list[Told]:
    """Return the things of a name; warn of, and drop, those that a distribution brings twice."""
    counts = Counter(told.info.distribution for told in several)
    for told in several:
        own = told.info.distribution
        if own not in (PROJECT, HERE) and counts[own] > 1:
            rule = f"brought {name!r} twice, and neither is taken: give each a name"
            MANAGER.tell(told.info, PluginError(f"{told.info.source} {rule}"))
    return [
        told
        for told in several
        if told.info.distribution in (PROJECT, HERE) or counts[told.info.distribution] == 1
    ]


def find_thing(rivals: list[Told]) -> Told | None:
    """Return what a name means among things of that name, or None if it is refused."""
    for origin in (HERE, PROJECT):  # a registration of the program wins
        own = [told for told in rivals if told.info.distribution == origin]
        if own:
            return own[0]
    return rivals[0] if len(rivals) == 1 else None
