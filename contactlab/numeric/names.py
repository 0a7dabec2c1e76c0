"""Names that users write: imported on first use, and refused with the nearest if unknown."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from typing import Any, TypeVar

Class = TypeVar("Class", bound=type)
Function = TypeVar("Function", bound=Callable[..., Any])
T = TypeVar("T")

#: Names in this package for symbols and names that users try. The first two that are accepted
#: where the symbol was used are suggested.
SYMBOLS: dict[str, tuple[str, ...]] = {
    "mu": ("friction_coefficient",), "friction": ("friction_coefficient", "tangential"),
    "nu": ("poisson_ratio",), "E": ("young_modulus",), "G": ("shear_modulus",),
    "rho": ("density",), "R": ("radius",), "r": ("radius",), "diameter": ("radius",),
    "d": ("radius",), "Y": ("yield_stress",),
    "law": ("tangential", "simulation"), "theta": ("angle_deg",), "alpha": ("angle_deg",),
    "m": ("mass",), "M": ("mass",), "K": ("gyration_ratio",),
    "I": ("inertia",), "J": ("inertia",), "moments": ("principal",),
    "v": ("tangential_velocity", "speed", "velocity"), "vx": ("tangential_velocity",),
    "velocity": ("rebound_tangential_velocity", "rebound_normal_velocity"),
    "speed": ("normal_speed",), "v1": ("normal_speed",), "vn": ("normal_speed",),
    "vz": ("normal_speed",), "v2": ("rebound_normal_velocity",),
    "omega": ("spin", "rebound_spin"), "w": ("spin", "rebound_spin"), "spin": ("rebound_spin",),
    "normal_spin": ("spin",), "side_spin": ("normal_spin", "spin"), "english": ("spin",),
    "w1": ("spin",), "chi_w": ("spin_inertia",), "chi_t": ("spin_inertia",),
    "e": ("restitution", "normal_restitution"), "restitution": ("normal_restitution",),
    "e_n": ("normal_restitution",), "e_t": ("tangential_restitution", "beta0"),
    "et": ("tangential_restitution", "beta0"), "e_T": ("beta0",), "slip_restitution": ("beta0",),
    "t": ("time",), "T": ("duration",),
    "force": ("normal_force", "tangential_force"),
    "F": ("tangential_force",), "P": ("normal_force",), "work": ("friction_work",),
    "kappa": ("stiffness_ratio",),
    "shear_modulus_ratio": ("stiffness_ratio",),
    "rebound_velocity": ("rebound_tangential_velocity", "rebound_normal_velocity", "velocity"),
    "final_velocity": ("rebound_tangential_velocity", "rebound_normal_velocity", "velocity"),
    "velocity_after": ("velocity",), "rebound_spin": ("spin",), "final_spin": ("spin",),
    "ball": ("sphere", "body"), "sphere": ("body",), "wall": ("target",), "plane": ("target",),
    "half_space": ("target",),
    "laws": ("simulation", "tangential"), "tangential": ("law",), "normal": ("law",),
    "to_csv": ("to_dataframe",), "save": ("to_dataframe",), "write": ("to_dataframe",),
    "to_pandas": ("to_dataframe",), "output": ("out",), "plot": ("figure",), "jobs": ("workers",),
    "angle": ("angle_deg", "rebound_angle"), "psi": ("psi1",), "dt": ("steps",), "n": ("steps",),
}  # fmt: skip
#: Shapes of bodies by the names that users try, and what makes them.
SHAPES = {
    "box": "shapes.box", "cube": "shapes.box", "cuboid": "shapes.box", "plate": "shapes.box",
    "block": "shapes.box", "rod": "shapes.rod", "bar": "shapes.rod or shapes.box",
    "cylinder": "shapes.rod (rounded ends) or shapes.disc (rounded rims)",
    "capsule": "shapes.rod", "tube": "shapes.rod, with its mass", "disc": "shapes.disc",
    "disk": "shapes.disc", "puck": "shapes.disc", "coin": "shapes.disc",
    "ellipsoid": "shapes.ellipsoid", "egg": "shapes.ellipsoid", "ball": "contactlab.Sphere",
    "sphere": "contactlab.Sphere",
}  # fmt: skip
#: Remarks on a suggested name whose quantity is another.
REMARKS = {
    **dict.fromkeys(("to_csv", "save", "write"), ", which has .to_csv(path)"),
    "diameter": ", half the diameter", "d": ", half the diameter",
    "slip_restitution": ", which is -slip_restitution in results, and the same number in walton",
    "e_T": ", which is -psi2/psi1",
}  # fmt: skip


def nearest(name: str, known: Iterable[str], *, alike: float = 0.5) -> str:
    """Return "did you mean ...? " with the nearest of ``known``; empty if none is near.

    A symbol means its name in this package, mu friction_coefficient. An option means a dotted
    name that ends with it. Else a name counts if its letters are ``alike`` to this share.
    """
    names = {_plain(each): each for each in known}
    plain = _plain(name)
    front, dot, last = plain.rpartition(".")
    words = (plain, *(f"{front}{dot}{each}" for each in SYMBOLS.get(last, ())))
    meant = [names[word] for word in words if word in names] or [
        names[each] for word in words for each in names if each.endswith(f".{word}")
    ]
    if not meant and last not in REMARKS:  # which would be wrong of another name
        import difflib  # slow to import, needed for misspelt names only

        if "." not in plain:
            names = {each.rpartition(".")[2]: full for each, full in names.items()} | names
        meant = [names[each] for each in difflib.get_close_matches(plain, names, 1, alike)]
    remark = REMARKS.get(last, "")
    return f"did you mean {' or '.join(map(repr, meant[:2]))}{remark}? " if meant else ""


def quote(value: object, *, most: int = 80) -> str:
    """Return ``value`` as one line of at most ``most`` characters, for a message."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # too many digits, lists nested too deeply, or a faulty __repr__
        text = f"a {type(value).__name__}"
    return text if len(text) <= most else text[: most - 3] + "..."


def _plain(name: str) -> str:
    """Return a name without the hyphens of an option on the command line."""
    return name.lstrip("-").replace("-", "_")


def tell_arguments(made: Class) -> Class:
    """Return a class that users make: wrong arguments are refused with the nearest, and all names.

    ``_remedy(name, value)`` of a class tells where an argument belongs that it does not have.
    """
    return _telling(made, made.__init__)  # type: ignore[misc]


def state_arguments(made: Class) -> Class:
    """Return a class of ``tell_arguments`` whose ``__init__`` states arguments only.

    Type checkers and readers see that method, attrs takes the arguments: no checker sees what the
    converters of attrs accept, and a call between the two would take as long as a small object.
    """
    return _telling(made, vars(made)["__attrs_init__"])


def _telling(made: Class, call: Callable[..., None]) -> Class:
    """Return a class whose class methods tell, and ``call`` in place of its ``__init__``."""
    remedy = getattr(made, "_remedy", None)
    for name, each in [*vars(made).items()]:
        if isinstance(each, classmethod):
            setattr(made, name, classmethod(_tell(made.__name__, each.__func__, remedy)))
    stated = made.__init__  # type: ignore[misc]
    made.__init__ = functools.wraps(stated)(_tell(made.__name__, call, remedy))  # type: ignore[misc]
    return made


def tell_function(call: Function) -> Function:
    """Return a function whose wrong arguments are refused with the nearest, and all names."""
    return _tell(call.__name__, call, None, own=0)  # type: ignore[return-value]


def tell_attributes(made: Class) -> Class:
    """Return a class of results that refuses a wrong attribute with the nearest, or all names."""

    def __getattr__(self: object, name: str) -> object:  # noqa: N807
        if name.startswith("_") or hasattr(made, name):
            return object.__getattribute__(self, name)  # an error in a property is its own
        public = [each for each in dir(self) if not each.startswith("_")]
        near = nearest(name, public).strip()
        remedy = near or f"it has {', '.join(public)}"
        for place, kind in getattr(made, "_within", {}).items():
            if hasattr(kind, name):
                remedy = f"it is in .{place}: write .{place}.{name}{near and '; ' + near}"
        text = f"{made.__name__} has no attribute {name!r}; {remedy}"
        raise AttributeError(text, name=name, obj=self)

    made.__getattr__ = __getattr__  # type: ignore[attr-defined]
    return made


def _tell(
    name: str, call: Callable[..., T], remedy: Callable[[str, object], str] | None, *, own: int = 1
) -> Callable[..., T]:
    """Return a function that says which arguments are wrong; the first of methods is their own."""

    @functools.wraps(call)
    def run(*values: object, **named: object) -> T:
        try:
            return call(*values, **named)
        except TypeError:
            if complaint := _unfit(call, values, named, remedy, own):
                raise TypeError(f"{name}: {complaint}") from None
            raise

    return run


def _unfit(
    call: Callable[..., object],
    values: Sequence[object],
    named: Mapping[str, object],
    remedy: Callable[[str, object], str] | None,
    own: int,
) -> str:
    """Return why arguments do not fit a call, and what would; empty if they fit."""
    import inspect  # slow to import, needed for wrong arguments only

    signature = inspect.signature(call)
    try:
        signature.bind(*values, **named)
    except TypeError:
        parameters = [*signature.parameters.values()][own:]
    else:
        return ""  # the error came from within
    names = [each.name for each in parameters]
    free = [each.name for each in parameters if each.kind is each.POSITIONAL_OR_KEYWORD]
    listed = f"arguments: {', '.join(names)}"
    for name in named:
        if name not in names:
            told = remedy(name, named[name]) if remedy else ""
            told = told or nearest(name, names, alike=0.75 if remedy else 0.5)
            return f"{name} is not an argument; {told}{listed}"
    if len(values) - own > len(free):
        rest = f"but for {' and '.join(free)}, " if free else ""
        return f"{rest}write arguments as name=value; {listed}"
    given = {*free[: len(values) - own], *named}
    for each in parameters:
        if each.default is each.empty and each.name not in given:
            return f"{each.name} must be given; {listed}"
    return "an argument is given twice"


def import_on_use(
    package: str, modules: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the functions ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package : str
        Name of the package, its ``__name__``.
    modules : mapping of str to str
        For each public name, the module in ``contactlab``, or that of a plug-in, that defines it,
        or that it is, if the module has no such name.
    """

    def __getattr__(name: str) -> object:  # noqa: N807
        """Return a public name, imported on first use and kept."""
        if name not in modules:
            hint = "" if name.startswith("_") else f"; {nearest(name, modules)}".rstrip("; ")
            if name.lower() in SHAPES:
                hint = f"; that body is made by contactlab.{SHAPES[name.lower()]}"
                hint = hint.replace("contactlab.contactlab", "contactlab")
            raise AttributeError(f"module {package!r} has no attribute {name!r}{hint}")
        place = modules[name]
        folder = place.partition(".")[0]
        if not folder.startswith("contactlab_"):
            place = f"contactlab.{place}"
        try:
            module = import_module(place)
        except ModuleNotFoundError as error:
            if error.name != folder:
                raise
            text = (
                f"{package}.{name} is in {folder}, which is not installed; install contactlab whole"
            )
            raise ModuleNotFoundError(text, name=folder) from None
        value = getattr(module, name, module)
        setattr(sys.modules[package], name, value)
        return value

    def __dir__() -> list[str]:  # noqa: N807
        """Return the public names, those that are not imported yet among them."""
        names = vars(sys.modules[package])
        return sorted({*names["__all__"], *modules, *({"__version__"} & names.keys())})

    return __getattr__, __dir__
