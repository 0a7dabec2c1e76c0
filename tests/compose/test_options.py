"""Options of laws in words: nothing built in goes without, and what is told is what holds."""

import json
import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab.compose.options import meanings, options
from contactlab.compose.registry import REGISTRY
from contactlab.contracts import NormalLaw
from contactlab.numeric.checks import choice, count, flag, quantity

LAWS = [info.name for info in REGISTRY.installed() if info.distribution == "contactlab"]


@pytest.mark.parametrize("name", LAWS)
def test_every_option_of_a_built_in_law_has_a_meaning_and_a_range(name):
    law = REGISTRY.law_class(name)
    found = options(law)
    assert [option.name for option in found if not (option.meaning and option.rule)] == []
    assert set(meanings(law)) == {option.name for option in found}
    made = contactlab.create(name)
    for option in found:
        if option.default is not None:  # of None a law may fill in another
            assert getattr(made, option.name) == option.default
    json.dumps([option.to_dict() for option in found], allow_nan=False)


@pytest.mark.parametrize("name", LAWS)
def test_a_refusal_says_the_rule_that_is_told(name):
    for option in options(REGISTRY.law_class(name)):
        with pytest.raises(ValueError, match=re.escape(option.rule.removesuffix(", if given"))):
            contactlab.create(name, **{option.name: -7.5})


@pytest.mark.parametrize("name", LAWS)
def test_an_option_of_a_law_is_one_number(name):
    """An array, one value for each impact, was taken by eleven laws."""
    for option in options(REGISTRY.law_class(name)):
        value = 0.5 if option.default is None else option.default
        alone = {option.name: np.array(value)[()]} if isinstance(value, float) else {}
        assert contactlab.create(name, **alone) is not None
        with pytest.raises(ValueError, match=rf"{option.name} = .*must be"):
            contactlab.create(name, **{option.name: np.array([value, value])})


def test_an_array_for_an_option_of_a_strangers_law_is_refused_with_the_remedy():
    @attrs.frozen(kw_only=True)
    class Theirs(NormalLaw):
        api_version: ClassVar[int] = 2
        stiffness: float = quantity("N/m", default=1.0)

        def start(self, scene):
            return None

        def respond(self, state, approach, rate):
            raise NotImplementedError

    assert Theirs(stiffness=[3.0][0]).stiffness == 3.0
    with pytest.raises(
        ValueError,
        match=r"stiffness = \[1.0, 2.0\]: must be one number: .*; make a law for each value",
    ):
        Theirs(stiffness=[1.0, 2.0])


@attrs.frozen(kw_only=True)
class Made:
    """A law.

    Parameters
    ----------
    parts : int
        How many,

        in two paragraphs.
    first, second : float
        Both.

    References
    ----------
    sure : nothing of this.
    """

    parts: int = count(least=2, most=9)
    first: float = quantity("m", default=1.0)
    second: float = quantity("m", default=2.0)
    kind: str = choice("one", "other", default="one")
    sure: bool = flag(default=True)


class Plain:
    """A stranger's class, without fields or sections."""

    def __init__(self, size, shape=object):
        self.size, self.shape = size, shape


def test_options_of_any_class():
    parts, first, second, kind, sure = options(Made)
    assert (str(parts), parts.meaning) == ("parts, to be given", "How many, in two paragraphs.")
    assert parts.rule == "must be a whole number from 2 to 9"
    assert (first.unit, first.meaning, second.meaning) == ("m", "Both.", "Both.")
    assert (kind.rule, kind.meaning) == ("must be one of 'one', 'other'", "")
    assert (sure.rule, sure.meaning, str(sure)) == ("must be True or False", "", "sure = True")


def test_options_of_a_class_without_fields():
    size, shape = options(Plain)
    assert (size.unit, size.rule, size.meaning) == ("", "", "")
    assert size.to_dict()["needed"]
    assert size.to_dict()["default"] is None
    assert shape.to_dict()["default"] == "<class 'object'>"
