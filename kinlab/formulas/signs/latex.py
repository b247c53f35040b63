r"""LaTeX of the textbooks as plain arithmetic text, which the whitelist parser then reads.

sympy's own LaTeX parsers are not used: the one on lark refuses ``\ddot{q}_1`` and ``l_1^2``, gives
two meanings to ``\cos q_2 \sin q_1``, and works out ``9^{9^{9^{9}}}`` until it is stopped.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from kinlab.errors import ExpressionError
from kinlab.formulas.signs.letters import GREEK
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_, _

_LENGTH = 20_000
_NESTING = 40

_WORD = (
    r"\\(?:mathrm|mathcal|mathit|mathsf|mathbf|mathfrak|boldsymbol|bm|text|textrm|textit|operatorname)"
    r"(?![A-Za-z])\*?\s*\{[A-Za-z0-9_ ]*\}"
)
_OWN = (
    r"(?<![A-Za-z\\])(?:[xyz]t(?![A-Za-z])|[FM][xyz](?![A-Za-z\d])"
    r"|(?:Ia|I[xyz]{2}|c[xyz]|lc|d{0,2}th|d{1,2}q|qd{1,2})(?=\d))"
)
"""Names of an arm's own numbers, typed as they are: the tool's ``xt``, ``Fx``, ``Izz4``."""
_TOKEN = re.compile(
    rf"{_WORD}|{_OWN}|\\[A-Za-z]+|\\.|\d+(?:(?:\.|\{{,\}})\d+)?|(?:sin|cos|tan|sqrt|atan2)(?![A-Za-z])"
    r"|(?<![A-Za-z\\])(?:theta|alpha|omega|varphi|phi|tau)(?![A-Za-z])|[A-Za-z]|[-+*/^_{}()\[\]=,&|.~]|\s+",
    re.ASCII,
)
_BLANKS = (
    r"\, \; \: \! \quad \qquad ~ \left \right \big \Big \bigg \Bigg \bigl \bigr \Bigl \Bigr "
    r"\biggl \biggr \displaystyle \textstyle \mathbf \boldsymbol \bm"
)
_SPACE = {"\\ ", "\\\\", "&", *_BLANKS.split()}
_CALLED = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_TIMES = {"*", r"\cdot", r"\times"}
_FRACTIONS = {r"\frac", r"\dfrac", r"\tfrac"}
_NAMED = "sin cos tan atan2 arcsin arccos arctan ln exp"
_FUNCTIONS = {rf"\{name}": name for name in _NAMED.split()}
_RAISED = {"sin", "cos", "tan"}
_EXTREMES = (r"\max", r"\min")
_ANGLE = re.compile(r"(?:q|theta)[1-9]\d?")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*")
_PLAIN = re.compile(r"\d+(?:\.\d+)?|pi")
LAMBDA = "lam"
"""What the letter is called in plain text, where its own name is a word of the language."""
_GREEK = {rf"\{name}": name for name in GREEK} | {r"\lambda": LAMBDA}
_GREEK |= {rf"\var{name}": name for name in ("theta", "phi", "rho", "epsilon", "kappa")}
_THETAS = ([r"\theta"], [r"\vartheta"])
_JOINTS = "123456789"
"""The joints whose angles a sum of angles has, ascending and without a gap."""
_PARTS = (r"\omega", r"\phi", r"\varphi", r"\theta")
r"""Of a Jacobian the angular part, of a pose its angle: ``J_\omega``, ``c_\phi``."""
_OF_TOOL = ("x", "y", "z", "phi")
"""Coordinates of the tool, whose rates a five-bar's formulas have, and what J makes."""
_DOTS = {r"\dot": "d", r"\ddot": "dd"}
_BRACES = {r"\{": "(", r"\}": ")"}
_WITHOUT = N_("a function without parentheses before {text}")
_PRODUCT = N_("write {product} for a product")
_PAIRS = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True)
class Leaf:
    """A name, number, function or sign: what it is in plain text, and where it was typed."""

    plain: str
    start: int
    end: int


def expression(
    text: str,
    place: str = "expression",
    leaves: list[Leaf] | None = None,
    known: frozenset[str] = frozenset(),
) -> str:
    """Plain text of a LaTeX formula: ``m_1 l_1^2 \\ddot{q}_1`` gives ``m1*l1**2*qdd1``.

    Args:
        text: sums, products (also by standing side by side), ``/``, powers, ``\\frac``, ``\\sqrt``,
            ``\\sin \\cos \\tan`` with parentheses or one name behind, names with subscripts,
            ``\\mathrm`` and its like, ``\\dot`` and ``\\ddot`` over q or theta.
        place: what to put in front of a message.
        leaves: gets every leaf, in the order of the text.
        known: names that the writer explains.

    Raises:
        ExpressionError: too long, nested too deep, a command that is none of these, or what two
            people would read differently (``\\cos^{-1}``, ``c_12``, ``a/b c``).
    """
    if len(text) > _LENGTH:
        raise refused(
            place, N_("{count} characters; at most {length}"), count=len(text), length=_LENGTH
        )
    tokens: list[str] = []
    tight: list[bool] = []
    spans: list[tuple[int, int]] = []
    depth = at = 0
    glued = False
    while at < len(text):
        found = _TOKEN.match(text, at)
        if found is None:
            raise refused(place, N_("{text!r} has no meaning in LaTeX of a formula"), text=text[at])
        token, at = found.group().replace("{,}", "."), found.end()
        token = _BRACES.get(token, token)
        if token in _SPACE or token.isspace():
            glued = glued and token in (r"\left", r"\right")
            continue
        depth += (token in _PAIRS) - (token in _PAIRS.values())
        if depth > _NESTING:
            raise refused(place, N_("nested deeper than {nesting}"), nesting=_NESTING)
        tokens.append(token)
        tight.append(glued)
        spans.append(found.span())
        glued = True
    reader = _Reader(tokens, tight, spans, place, known)
    result = reader.sum()
    if reader.next:
        raise reader.unread()
    if leaves is not None:
        leaves += reader.leaves
    return result


def _raised(exponent: str) -> str:
    """An exponent in plain text, whole numbers without brackets."""
    return f"**{exponent}" if exponent.isdigit() else f"**({exponent})"


class _Reader:
    """Walks the tokens from left to right, one method for each level of binding."""

    def __init__(
        self,
        tokens: list[str],
        tight: list[bool],
        spans: list[tuple[int, int]],
        place: str,
        known: frozenset[str],
    ) -> None:
        self.tokens = tokens
        self.tight = tight
        self.spans = spans
        self.leaves: list[Leaf] = []
        self.place = place
        self.known = known
        self.at = 0
        self.depth = 0
        self.bare = -1
        """Where the last function without parentheses ended."""

    @property
    def next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    @property
    def glued(self) -> bool:
        """Whether the next token stands without a gap behind the one before."""
        return self.at < len(self.tight) and self.tight[self.at]

    def take(self, wanted: str = "") -> str:
        token = self.next
        if not token or (wanted and token != wanted):
            raise self.unread(wanted)
        self.at += 1
        return token

    def leaf(self, plain: str, first: int) -> str:
        """Notes a leaf that the tokens from ``first`` to here were."""
        self.leaves.append(Leaf(plain, self.spans[first][0], self.spans[self.at - 1][1]))
        return plain

    def single(self) -> str:
        return self.leaf(self.take(), self.at - 1)

    def unread(self, wanted: str = "") -> ExpressionError:
        found = repr(self.next) if self.next else _("the end")
        signs = r"+ - / ^ _, \frac, \sqrt, \sin, \cos, \tan, \dot, \ddot, \cdot"
        allowed = _("names, numbers, {signs}").format(signs=signs)
        remedy = _("{sign!r} was expected") if wanted else _("write {allowed}")
        remedy = remedy.format(sign=wanted, allowed=allowed)
        near = "".join(self.tokens[max(0, self.at - 6) : self.at])[-40:]
        behind = _(" after {text}").format(text=near) if near else ""
        return refused(
            self.place,
            N_("LaTeX: {found}{behind} cannot be read; {remedy}"),
            found=found,
            behind=behind,
            remedy=remedy,
        )

    def unsure(self, what: str, remedy: str) -> ExpressionError:
        """Of what two people would read differently."""
        return refused(
            self.place,
            N_("LaTeX: {what} can be read in two ways; {remedy}"),
            what=what,
            remedy=remedy,
        )

    def split(self) -> None:
        """Makes one token of each digit of the next: LaTeX takes one sign without braces."""
        whole = list(self.next)
        self.tokens[self.at : self.at + 1] = whole
        self.tight[self.at : self.at + 1] = [self.tight[self.at]] + [True] * (len(whole) - 1)
        start = self.spans[self.at][0]
        self.spans[self.at : self.at + 1] = [(start + k, start + k + 1) for k in range(len(whole))]

    def sum(self) -> str:
        text = self.single() if self.next in ("+", "-") else ""
        text += self.product()
        while self.next in ("+", "-"):
            bare = self.bare == self.at
            sign, product = self.single(), self.product()
            if bare and _ANGLE.fullmatch(product):
                raise self.unsure(
                    _(_WITHOUT).format(text=f"{sign} {product}"),
                    _("put them around its angle: {call}").format(call=r"\cos(q_1 + q_2)"),
                )
            text += f" {sign} {product}"
        return text

    def product(self) -> str:
        last = text = self.power()
        while self.next and self.next not in ("+", "-", ",", *_PAIRS.values()):
            if self.next in _TIMES:
                self.take()
                last = self.power()
                text += f"*{last}"
            elif self.next == "/":
                text += self.below(last)
                last = "/"
            else:
                if _PLAIN.fullmatch(last) and self.next[:1].isdigit():
                    raise self.unsure(f"{last} {self.next}", _(r"write \cdot between two numbers"))
                bare = self.bare == self.at
                last = self.power()
                if bare and _ANGLE.fullmatch(last):
                    raise self.unsure(_(_WITHOUT).format(text=last), _("put them around its angle"))
                self.refuse_call(text, last)
                text += f"*{last}"
        return text

    def below(self, above: str) -> str:
        """What stands behind a slash; refuses ``a/b c``, where c may stand above or below."""
        if self.bare == self.at:
            raise self.unsure(
                _("a slash behind {text}").format(text=r"\cos q_1"),
                _("write {one} or {other}").format(one=r"\frac{\cos q_1}{2}", other=r"\cos(q_1/2)"),
            )
        self.take("/")
        under = self.power()
        ends = ("", "+", "-", "/", ",", *_TIMES, *_PAIRS.values())
        number = _PLAIN.fullmatch(under)
        sure = number and (_PLAIN.fullmatch(above) or not self.glued or self.next in _FUNCTIONS)
        if self.next not in ends and not sure:
            raise self.unsure(
                _("{factor} behind .../{under}").format(factor=self.next, under=under),
                _("write {one} or {other}").format(
                    one=rf"\frac{{a}}{{{under}}}", other=f"a/({under} b)"
                ),
            )
        return f"/{under}"

    def refuse_call(self, name: str, last: str) -> None:
        """``g(q_1)`` may be g times q_1, or a function of q_1."""
        inside = last[1:-1]
        name = name.rpartition("*")[2]
        if last[:1] == "(" and _ANGLE.fullmatch(inside) and _NAME.fullmatch(name):
            raise self.unsure(
                f"{name}({inside})", _(_PRODUCT).format(product=rf"{name} \cdot {inside}")
            )

    def power(self) -> str:
        text = self.atom()
        if not self.raised():
            return text
        if _PLAIN.fullmatch(text) and self.degrees():
            return f"({text}*pi/180)"
        return text + _raised(self.argument())

    def degrees(self) -> bool:
        r"""Whether a degree sign is next, as ``^\circ`` or in braces; takes it."""
        for signs in ([r"\circ"], ["{", r"\circ", "}"]):
            if self.tokens[self.at : self.at + len(signs)] == signs:
                for sign in signs:
                    self.take(sign)
                return True
        return False

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
            self.split()
            return self.single()
        return self.atom()

    def letter_alone(self) -> str:
        r"""A letter with a number behind, of which LaTeX takes the letter: ``\frac l2`` is l/2."""
        behind = self.tokens[self.at + 1 : self.at + 2]
        if len(self.next) == 1 and self.next.isalpha() and behind and behind[0].isdigit():
            return self.single()
        return ""

    def group(self) -> str:
        closing = _PAIRS[self.take()]
        text = self.sum()
        self.take(closing)
        return text

    def atom(self) -> str:
        self.depth += 1  # \sqrt\sqrt\sqrt nests without braces
        if self.depth > _NESTING:
            raise refused(self.place, N_("nested deeper than {nesting}"), nesting=_NESTING)
        text = self._atom()
        self.depth -= 1
        return text

    def _atom(self) -> str:
        token = self.next
        if token in _PAIRS:
            opened = self.at
            inside = self.group()
            if token == "{" and self.next == "_" and _NAME.fullmatch(inside):  # {\dot q}_1
                self.leaves.pop()
                return self.leaf(f"{inside}{self.subscript()}", opened)
            return f"({inside})"
        if token in _FRACTIONS:
            self.take()
            above = self.letter_alone() or self.argument()
            return f"(({above})/({self.argument()}))"
        if token in (r"\sqrt", "sqrt"):
            self.take()
            self.leaf("sqrt", self.at - 1)
            if self.next == "[":
                raise refused(self.place, N_("LaTeX: only square roots can be read"))
            return f"sqrt({self.argument()})"
        if self.called():
            return self.function()
        if token[:1].isdigit():
            return self.single()
        if token == r"\pi" and self.tokens[self.at + 1 : self.at + 2] != ["_"]:
            return self.leaf(self.take()[1:], self.at - 1)
        return self.wave() or self.name()

    def wave(self) -> str:
        r"""``c\theta_{12}`` as c12, or nothing where c is a name of the writer's."""
        letter = _word(self.next) or self.next
        behind = self.tokens[self.at + 1 : self.at + 2]
        if letter not in ("c", "s") or letter in self.known or behind not in _THETAS:
            return ""
        first, noted = self.at, len(self.leaves)
        self.take()
        angle = self.name()
        joints = angle.removeprefix("theta")
        del self.leaves[noted:]
        if not joints or joints not in _JOINTS or angle in self.known:
            self.at = first
            return ""
        if self.next == "^":
            name = "cos" if letter == "c" else "sin"
            raise self.unsure(
                _("a power behind {text}").format(text=rf"{letter}\theta_{joints}"),
                _(r"write \{name}^2(...), or parentheses around the angle").format(name=name),
            )
        return self.leaf(f"{letter}{joints}", first)

    def called(self) -> str:
        """The function that comes next, if one does."""
        word = _word(self.next) or self.next.lstrip("\\")
        word = _CALLED.get(word, word)
        return word if rf"\{word}" in _FUNCTIONS else ""

    def function(self) -> str:
        name = self.called()
        self.take()
        self.leaf(name, self.at - 1)
        exponent = self.argument() if self.raised() else ""
        if exponent and (name not in _RAISED or exponent.lstrip("(").startswith("-")):
            raise self.unsure(
                rf"\{name}^{{{exponent}}}",
                _(r"write \arc{name} for the angle, or 1/\{name}").format(name=name),
            )
        inside = self.arguments() if self.next in _PAIRS else self.bare_argument(name)
        text = f"{name}({inside})"
        return text + _raised(exponent) if exponent else text

    def arguments(self) -> str:
        closing = _PAIRS[self.take()]
        text = self.sum()
        while self.next == ",":
            self.take()
            text += f", {self.sum()}"
        self.take(closing)
        return text

    def bare_argument(self, name: str) -> str:
        doubtful = False
        if self.next in _FRACTIONS:
            inside = self.atom()
        else:
            number = f"{self.single()}*" if self.next[:1].isdigit() else ""
            inside = number + self.name()
            doubtful = "**" in inside
        if doubtful or self.next == "^":
            raise self.unsure(
                _("a power behind {text}").format(text=rf"\{name} {inside.partition('*')[0]}"),
                _(r"write \{name}^2(...), or parentheses around the angle").format(name=name),
            )
        self.bare = self.at
        return inside

    def name(self) -> str:
        dots, power, first = "", "", self.at
        if self.next in _DOTS:
            dots = _DOTS[self.take()]
            braced = self.next == "{"
            if braced:
                self.take()
            head = self.letter()
            below = self.subscript()
            if braced:  # \\dot{q_1^2} is the rate squared
                power = _raised(self.argument()) if self.raised() else ""
                self.take("}")
            below = below or self.subscript()
        else:
            head, below = self.letter(), self.subscript()
        if dots and head not in ("q", "theta", "Theta", "d", *_OF_TOOL):
            raise refused(
                self.place,
                N_("LaTeX: a dot over {head}; only over q, theta and a slide's d"),
                head=head,
            )
        if self.next == "^" and not below and not power:  # l^2_1 is l_1^2
            mark, noted = self.at, len(self.leaves)
            self.take()
            exponent = self.argument()
            below = self.subscript()
            if below:
                behind, self.leaves[noted:] = self.leaves[noted:], []
                base = self.leaf(f"{head}{dots}{below}", first)
                self.leaves += behind
                return f"{base}{_raised(exponent)}"
            self.at = mark
            del self.leaves[noted:]
        plain = f"{head}{dots}{below}"
        if plain not in self.known and f"{head}_{below}" in self.known:  # I_S of plain text
            plain = f"{head}_{below}"
        return self.leaf(plain, first) + power

    def letter(self) -> str:
        token = self.next
        word = _word(token)
        if word and not token.startswith(r"\operatorname"):
            self.take()
            return word
        if token == r"\ell":
            self.take()
            return "l"
        if token in _GREEK or (token.isalpha() and not self.called() and token != "sqrt"):
            self.take()
            return _GREEK.get(token, _GREEK.get(f"\\{token}", token))
        raise self.unread()

    def subscript(self) -> str:
        if self.next.isdigit() and self.glued:  # m1 for m_1
            return self.take()
        if self.next != "_":
            return ""
        self.take()
        if self.next != "{":
            token = self.take()
            if len(token) > 1 and token.isdigit():
                raise self.unsure(
                    f"_{token}",
                    _(r"write {index} for one index, {product} for a product").format(
                        index=f"_{{{token}}}", product=rf"_{token[0]} \cdot"
                    ),
                )
            if self.next.isdigit() and self.glued:
                raise self.unsure(
                    f"_{token}{self.next}",
                    _("write {index} for one index").format(index=f"_{{{token}{self.next}}}"),
                )
            return self.plain(token)
        first = self.at
        self.take()
        text = ""
        while self.next and self.next != "}":
            if self.next == "," and text[-1:].isalpha():  # T_{max,1}; of two digits it is unclear
                self.take()
                continue
            text += self.take() if self.next == "+" else self.below_below()
        self.take("}")
        if "+" in text:  # c_{1+2}
            joints = text.split("+")
            if not all(j.isdigit() and len(j) == 1 for j in joints) or joints != sorted(joints):
                self.at = first
                raise self.unread()
        return text.replace("+", "")

    def below_below(self) -> str:
        """One sign in a subscript, or a subscript of it: ``l_{c_2}`` is ``l_{c2}``."""
        if self.next != "_":
            return self.plain(self.take())
        self.take()
        if self.next != "{":
            return self.plain(self.take())
        self.take()
        text = ""
        while self.next and self.next != "}":
            text += self.plain(self.take())
        self.take("}")
        return text

    def plain(self, token: str) -> str:
        if token in _EXTREMES or token in _PARTS:
            token = token[1:].removeprefix("var")
        token = _word(token) or token
        if token.isalnum():
            return token
        raise refused(
            self.place, N_("LaTeX: {token!r} in a subscript; letters and digits"), token=token
        )


def _word(token: str) -> str:
    r"""What stands in ``\mathrm{...}`` and its like."""
    if token[:1] != "\\" or "{" not in token:
        return ""
    return re.sub(r"[\s_{}]", "", token.partition("{")[2])
