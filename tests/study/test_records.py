"""The records of the studies are made by keyword alone; those with arrays are compared by identity.

A field may then be added in its place, and no comparison of arrays is taken for a truth value.
"""

import importlib
import inspect
import pkgutil

import attrs
import pytest

import contactlab.study

MODULES = [
    importlib.import_module(module.name)
    for module in pkgutil.iter_modules(contactlab.study.__path__, "contactlab.study.")
]
RECORDS = {
    record.__name__: record
    for module in MODULES
    for _, record in inspect.getmembers(module, inspect.isclass)
    if attrs.has(record) and record.__module__ == module.__name__
}
BY_IDENTITY = {
    "Agreement", "Comparison", "ErrorMap", "Evidence", "FigureData", "LawRun", "ModelError",
    "Region",
}  # fmt: skip


def test_these_are_the_records():
    assert set(RECORDS) == {
        *BY_IDENTITY, "Benchmark", "Case", "Finding", "Method", "Outcome", "Row", "Score", "Source",
        "Stability",
    }  # fmt: skip


@pytest.mark.parametrize("name", sorted(RECORDS))
def test_a_record_is_made_by_keyword_and_never_changed(name):
    parameters = inspect.signature(RECORDS[name]).parameters.values()
    assert {parameter.kind for parameter in parameters} == {inspect.Parameter.KEYWORD_ONLY}
    assert RECORDS[name].__setattr__ is not object.__setattr__


@pytest.mark.parametrize("name", sorted(RECORDS))
def test_a_record_of_arrays_is_equal_to_itself_alone(name):
    assert (RECORDS[name].__eq__ is object.__eq__) is (name in BY_IDENTITY)
