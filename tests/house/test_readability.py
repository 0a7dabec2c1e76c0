"""What a stranger relies on when reading: a map of the modules, and documented parameters."""

import ast
import importlib
import inspect
import re
import textwrap
from functools import cache
from graphlib import TopologicalSorter

import pytest

import contactlab
from contactlab import contracts
from tests.present import PACKAGE, ROOT, needs_sources

#: The public modules: guide, read-me and examples import from no other.
PUBLIC_MODULES = (
    "contactlab",
    "contactlab.contracts",
    "contactlab.testing",
    "contactlab.study",
    "contactlab.figures",
    "contactlab.plugin",
)
ROOMS = re.findall(r"^``(\w+)`` ", contactlab.__doc__, flags=re.MULTILINE)


def statements(node):
    """Yield every statement under a node; expressions, most of a file, are passed over."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.stmt | ast.excepthandler | ast.match_case):
            yield child
            yield from statements(child)


@cache
def imported_names(text):
    """Return the dotted name of every import in a file: lazy and type-only ones too."""
    names = []
    for node in statements(ast.parse(text)):
        if isinstance(node, ast.Import):
            names += [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{name.name}" for name in node.names]
    return [name for name in names if name.startswith("contactlab.")]


def imported_rooms(text):
    """Return the room of every import in a file."""
    return [name.split(".")[1] for name in imported_names(text)]


def upward_imports():
    """Return pairs (file, imported room) whose room comes after the room of the file."""
    return {
        (file.relative_to(PACKAGE).as_posix(), imported)
        for level, room in enumerate(ROOMS)
        for file in (PACKAGE / room).rglob("*.py")
        for imported in imported_rooms(file.read_text())
        if imported not in ROOMS[: level + 1]
    }


def test_the_map_of_the_package_names_every_room():
    paths = (path for path in PACKAGE.iterdir() if (path.is_dir() or path.suffix == ".py"))
    rooms = {path.stem for path in paths if not path.name.startswith("__")}
    # two have no Python, and one names what authors of plug-ins import
    assert sorted(ROOMS) == sorted(rooms - {"guide", "kernels", "plugin"})


def test_no_room_has_the_name_of_a_public_function():
    """Python would give the one in place of the other."""
    assert not set(ROOMS) & set(contactlab.__all__)


@pytest.mark.parametrize("room", ["registry", "solve", "runs", "collisions", "paths"])
def test_a_room_that_solves_has_few_files(room):
    assert len(list((PACKAGE / room).glob("*.py"))) <= 22


def test_the_face_has_at_most_twenty_eight_names_beside_those_of_authors_of_laws():
    of_authors = set(contactlab.__all__) & set(contracts.__all__) - {"Scene", "Status"}
    assert len(set(contactlab.__all__) - of_authors) <= 28
    assert all(getattr(contactlab, name) is getattr(contracts, name) for name in of_authors)
    derived_from = {name for name in contracts.__all__ if name.endswith(("Law", "Integrator"))}
    assert derived_from - of_authors == {"Law"}  # which nobody derives from


@needs_sources
def test_laws_import_contracts_impact_and_numbers_only():
    """Nor anything above, lazily or for types."""
    laws = ROOT / "plugins" / "contactlab_laws"
    rooms = {
        (file.relative_to(laws).as_posix(), room)
        for file in laws.rglob("*.py")
        for room in imported_rooms(file.read_text())
    }
    assert {room for _, room in rooms} == {"contracts", "impact", "numeric"}, rooms


def test_the_example_of_the_first_docstring_runs(capsys):
    example = re.search(r"::\n\n((?:    .*\n|\n)+)", contactlab.__doc__).group(1)
    exec(textwrap.dedent(example), {})
    assert "numerical error of psi2" in capsys.readouterr().out


def test_imports_point_downward():
    """In the order of the map: the laws import no figure, the scene no result."""
    assert upward_imports() == set()


def imports_of_modules():
    """Return {module: modules that it imports}."""
    files = {}
    for file in PACKAGE.rglob("*.py"):
        parts = file.relative_to(PACKAGE.parent).with_suffix("").parts
        files[".".join(part for part in parts if part != "__init__")] = file
    graph = {}
    for module, file in files.items():
        owners = {
            name if name in files else name.rpartition(".")[0]
            for name in imported_names(file.read_text())
        }
        graph[module] = (owners & files.keys()) - {module}
    return graph


def test_imports_make_no_circle():
    """Inside a room neither: modules can be read one after the other, each after its imports."""
    graph = imports_of_modules()
    assert "contactlab.registry.loading" in graph["contactlab.registry.registry"]
    assert len(list(TopologicalSorter(graph).static_order())) == len(graph)


def test_lazy_and_type_only_imports_count():
    text = (
        "if TYPE_CHECKING:\n    from contactlab.cli.main import main\n"
        "def lazy():\n    from contactlab import figures\n    import contactlab.study.loops\n"
    )
    assert imported_rooms(text) == ["cli", "figures", "study"]


def exported():
    """Return {dotted name: object} of the names in ``__all__`` of the public modules."""
    modules = map(importlib.import_module, PUBLIC_MODULES)
    return {
        f"{module.__name__}.{name}": getattr(module, name)
        for module in modules
        for name in module.__all__
    }


def imported_by_readers():
    """Return pairs (module, name) of what guide, read-me and examples import from contactlab."""
    pages = [*ROOT.glob("*.md"), *PACKAGE.glob("guide/*.md"), *ROOT.glob("examples/**/*.py")]
    return {
        (module, name)
        for page in pages
        for module, block, line in re.findall(
            r"^from (contactlab(?:\.\w+)*) import (?:\(([^)]*)\)|(.+))$",
            page.read_text(encoding="utf-8"),
            flags=re.MULTILINE,
        )
        for name in re.findall(r"\w+", block or line)
    }


def test_readers_are_shown_public_names_only():
    names = imported_by_readers()
    assert {("contactlab.study", "compare"), ("contactlab.figures", "save")} <= names
    for module, name in names:
        assert module in PUBLIC_MODULES, (module, name)
        assert name in dir(importlib.import_module(module)), (module, name)


def callables(name, value):
    """Yield (name, function, documented object) of a function, or of the methods of a class.

    A constructor is documented by its class; a generated one is left out, test_docstrings asks
    for its fields. A module stands for the functions and classes that it defines.
    """
    if inspect.ismodule(value):
        for inner, each in vars(value).items():
            own = getattr(each, "__module__", None) == value.__name__
            if own and not inner.startswith("_") and not inspect.ismodule(each):
                yield from callables(f"{name}.{inner}", each)
    elif inspect.isfunction(value):
        yield name, value, value
    elif inspect.isclass(value):
        for inner, _ in inspect.getmembers(value):
            if inner == "__init__" or not inner.startswith("_"):
                method = inspect.getattr_static(value, inner)
                method = getattr(method, "__func__", method)
                generated = "<" in getattr(getattr(method, "__code__", None), "co_filename", "<")
                if inspect.isfunction(method) and not (inner == "__init__" and generated):
                    bound = getattr(value, inner)
                    yield f"{name}.{inner}", bound, value if inner == "__init__" else bound


def undocumented(name, value):
    """Return the functions of a public name with four or more arguments and no Parameters section.

    A method may have its section in a class that it is derived from.
    """
    missing = []
    for dotted, function, described in callables(name, value):
        arguments = [each for each in inspect.signature(function).parameters if each != "self"]
        sections = ("Parameters\n---", "Attributes\n---")
        text = inspect.getdoc(described) or ""
        own = getattr(value, "__doc__", None) or ""
        told = "Parameters of methods\n" in own or any(section in text for section in sections)
        if len(arguments) >= 4 and not told:
            missing.append(dotted)
    return missing


def test_functions_of_four_arguments_document_them():
    """Only what is public is asked: a private helper has one line."""
    public = exported()
    assert {"contactlab.collide", "contactlab.contracts.quantity"} <= public.keys()
    assert {"contactlab.study.compare", "contactlab.figures.save"} <= public.keys()
    looked_at = [each[0] for name, value in public.items() for each in callables(name, value)]
    assert "contactlab.contracts.Integrator.integrate" in looked_at
    assert "contactlab.Scene.at_angle" in looked_at
    assert "contactlab.materials.entry" in looked_at
    assert not [each for name, value in public.items() for each in undocumented(name, value)]


def three(a, b, *, c): ...


def four(a, b, c, *, d): ...


class Base:
    def inherited(self, a, b, c, d):
        """Do.

        Parameters
        ----------
        a, b, c, d : int
        """


class Some(Base):
    def __init__(self, a, b, c, d): ...

    def short(self, a, b, c): ...

    def long(self, a, b, c, d): ...

    def _private(self, a, b, c, d): ...

    @classmethod
    def made(cls, a, b, c, d): ...

    def inherited(self, a, b, c, d): ...


@pytest.mark.parametrize(
    ("value", "missing"),
    [
        (three, []),
        (four, ["x"]),
        (Base, []),
        (Some, ["x.__init__", "x.long", "x.made"]),
    ],
)
def test_a_missing_section_is_found(value, missing):
    assert undocumented("x", value) == missing


def test_a_scene_shows_a_user_forty_one_members():
    """What solvers alone ask are functions of ``impact.kinetics``."""
    assert len([name for name in dir(contactlab.Scene) if not name.startswith("_")]) <= 41


@pytest.mark.parametrize(
    ("law", "most"), [("SteppedTangentialLaw", 16), ("NormalLaw", 11), ("Integrator", 12)]
)
def test_an_author_of_a_law_sees_few_members(law, most):
    bases = [
        base
        for base in getattr(contracts, law).__mro__
        if base.__module__.startswith("contactlab.contracts")
    ]
    names = {name for base in bases for name in (*vars(base), *base.__annotations__)}
    assert len({name for name in names if not name.startswith("_")}) <= most
