"""Options of laws in words: nothing built in goes without, and what is told is what holds."""

import json
import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab.contracts import NormalLaw
from contactlab.numeric.checks import quantity
from contactlab.registry.options import meanings, options
from contactlab.registry.registry import REGISTRY

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
        several = any(word in option.rule for word in ("pairs", "whole", "True or False"))
        one = isinstance(value, float) and not several
        alone = {option.name: np.array(value)[()]} if one else {}
        assert contactlab.create(name, **alone) is not None
        if "one number, or one an impact" in option.meaning:
            continue
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
