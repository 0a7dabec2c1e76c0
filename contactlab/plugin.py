"""For authors of plug-ins: the classes that hooks return, and ``hookimpl``, which marks a hook.

A plug-in is a module that an entry point of the group ``contactlab`` names, ``kind.name``. The
classes of laws are in ``contactlab`` itself. The other kinds:

================= ============================ ==============================================
kind              hook                         returns
================= ============================ ==============================================
``materials``     ``contactlab_materials()``    a list of ``Entry``
``columns``       ``contactlab_columns()``      a list of ``Column``
``shapes``        ``contactlab_shapes()``       a list of ``Shape``
``cases``         ``contactlab_cases()``        an iterable of ``Case``
``checks``        ``contactlab_checks()``       a list of functions that return a ``Finding``
``measurements``  ``contactlab_measurements()`` a list of ``Source`` or ``Slopes``
``cautions``      ``contactlab_cautions()``     a list of sentences, for a scene and laws
``options``       ``contactlab_options()``      nothing: adds options to a command's parser
================= ============================ ==============================================

``contactlab plugins check`` checks what a plug-in brings, whatever its kind.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactlab.numeric.names import import_on_use

if TYPE_CHECKING:
    from contactlab.impact.material import Entry
    from contactlab.impact.shapes import Shape
    from contactlab.outcome.columns import Column
    from contactlab.registration.hooks import hookimpl
    from contactlab.study.evidence import Slopes, Source
    from contactlab.study.stability_cases import Case
    from contactlab.study.validation import Finding

__all__ = ["Case", "Column", "Entry", "Finding", "Shape", "Slopes", "Source", "hookimpl"]

__getattr__, __dir__ = import_on_use(
    __name__,
    {
        "Case": "study.stability_cases",
        "Column": "outcome.columns",
        "Entry": "impact.material",
        "Finding": "study.validation",
        "Shape": "impact.shapes",
        "Slopes": "study.evidence",
        "Source": "study.evidence",
        "hookimpl": "registration.hooks",
    },
)
