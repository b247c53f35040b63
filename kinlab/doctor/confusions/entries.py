"""What people write otherwise in the entries of a link's matrix that is written out."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator

from kinlab.doctor.confusions.books import MODIFIED, STANDARD
from kinlab.doctor.confusions.walk import Step, again
from kinlab.doctor.confusions.words import minus, spelt
from kinlab.host.language import N_, _

Make = Callable[..., Step]


_AS_IN = {
    "standard": N_("{does} (as in the standard convention, {new} for {old})"),
    "modified": N_("{does} (as in the modified convention, {new} for {old})"),
}


def entry_steps(node: ast.List, step: Make) -> Iterator[Step]:
    """The entries of a matrix that is written out."""
    rows = [row.elts for row in node.elts if isinstance(row, ast.List)][:3]
    for r, row in enumerate(rows):
        for c, entry in enumerate(row):
            empty = isinstance(entry, ast.Constant)
            text = spelt(entry)
            theirs = _other_convention(node, r, c)
            if theirs is not None:
                kind, does = _against(entry, theirs[1])
                does = _(_AS_IN[theirs[0]]).format(does=does, new=spelt(theirs[1]), old=text)
                yield step(kind, does, 1.1, (entry, theirs[1]))
            if not empty:
                does = _(
                    "has the opposite sign in entry ({row}, {column}): {new} for {old}"
                ).format(row=r + 1, column=c + 1, new=spelt(minus(entry)), old=text)
                yield step("sign", does, 1.02, (entry, minus(entry)))
                does = _("leaves {term} out (0 for it)").format(term=text)
                yield step("missing term", does, 1.08, (entry, ast.Constant(0)))
                for name in ("ct", "st", "ca", "sa"):
                    new = ast.BinOp(again(entry), ast.Mult(), ast.Name(name))
                    does = _("has the extra factor {factor} in {new} for {old}").format(
                        factor=spelt(new.right), new=spelt(new), old=text
                    )
                    yield step("extra factor", does, 1.2, (entry, new))
            if c + 1 < len(row) and not (empty and isinstance(row[c + 1], ast.Constant)):
                does = _("has {one} and {other} exchanged in row {row} of the matrix").format(
                    one=text, other=spelt(row[c + 1]), row=r + 1
                )
                swapped = ((entry, again(row[c + 1])), (row[c + 1], again(entry)))
                yield step("exchanged", does, 1.15, *swapped)
        negative = [(x, minus(x)) for x in row if minus(x) is not x and spelt(x)[0] == "-"]
        if len(negative) > 1:
            does = _("leaves the minus sign out in row {row} of the matrix").format(row=r + 1)
            yield step("sign", does, 1.1, *negative)


def _other_convention(node: ast.List, r: int, c: int) -> tuple[str, ast.expr] | None:
    """The entry that stands there in the other convention's matrix, where it is another one."""
    for convention, text in (("standard", STANDARD), ("modified", MODIFIED)):
        other = ast.parse(text.partition("=")[2].strip(), mode="eval").body
        if ast.dump(other) != ast.dump(node):
            mine, theirs = (x.elts[r].elts[c] for x in (node, other))  # type: ignore[attr-defined]
            return None if ast.dump(mine) == ast.dump(theirs) else (convention, theirs)
    return None


def _against(mine: ast.expr, theirs: ast.expr) -> tuple[str, str]:
    """A kind and words for another entry: a factor more, a factor less, or something else."""
    one, two = (set(spelt(x).lstrip("-").split("*")) for x in (mine, theirs))
    if two < one:
        return "missing factor", _("leaves the factor {factor} out").format(
            factor="*".join(sorted(one - two))
        )
    if one < two:
        return "extra factor", _("has the extra factor {factor}").format(
            factor="*".join(sorted(two - one))
        )
    return "convention", _("has {new} for {old}").format(new=spelt(theirs), old=spelt(mine))
