"""A kept sweep goes on with the code that it was begun with, or is refused."""

import importlib
import subprocess
import sys
from importlib import metadata

import pytest

import contactlab
from contactlab import PluginError, Scene, Simulation

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

@attrs.frozen
class Friction:
    def share(self):
        return SHARE
"""


def law(line="", value="SHARE", lazy="pass"):
    return LAW.replace("IMPORT", line).replace("VALUE", value).replace("LAZY", lazy)


def of_module(name):
    return importlib.import_module(name).Share()


def with_object():
    return importlib.import_module("my_law").Share(of=importlib.import_module("helper").Friction())


#: Files, how the law is made of them, the file with the share, and what the refusal says.
WAYS = {
    "beside a law's file": (
        {"my_law.py": law("from helper import SHARE")},
        lambda: "my_law.py:Share", "helper.py", "code of helper",
    ),
    "two files away": (
        {"my_law.py": law("import middle", "middle.share()"),
         "middle.py": "import helper\ndef share(): return helper.SHARE\n"},
        lambda: "my_law.py:Share", "helper.py", "code of helper",
    ),
    "in a package beside it": (
        {"my_law.py": law("from parts import helper", "helper.SHARE"), "parts/__init__.py": ""},
        lambda: "my_law.py:Share", "parts/helper.py", r"code of parts\.helper",
    ),
    "in the law's file": (
        {}, lambda: "my_law.py:Share", "my_law.py", r"code of my_law\.py",
    ),
    "imported in a method": (
        {"my_law.py": law(lazy="from helper import SHARE")},
        lambda: of_module("my_law"), "helper.py", "code of helper",
    ),
    "imported by a text": (
        {"my_law.py": law("import importlib\nhelper = importlib.import_module('helper')",
                          "helper.SHARE")},
        lambda: "my_law.py:Share", "helper.py", "code of helper",
    ),
    "in a package": (
        {"laws/__init__.py": "from .friction import Share\n",
         "laws/friction.py": law("from .parts import helper", "helper.SHARE"),
         "laws/parts/__init__.py": ""},
        lambda: of_module("laws"), "laws/parts/helper.py", r"code of laws\.parts\.helper",
    ),
    "in a class that a law derives from": (
        {"my_law.py": "from helper import Share\nclass Mine(Share):\n    pass\n"},
        lambda: importlib.import_module("my_law").Mine(), "helper.py", "code of helper",
    ),
    "in an object that is an option": (
        {"my_law.py": law(value="self.of.share()")}, with_object, "helper.py", "code of helper",
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


def psi2(tangential, keep):
    scene = Scene.nondimensional(psi1=[8.0, 9.0], chi=1.0)
    return Simulation(tangential=tangential).sweep(scene, keep=keep).check().psi2.tolist()


def shares(way):
    """Return the text of the file with the share, half and full."""
    if way in ("in the law's file", "in a class that a law derives from"):
        return [law(text) for text in (HALF, FULL)]
    return [text + FRICTION for text in (HALF, FULL)]


@pytest.mark.parametrize(("way", "case"), WAYS.items())
@pytest.mark.parametrize("anew", [True, False])
def test_a_sweep_whose_code_has_changed_is_refused(folder, way, case, anew):
    files, made, changed, words = case
    half, full = shares(way)
    for name, text in (files | {changed: half}).items():
        written(folder / name, text)
    assert psi2(made(), "kept") == pytest.approx([6.0, 7.0])
    if anew:
        forget(folder)
    assert psi2(made(), "kept") == pytest.approx([6.0, 7.0])
    written(folder / changed, full)
    if anew:
        forget(folder)
    elif not isinstance(made(), str):
        # Python keeps what it has imported: the sweep goes on with that, and so does its label
        assert psi2(made(), "kept") == pytest.approx([6.0, 7.0])
        return
    with pytest.raises(ValueError, match=rf"holds another sweep: {words} was \w+, is \w+; delete"):
        psi2(made(), "kept")
    assert psi2(made(), "other") == pytest.approx([4.0, 5.0])
    written(folder / changed, half)
    if anew:
        forget(folder)
    assert psi2(made(), "kept") == pytest.approx([6.0, 7.0])


def test_a_module_that_the_law_does_not_import_does_not_count(folder):
    for name, text in {"__init__": "", "friction": law(HALF), "other": "", "another": ""}.items():
        written(folder / "laws" / f"{name}.py", text)
    for others in ((), ("laws.other",), ("laws.other", "laws.another")):
        forget(folder)
        for name in others:
            importlib.import_module(name)
        assert psi2(of_module("laws.friction"), "kept") == pytest.approx([6.0, 7.0])


def test_a_module_that_was_loaded_again_is_read_again(folder):
    written(folder / "helper.py", HALF)
    written(folder / "my_law.py", law("import helper", "helper.SHARE"))
    assert psi2(of_module("my_law"), "kept") == pytest.approx([6.0, 7.0])
    written(folder / "helper.py", FULL)
    importlib.reload(sys.modules["helper"])
    with pytest.raises(ValueError, match="code of helper was"):
        psi2(of_module("my_law"), "kept")


def test_a_plugin_in_a_working_copy_counts_by_its_code(folder, install):
    install("workshop", "my_law:Share", law("import helper", "helper.SHARE"), "tangential.workshop")
    written(folder / "helper.py", HALF)
    assert psi2("workshop", "kept") == pytest.approx([6.0, 7.0])
    written(folder / "helper.py", FULL)
    importlib.reload(sys.modules["helper"])
    with pytest.raises(ValueError, match="code of helper was"):
        psi2("workshop", "kept")


@pytest.mark.parametrize("name", ["contactlab", "numpy", "scipy"])
def test_other_versions_are_refused(folder, monkeypatch, name):
    before = metadata.version
    assert psi2("coulomb", "kept") == pytest.approx([4.0, 5.0])
    monkeypatch.setattr(metadata, "version", lambda each: "99.1" if each == name else before(each))
    with pytest.raises(ValueError, match=rf"{name} was {before(name)}, is 99\.1"):
        psi2("coulomb", "kept")


def test_a_description_changes_with_the_files_beside_a_law(folder):
    written(folder / "helper.py", HALF)
    written(folder / "my_law.py", law("from helper import SHARE"))
    scene = Scene.nondimensional(psi1=9.0, chi=1.0)
    told = []
    for text in (HALF, FULL):
        written(folder / "helper.py", text)
        told.append(Simulation(tangential="my_law.py:Share").run(scene))
    assert [result.psi2 for result in told] == pytest.approx([7.0, 5.0])
    assert told[0].laws["tangential"] != told[1].laws["tangential"]


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


def test_code_in_no_file_is_not_kept(tmp_path):
    done = script(tmp_path, "-", input=law(HALF) + SWEEP)
    assert "cannot tell the code of __main__ from an earlier one" in done.stderr
    assert not (tmp_path / "kept").exists()
