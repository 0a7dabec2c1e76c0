"""What a stranger relies on when reading: a map of the modules, and documented parameters."""

import ast
import re
from pathlib import Path

import contactlab

PACKAGE = Path(contactlab.__file__).parent
PLUGINS = PACKAGE.parent / "plugins"
ROOMS = re.findall(r"^``(\w+)`` ", contactlab.__doc__, flags=re.MULTILINE)
#: Arrows that point upward still, from a file to a room. None may come; one that goes, goes here.
UPWARD = {
    ("outcome/history.py", "figures"),
    ("outcome/result.py", "figures"),
}


def imported_rooms(text):
    """Yield the room of every import in a file: lazy and type-only ones too."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{name.name}" for name in node.names]
        else:
            continue
        yield from (name.split(".")[1] for name in names if name.startswith("contactlab."))


def upward_imports():
    """Return every arrow from a file to a room that does not stand before its own."""
    return {
        (file.relative_to(PACKAGE).as_posix(), other)
        for level, room in enumerate(ROOMS)
        for file in (PACKAGE / room).rglob("*.py")
        for other in imported_rooms(file.read_text())
        if other not in ROOMS[: level + 1]
    }


def test_the_map_of_the_package_names_every_room():
    paths = (path for path in PACKAGE.iterdir() if (path.is_dir() or path.suffix == ".py"))
    found = {path.stem for path in paths if not path.name.startswith("__")}
    assert sorted(ROOMS) == sorted(found - {"guide"})


def test_imports_point_downward():
    """In the order of the map: the laws import no figure, the scene no result."""
    assert upward_imports() == UPWARD


def test_lazy_and_type_only_imports_count():
    text = (
        "if TYPE_CHECKING:\n    from contactlab.cli.main import main\n"
        "def lazy():\n    from contactlab import figures\n    import contactlab.pages.html\n"
    )
    assert list(imported_rooms(text)) == ["cli", "figures", "pages"]


def documented(docstring):
    return docstring is not None and "Parameters\n" in docstring


def functions(path):
    """Yield each function of a file and the class that it is a method of, if it is one."""
    for node in ast.walk(ast.parse(path.read_text())):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef):
                yield child, node if isinstance(node, ast.ClassDef) else None


def undocumented(path, contract=frozenset()):
    """Yield the functions of a file with four or more arguments and no Parameters section.

    Not overloads, nor what is documented elsewhere: a constructor by its class, a method of the
    contracts, or of an abstract class of the same package, there.
    """
    for function, owner in functions(path):
        given = function.args
        names = [each.arg for each in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
        if owner is not None and names[:1] in (["self"], ["cls"]):
            del names[0]
        elsewhere = owner is not None and (
            function.name in contract
            or (function.name == "__init__" and documented(ast.get_docstring(owner)))
        )
        overload = any("overload" in ast.unparse(each) for each in function.decorator_list)
        if len(names) >= 4 and not (
            elsewhere or overload or documented(ast.get_docstring(function))
        ):
            yield f"{path.name}: {function.name}"


def described(paths, *, abstract_only):
    """Return the names of the methods in some files that have a Parameters section."""
    return {
        function.name
        for path in paths
        for function, owner in functions(path)
        if owner is not None and documented(ast.get_docstring(function))
        if not abstract_only or "abstractmethod" in map(ast.unparse, function.decorator_list)
    }


def test_functions_of_four_arguments_document_them():
    contracts = list((PACKAGE / "contracts").glob("*.py"))
    assert not [found for path in contracts for found in undocumented(path)]
    contract = described(contracts, abstract_only=False)
    assert {"integrate", "advance", "after_event"} <= contract
    total = 0
    for root in (PACKAGE, *PLUGINS.iterdir()):
        paths = list(root.rglob("*.py"))
        total += len(paths)
        known = contract | described(paths, abstract_only=True)
        assert not [found for path in paths for found in undocumented(path, known)]
    assert total > 120


def test_a_missing_section_is_found(tmp_path):
    """Of a function, of a method with self left out; not of three arguments, nor of an overload."""
    path = tmp_path / "example.py"
    path.write_text(
        "def three(a, b, *, c): ...\n"
        "def four(a, b, c, *, d): ...\n"
        "@overload\ndef typed(a, b, c, d): ...\n"
        "class Some:\n"
        "    def short(self, a, b, c): ...\n"
        "    def long(self, a, b, c, d): ...\n"
        "    def advance(self, a, b, c, d): ...\n"
        "    def described(self, a, b, c, d):\n"
        "        '''Do.\n\n        Parameters\n        ---\n        '''\n"
    )
    found = list(undocumented(path, {"advance"}))
    assert found == ["example.py: four", "example.py: long"]
