"""The library of ``kernels/*.h``, compiled with the package where there is a C compiler."""

from __future__ import annotations

import ctypes
import hashlib
import os
from functools import cache
from importlib import resources

#: 0 in this variable leaves the library out, at the build and at run time.
VARIABLE = "CONTACTLAB_COMPILED"
#: Name of the library beside this module, and the sources that it is built of, by package.
LIBRARY = "_compiled.so"
SOURCES = (
    ("contactlab", "kernels/contactlab_impact.h"),
    ("contactlab", "kernels/contactlab_march.h"),
    ("contactlab_laws", "compiled/impacts.c"),
    ("contactlab_laws", "compiled/marches.c"),
)
#: Words on an installation with the library.
COMPILED = "compiled"


def digest() -> str:
    """Return the digest of the installed sources."""
    content = hashlib.sha256()
    for package, path in SOURCES:
        content.update(resources.files(package).joinpath(path).read_bytes())
    return content.hexdigest()


def library() -> ctypes.CDLL | None:
    """Return the library, or None if it is missing or left out."""
    return _library(_wants_library())[0]


def tell() -> str:
    """Return in words whether the library is used, and why not."""
    return _library(_wants_library())[1]


def _wants_library() -> bool:
    """Return whether the environment lets the library be used."""
    return os.environ.get(VARIABLE, "").strip().lower() not in ("0", "false", "no", "off")


@cache
def _library(wanted: bool) -> tuple[ctypes.CDLL | None, str]:
    """Return the library, or None, and words about it."""
    if not wanted:
        return None, f"{VARIABLE}=0 leaves the compiled solver out"
    again = "install contactlab again where there is a C compiler"
    with resources.as_file(resources.files(__package__).joinpath(LIBRARY)) as path:
        if not path.exists():
            return None, f"the compiled solver was not built; {again}"
        try:
            found = ctypes.CDLL(str(path))
            built_of = found.contactlab_impact_sources
        except (OSError, AttributeError) as error:
            return None, f"the compiled solver does not load ({error}); {again}"
    built_of.restype = ctypes.c_char_p
    try:
        sources = digest()
    except OSError:
        return None, f"the sources of the compiled solver are not there; {again}"
    if built_of().decode() != sources:
        return None, f"the compiled solver is older than its sources; {again}"
    _declare(found)
    return found, COMPILED


def _declare(found: ctypes.CDLL) -> None:
    """Set the types of the functions of the library."""
    pointer, whole, number = ctypes.c_void_p, ctypes.c_long, ctypes.c_double
    some = ctypes.c_int  # ``ndpointer`` takes longer than an impact
    types = {
        "impact_follow_all": (None, whole, pointer, number, some, pointer, pointer),
        "impact_follow_kept": (whole, pointer, number, some, whole, pointer, pointer, pointer),
        "march_room": (ctypes.c_size_t, some, some),
        "march_scenes": (
            whole, whole, some, *[pointer] * 4, *[some] * 4, *[pointer] * 4, number,
            *[pointer] * 4,
        ),
        "march_paths": (
            whole, whole, some, some, pointer, whole, pointer, number, *[pointer] * 3,
        ),
        "march_rebounds": (None, whole, *[pointer] * 3, some, whole, *[pointer] * 3),
    }  # fmt: skip
    for name, (result, *arguments) in types.items():
        function = getattr(found, f"contactlab_{name}")
        function.restype, function.argtypes = result, arguments
