"""A kept sweep goes on with the code that it was begun with, or is refused."""

import importlib
import os
import subprocess
import sys
from importlib import metadata

import numpy as np
import pytest

import contactlab
from contactlab import PluginError, Scene, Simulation
from tests.longer import longer
from tests.runs.test_sweep import blocks_of

#: A friction law of a share of the friction, which is written elsewhere.
LAW = """
from typing import ClassVar
import attrs
import numpy as np
from contactlab.contracts import WholeImpact, WholeImpactTangentialLaw
IMPORT

@attrs.frozen(kw_only=True)
class Share(WholeImpactTangentialLaw):
    api_version: ClassVar[int] = 2
    of: object = None

    def whole_impacts(self, scene, normal):
        LAZY
        mass, slip = scene.pair.tangential_mass, scene.slip_velocity
        most = VALUE * scene.friction_coefficient * normal.total_load_impulse / mass
        lost = np.minimum(most, np.abs(slip))
        return (*super().whole_impacts(scene, normal), WholeImpact(
            where=True, slip_velocity_change=-np.sign(slip) * lost,
            friction_work=mass * lost * (np.abs(slip) - 0.5 * lost), reason="share"))
"""
HALF, FULL = "SHARE = 0.5\n", "SHARE = 1.0 / 1.0\n"
FRICTION = """
import attrs

def share():
    return SHARE

@attrs.frozen
class Friction:
    def share(self):
        return SHARE
"""


def law(line="", value="SHARE", lazy="pass"):
    return LAW.replace("IMPORT", line).replace("VALUE", value).replace("LAZY", lazy)


def of_module(name):
    return importlib.import_module(name).Share()


def with_function():
    return importlib.import_module("my_law").Share(of=importlib.import_module("helper").share)


def with_object():
    return importlib.import_module("my_law").Share(of=importlib.import_module("helper").Friction())


#: Files, how the law is made of them, the file with the share, and what the refusal says: the name
#: of a file that holds a class of the law, or else what the law does.
BY_WORK = "of impacts 0 to 2 is another now"
WAYS = {
    "beside a law's file": (
        {"my_law.py": law("from helper import SHARE")},
        lambda: "my_law.py:Share", "helper.py", BY_WORK,
    ),
    "two files away": (
        {"my_law.py": law("import middle", "middle.share()"),
         "middle.py": "import helper\ndef share(): return helper.SHARE\n"},
        lambda: "my_law.py:Share", "helper.py", BY_WORK,
    ),
    "in a package beside it": (
        {"my_law.py": law("from parts import helper", "helper.SHARE"), "parts/__init__.py": ""},
        lambda: "my_law.py:Share", "parts/helper.py", BY_WORK,
    ),
    "in the law's file": (
        {}, lambda: "my_law.py:Share", "my_law.py", r"code of my_law\.py was",
    ),
    "imported in a method": (
        {"my_law.py": law(lazy="from helper import SHARE")},
        lambda: of_module("my_law"), "helper.py", BY_WORK,
    ),
    "in a package": (
        {"laws/__init__.py": "from .friction import Share\n",
         "laws/friction.py": law("from .parts import helper", "helper.SHARE"),
         "laws/parts/__init__.py": ""},
        lambda: of_module("laws"), "laws/parts/helper.py", BY_WORK,
    ),
    "in a file of data": (
        {"my_law.py": law("from pathlib import Path",
                          "float(Path('share.py').read_text().split()[2])")},
        lambda: of_module("my_law"), "share.py", BY_WORK,
    ),
    "in a class that a law derives from": (
        {"my_law.py": "from helper import Share\nclass Mine(Share):\n    pass\n"},
        lambda: importlib.import_module("my_law").Mine(), "helper.py", "code of helper was",
    ),
    "in an object that is an option": (
        {"my_law.py": law(value="self.of.share()")}, with_object, "helper.py", "code of helper was",
    ),
    "in a function that is an option": (
        {"my_law.py": law(value="self.of()")}, with_function, "helper.py", "code of helper was",
    ),
    "in a function that a function calls": (
        {"my_law.py": law(value="self.of()"),
         "helper.py": "import far\ndef share(): return far.SHARE\n"},
        with_function, "far.py", BY_WORK,
    ),
}  # fmt: skip


def written(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def forget(folder):
    """Forget the modules of a folder, as a new interpreter has none of them."""
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__file__", None)).startswith(str(folder)):
            del sys.modules[name]
    importlib.invalidate_caches()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # whose times are whole seconds
    yield tmp_path
    forget(tmp_path)


def psi2(tangential, keep, argument="keep"):
    scene = Scene.nondimensional(psi1=[8.0, 9.0], chi=1.0)
    found = Simulation(tangential=tangential).sweep(scene, **{argument: keep}).check()
    return np.asarray(found["psi2"] if argument == "into" else found.psi2).tolist()


def shares(way):
    """Return the text of the file with the share, half and full."""
    if way in ("in the law's file", "in a class that a law derives from"):
        return [law(text) for text in (HALF, FULL)]
    return [text + FRICTION for text in ("SHARE = 0.5\n", "SHARE = 1.0\n")]


@pytest.mark.parametrize("argument", ["keep", "into"])
@pytest.mark.parametrize(("way", "case"), WAYS.items())
def test_a_sweep_whose_code_has_changed_is_refused(folder, way, case, argument):
    files, made, changed, words = case
    half, full = shares(way)
    for name, text in (files | {changed: half}).items():
        written(folder / name, text)
    for _ in range(2):
        assert psi2(made(), "kept", argument) == pytest.approx([6.0, 7.0])
        forget(folder)
    written(folder / changed, full)
    with pytest.raises(
        ValueError, match=rf"{argument} = 'kept': .*{words}.*; delete the folder, or name another"
    ):
        psi2(made(), "kept", argument)
    assert psi2(made(), "other", argument) == pytest.approx([4.0, 5.0])
    written(folder / changed, half)
    forget(folder)
    assert psi2(made(), "kept", argument) == pytest.approx([6.0, 7.0])


#: A law of one share at the ends of psi1 and another between, and one of a share above a chi.
AT_ENDS = """
from typing import ClassVar
import attrs
import numpy as np
from contactlab.contracts import WholeImpact, WholeImpactTangentialLaw
from where import where

@attrs.frozen(kw_only=True)
class Ends(WholeImpactTangentialLaw):
    api_version: ClassVar[int] = 2

    def whole_impacts(self, scene, normal):
        lost = 0.1 * np.where(where(scene.psi1, scene.chi), 1.0, 2.0) * scene.slip_velocity
        return (*super().whole_impacts(scene, normal), WholeImpact(
            where=True, slip_velocity_change=-lost, reason="ends",
            friction_work=scene.pair.tangential_mass * lost * (scene.slip_velocity - 0.5 * lost)))
"""


@pytest.mark.parametrize("argument", ["keep", "into"])
@pytest.mark.parametrize("end", ["psi1 < -5.9", "chi > 1.98", *longer("psi1 > 5.9", "chi < 0.52")])
def test_a_change_at_one_end_is_seen(folder, monkeypatch, argument, end):
    blocks_of(monkeypatch, 10)
    rng = np.random.default_rng(3)
    scene = Scene.nondimensional(psi1=rng.uniform(-6.0, 6.0, 4000), chi=rng.uniform(0.5, 2.0, 4000))
    written(folder / "my_law.py", AT_ENDS)
    text = "import numpy as np\ndef where(psi1, chi): return (psi1 < 9.0) & ~(CHANGED)\n"

    def swept(changed):
        forget(folder)
        written(folder / "where.py", text.replace("CHANGED", changed))
        simulation = Simulation(tangential=importlib.import_module("my_law").Ends())
        return simulation.sweep(scene, **{argument: "kept"}, chunk=500).check()

    swept("psi1 > 9.0")
    with pytest.raises(ValueError, match=rf"{argument} = 'kept': .* is another now"):
        swept(end)
    swept("psi1 > 9.0")


def test_a_block_is_drawn_anew_each_time(folder, monkeypatch):
    """One block of four has changed, at neither end: some of forty runs see it."""
    blocks_of(monkeypatch, 10)
    scene = Scene.nondimensional(psi1=np.linspace(1.0, 2.0, 40), chi=1.0)
    written(folder / "my_law.py", AT_ENDS)
    text = "def where(psi1, chi): return (psi1 < 9.0) & ~CHANGED\n"

    def swept(changed):
        forget(folder)
        written(folder / "where.py", text.replace("CHANGED", changed))
        simulation = Simulation(tangential=importlib.import_module("my_law").Ends())
        return lambda: simulation.sweep(scene, keep="kept", chunk=40).check()

    swept("(psi1 > 9.0)")()
    again, seen = swept("((psi1 > 1.3) & (psi1 < 1.4))"), 0
    for _ in range(40):
        np.random.seed(0)  # noqa: NPY002 a user's own
        try:
            again()
        except ValueError:
            seen += 1
    assert 0 < seen < 40


def test_a_module_that_the_law_does_not_import_does_not_count(folder):
    for name, text in {"__init__": "", "friction": law(HALF), "other": "", "another": ""}.items():
        written(folder / "laws" / f"{name}.py", text)
    for others in ((), ("laws.other",), ("laws.other", "laws.another")):
        forget(folder)
        for name in others:
            importlib.import_module(name)
        assert psi2(of_module("laws.friction"), "kept") == pytest.approx([6.0, 7.0])


@pytest.mark.parametrize("name", ["contactlab", "numpy", "scipy"])
def test_other_versions_are_refused(folder, monkeypatch, name):
    before = metadata.version
    assert psi2("coulomb", "kept") == pytest.approx([4.0, 5.0])
    monkeypatch.setattr(metadata, "version", lambda each: "99.1" if each == name else before(each))
    with pytest.raises(ValueError, match=rf"{name} was {before(name)}, is 99\.1"):
        psi2("coulomb", "kept")


def test_the_modules_of_the_user_stay(folder):
    """An object of a class in one is of that class afterwards, whatever changed."""
    surface = "import attrs\n@attrs.frozen\nclass Surface:\n    pass\n"
    written(folder / "helper.py", surface)
    judge = "import helper\nassert_surface = attrs.validators.instance_of(helper.Surface)\n"
    own = law(value="0.5").replace(
        "of: object = None", "of: object = attrs.field(validator=SURFACE)"
    )
    written(
        folder / "my_law.py",
        own.replace("from contactlab", judge + "from contactlab", 1).replace(
            "SURFACE", "assert_surface"
        ),
    )
    helper = importlib.import_module("helper")
    assert contactlab.create("my_law.py:Share", of=helper.Surface())
    written(folder / "helper.py", surface + "# changed\n")
    written(folder / "other.py", "")
    assert contactlab.create("my_law.py:Share", of=helper.Surface())
    assert sys.modules["helper"] is helper
    written(folder / "my_law.py", (folder / "my_law.py").read_text() + "# changed\n")
    made = contactlab.create("my_law.py:Share", of=helper.Surface())
    assert psi2(made, "kept") == pytest.approx([6.0, 7.0])


def test_two_laws_with_files_of_one_name_are_told_apart(folder):
    """The second law got the first one's number."""
    for name, text in (("one", HALF), ("two", FULL)):
        written(folder / name / "my_law.py", law("from parts import SHARE"))
        written(folder / name / "parts.py", text)
    assert psi2("one/my_law.py:Share", None) == pytest.approx([6.0, 7.0])
    for _ in range(2):
        with pytest.raises(
            PluginError, match=r"it imports .*one/parts\.py, not the file beside it"
        ):
            psi2("two/my_law.py:Share", None)
    (folder / "linked").mkdir()
    written(folder / "linked" / "my_law.py", law("from parts import SHARE"))
    (folder / "linked" / "parts.py").symlink_to(folder / "one" / "parts.py")
    assert psi2("linked/my_law.py:Share", None) == pytest.approx([6.0, 7.0])
    (folder / "two" / "parts.py").rename(folder / "two" / "others.py")
    written(folder / "two" / "my_law.py", law("from others import SHARE"))
    assert psi2("two/my_law.py:Share", None) == pytest.approx([4.0, 5.0])
    assert psi2("one/my_law.py:Share", None) == pytest.approx([6.0, 7.0])


def test_folders_whose_names_differ_by_a_dot_are_told_apart(folder):
    for name, text in (("v1.0", HALF), ("v1_0", FULL), ("v1%2E0", "SHARE = 0.25")):
        written(folder / name / "my_law.py", law(text))
    shares = {"v1.0": 0.5, "v1_0": 1.0, "v1%2E0": 0.25}
    for name, share in shares.items():
        expected = pytest.approx([8.0 - 4.0 * share, 9.0 - 4.0 * share])
        assert psi2(f"{name}/my_law.py:Share", None) == expected, name


def test_what_a_file_adds_to_the_path_stays(folder, monkeypatch):
    monkeypatch.setattr(sys, "path", [*sys.path])
    before = [*sys.path]
    written(folder / "my_law.py", "import sys\nsys.path.append('elsewhere')\n" + law(HALF))
    psi2("my_law.py:Share", None)
    assert sys.path == [*before, "elsewhere"]


def test_a_set_of_a_law_is_the_same_in_any_order(folder):
    written(folder / "my_law.py", law(HALF))
    scene = Scene.nondimensional(psi1=[8.0, 9.0], chi=1.0)
    # 0 and 8 fall into one place of a small set, so that the first to come is the first
    words = frozenset([0, 8]), frozenset([8, 0])
    assert words[0] == words[1]
    assert repr(words[0]) != repr(words[1])
    for of in words:
        made = contactlab.create("my_law.py:Share", of=of)
        Simulation(tangential=made).sweep(scene, keep="kept")
    other = Simulation(tangential=contactlab.create("my_law.py:Share", of=frozenset([0, 9])))
    with pytest.raises(ValueError, match="holds another sweep: tangential was"):
        other.sweep(scene, keep="kept")


SWEEP = """
import numpy as np
from contactlab import Scene, Simulation
scene = Scene.nondimensional(psi1=[8.0, 9.0], chi=1.0)
print(Simulation(tangential=Share()).sweep(scene, keep="kept").psi2.tolist())
"""


def script(folder, *words, **options):
    return subprocess.run(
        [sys.executable, *words], cwd=folder, capture_output=True, text=True, **options
    )


@pytest.mark.slow
def test_the_code_of_a_script_counts(tmp_path):
    for text in (HALF, FULL):
        (tmp_path / "study.py").write_text(law(text) + SWEEP)
        done = script(tmp_path, "study.py")
    assert "ValueError: keep = 'kept': holds another sweep: code of study.py was" in done.stderr


@pytest.mark.slow
def test_code_in_no_file_is_known_by_its_work(tmp_path):
    """As that of a notebook: the same code goes on, other code is refused."""
    told = [script(tmp_path, "-", input=law(text) + SWEEP) for text in (HALF, HALF, FULL)]
    assert [each.stdout for each in told] == ["[6.0, 7.0]\n"] * 2 + [""]
    assert "keep = 'kept': slip_velocity_change of impacts 0 to 2 is another" in told[2].stderr


@pytest.mark.slow
def test_bits_of_another_computer_are_told_as_such(tmp_path):
    """The last bits of this law depend on the threads of BLAS, as those of a matrix product do."""
    share = "0.5 + 2e-16 * (os.environ['OPENBLAS_NUM_THREADS'] == '3')"
    (tmp_path / "study.py").write_text(law("import os", share) + SWEEP)
    told = []
    for threads in "113":
        environment = os.environ | {"OPENBLAS_NUM_THREADS": threads}
        told.append(script(tmp_path, "study.py", env=environment).stderr)
    assert told[:2] == ["", ""]
    assert "ValueError: keep = 'kept': impacts 0 to 2 are of " in told[2]
    assert "1 BLAS threads); slip_velocity_change has other bits on " in told[2]
    assert "3 BLAS threads); go on where it was begun, or name another folder" in told[2]
