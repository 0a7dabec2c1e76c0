"""What results say, in whole sentences, and their numerical error at both sides of a bound."""

import copy
import math

import attrs
import numpy as np
import pytest

from contactlab import ImpactError, Status
from contactlab.outcome.history import NO_HISTORY, History
from contactlab.outcome.numerical_error import error_cautions, error_words
from tests.outcome.made import plan, result, scene

NAN = math.nan
FEW = "the numerical error is {} of the range of psi2, so that no digit is sure; finer resolutions "


@pytest.mark.parametrize(
    ("estimate", "declared", "words"),
    [
        (None, NAN, "not estimated; not declared"),
        (None, 0.0123, "not estimated; at most 0.01, declared"),
        (0.0456, NAN, "about 0.05, estimated; not declared"),
        (NAN, 2e-9, "no estimate: no finer resolution shows one; at most 2e-09, declared"),
    ],
)
def test_the_numerical_error_of_an_impact(estimate, declared, words):
    made = result(planned=plan(error=declared), psi2_error_estimate=estimate)
    assert error_words(made) == words


def test_the_numerical_error_of_a_batch_is_its_largest():
    given = scene(spin=[4.0, 4.0, 4.0])

    def said(estimate, declared):
        estimate = None if estimate is None else np.array(estimate)
        return error_words(result(given, planned=plan((3,), error=declared),
                                  psi2_error_estimate=estimate))  # fmt: skip

    assert said([0.1, 0.2, 0.05], [1e-3, 3e-3, 2e-3]) == (
        "about 0.2, estimated; at most 0.003, declared"
    )
    assert said([0.1, NAN, 0.05], [NAN, NAN, 2e-3]) == (
        "about 0.1, estimated for 2 of 3 impacts; at most 0.002, declared for 1 of 3 impacts"
    )
    assert said(None, [NAN] * 3) == "not estimated; not declared"


def test_cautions_about_the_numerical_error():
    """The range of psi2 is the lesser of 4 chi = 10 and 2 psi1 = 10; a quarter is coarse."""

    def said(estimate, declared, **kinds):
        return error_cautions(result(planned=plan(error=declared, **kinds),
                                     psi2_error_estimate=estimate))  # fmt: skip

    assert said(0.1, 0.01) == []
    assert said(0.11, 0.01) == [
        "the declared numerical error of psi2 is false: at most 0.01 is declared, about 0.1 is "
        "estimated"
    ]
    assert said(None, 2.5) == []
    assert said(None, 2.6) == [f"coarse: {FEW.format('0.26')}would help"]
    assert said(2.6, NAN) == [f"coarse: {FEW.format('0.26')}would help"]
    assert said(None, 2.6, marched=False) == []


def test_cautions_about_the_numerical_errors_of_a_batch():
    given = scene(spin=[4.0, 4.0, 4.0])
    made = result(
        given,
        planned=plan((3,), error=[0.01, 3.0, 0.02], marched=[True, True, False]),
        psi2_error_estimate=np.array([0.2, 0.1, 6.0]),
    )
    assert error_cautions(made) == [
        "the declared numerical error of psi2 is false for 2 of 3 impacts: at most 0.02 is "
        "declared, about 6 is estimated",
        f"coarse for 1 of 3 impacts: {FEW.format('0.3')}would help",
    ]


def test_an_impact_in_words():
    made = result(planned=plan(cautions=("doubt: one", "doubt: two")))
    line = "ImpactResult(psi1=5, chi=2.5, psi2=3; SUCCESS; hertz, springs, symplectic)"
    error = "numerical error of psi2: not estimated; at most 0.01, declared"
    assert repr(made) == line
    assert str(made).splitlines() == [line, error, "caution: doubt: one", "caution: doubt: two"]
    assert made._repr_html_() == f"<pre>{made}</pre>"
    failed = result(status=Status.NON_FINITE, detail="At <step> 3.")
    told = f"{Status.NON_FINITE.value} At <step> 3."
    assert str(failed).splitlines()[2:] == [f"failed: {told}"]
    assert "At &lt;step&gt; 3." in failed._repr_html_()
    with pytest.raises(ImpactError) as caught:
        failed.check()
    assert (str(caught.value), caught.value.status) == (told, Status.NON_FINITE)
    assert made.check() is made
    with pytest.raises(ImpactError) as caught:
        made.check(cautions=True)
    assert str(caught.value) == "caution: doubt: one"
    assert caught.value.status is Status.SUCCESS


def test_a_batch_in_words():
    given = scene(spin=[4.0, 4.0, 4.0, 4.0])
    status = [Status.SUCCESS, Status.NON_FINITE, Status.SUCCESS, Status.UNBALANCED]
    made = result(
        given,
        slip_velocity_change=[-2.0, NAN, -1.5, NAN],
        status=status,
        detail=np.array(["", "a", "", "b"], dtype=object),
    )
    line = (
        "ImpactResult(4 impacts, psi2 from 3 to 3.5; 2 SUCCESS, 1 NON_FINITE, 1 UNBALANCED; hertz, "
        "springs, symplectic)"
    )
    assert repr(made) == line
    told = f"{Status.NON_FINITE.value} a"
    assert str(made).splitlines()[2:] == [f"failed (impact 1; 2 in all): {told}"]
    assert made.failures == {1: told, 3: f"{Status.UNBALANCED.value} b"}
    with pytest.raises(ImpactError) as caught:
        made.check()
    assert (str(caught.value), caught.value.status) == (f"impact 1: {told}", Status.NON_FINITE)
    none = result(given, slip_velocity_change=NAN)
    assert repr(none).startswith("ImpactResult(4 impacts, psi2 unknown; 4 SUCCESS; ")
    assert made[-1].status is Status.UNBALANCED
    assert [len(made[part]) for part in (slice(1, 3), slice(None), slice(-1, None))] == [2, 4, 1]
    for bad, words in (
        (4, "4: is out of range for a batch of 4 impacts"),
        (-5, "-5: is out of range for a batch of 4 impacts"),
    ):
        with pytest.raises(IndexError) as caught:
            made[bad]
        assert str(caught.value) == words
    for bad in (True, 1.0, "1"):
        with pytest.raises(TypeError) as caught:
            made[bad]
        assert str(caught.value) == f"a result is indexed by a number or a slice, not {bad!r}"
    assert [one.status for one in made] == status


def test_no_history_says_how_to_have_one():
    for again in (copy.copy(NO_HISTORY), copy.deepcopy(NO_HISTORY)):
        assert not again
    assert repr(NO_HISTORY) == "NoHistory(run(scene, history=True) keeps one)"
    assert not hasattr(NO_HISTORY, "__array__")
    with pytest.raises(AttributeError) as caught:
        _ = NO_HISTORY.time
    assert str(caught.value) == (
        "history.time: this run kept no history; write run(scene, history=True), or "
        "history='fields' for traction, stick and slip too"
    )
    names = [item.name for item in attrs.fields(History)][:-1]
    bare = History(**dict.fromkeys(names, np.zeros(1)))
    assert bare.fields == {}
    assert repr(bare) == "History(1 instants to 0 s; no fields)"
