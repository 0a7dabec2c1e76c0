"""What is built and what a contributor finds: wheel, source archive, metadata, templates."""

import os
import re
import tomllib
from shutil import which
from zipfile import ZipFile

import pytest

from tests.conftest import SHELVES
from tests.present import ROOT, needs_sources

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
GITHUB = ROOT / ".github"


def built(builder):
    """Return the paths of the files in a wheel or source archive, without building it."""
    return {each.distribution_path for each in builder(str(ROOT)).recurse_included_files()}


@needs_sources
def test_the_wheel_installs_contactlab_and_its_laws_only():
    wheel = pytest.importorskip("hatchling.builders.wheel", reason="needs hatchling (extra dev)")
    paths = built(wheel.WheelBuilder)
    assert {path.partition("/")[0] for path in paths} >= {"contactlab", "contactlab_laws"}
    assert {"contactlab/py.typed", "contactlab/kernels/package.json"} <= paths


@needs_sources
@pytest.mark.parametrize(
    ("compiler", "holds"),
    [
        pytest.param(
            "cc -O1",
            True,
            marks=[pytest.mark.slow, pytest.mark.skipif(not which("cc"), reason="no cc")],
        ),
        ("no-such-compiler", False),
        ("false", False),
    ],
)
def test_the_wheel_stands_alone_with_or_without_a_compiler(tmp_path, monkeypatch, compiler, holds):
    wheel = pytest.importorskip("hatchling.builders.wheel", reason="needs hatchling (extra dev)")
    monkeypatch.setenv("CC", compiler)
    monkeypatch.setenv("CONTACTLAB_COMPILED", "1")
    (made,) = wheel.WheelBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"])
    assert [str(path) for path in tmp_path.iterdir()] == [made]
    with ZipFile(made) as archive:
        assert ("contactlab_laws/compiled/_compiled.so" in archive.namelist()) == holds
    assert ("-none-any" in made) != holds


@needs_sources
def test_the_source_archive_has_what_its_tests_read():
    sdist = pytest.importorskip("hatchling.builders.sdist", reason="needs hatchling (extra dev)")
    paths = built(sdist.SdistBuilder)
    folders = {path.partition("/")[0] for path in paths}
    assert folders >= {"contactlab", "plugins", "tests", "examples", ".ci", ".github"}
    assert {"plugins/table_builders/__main__.py", ".ci/site/index.md", ".ci/run"} <= paths
    read = {"README.md", "CHANGELOG.md", "LICENSE", "CITATION.cff", ".pre-commit-config.yaml"}
    assert read <= folders


def test_the_metadata_name_authors_and_no_place_that_there_is_not():
    assert PROJECT["authors"] == [{"name": "The contactlab developers"}]
    assert "urls" not in PROJECT
    classifiers = PROJECT["classifiers"]
    assert "Operating System :: POSIX :: Linux" in classifiers  # no other is tested
    least = PROJECT["requires-python"].removeprefix(">=")
    versions = [each.rpartition(" ")[2] for each in classifiers if "Python :: 3." in each]
    assert versions[0] == least
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    assert "- name: The contactlab developers" in citation
    assert f"\nversion: {PROJECT['version']}\n" in citation


def test_the_changelog_is_a_page_on_this_version():
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    assert re.findall(r"^## (\S+)", text, re.MULTILINE)[0] == PROJECT["version"]
    assert len(text.split()) < 600


@pytest.mark.parametrize("name", ["wrong-answer", "law-wanted", "data"])
def test_an_issue_begins_with_questions(name):
    text = (GITHUB / "ISSUE_TEMPLATE" / f"{name}.md").read_text("utf-8")
    front, fields, body = re.fullmatch(r"(---\n)(.*?\n)---\n(.*)", text, re.DOTALL).groups()
    assert re.findall(r"^(\w+): \S", fields, re.MULTILINE) == ["name", "about", "labels"]
    assert front
    assert len(re.findall(r"^\*\*.+\.\*\* ", body, re.MULTILINE)) >= 3


@needs_sources
def test_whoever_contributes_finds_a_word_on_each_step():
    text = (GITHUB / "CONTRIBUTING.md").read_text("utf-8")
    headings = re.findall(r"^## (.*)$", text, re.MULTILINE)
    assert headings == [
        "Set up", "Test", "Add a law", "Add data", "What a picture needs", "Write",
    ]  # fmt: skip
    for path in re.findall(r"`((?:contactlab|examples|tests|\.ci)/[\w./]+)`", text):
        assert (ROOT / path).exists(), path
    assert (GITHUB / "CODE_OF_CONDUCT.md").is_file()


def test_the_workflow_runs_what_a_change_must_pass():
    text = (GITHUB / "workflows" / "ci.yml").read_text("utf-8")
    assert "- run: .ci/run\n" in text
    assert "- run: .ci/without_shelves ${{ matrix.shelf }}\n" in text
    for script in ("run", "without_shelves"):
        assert os.access(ROOT / ".ci" / script, os.X_OK)


def test_the_workflow_takes_out_each_folder_whose_tests_stand_apart():
    text = (GITHUB / "workflows" / "ci.yml").read_text("utf-8")
    (listed,) = re.findall(r"shelf: \[(.*)\]", text)
    (tests,) = re.findall(
        r"^shelves=\((.*)\)$", (ROOT / ".ci" / "without_shelves").read_text("utf-8"), re.M
    )
    assert listed.split(", ") == tests.split() == [*SHELVES]


def test_a_commit_is_checked_by_ruff_and_mypy():
    text = (ROOT / ".pre-commit-config.yaml").read_text("utf-8")
    entries = re.findall(r"entry: (.*)", text)
    assert [entry.split()[0] for entry in entries] == ["ruff", "ruff", "mypy"]
    assert "https://" not in text
