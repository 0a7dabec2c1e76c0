"""Finding and making laws; what broken plug-ins do, and do not do to others."""

import sys
from importlib import metadata

import numpy as np
import pytest

import contactlab
from contactlab import PluginError
from contactlab.contracts.law import law_kind
from contactlab.contracts.normal import NormalLaw
from contactlab.registration.installed import clashes
from contactlab.registry.registry import KINDS, REGISTRY, PluginWarning

MINE, KNOWN = "tangential.mine", "normal.hertz"
NORMAL_LAW = """
from typing import ClassVar
import attrs
import contactlab
from contactlab.contracts import NormalContact, NormalLaw

@attrs.frozen(kw_only=True)
class Soft(NormalLaw):
    api_version: ClassVar[int] = 2
    def start(self, scene):
        return scene.pair.effective_modulus * scene.pair.radius
    def respond(self, state, approach, rate):
        inside = approach * (approach > 0.0)
        return NormalContact(force=state * inside, radius=0.0 * inside, overlap=approach), state

@contactlab.hookimpl
def contactlab_law(name):
    return Soft
"""


def test_every_declared_entry_point_loads(registry):
    points = [
        point
        for point in metadata.entry_points(group="contactlab")
        if point.dist.name == "contactlab" and point.name.partition(".")[0] in KINDS
    ]
    assert len(points) >= 6
    for point in points:
        law = registry.law_class(point.name)
        assert law_kind(law) == point.name.partition(".")[0]
        assert registry.create(point.name) is not None


def test_create_passes_options_and_checks_them():
    assert contactlab.create("integrator.paper", steps=123).steps == 123
    with pytest.raises(ValueError, match=r"integrator.paper: steps = 0: must be a whole number"):
        contactlab.create("integrator.paper", steps=0)
    with pytest.raises(
        ValueError,
        match=r"step = 3: paper has no such option; did you mean 'steps'",
    ):
        contactlab.create("integrator.paper", step=3)


def test_a_name_that_is_no_text_is_refused():
    with pytest.raises(ValueError, match="name = None: must be a text"):
        contactlab.create(None)


def test_unknown_name_gives_the_nearest():
    with pytest.raises(ValueError, match=r"no friction law 'columb'.*did you mean 'coulomb'"):
        contactlab.create("tangential.columb")
    with pytest.raises(ValueError, match=r"no friction law 'exact' is installed; all names"):
        contactlab.create("tangential.exact")  # like none but for the kind
    assert contactlab.create("hertz") == contactlab.create("normal.hertz")


def test_a_third_party_law_is_made_like_any_other(registry, install, law_source):
    install("thirdparty", "thirdparty_law", law_source, MINE)
    assert registry.info(MINE).distribution == "thirdparty"
    assert registry.info(MINE).version == "1.5"
    law = registry.create(MINE)
    assert type(law).__name__ == "Mine"
    assert registry.describe(law) == "mine (thirdparty 1.5)"


def test_where_a_law_comes_from_does_not_hang_on_how_it_was_made(registry):
    from contactlab_laws.springs.law import Springs

    origin = registry.describe(Springs())
    assert origin.startswith("springs (contactlab ")
    assert registry.describe(registry.create("tangential.springs")) == origin


def test_two_distributions_with_one_name_are_refused_naming_both(registry, install, law_source):
    install("first", "first_law", law_source, MINE)
    install("second", "second_law", law_source, MINE)
    with pytest.raises(ValueError, match=r"first 1.5 and second 1.5") as caught:
        registry.create(MINE)
    assert "'first:tangential.mine' or 'second:tangential.mine'" in str(caught.value)
    assert registry.create("tangential.coulomb") is not None
    for name in ("first", "second"):
        law = registry.create(f"{name}:{MINE}")
        assert registry.describe(law) == f"mine ({name} 1.5)"
        assert type(law).__module__ == f"{name}_law"
    assert [name for name in registry.names() if MINE in name] == [
        f"first:{MINE}",
        f"second:{MINE}",
    ]


@pytest.mark.parametrize("blocking", ["second", f"second:{MINE}", "Second", "other, second"])
def test_the_advised_block_leaves_the_other_law(
    registry, install, law_source, monkeypatch, blocking
):
    for name in ("first", "second", "other"):
        install(name, f"{name}_law", law_source, MINE if name != "other" else "tangential.other")
    with pytest.raises(ValueError, match="block all laws of one: CONTACTLAB_BLOCK_PLUGINS=second"):
        registry.create(MINE)
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", blocking)
    assert registry.describe(registry.create(MINE)) == "mine (first 1.5)"
    assert MINE in registry.names()
    with pytest.raises(ValueError, match="blocked"):
        registry.create(f"second:{MINE}")
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", MINE)
    with pytest.raises(ValueError, match="blocked"):
        registry.create(MINE)


@pytest.mark.parametrize(
    ("entries", "blocked"),
    [
        (MINE, True), ("my-laws", True), ("My_Laws", True), (f"my-laws:{MINE}", True),
        (f"My.Laws:{MINE}", True), (f"normal.jkr,{MINE}", True), ("", False),
        (" normal.jkr  normal.dmt, ", False), ("contactlab:normal.jkr", False),
    ],
)  # fmt: skip
def test_what_an_entry_blocks(registry, install, law_source, monkeypatch, entries, blocked):
    install("my-laws", "my_law", law_source, MINE)
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", entries)
    assert registry.info(f"contactlab:{KNOWN}").blocked is False
    assert (MINE not in registry.names()) is blocked
    (law,) = (info for info in registry.installed() if info.name == MINE)
    assert (law.blocked, law.usable) == (blocked, not blocked)


def test_laws_are_listed_by_kind_and_name_and_described_by_their_distribution(
    registry, install, law_source
):
    install("theirs", "their_law", law_source, MINE)
    names = [law.name for law in registry.installed()]
    kinds = ["normal", "tangential", "integrator"]
    assert names == sorted(names, key=lambda name: (kinds.index(name.partition(".")[0]), name))
    assert registry.names("normal") == [name for name in names if name.startswith("normal.")]
    assert clashes(registry.installed()) == []
    law = registry.info(MINE)
    assert registry.at_hand(registry.info(KNOWN))
    assert not registry.at_hand(law)
    made = registry.create(MINE)
    assert registry.at_hand(law)  # imported
    assert registry.describe(made) == registry.describe(type(made)) == "mine (theirs 1.5)"
    assert registry.describe(NormalLaw).endswith(".NormalLaw (not registered)")


def test_an_entry_point_names_a_class_or_a_module_with_a_hook(registry, install, law_source):
    """The class alone needs no hook: its own distribution tells it as one with a hook."""
    plain = law_source.partition("@contactlab.hookimpl")[0]
    install("plain", "plain_law:Mine", plain, MINE)
    install("hooked", "hooked_law", law_source, "tangential.other")
    made = registry.create(MINE), registry.create("tangential.other")
    assert [type(law).__module__ for law in made] == ["plain_law", "hooked_law"]
    assert registry.describe(made[0]) == "mine (plain 1.5)"
    assert registry.describe(made[1]) == "other (hooked 1.5)"
    install("broken", "broken_law:Nothing", plain, "tangential.broken")
    with pytest.raises(PluginError, match=r"broken 1.5 could not be imported: .*Nothing"):
        registry.create("tangential.broken")
    install("number", "number_law:np", f"{plain}\nnp = 3", "tangential.number")
    with pytest.raises(PluginError, match="3, which is not the class of a law"):
        registry.create("tangential.number")


def test_a_distribution_cannot_take_over_a_built_in_name(
    registry, install, law_source, monkeypatch
):
    install("usurper", "usurper_law", law_source, "tangential.coulomb")
    assert registry.describe(registry.create("tangential.coulomb")).startswith(
        "coulomb (contactlab "
    )
    ours = registry.create("contactlab:tangential.coulomb")
    assert type(ours) is type(registry.create("tangential.coulomb"))
    theirs = registry.create("usurper:tangential.coulomb")
    assert registry.describe(theirs) == "coulomb (usurper 1.5)"
    assert {"tangential.coulomb", "usurper:tangential.coulomb"} <= set(registry.names())
    (sentence,) = clashes(registry.installed())
    assert "means 'contactlab:tangential.coulomb'; write 'usurper:tangential.coulomb'" in sentence
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "contactlab:tangential.coulomb")
    assert type(registry.create("tangential.coulomb")) is type(theirs)
    assert clashes(registry.installed()) == []
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "usurper")
    assert type(registry.create("tangential.coulomb")) is type(ours)


def test_a_strangers_normal_hertz_leaves_the_program_as_it_was(registry, install, monkeypatch):
    """The whole program was disabled by it: every default names this law."""
    for name, nothing in (("_loaded", {}), ("_meant", {})):
        monkeypatch.setattr(REGISTRY, name, nothing)
    install("usurper", "usurper_law", NORMAL_LAW, "normal.hertz")
    scene = contactlab.Scene.nondimensional(psi1=1.2, chi=1.4412)
    assert contactlab.Simulation().run(scene).psi2 == pytest.approx(-0.18048, abs=1e-5)
    for name in ("usurper:hertz", "usurper:normal.hertz", "Usurper:hertz"):
        theirs = contactlab.Simulation(normal=name, tangential="coulomb")
        assert type(theirs.normal).__name__ == "Soft"
        assert theirs.run(scene).laws["normal"] == "hertz (usurper 1.5)"


def test_names_of_no_law_with_a_distribution_are_refused_with_what_is_meant(
    registry, install, law_source
):
    install("my-laws", "my_law", law_source, MINE)
    assert registry.create(f"My_Laws:{MINE}") is not None  # spellings of one distribution
    with pytest.raises(ValueError, match=r"write 'my-laws:tangential"):
        registry.create(f"contactlab:{MINE}")
    with pytest.raises(ValueError, match=r"did you mean 'my-laws'"):
        registry.create("my-law:tangential.other")
    with pytest.raises(ValueError, match="no friction law"):
        registry.create("my-laws:tangential.miner")


def test_a_blocked_distribution_that_is_not_installed_is_warned_of(registry, install, monkeypatch):
    install("my-laws", "my_law", "", MINE)
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "my-lawz my-laws")
    with pytest.warns(PluginWarning, match=r"'my-lawz', .* did you mean 'my-laws'"):
        assert MINE not in registry.names()


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (
            "import not_there_at_all",
            r"could not be imported: ModuleNotFoundError: .*_at_all' \(broken_law.py, line 1\)$",
        ),
        ("x = (", r"could not be imported: SyntaxError: .* \(broken_law.py, line 1\)$"),
        ("raise SystemExit(3)", "could not be imported: SystemExit"),
        ("1/0", "could not be imported: ZeroDivisionError"),
        ("", "has no hook"),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_lwa(name): pass",
            "does not fit the hooks",
        ),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name, more): pass",
            "does not fit the hooks",
        ),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name): return 5",
            "not the class of a law",
        ),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name): return None",
            "not the class of a law",
        ),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name): return int",
            "not the class of a law",
        ),
        (
            "import contactlab, contactlab.contracts.law as base\nclass Odd(base.Law): pass\n"
            "@contactlab.hookimpl\ndef contactlab_law(name): return Odd",
            "not the class of a law",
        ),
        (
            "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name): 1/0",
            "raised when asked",
        ),
    ],
)
def test_a_broken_plugin_says_so_and_harms_nobody(registry, install, source, message):
    install("broken", "broken_law", source, MINE)
    assert MINE in registry.names()
    for _ in range(2):  # the second time is no different
        with pytest.raises(PluginError, match=message) as caught:
            registry.create(MINE)
        assert "broken 1.5" in str(caught.value)
        assert MINE in str(caught.value)
    assert registry.create("tangential.coulomb") is not None


def test_a_plugin_cannot_end_the_program_print_among_data_or_change_settings(
    registry, install, law_source, capsys
):
    spoilt = "import numpy, sys\nprint('hello')\nnumpy.seterr(all='raise')\n" + law_source
    asked = "    print('asked')\n    numpy.seterr(all='raise')\n    return Mine"
    install("loud", "loud_law", spoilt.replace("    return Mine", asked), MINE)
    before = np.geterr()
    assert type(registry.create(MINE)).__name__ == "Mine"
    assert np.geterr() == before
    caught = capsys.readouterr()
    assert (caught.out, caught.err) == ("", "hello\nasked\n")


@pytest.mark.parametrize("raised", ["SystemExit(3)", "GeneratorExit()", "BaseException('x')"])
def test_whatever_a_hook_or_an_import_raises_is_a_broken_plugin(registry, install, raised):
    hook = "import contactlab\n@contactlab.hookimpl\ndef contactlab_law(name): raise "
    install("hook", "hook_law", hook + raised, MINE)
    install("imported", "imported_law", f"raise {raised}", "tangential.other")
    with pytest.raises(PluginError, match="raised when asked"):
        registry.create(MINE)
    with pytest.raises(PluginError, match="could not be imported"):
        registry.create("tangential.other")


def test_what_is_installed_meanwhile_is_found_and_what_is_known_is_not_read_again(
    registry, install, law_source, monkeypatch
):
    assert MINE not in registry.names()
    install("late", "late_law", law_source, MINE)
    assert MINE in registry.names()
    monkeypatch.setattr(metadata, "entry_points", None)
    assert MINE in registry.names()
    assert registry.create(MINE) is not None


# bytecode written by the import changes the folder, which is read and told again
@pytest.mark.filterwarnings("ignore::contactlab.registration.installed.PluginWarning")
@pytest.mark.parametrize("content", [b"[contactlab]\ntangential.x\n", b"[contactlab]\n\xff = x\n"])
def test_a_distribution_that_cannot_be_read_stops_nothing(
    registry, install, law_source, content, tmp_path
):
    install("good", "good_law", law_source, MINE)
    install("unreadable", "unreadable_law", "", "tangential.other")
    (tmp_path / "unreadable-1.5.dist-info" / "entry_points.txt").write_bytes(content)
    with pytest.warns(PluginWarning, match=r"unreadable-1.5.dist-info cannot be read"):
        assert registry.create(MINE) is not None
    assert {MINE, "tangential.coulomb"} <= set(registry.names())


def test_an_interruption_is_still_one(registry, install):
    install("slow", "slow_law", "raise KeyboardInterrupt", MINE)
    with pytest.raises(KeyboardInterrupt):
        registry.create(MINE)


@pytest.mark.parametrize(
    "name", ["tangential.", "", "nodot", ".annulus", "tangental.mine", "a.b.c"]
)
def test_a_malformed_name_stops_nothing(registry, install, law_source, name):
    install("odd", "odd_law", law_source, name, MINE)
    found = {info.name: info for info in registry.installed() if info.distribution == "odd"}
    assert found[MINE].malformed is False
    assert all(info.malformed for known, info in found.items() if known != MINE)
    assert name not in registry.names()
    assert contactlab.Simulation(tangential=registry.create(MINE)) is not None
    if name in found:
        with pytest.raises(PluginError, match=r"odd 1\.5: the name must be"):
            registry.create(name)


@pytest.mark.parametrize("name", ["tangential.mine.py", "tangential.mine:Mine", "tangential.Brush"])
def test_a_name_like_a_place_is_malformed(registry, install, law_source, name):
    """It would mean the file ``mine.py`` of the folder, or the class ``odd:Brush``."""
    install("odd", "odd_law", law_source, name)
    (found,) = (info for info in registry.installed() if info.distribution == "odd")
    assert found.malformed
    assert name not in registry.names()


def test_wrong_interface_version_wrong_kind_and_abstract_laws(registry, install, law_source):
    install("old", "old_law", law_source.replace("int] = 2", "int] = 99"), "tangential.old")
    install("odd", "odd_law", law_source, "normal.odd")
    start = "    def start(self, scene, normal):\n        return 0.0\n"
    install("half", "half_law", law_source.replace(start, ""), "tangential.half")
    with pytest.raises(PluginError, match=r"api_version is 99.*write api_version: ClassVar"):
        registry.create("tangential.old")
    with pytest.raises(
        PluginError, match="a tangential law; an entry point names a class of its kind"
    ):
        registry.create("normal.odd")
    with pytest.raises(PluginError, match="does not define start"):
        registry.create("tangential.half")


def test_blocked_names_are_refused_and_not_imported(registry, install, monkeypatch):
    install("broken", "broken_law", "1/0", MINE)
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", f"{MINE}, normal.other")
    with pytest.warns(PluginWarning, match=r"'normal.other', .* did you mean 'normal.hertz'"):
        assert MINE not in registry.names()
    assert MINE not in registry.names()  # said once
    with pytest.raises(ValueError, match="CONTACTLAB_BLOCK_PLUGINS"):
        registry.create(MINE)
    assert "broken_law" not in sys.modules


def test_a_law_loaded_before_is_blocked_too(registry, monkeypatch):
    registry.create("tangential.coulomb")
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "tangential.coulomb")
    with pytest.raises(ValueError, match="blocked"):
        registry.create("tangential.coulomb")
