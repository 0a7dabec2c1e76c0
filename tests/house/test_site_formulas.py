"""The site typesets the plain formulas of the guide."""

# ruff: noqa: RUF001 - mathematical characters are meant

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from contactlab.cli.guide import TOPICS, text

HOME = Path(__file__).parents[2] / ".ci" / "site" / "formulas.py"


@pytest.fixture(scope="module")
def site():
    spec = importlib.util.spec_from_file_location("formulas", HOME)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def flat(element):
    """Return MathML as words: fractions, roots and scripts with their names."""
    parts = [flat(child) for child in element]
    if element.tag in ("mrow", "math"):
        return "".join(parts)
    if parts:
        return f"{element.tag[1:]}({','.join(parts)})"
    return element.text or ""


@pytest.mark.parametrize(
    ("plain", "shown"),
    [
        ("zeta' = V", "sup(ζ,′)=V"),
        ("F^ = F/(mu P_max)", "over(F,^)=frac(F,μsub(P,max))"),
        ("k z^1.5", "ksup(z,1.5)"),
        ("v_x' - v_x", "subsup(v,x,′)−sub(v,x)"),
        ("1/E* + K1²/m2", "frac(1,sup(E,*))+frac(subsup(K,1,2),sub(m,2))"),
        ("(kappa/2) M_n/M_t", "(frac(κ,2))frac(sub(M,n),sub(M,t))"),
        ("a b / (c d)", "frac(ab,cd)"),
        ("(k/M)^(2/5)", "sup((frac(k,M)),2/5)"),
        ("g(u) = sqrt((1 + u)/(1 - u))", "g(u)=sqrt(frac(1+u,1−u))"),
        ("dT/dx = 2 u/g(u)", "frac(dT,dx)=2frac(u,g(u))"),
        ("b <= A/4", "b≤frac(A,4)"),
        ("1.5 ∫ w ds", "1.5∫wds"),
    ],
)
def test_a_formula(site, plain, shown):
    assert flat(ElementTree.fromstring(site.formula(plain))) == shown


def test_an_open_bracket_is_refused(site):
    with pytest.raises(ValueError, match=r"no \) in"):
        site.formula("(a + b")


def test_what_looks_like_a_tag_is_typeset(site):
    shown = site.typeset("at abs(psi1) < 1, or mu² >= F^", blocks=False)
    assert shown == "at &#124;<i>ψ</i><sub>1</sub>&#124; < 1, or <i>μ</i>² ≥ F\u0302"


def test_symbols_in_prose(site):
    shown = site.prose("psi1 of abs(mu), zeta^1.5, v_x, nu1 and a museum")
    assert shown == (
        "<i>ψ</i><sub>1</sub> of &#124;<i>μ</i>&#124;, <i>ζ</i><sup>1.5</sup>, "
        "<i>v</i><sub>x</sub>, <i>ν</i><sub>1</sub> and a museum"
    )


@pytest.mark.parametrize("topic", TOPICS)
def test_code_headings_and_links_are_left(site, topic):
    page = text(topic)
    typeset = site.typeset(page, blocks=topic == "theory")
    for pattern in (r"```.*?^```", r"^#.*?$", r"\]\(.*?\)"):
        kept = re.compile(pattern, re.DOTALL | re.MULTILINE)
        assert kept.findall(typeset) == kept.findall(page)


def test_every_formula_of_the_theory_is_well_formed(site):
    typeset = site.typeset(text("theory"), blocks=True)
    formulas = re.findall(r"<math .*?</math>", typeset)
    assert len(formulas) > 35
    for formula in formulas:
        ElementTree.fromstring(formula)
    assert "|<------- u" in typeset  # the drawing of the phases
