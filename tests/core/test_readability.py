"""What a stranger relies on when reading: a map of the modules, and documented parameters."""

import ast
import re
from pathlib import Path

import contactlab

PACKAGE = Path(contactlab.__file__).parent
MODULES = re.findall(r"^``(\w+)`` ", contactlab.__doc__, flags=re.MULTILINE)


def imported_modules(path):
    """Yield the modules of the package that a file imports when it is imported itself."""
    for node in ast.parse(path.read_text()).body:
        if not isinstance(node, ast.ImportFrom) or node.module is None:
            continue
        if node.module == "contactlab":
            yield from (name.name for name in node.names)
        elif node.module.startswith("contactlab."):
            yield node.module.split(".")[1]


def test_the_map_of_the_package_names_every_module():
    paths = (path for path in PACKAGE.iterdir() if (path.is_dir() or path.suffix == ".py"))
    found = {path.stem for path in paths if not path.name.startswith("__")}
    assert sorted(MODULES) == sorted(found - {"guide"})  # which holds no code


def test_imports_point_downward():
    """In the order of the map: the laws import no figure, the scene no result."""
    wrong = []
    for level, module in enumerate(MODULES):
        path = PACKAGE / module
        above = {*MODULES[: level + 1], "__version__"}
        for file in path.rglob("*.py") if path.is_dir() else [path.with_suffix(".py")]:
            names = set(imported_modules(file)) - above
            wrong += [f"{module}/{file.name} imports {name}" for name in sorted(names)]
    assert not wrong
