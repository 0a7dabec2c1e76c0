"""Sources: every DOI is that of its work, and every work that is named has an entry."""

import re
import subprocess
import tomllib

import pytest

from contactlab.impact import material as materials
from contactlab.registry import citations
from contactlab.registry.citations import DOI, YEAR, bibtex, references
from contactlab.registry.registry import REGISTRY
from tests.present import INSTALLED, PACKAGE, ROOT

if not (ROOT / "contactlab").is_dir():
    pytest.skip(INSTALLED, allow_module_level=True)

BIB = (PACKAGE / "registry" / "references.bib").read_text(encoding="utf-8")
#: A DOI that no work has, in a test of what is done with unknown ones; nothing else is exempt.
INVENTED = {"10.9999/odd"}
#: What a data file may name besides works: codes that were run, by name and version.
CODES = re.compile(r"LAMMPS|MFiX|Lethe|Kratos")


FOLDERS = ("contactlab", "plugins", "tests", "examples", ".ci")


def names():
    """Return the tracked files; of a copy without a repository those of the same folders."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode == 0:
        return [name for name in listed.stdout.split("\0") if name]
    paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    return [str(path.relative_to(ROOT)) for path in (*paths, *ROOT.glob("*"))]


def texts():
    """Return the tracked files that are text, by path from the root."""
    paths = {name: ROOT / name for name in names()}
    binary = (".png", ".gif", ".npz", ".pyc", ".so")
    return {
        name: path.read_text(encoding="utf-8")
        for name, path in paths.items()
        if path.is_file() and path.suffix not in binary
    }


TEXTS = texts()


def entries():
    """Return the entries of the bibliography: key, fields."""
    found = {}
    for entry in re.split(r"\n(?=@)", BIB.strip()):
        key = re.match(r"@\w+\{(\w+),", entry)[1]
        assert key not in found, key
        found[key] = dict(re.findall(r"^  (\w+) = \{(.*)\},?$", entry, re.MULTILINE))
    return found


ENTRIES = entries()
BY_DOI = {fields["doi"]: fields for fields in ENTRIES.values() if "doi" in fields}


def places():
    """Return every DOI of the project with its file and the text before it."""
    for name, text in TEXTS.items():
        for match in DOI.finditer(text):
            if match[0] not in INVENTED:
                yield name, match[0], text[max(0, match.start() - 500) : match.start()]


def surname(fields):
    """Return the first author's or editor's."""
    return fields.get("author", fields.get("editor")).partition(",")[0]


def test_the_walk_finds_files_and_dois():
    assert {"README.md", "CITATION.cff", "contactlab/impact/materials.toml"} <= set(TEXTS)
    assert len(list(places())) > 80


def test_the_paper_has_its_doi():
    """Crossref's; the one that stood here before belongs to another article."""
    assert ENTRIES["maw1976"]["doi"] == "10.1016/0043-1648(76)90201-5"


def test_every_doi_of_the_project_is_that_of_its_entry():
    wrong = {
        (name, doi)
        for name, doi, before in places()
        if doi not in BY_DOI
        or (not name.startswith("tests/") and surname(BY_DOI[doi]) not in before)
    }
    assert wrong == set()


def test_a_doi_stands_in_one_entry_and_each_has_author_and_year():
    dois = [fields["doi"] for fields in ENTRIES.values() if "doi" in fields]
    assert len(dois) == len(set(dois))
    for key, fields in ENTRIES.items():
        assert {"author", "editor"} & set(fields), key
        assert re.fullmatch(r"\d{4}", fields["year"]), key
        assert re.sub(r"\W|\\", "", surname(fields)).lower()[:4] in key, key


def named(text):
    """Return the years and DOIs of works that a text names."""
    return DOI.findall(text) + YEAR.findall(text)


def test_every_work_that_a_law_names_has_an_entry():
    for name in REGISTRY.names():
        for text in references(REGISTRY.law_class(name)):
            found = bibtex([text])
            assert "@misc" not in found, text
            assert all(mark in found for mark in named(text)), text


def toml_sources():
    """Return what the data files name as sources, with the file."""
    for name, text in TEXTS.items():
        if not name.endswith(".toml"):
            continue
        content = tomllib.loads(text)
        about = content.get("about", {})
        measured = content.get("measured", [])
        told = [about.get("citation", ""), about.get("notes", "")]
        told += [series.get("source", "") for series in measured]
        told += [each["by"] for series in measured for each in series.get("readings", [])]
        if name.endswith("materials.toml"):
            told += list(content["references"].values())
        yield from ((name, " ".join(each.split())) for each in told if each)


def test_every_work_that_a_data_file_names_has_an_entry():
    sources = [text for _, text in toml_sources()]
    assert len(sources) > 40
    for text in sources:
        found = bibtex([text])
        assert all(mark in found for mark in named(text)), text
        if named(text) and not CODES.search(text):
            assert "@misc{source" not in found, text


def test_every_work_of_the_materials_has_an_entry():
    for key, text in materials.references().items():
        assert "@misc{source" not in bibtex([text]), key


def test_every_work_in_the_list_of_the_theory_page_has_an_entry():
    listed = TEXTS["contactlab/guide/theory-references.md"].partition("\n## References\n")[2]
    works = re.split(r"\n(?=\d+\. )", listed.strip())
    assert len(works) >= 18
    for work in works:
        text = " ".join(work.split())
        found = bibtex([text])
        assert "@misc{source" not in found, text
        for doi in DOI.findall(found):
            assert doi in text, f"{doi} is missing beside {text}"


@pytest.mark.parametrize(
    "key",
    ["garwin1969", "dundurs1969", "tabor1977", "wu2001", "direnzo2004", "direnzo2005",
     "lyashenko2015", "lyashenko2018", "maw1981"],
)  # fmt: skip
def test_the_works_that_were_missing_have_entries(key):
    assert key in ENTRIES


def test_the_year_of_a_thesis_counts():
    """A year in front of a comma or a semicolon names a work too."""
    assert "wu2001" in bibtex(["C. Y. Wu, thesis, Aston University (2001)"])
    assert citations.YEAR.findall("Wu (2001)") == ["2001"]
