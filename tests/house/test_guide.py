"""The guide says what is so: its code runs, its sections are those cited, its names exist."""

import contextlib
import io
import re
import subprocess
import sys
import textwrap
import types
from pathlib import Path

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Status, contracts
from contactlab.cli.guide import PARTS, SECTION, add_pages, sections, summary, text, whole
from contactlab.cli.guide import pages as guide_pages
from contactlab.cli.guide import topics as guide_topics
from contactlab.impact import bodies, coupling, error_model, hertz, normal_spin
from contactlab.outcome import energy, history, motion, plan, result
from contactlab.solve import normal_motion
from contactlab.study.validation import REFERENCE_PSI2
from contactlab.testing import Verdict, check_law
from contactlab_laws import compiled
from tests.house import contract_page
from tests.present import PACKAGE, ROOT, extra

GUIDE = PACKAGE / "guide"
INDEX = ROOT / ".ci" / "site" / "index.md"
#: Code with the output that is shown below it, if any.
BLOCKS = re.compile(r"```python\n(.*?)```\n(?:```text\n(.*?)```\n)?", re.DOTALL)
#: "theory §5", "theory §§1 and 4", also where a line ends between the two.
CITATION = re.compile(r"\btheory(?:\.md`?)?\s+(?:#:?\s*)?(§§?\s*\d+(?:(?:,| and| to)\s+§?\d+)*)")
DOI = re.compile(r"10\.\d{4,9}/[^\s,;]+")
LAWS = (
    "Viscoelastic", "Brush", "HardSphere", "SlipThenRoll", "Leapfrog", "Bristle",
    "OneSpring",
)  # fmt: skip
#: Laws whose checks take longer than a second.
HEAVY = ("Viscoelastic", "Brush", "Bristle", "Leapfrog", "OneSpring")
WITH_CODE = [page for page in guide_pages() if BLOCKS.search(text(page))]
#: Pages whose code takes longer than a third of a second.
LONG_CODE = ("many-machines", "any-two-bodies", "several-contacts", "beyond-the-paper")
#: Pages to look something up: they are not read from end to end, and have no bound of words.
LOOKED_UP = {
    "glossary", "theory", *PARTS["theory"], "extending-integrator", "extending-command",
    "extending-knowledge",
}  # fmt: skip
#: Words of all other pages, code and tables among them, above which nobody reads a guide.
MOST_WORDS = 20_800
#: Extras that the code of a page needs, or folders of plugins.
EXTRAS = {
    "beyond-the-paper": ("contactlab_halfspace",),
    "for-a-paper": ("pandas",),
    "getting-started": ("xarray",),
    "many-machines": ("xarray", "dask"),
}
#: Pages whose numbers are those of the finer steps that a compiled march takes by itself.
COMPILED = ("how-far-to-trust", "extending-integrator")
needs_library = pytest.mark.skipif(compiled.library() is None, reason=compiled.tell())
#: Where names in the tables of the guide are looked for.
NAMESPACES = (
    contactlab, contracts, bodies, plan, history, motion, energy, normal_motion, result,
)  # fmt: skip
#: Modules that the glossary names functions of, by the name that stands there.
MODULES = {
    "coupling": coupling, "error_model": error_model, "hertz": hertz, "normal_spin": normal_spin,
}  # fmt: skip


def sources():
    """Every file that may cite the guide."""
    for folder in (PACKAGE, ROOT / "plugins", ROOT / "tests", ROOT / "examples"):
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".py", ".md", ".toml") and path != Path(__file__):
                yield path
    yield ROOT / "README.md"


def run(page):
    """Run the code of a page, block after block, as one module; return it and what it prints."""
    module = types.ModuleType(f"guide_{page.replace('-', '_')}")
    sys.modules[module.__name__] = module  # a class must be found again to be copied
    printed = []
    for code, _ in BLOCKS.findall(text(page)):
        stream = io.StringIO()
        with contextlib.redirect_stdout(stream):
            exec(compile(code, f"{page}.md", "exec"), vars(module))
        printed.append(stream.getvalue())
    return module, printed


@pytest.fixture(scope="module")
def extending():
    """Return the laws of the guide, each from the page that it stands on."""
    pages = [run(page)[0] for page in PARTS["extending"]]
    return {name: law for page in pages for name, law in vars(page).items() if name in LAWS}


def test_the_contract_in_the_guide_is_that_of_the_code():
    """``python -m tests.house.contract_page`` writes it anew."""
    assert contract_page.FILE.read_text(encoding="utf-8") == contract_page.written()


def test_topics_are_the_files():
    own = {*guide_pages()} - {*add_pages()}
    assert sorted(path.stem for path in GUIDE.glob("*")) == sorted(own)


def test_a_topic_begins_with_a_title_and_a_line_about_it():
    for topic in guide_pages():
        lines = text(topic).split("\n", 4)
        assert lines[0].startswith("# "), topic
        assert (lines[1], lines[3]) == ("", ""), topic
        assert lines[2].endswith("."), topic
        assert summary(topic) == lines[2]


@pytest.mark.parametrize("topic", PARTS)
def test_the_table_of_a_long_topic_leads_to_its_parts_of_a_thousand_words(topic):
    rows = re.findall(r"^\| \[`(.*?)`\]\((.*?)\.md\) \|(?: ([^|]*) \|)?", text(topic), re.MULTILINE)
    assert [row[0] for row in rows] == [row[1] for row in rows] == list(PARTS[topic])
    for part, _, numbered in rows:
        bounds = [int(number) for number in re.findall(r"\d+", numbered)]
        expected = list(range(bounds[0], bounds[-1] + 1)) if bounds else []
        if topic == "theory":
            assert [int(number) for number in SECTION.findall(text(part))] == expected
        assert 300 < len(text(part).split()) < 1500


def test_what_is_to_be_read_has_few_words():
    read = {page: len(text(page).split()) for page in guide_pages() if page not in LOOKED_UP}
    assert sum(read.values()) <= MOST_WORDS, read


@pytest.mark.parametrize("topic", guide_topics())
def test_every_page_has_a_picture_that_exists(topic):
    pictures = re.findall(r"!\[.+?\]\(\.\./\.\./(.+?)\)", text(topic))
    assert pictures
    assert [picture for picture in pictures if not (ROOT / picture).is_file()] == []


def test_lines_fit_a_terminal_but_for_tables_and_code():
    for topic in guide_pages():
        prose = re.sub(r"```.*?```", "", text(topic), flags=re.DOTALL).splitlines()
        long = [line for line in prose if len(line) > 120 and not line.startswith(("|", "!["))]
        assert long == [], topic


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page,
            marks=[
                *[extra(name) for name in EXTRAS.get(page, ())],
                *[pytest.mark.slow] * (page in LONG_CODE),
                *[needs_library] * (page in COMPILED),
            ],
        )
        for page in WITH_CODE
    ],
)
def test_the_code_of_a_page_runs_alone_and_prints_what_is_shown(page):
    expected = [shown for _, shown in BLOCKS.findall(text(page))]
    assert run(page)[1] == expected


def test_the_code_of_the_site_prints_numbers_and_draws(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", INDEX.read_text("utf-8"), re.DOTALL)
    pyplot = pytest.importorskip("matplotlib.pyplot")
    try:
        exec(compile(code, "index.md", "exec"), {})
        assert pyplot.get_fignums()
    finally:
        pyplot.close("all")
    assert len([float(word) for word in capsys.readouterr().out.split()]) == 3


def test_there_is_code():
    assert len(BLOCKS.findall(text("getting-started"))) >= 5
    assert set(PARTS["extending"]) < set(WITH_CODE)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in HEAVY)) for name in LAWS]
)
def test_a_law_of_the_guide_passes_the_kit(extending, name):
    law = extending[name]()
    found = check_law(law)
    assert Verdict.PASSED in {item.verdict for item in found}
    failing = {item.check for item in found if item.verdict is Verdict.EXPECTED_FAILURE}
    assert failing == set(law.expected_failures)


@pytest.mark.slow
def test_the_files_of_a_law_and_of_its_tests_run_in_a_folder_of_their_own(tmp_path):
    page = text("extending-kit")
    (tmp_path / "my_law.py").write_text(BLOCKS.findall(page)[0][0], "utf-8")
    (tests,) = re.findall(r"`test_my_law\.py`[^\n]*\n\n((?: {4}.*\n|\n)+)", page)
    (tmp_path / "test_my_law.py").write_text(textwrap.dedent(tests), "utf-8")
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"], cwd=tmp_path,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    checks = check_law(run("extending-kit")[0].OneSpring())
    passed = sum(item.verdict is Verdict.PASSED for item in checks)
    assert f"{passed} passed" in ran.stdout


def test_the_theory_has_the_sections_that_are_numbered():
    assert SECTION.findall(whole("theory")) == [str(number) for number in range(1, 19)]


def test_every_citation_of_the_theory_resolves():
    known, cited = set(SECTION.findall(whole("theory"))), []
    for path in sources():
        for found in CITATION.findall(path.read_text(encoding="utf-8")):
            numbers = re.findall(r"\d+", found)
            assert set(numbers) <= known, f"{path}: theory {found}"
            cited += numbers
    assert len(cited) > 50


def test_sections_cited_within_the_theory_resolve():
    known = set(SECTION.findall(whole("theory")))
    own = re.sub(r"§\d+\.\d+", "", whole("theory"))  # sections of the paper
    assert set(re.findall(r"§(\d+)", own)) <= known


def rows(section):
    """The rows of numbers in the tables of a section of the theory."""
    for line in sections("theory")[section].splitlines():
        cells = line.strip("| ").split(" | ")
        with contextlib.suppress(ValueError):
            yield [49 / 34 if cell == "49/34" else float(cell) for cell in cells]


def test_tables_of_the_theory_are_those_of_the_code():
    reference = {round(row[0], 6): tuple(row[1:]) for row in rows("5")}
    for chi, psi2 in REFERENCE_PSI2.items():
        assert reference[round(chi, 6)] == psi2
    (angles, ratios, rims), psi2, _ = normal_spin.nodes()
    places = np.searchsorted(rims, [0.1, 0.2, 0.5, 1.0, 2.0, 5.0])
    moved = {row[0]: row[1:] for row in rows("17") if len(row) == 7}
    for place, psi1 in enumerate(angles):
        if psi1 in moved:
            along = psi2[place, np.argmin(np.abs(ratios - 49 / 34))]
            assert moved[psi1] == pytest.approx(along[places] - along[0], abs=6e-4)
    assert len(moved) == 5
    angles = np.array([0.5, 1.0, 1.5, 2.0, 3.0])
    shifts = {row[0]: [abs(cell) for cell in row[1:]] for row in rows("9")}
    for strength in (0.25, 0.5, 1.0, 2.0):
        scene = Scene.nondimensional(
            psi1=angles, chi=49 / 34, poisson_ratio=0.3, coupling_number=strength
        )
        found = coupling.coupling_shift(scene)
        assert found == pytest.approx(shifts[strength], rel=0.12, abs=4e-3)


def test_references_of_the_theory_are_numbered_and_all_cited():
    body, _, listed = whole("theory").partition("## References")
    numbers = re.findall(r"^(\d+)\. ", listed, re.MULTILINE)
    assert numbers == [str(number) for number in range(1, len(numbers) + 1)]
    assert set(re.findall(r"\[(\d+)\]", body)) == set(numbers)


def test_dois_are_well_formed():
    found = []
    for path in sources():
        for after in re.findall(r"\bdoi:\s*(\S+)", path.read_text(encoding="utf-8")):
            doi = after.rstrip('.,;"\\`')
            assert DOI.fullmatch(doi), f"{path}: {after}"
            assert doi.count("(") == doi.count(")"), f"{path}: {after}"
            found.append(doi)
    assert len(set(found)) > 10


def test_topics_named_in_the_guide_exist():
    for topic in guide_pages():
        named = re.findall(r"`contactlab guide ([a-z0-9-]+)", text(topic))
        assert set(named) <= set(guide_pages()), topic


def test_every_status_is_explained():
    rows = re.findall(r"^\| `([A-Z_]+)` \|", text("plans-and-statuses"), re.MULTILINE)
    assert sorted(rows) == sorted(status.name for status in Status)


@pytest.mark.parametrize("topic", ["glossary", "units-and-signs"])
def test_names_of_code_exist(topic):
    for owner, name in re.findall(r"`([A-Z]\w+|[a-z]\w+)\.([a-z_]\w*)`", text(topic)):
        if owner in MODULES:
            assert hasattr(MODULES[owner], name), f"{owner}.{name}"
            continue
        if owner in ("motion", "energy"):  # attributes of a result
            owner = {"motion": "Motion", "energy": "EnergyLedger"}[owner]
        holders = [getattr(space, owner) for space in NAMESPACES if hasattr(space, owner)]
        if owner in ("contactlab", "plan"):
            continue
        assert holders, f"{owner}.{name}"
        assert any(known(holder, name) for holder in holders), f"{owner}.{name}"


def known(holder, name):
    """Whether a class has an attribute, be it one of its instances only."""
    fields = {field.name for field in attrs.fields(holder)} if attrs.has(holder) else set()
    annotated = {key for kind in holder.__mro__ for key in vars(kind).get("__annotations__", {})}
    return hasattr(holder, name) or name in fields | annotated


def test_a_term_of_the_glossary_has_one_entry():
    terms = re.findall(r"^\| ([^|]+?) \|", text("glossary"), re.MULTILINE)
    terms = [term for term in terms if term != "term" and not term.startswith("---")]
    assert len(terms) == len(set(terms)) > 90
