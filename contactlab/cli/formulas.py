r"""Pages of the guide for a terminal: formulas, which they hold as LaTeX, in letters; lines filled.

``$\psi_1 = \frac{\kappa v_x}{\mu v_1}$`` is read as ``ψ₁ = (κ v_x)/(μ v₁)``. The site hands the
same LaTeX to latex2mathml.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata

CODE = re.compile(r"(^```.*?^```$|`[^`]*`)", re.DOTALL | re.MULTILINE)
FORMULA = re.compile(r"^\$\$\n(.*?)\n\$\$$|\$([^$]+)\$", re.DOTALL | re.MULTILINE)
#: A link to a page of the guide, whose name stands in its words.
LINK = re.compile(r"\[(`[a-z-]+`)\]\([a-z-]+\.md\)")
TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\s+|.", re.DOTALL)
WIDE = "\N{EN QUAD}"  # of two columns
UNBROKEN = "\N{NO-BREAK SPACE}"
SIGNS = {
    "\\le": "<=", "\\ge": ">=", "\\to": "->", "\\pm": "±", "\\cdot": "·",
    "\\times": "\N{MULTIPLICATION SIGN}",
    "\\int": "∫", "\\sum": "sum", "\\dots": "...", "\\lvert": "|", "\\rvert": "|", "\\,": " ",
    "\\quad": WIDE, "\\qquad": 2 * WIDE, "\\left": "", "\\right": "",
}  # fmt: skip
LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
FRACTIONS = {"1/2": "½", "3/4": "¾"}
INDENT = "    "
#: Begins of lines that are not filled: tables, headings, pictures, code.
KEPT = ("|", "#", "![", INDENT, "```")


def readable(page: str, width: int) -> str:
    """Return a page of Markdown with its formulas in letters, and its prose in lines of a width."""
    parts = CODE.split(page)
    parts[::2] = (FORMULA.sub(_show, part) for part in parts[::2])
    parts[1::2] = (part if part[:3] == "```" else _unbroken(part) for part in parts[1::2])
    told = LINK.sub(r"\1", "".join(parts))
    parts = re.split(r"(^```.*?^```$)", told, flags=re.DOTALL | re.MULTILINE)
    for at in range(0, len(parts), 2):
        parts[at] = "\n\n".join(fill_lines(each, width) for each in parts[at].split("\n\n"))
    return "".join(parts).replace(UNBROKEN, " ")


def _show(found: re.Match[str]) -> str:
    """Return the text of a matched formula."""
    return _unbroken(inline(found[2])) if found[2] else block(found[1])


def _unbroken(text: str) -> str:
    """Return a text with spaces at which no line ends."""
    return re.sub(r"\s+", UNBROKEN, text)


def fill_lines(paragraph: str, width: int) -> str:
    """Return a paragraph, or the items of a list, in lines of a width."""
    texts = []
    for item in re.split(r"\n(?=- |\d+\. |\||!\[)", paragraph):
        mark = re.match(r" *(?:- |\d+\. )?", item)
        if mark and item.strip() and not item.lstrip("\n").startswith(KEPT):
            breaks = len(item) - len(item.lstrip("\n"))
            hanging = " " * len(mark[0])
            item = "\n" * breaks + textwrap.fill(
                " ".join(re.split(r"[ \n]+", item.strip(" \n"))), width,
                subsequent_indent=hanging, break_long_words=False, break_on_hyphens=False,
            )  # fmt: skip
        texts.append(item)
    return "\n".join(texts)


def inline(latex: str) -> str:
    """Return a formula on one line."""
    text = re.sub("[ \n]+", " ", Reader(latex).read()).strip()
    return re.sub(r"\| ?(.+?) ?\|", r"|\1|", text).replace(WIDE, "  ")


def block(latex: str) -> str:
    """Return a displayed formula: its rows below each other, their columns in line."""
    lines = re.sub(r"\\(begin|end)\{align\*\}", "", latex).strip().split("\\\\\n")
    rows = [[inline(cell) for cell in line.split("&")] for line in lines]
    columns = max(map(len, rows))
    widths = [max(_width(row[at]) for row in rows if at < len(row)) for at in range(columns)]
    gaps = [" " if at % 2 == 0 else INDENT for at in range(columns)]
    texts = []
    for row in rows:
        cells = zip(row, widths, gaps, strict=False)
        padded = (cell + (width - _width(cell)) * " " + gap for cell, width, gap in cells if width)
        texts.append("".join(padded))
    return "\n".join(INDENT + text.rstrip() for text in texts)


def _width(text: str) -> int:
    """Return the columns that a text takes: a hat takes none."""
    return sum(not unicodedata.combining(character) for character in text)


class Reader:
    """Reads LaTeX from left to right."""

    def __init__(self, latex: str) -> None:
        self.tokens = TOKEN.findall(latex)

    def read(self, end: str = "") -> str:
        """Return all up to a token, which is consumed."""
        text = ""
        while self.tokens and (token := self.tokens.pop(0)) != end:
            text += self.item(token)
        return text

    def group(self) -> str:
        """Return the content of braces, or the next token."""
        while self.tokens[0].isspace():
            self.tokens.pop(0)
        token = self.tokens.pop(0)
        return self.read("}") if token == "{" else self.item(token)

    def item(self, token: str) -> str:
        """Return a token with the groups that it takes."""
        if token in ("\\frac", "\\tfrac"):
            return self.fraction()
        if token == "\\sqrt":
            return f"sqrt({self.group()})"
        if token == "\\hat":
            return self.group() + "\N{COMBINING CIRCUMFLEX ACCENT}"
        if token in ("\\text", "{"):
            return self.read("}").removeprefix("{")
        if token in "_^":
            return script(token, self.group())
        if token.isspace():
            return " "
        if token in SIGNS or token[0] != "\\":
            return SIGNS.get(token, token)
        return greek(token[1:])

    def fraction(self) -> str:
        """Return a fraction on one line, in brackets if a factor follows."""
        above, below = self.group(), self.group()
        text = f"{bracket(above)}/{bracket(below)}"
        if text in FRACTIONS:
            return FRACTIONS[text]
        following = "".join(self.tokens).lstrip()
        factor = re.match(r"[\w(\[]|\\(?!right|q?quad|\\)", following)
        return f"({text})" if factor else text


def script(sign: str, text: str) -> str:
    """Return a lowered or raised text: whole numbers as such, other text behind the sign."""
    if re.fullmatch(r"\d+", text) or (sign == "^" and re.fullmatch(r"-\d+", text)):
        return text.translate(LOWERED if sign == "_" else RAISED)
    if sign == "^" and set(text) == {"*"}:
        return text
    simple = sign == "_" or re.fullmatch(r"-?[\d.]+|\w", text)
    return sign + (text if simple else f"({text})")


def bracket(text: str) -> str:
    """Return a part of a fraction, in brackets unless it is one factor."""
    return text if re.fullmatch(r"[\w.*'\u0302]+|\w*\([^()]*\)", text) else f"({text})"


def greek(name: str) -> str:
    """Return a Greek letter, or the name of a function as it is."""
    case = "CAPITAL" if name[0].isupper() else "SMALL"
    letter = name.replace("ambda", "amda")  # so does Unicode spell it
    try:
        return unicodedata.lookup(f"GREEK {case} LETTER {letter}")
    except KeyError:
        return name
