"""What the registry says of names that several distributions offer, or that are blocked."""

import os
import sys

import pytest

from contactlab.compose.installed import (
    PluginInfo,
    PluginWarning,
    blocked_names,
    blocks,
    by_name,
    clash,
    meant,
    stamp,
)
from contactlab.compose.names import full_name, kind_of, parted, same_distribution, short_name

NAME = "normal.mine"


def info(distribution, *, name=NAME, blocked=False):
    return PluginInfo(name, distribution, "1.5", "module", blocked)


OURS, FIRST, SECOND = info("contactlab"), info("first"), info("second")


@pytest.mark.parametrize(
    ("rivals", "law"),
    [
        ([FIRST], FIRST), ([FIRST, OURS], OURS), ([FIRST, SECOND], None),
        ([FIRST, info("second", blocked=True)], FIRST), ([OURS, info("contactlab")], None),
        ([info("first", blocked=True), info("second", blocked=True)], None),
    ],
)  # fmt: skip
def test_the_law_that_a_name_means(rivals, law):
    assert meant(rivals) is law


def test_a_blocked_law_is_meant_if_there_is_no_other():
    alone = info("first", blocked=True)
    assert meant([alone]) is alone
    assert meant([info("contactlab", blocked=True), FIRST]) is FIRST


def test_a_name_of_several_distributions():
    both = "'first:normal.mine' or 'second:normal.mine'"
    block = "or block all laws of one: CONTACTLAB_BLOCK_PLUGINS="
    assert clash([FIRST, SECOND]) == (
        f"name = 'normal.mine': is offered by first 1.5 and second 1.5; write {both}, {block}second"
    )
    assert clash([OURS, FIRST]) == (
        "'normal.mine' is offered by contactlab 1.5 and first 1.5: it means "
        f"'contactlab:normal.mine'; write 'first:normal.mine' for the other, {block}first"
    )
    assert clash([FIRST, info("first")]) == (
        "name = 'normal.mine': is offered twice, by first 1.5 and first 1.5; uninstall one of them"
    )


@pytest.mark.parametrize(
    ("entries", "blocked"),
    [
        ({NAME}, True), ({"my-laws"}, True), ({"My_Laws"}, True), ({f"my-laws:{NAME}"}, True),
        ({f"My.Laws:{NAME}"}, True), ({f"other:{NAME}"}, False), ({"normal.other"}, False),
        ({"my-laws:normal.other"}, False), (set(), False), ({"normal.other", NAME}, True),
        ({f":{NAME}"}, False),
    ],
)  # fmt: skip
def test_what_an_entry_blocks(entries, blocked):
    assert blocks(entries, NAME, "my-laws") is blocked


def test_entries_are_separated_by_commas_or_blanks(monkeypatch):
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", " a,b  c, d")
    assert blocked_names() == {"a", "b", "c", "d"}
    monkeypatch.delenv("CONTACTLAB_BLOCK_PLUGINS")
    assert blocked_names() == set()


@pytest.mark.parametrize(
    ("name", "kind", "malformed"),
    [
        ("normal.mine", "normal", False), ("normal.", "normal", True), ("mine", "mine", True),
        ("other.mine", "other", True), ("normal.a.b", "normal", False),
    ],
)  # fmt: skip
def test_a_name_is_a_kind_a_dot_and_a_name(name, kind, malformed):
    law = info("first", name=name)
    assert (law.kind, law.malformed, law.usable) == (kind, malformed, not malformed)
    assert not info("first", name=name, blocked=True).usable
    assert (law.qualified, law.source) == (f"first:{name}", f"{name!r} of first 1.5")


def test_the_shortest_name_of_a_law():
    law = info("first")
    assert law.known_as == NAME
    assert (
        PluginInfo(NAME, "first", "1.5", "module", False, meant=False).known_as == f"first:{NAME}"
    )
    assert by_name([FIRST, OURS, info("first", name="normal.b")]) == {
        NAME: [FIRST, OURS],
        "normal.b": [info("first", name="normal.b")],
    }


def test_names_in_parts():
    assert parted("a:b:normal.c") == ("a:b", "normal.c")
    assert parted("normal.c") == ("", "normal.c")
    assert kind_of("a:normal.c.d") == "normal"
    assert full_name("normal", "c") == full_name("normal", "normal.c") == "normal.c"
    assert short_name("other.c") == "other.c"
    assert short_name("normal.") == "normal."
    assert same_distribution("My__Laws", "my-laws")
    assert not same_distribution("mylaws", "my-laws")


def test_an_installation_changes_the_stamp(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(tmp_path / "none"), ""])
    os.utime(tmp_path, ns=(10**9, 10**9))
    before = stamp()
    assert before[:2] == [(str(tmp_path), 10**9), (str(tmp_path / "none"), 0)]
    assert before[2] == ("", os.stat(".").st_mtime_ns)
    os.utime(tmp_path, ns=(10**9, 2 * 10**9))
    assert stamp() != before


def test_a_blocked_name_that_is_not_installed_is_told_once(registry, monkeypatch):
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "normal.hertzz zzzzzz")
    with pytest.warns(PluginWarning) as told:
        registry.installed()
    assert [str(one.message) for one in told] == [
        "CONTACTLAB_BLOCK_PLUGINS names 'normal.hertzz', which is not installed; did you mean "
        "'normal.hertz'?",
        "CONTACTLAB_BLOCK_PLUGINS names 'zzzzzz', which is not installed",
    ]
    registry.installed()  # a second warning would be an error


def test_laws_are_listed_by_kind_and_name(registry):
    names = [law.name for law in registry.installed()]
    kinds = ["normal", "tangential", "integrator"]
    assert names == sorted(names, key=lambda name: (kinds.index(name.partition(".")[0]), name))
    assert registry.names("normal") == [name for name in names if name.startswith("normal.")]
    assert registry.names() == sorted(names)
    assert registry.clashes() == []


def test_laws_at_hand_are_ours_and_those_that_were_imported(registry, install, law_source):
    install("theirs", "their_law", law_source, "tangential.mine")
    law = registry.info("tangential.mine")
    assert registry.at_hand(registry.info("normal.hertz"))
    assert not registry.at_hand(law)
    made = registry.create("tangential.mine")
    assert registry.at_hand(law)
    assert registry.describe(made) == registry.describe(type(made)) == "mine (theirs 1.5)"


def test_a_class_that_no_distribution_offers_is_described_by_its_place(registry):
    assert registry.describe(PluginInfo) == (
        "contactlab.compose.installed.PluginInfo (not registered)"
    )
