r"""LaTeX of the textbooks as plain arithmetic text, which the whitelist parser then reads.

sympy's own LaTeX parsers are not used: the one on lark refuses ``\ddot{q}_1`` and ``l_1^2``, gives
two meanings to ``\cos q_2 \sin q_1``, and works out ``9^{9^{9^{9}}}`` until it is stopped.
"""

from __future__ import annotations

import re

from kinlab.errors import ExpressionError

_LENGTH = 20_000
_NESTING = 40

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|[A-Za-z]|[-+*/^_{}()\[\]=,&|.~]|\s+")
_BLANKS = r"\, \; \: \! \quad \qquad ~ \left \right \big \Big \bigl \bigr \Bigl \Bigr \displaystyle"
_SPACE = {"\\ ", *_BLANKS.split()}
_TIMES = {"*", r"\cdot", r"\times"}
_FRACTIONS = {r"\frac", r"\dfrac", r"\tfrac"}
_FUNCTIONS = {r"\sin": "sin", r"\cos": "cos", r"\tan": "tan"}
_LETTERS = "alpha beta gamma delta theta lambda mu phi psi omega rho tau"
_GREEK = {rf"\{name}": name for name in _LETTERS.split()}
_DOTS = {r"\dot": "d", r"\ddot": "dd"}
_PAIRS = {"(": ")", "[": "]", "{": "}"}


def expression(text: str, place: str = "expression") -> str:
    """Plain text of a LaTeX formula: ``m_1 l_1^2 \\ddot{q}_1`` gives ``m1*l1**(2)*qdd1``.

    Args:
        text: sums, products (also by standing side by side), ``/``, powers, ``\\frac``, ``\\sqrt``,
            ``\\sin \\cos \\tan`` with parentheses or one name behind, names with subscripts,
            ``\\dot`` and ``\\ddot`` over q or theta.
        place: what to put in front of a message.

    Raises:
        ExpressionError: too long, nested too deep, or a command that is none of these.
    """
    if len(text) > _LENGTH:
        raise ExpressionError(f"{place}: {len(text)} characters; at most {_LENGTH}")
    tokens: list[str] = []
    depth = at = 0
    while at < len(text):
        found = _TOKEN.match(text, at)
        if found is None:
            raise ExpressionError(f"{place}: {text[at]!r} has no meaning in LaTeX of a formula")
        token, at = found.group(), found.end()
        if token in _SPACE or token.isspace():
            continue
        depth += (token in _PAIRS) - (token in _PAIRS.values())
        if depth > _NESTING:
            raise ExpressionError(f"{place}: nested deeper than {_NESTING}")
        tokens.append(token)
    reader = _Reader(tokens, place)
    result = reader.sum()
    if reader.next:
        raise reader.unread()
    return result


class _Reader:
    """Walks the tokens from left to right, one method for each level of binding."""

    def __init__(self, tokens: list[str], place: str) -> None:
        self.tokens = tokens
        self.place = place
        self.at = 0
        self.depth = 0

    @property
    def next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.next
        if not token or (wanted and token != wanted):
            raise self.unread(wanted)
        self.at += 1
        return token

    def unread(self, wanted: str = "") -> ExpressionError:
        found = repr(self.next) if self.next else "the end"
        allowed = r"names, numbers, + - / ^ _, \frac, \sqrt, \sin, \cos, \tan, \dot, \ddot, \cdot"
        remedy = f"{wanted!r} was expected" if wanted else f"write {allowed}"
        near = "".join(self.tokens[max(0, self.at - 6) : self.at])[-40:]
        behind = f" after {near}" if near else ""
        return ExpressionError(f"{self.place}: LaTeX: {found}{behind} cannot be read; {remedy}")

    def sum(self) -> str:
        text = self.take() if self.next in ("+", "-") else ""
        text += self.product()
        while self.next in ("+", "-"):
            text += f" {self.take()} {self.product()}"
        return text

    def product(self) -> str:
        text = self.power()
        while self.next and self.next not in ("+", "-", *_PAIRS.values()):
            if self.next in _TIMES:
                self.take()
                text += f"*{self.power()}"
            elif self.next == "/":
                self.take()
                text += f"/{self.power()}"
            else:
                text += f"*{self.power()}"
        return text

    def power(self) -> str:
        text = self.atom()
        return f"{text}**({self.argument()})" if self.raised() else text

    def raised(self) -> bool:
        if self.next == "^":
            self.take()
            return True
        return False

    def argument(self) -> str:
        """What stands behind ^ or in a fraction: a group, or one sign, as LaTeX reads it."""
        if self.next == "{":
            return self.group()
        if self.next[:1].isdigit() and len(self.next) > 1:  # \frac12 is one half
            whole = self.take()
            self.at -= 1
            self.tokens[self.at : self.at + 1] = list(whole)
            return self.take()
        return self.atom()

    def group(self) -> str:
        closing = _PAIRS[self.take()]
        text = self.sum()
        self.take(closing)
        return text

    def atom(self) -> str:
        self.depth += 1  # \sqrt\sqrt\sqrt nests without braces
        if self.depth > _NESTING:
            raise ExpressionError(f"{self.place}: nested deeper than {_NESTING}")
        text = self._atom()
        self.depth -= 1
        return text

    def _atom(self) -> str:
        token = self.next
        if token in _PAIRS:
            return f"({self.group()})"
        if token in _FRACTIONS:
            self.take()
            above = self.argument()
            return f"(({above})/({self.argument()}))"
        if token == r"\sqrt":
            self.take()
            return f"sqrt({self.argument()})"
        if token in _FUNCTIONS:
            return self.function()
        if token[:1].isdigit():
            return self.take()
        if token == r"\pi":
            return self.take()[1:]
        return self.name()

    def function(self) -> str:
        name = _FUNCTIONS[self.take()]
        exponent = self.argument() if self.raised() else ""
        if self.next in _PAIRS:
            inside = self.group()
        else:
            number = f"{self.take()}*" if self.next[:1].isdigit() else ""
            inside = number + self.name()
        text = f"{name}({inside})"
        return f"{text}**({exponent})" if exponent else text

    def name(self) -> str:
        dots = ""
        if self.next in _DOTS:
            dots = _DOTS[self.take()]
            braced = self.next == "{"
            if braced:
                self.take()
            head = self.letter()
            below = self.subscript()
            if braced:
                self.take("}")
            below = below or self.subscript()
        else:
            head, below = self.letter(), self.subscript()
        if dots and head not in ("q", "theta"):
            raise ExpressionError(f"{self.place}: LaTeX: a dot over {head}; only over q and theta")
        head = "q" if dots else head
        if self.next == "^" and not below:  # l^2_1 is l_1^2
            mark = self.at
            self.take()
            exponent = self.argument()
            below = self.subscript()
            if below:
                return f"{head}{dots}{below}**({exponent})"
            self.at = mark
        return f"{head}{dots}{below}"

    def letter(self) -> str:
        token = self.next
        if token in _GREEK or (len(token) == 1 and token.isalpha()):
            return _GREEK.get(self.take(), token)
        raise self.unread()

    def subscript(self) -> str:
        if self.next != "_":
            return ""
        self.take()
        if self.next != "{":
            token = self.take()
            if len(token) > 1 and token.isdigit():  # q_12 is q_1 2
                self.at -= 1
                self.tokens[self.at : self.at + 1] = list(token)
                token = self.take()
            return self.plain(token)
        self.take()
        text = ""
        while self.next and self.next != "}":
            text += self.plain(self.take())
        self.take("}")
        return text

    def plain(self, token: str) -> str:
        if token.isalnum():
            return token
        raise ExpressionError(f"{self.place}: LaTeX: {token!r} in a subscript; letters and digits")
