"""Typesets the plain formulas of the guide as MathML, which browsers draw without a network.

The guide is read in a terminal too, so its formulas are plain: ``T = t v1/delta``, ``k z^1.5``.
"""

# ruff: noqa: RUF001 - mathematical characters are meant

from __future__ import annotations

import html
import re

GREEK = {
    "Gamma": "Γ", "Lambda": "Λ", "beta": "β", "chi": "χ", "delta": "δ", "kappa": "κ",
    "lambda": "λ", "mu": "μ", "nu": "ν", "omega": "ω", "phi": "φ", "pi": "π", "psi": "ψ",
    "sigma": "σ", "tau": "τ", "theta": "θ", "xi": "ξ", "zeta": "ζ",
}  # fmt: skip
FUNCTIONS = ("arctan2", "arccos", "arcosh", "cos", "sin", "tan", "exp", "ln", "max", "min", "abs")
NAMES = ("sqrt", "angle")  # other words that a formula may have
SPACE = '<mspace width=".17em"></mspace>'
SIGNS = {"-": "−", "<=": "≤", ">=": "≥", "...": "…", "->": "→"}
POWERS = {"²": "2", "³": "3", "⁴": "4", "⁵": "5"}
CLOSING = {"(": ")", "[": "]", "|": "|"}
TOKEN = re.compile(
    r"\s+|\d+(?:\.\d+)?(?:e-?\d+)?|½|¾|<=|>=|->|\.\.\.|"
    rf"(?:{'|'.join((*GREEK, *FUNCTIONS, 'sqrt'))})(?![a-z])|[a-z]{{3,}}|[A-Za-z]|."
)
#: More than two spaces part the formulas and remarks of a line.
GAP = re.compile(r" {3,}")
WORD = re.compile(r"[A-Za-z]{3,}2?")


def cell(text: str) -> str:
    """Return a formula, or a remark about one, as HTML."""
    words = set(WORD.findall(text)) - {*GREEK, *FUNCTIONS, *NAMES}
    return prose(text) if words else formula(text)


def formula(text: str) -> str:
    """Return a plain formula as MathML."""
    return f'<math displaystyle="true">{Parser(text).row()}</math>'


class Parser:
    """Reads tokens from left to right; spaces count, for they part factors and set off ``/``."""

    def __init__(self, text: str) -> None:
        self.tokens = [" " if token.isspace() else token for token in TOKEN.findall(text.strip())]
        self.place = 0

    def next(self, *wanted: str) -> str:
        """Return the next token and go on, if it is one of those wanted, or else nothing."""
        token = self.tokens[self.place] if self.place < len(self.tokens) else ""
        if not token or (wanted and token not in wanted):
            return ""
        self.place += 1
        return token

    def row(self, closing: str = "") -> str:
        """Return all up to a closing bracket as one row."""
        parts: list[str] = []
        factors = 0  # where the product before a `/` between spaces begins
        while self.place < len(self.tokens) and self.tokens[self.place] != closing:
            if self.next(" "):
                if self.tokens[self.place : self.place + 2] == ["/", " "]:
                    self.place += 2
                    parts[factors:] = [f"<mfrac>{row(parts[factors:])}{self.below()}</mfrac>"]
                elif not parts[-1].startswith("<mo>"):
                    parts.append(SPACE)
                continue
            item = self.item()
            if item.startswith("<mo>"):
                parts[-1:] = [] if parts[-1:] == [SPACE] else parts[-1:]
                factors = len(parts) + 1
            parts.append(item)
        if closing and not self.next(closing):
            raise ValueError(f"no {closing} in {''.join(self.tokens)!r}")
        return row(parts)

    def item(self) -> str:
        """Return a factor with its scripts, or a fraction of two without spaces between."""
        begin = self.place
        above = self.scripted()
        if self.tokens[self.place : self.place + 1] != ["/"]:
            return above
        bare = self.tokens[begin] == "(" and self.tokens[self.place - 1] == ")"
        self.place += 1
        return f"<mfrac>{inside(above) if bare else above}{self.below()}</mfrac>"

    def below(self) -> str:
        """Return what stands below a fraction, without the brackets around all of it."""
        begin = self.place
        below = self.scripted()
        whole = self.tokens[begin] == "(" and self.tokens[self.place - 1] == ")"
        return inside(below) if whole else below

    def scripted(self) -> str:
        """Return a factor with its index, primes, hat and power."""
        name, base = self.base()
        below, above = "", ""
        if name == "d" and re.match("[A-Za-z]", "".join(self.tokens[self.place : self.place + 1])):
            return f"<mrow>{base}{self.scripted()}</mrow>"
        if (
            re.fullmatch(r"[A-Za-z]+", name)
            and name not in FUNCTIONS
            and self.place < len(self.tokens)
        ):
            if re.fullmatch(r"\d", self.tokens[self.place]):
                below = f"<mn>{self.next()}</mn>"
            elif self.next("_"):
                letters = self.next()
                while re.fullmatch(r"[a-z0-9]", "".join(self.tokens[self.place : self.place + 1])):
                    letters += self.next()
                below = f"<mtext>{letters}</mtext>" if len(letters) > 1 else mark(letters)
            if self.next("*"):
                above = "<mo>*</mo>"
        while self.next("'"):
            above += "<mo>′</mo>"
        if self.next("^"):
            following = "".join(self.tokens[self.place : self.place + 5])
            if simple := re.match(r"\((\d/\d)\)", following):
                self.place += 5
                above += f"<mn>{simple[1]}</mn>"
            elif re.match(r"[\w(]", following):
                above += self.below()
            else:
                base = f"<mover>{base}<mo>^</mo></mover>"
        while power := self.next(*POWERS):
            above += f"<mn>{POWERS[power]}</mn>"
        if name in FUNCTIONS and self.next("("):
            return f"<mrow>{base}{bracketed('(', self.row(')'))}</mrow>"
        if len(name) == 1 and name.isalpha() and not (below or above) and self.next("("):
            return f"<mrow>{base}{bracketed('(', self.row(')'))}</mrow>"
        return scripts(base, below, above)

    def base(self) -> tuple[str, str]:
        """Return a token, and what it or the bracket that it opens looks like."""
        token = self.next()
        if token == "sqrt" and self.next("("):
            return token, f"<msqrt>{self.row(')')}</msqrt>"
        if token in CLOSING:
            return token, bracketed(token, self.row(CLOSING[token]))
        return token, mark(token)


def mark(token: str) -> str:
    """Return a name, a number or a sign."""
    if token in FUNCTIONS:
        return f'<mi mathvariant="normal">{token}</mi>'
    if token[0].isdigit() or token in "½¾":
        return f"<mn>{token}</mn>"
    if token in GREEK or token.isalpha():
        return f"<mi>{GREEK.get(token, token)}</mi>"
    return f"<mo>{html.escape(SIGNS.get(token, token))}</mo>"


def row(parts: list[str]) -> str:
    """Return parts as one."""
    return "<mrow>" + "".join(parts[:-1] if parts[-1:] == [SPACE] else parts) + "</mrow>"


def bracketed(opening: str, within: str) -> str:
    """Return a row in brackets."""
    return f"<mrow><mo>{opening}</mo>{within}<mo>{CLOSING[opening]}</mo></mrow>"


def inside(group: str) -> str:
    """Return a bracketed row without its brackets."""
    return group.removeprefix("<mrow><mo>(</mo>").removesuffix("<mo>)</mo></mrow>")


def scripts(base: str, below: str, above: str) -> str:
    """Return a base with what stands below and above."""
    above = f"<mrow>{above}</mrow>" if above else ""
    if below and above:
        return f"<msubsup>{base}{below}{above}</msubsup>"
    if below or above:
        kind = "sub" if below else "sup"
        return f"<m{kind}>{base}{below}{above}</m{kind}>"
    return base


def prose(text: str) -> str:
    """Return plain words with symbols set: ``psi1`` as psi with an index, ``z^1.5`` raised."""
    for plain, sign in {"<=": "≤", ">=": "≥", "->": "→"}.items():
        text = text.replace(f" {plain} ", f" {sign} ")
    text = re.sub(r"\b([FP])\^(?![\w(])", "\\1\u0302", text)
    text = re.sub(r"\babs\(([^()|]*)\)", r"&#124;\1&#124;", text)
    text = re.sub(r"(?<=[\w)])\^\(?(-?[\d./]+\d|\d)\)?", r"<sup>\1</sup>", text)
    text = re.sub(r"\b([A-Za-z])_(\w+)", r"<i>\1</i><sub>\2</sub>", text)
    text = re.sub(r"\b([EGKRTkmv])([0-9])(?![\w.*]*[0-9A-Za-z_])", r"<i>\1</i><sub>\2</sub>", text)
    names = "|".join(GREEK)
    return re.sub(
        rf"\b({names})(?:_?(\d|[a-z]))?(?![A-Za-z0-9_*])",
        lambda found: f"<i>{GREEK[found[1]]}</i>" + f"<sub>{found[2] or ''}</sub>" * bool(found[2]),
        text,
    )


def block(lines: list[str]) -> str:
    """Return lines of formulas as a table of HTML."""
    rows = [GAP.split(re.sub(r" +(?=[=<>] )", " ", line.strip())) for line in lines]
    most, text = max(map(len, rows)), ""
    for *first, last in rows:
        cells = "".join(f"<td>{cell(part)}</td>" for part in first)
        text += f'<tr>{cells}<td colspan="{most - len(first)}">{cell(last)}</td></tr>'
    return f'<table class="formulas">{text}</table>'


def typeset(page: str, *, blocks: bool) -> str:
    """Return a page of Markdown with its symbols typeset, and its indented formulas where asked.

    Code, headings and links are left.
    """
    parts = re.split(r"(^```.*?^```$)", page, flags=re.DOTALL | re.MULTILINE)
    parts[::2] = (_outside_code(part, blocks) for part in parts[::2])
    return "".join(parts)


def _outside_code(text: str, blocks: bool) -> str:
    """Typeset what stands outside fences: indented formulas, and symbols in prose."""
    paragraphs = re.split(r"(\n\n+)", text)
    for number in range(len(paragraphs) - 3, -1, -1):  # what is indented stays together
        first, gap, second = paragraphs[number : number + 3]
        if _indented(first) and _indented(second):
            paragraphs[number : number + 3] = [first + gap + second]
    for number, paragraph in enumerate(paragraphs):
        if not _indented(paragraph) and not paragraph.startswith("#"):
            pieces = re.split(
                r"(`[^`]*`|\]\([^)]*\)|!\[[^\]]*\]|</?[a-z][^>]*>|https?:\S+)", paragraph
            )
            pieces[::2] = map(prose, pieces[::2])
            paragraphs[number] = "".join(pieces)
        elif (
            _indented(paragraph) and blocks and not re.search(r"--|__|\|<", paragraph)
        ):  # no diagram
            paragraphs[number] = block(paragraph.split("\n"))
    return "".join(paragraphs)


def _indented(paragraph: str) -> bool:
    """Return whether all lines of a paragraph are indented, or empty."""
    lines = [line for line in paragraph.splitlines() if line]
    return bool(lines) and all(line.startswith("    ") for line in lines)
