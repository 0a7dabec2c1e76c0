"""Default resolutions: the tangential law's choice, or the usual ones."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.law import law_kind, resolution_of
from contactlab.numeric.arrays import spread
from contactlab.outcome.plan import Clause
from contactlab.registry.composition import Laws
from contactlab.registry.law_words import keep_answers
from contactlab.solve.answers import Mask
from contactlab.solve.way import Way


def with_resolutions(way: Way, *, as_one: bool) -> list[Way]:
    """Return the ways of impacts whose laws have resolutions alike, each named.

    Impacts ``as_one`` share the finest resolution among them.
    """
    laws, scene = way.laws, way.scene
    found = None
    law = laws.capability.resolving
    if law is not None and len(laws.capability.unnamed) > 1:
        with faults.blaming(law):
            found = law.resolutions(scene, laws.normal, laws.integrator)
    if found is None:
        return [way._replace(laws=_usual(laws))]
    parts, steps, _ = found
    if not scene.shape:
        return [way._replace(laws=_choose(laws, float(parts), float(steps), found.reason))]
    both = np.stack([spread(each, scene.shape) for each in (parts, steps)])
    most = both.reshape(2, -1).max(axis=1)
    same = (both == most.reshape(2, *(1,) * len(scene.shape))).all(axis=0)
    if as_one or same.all():
        return [way._replace(laws=_choose(laws, float(most[0]), float(most[1]), found.reason))]
    ways = []
    for pair in sorted(set(map(tuple, both.reshape(2, -1).T.tolist()))):
        where = (both == np.reshape(pair, (2, *(1,) * len(scene.shape)))).all(axis=0)
        used = _choose(laws, pair[0], pair[1], found.reason)
        ways.append(way.taking(where)._replace(where=_within(way.where, where), laws=used))
    return ways


def _within(outer: object, where: Mask) -> Mask:
    """Return a part of a part as a mask of the whole batch."""
    if outer is ... or isinstance(outer, slice):
        return where
    mask = np.array(outer, dtype=bool)
    mask[mask] = where
    return mask


def _choose(laws: Laws, parts: float, steps: float, reason: str) -> Laws:
    """Return the laws with a number of parts and of steps."""
    return _with(laws, (("tangential", parts), ("integrator", steps)), reason)


def _usual(laws: Laws) -> Laws:
    """Return the laws with the usual resolutions where the user named none."""
    given = tuple((law_kind(law), resolution_of(law)) for law in laws.capability.unnamed)
    return _with(laws, given, "")


@keep_answers
def _with(laws: Laws, resolutions: tuple[tuple[str, float], ...], reason: str) -> Laws:
    """Return the laws with resolutions, by kind."""
    changed = {}
    for kind, value in resolutions:
        law = getattr(laws, kind)
        changed[kind] = attrs.evolve(law, **{law.resolution: type(resolution_of(law))(value)})
    return laws.change(**changed, by_scene=frozenset(changed), reason=reason, asked=laws)


def tell_resolution(laws: Laws, marched: Mask) -> list[Clause]:
    """Return words on the chosen resolutions, if the tangential law gives a reason."""
    if not laws.reason:
        return []
    found = {
        str(law.resolution): float(resolution_of(law))
        for kind, law in laws.by_kind().items()
        if kind in laws.by_scene
    }
    words = "up to " + " and ".join(f"{{:.0f}} {name}" for name in found)
    values = tuple(np.full(marched.shape, value) for value in found.values())
    return [Clause(f"resolution: {words}: {laws.reason}", marched, values)]
