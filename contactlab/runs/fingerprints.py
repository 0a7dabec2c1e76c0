"""Hashes of trees of laws, scenes and numbers, by which a sweep knows its pieces again."""

from __future__ import annotations

import contextlib
import hashlib
import pickle
from collections.abc import Callable, Mapping
from enum import Enum
from functools import singledispatch

import attrs
import numpy as np


def fingerprint(tree: object) -> str:
    """Return a hash of every number, text and class in a tree, 16 hexadecimal digits."""
    digest = hashlib.sha256()
    _feed(tree, digest.update)
    return digest.hexdigest()[:16]


def _feed(tree: object, update: Callable[[bytes], None]) -> None:
    """Pass the class and the bytes of a tree to ``update``."""
    update(type(tree).__qualname__.encode())
    _content(tree, update)


@singledispatch
def _content(tree: object, update: Callable[[bytes], None]) -> None:
    """Pass the bytes of a tree to ``update``."""
    kind = type(tree)
    if not attrs.has(kind):
        with contextlib.suppress(Exception):  # only answers tell a nested function
            update(pickle.dumps(tree))
        return
    for field in attrs.fields(kind):
        if not field.metadata.get("marks", True):
            continue
        update(field.name.encode())
        _feed(getattr(tree, field.name), update)


@_content.register
def _(tree: np.ndarray, update: Callable[[bytes], None]) -> None:
    update(f"{tree.dtype.str}{tree.shape}".encode())
    update(pickle.dumps(tree) if tree.dtype == object else np.ascontiguousarray(tree).tobytes())


@_content.register(Mapping)
def _(tree: Mapping[object, object], update: Callable[[bytes], None]) -> None:
    for name, value in tree.items():
        _feed(name, update)
        _feed(value, update)


@_content.register(list)
@_content.register(tuple)
def _(tree: list[object] | tuple[object, ...], update: Callable[[bytes], None]) -> None:
    for value in tree:
        _feed(value, update)


@_content.register(set)
@_content.register(frozenset)
def _(tree: set[object] | frozenset[object], update: Callable[[bytes], None]) -> None:
    for mark in sorted(map(fingerprint, tree)):  # their order changes from process to process
        update(mark.encode())


@_content.register
def _(tree: int | float | str | bytes | Enum | None, update: Callable[[bytes], None]) -> None:
    update(repr(tree).encode())
