"""Tables and lines for reading: as text in columns, and as HTML for notebooks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


#: Most numbers that stand in a line one by one.
MANY: Final = 8


@dataclass(frozen=True, eq=False, repr=False)
class Table:
    """Rows below heads.

    Attributes
    ----------
    heads : sequence of str
        What the columns are called.
    rows : sequence of sequence
        Text, numbers (NaN is a dash), or None where there is nothing.
    forms : sequence of str
        For each column ``<`` or ``>``, the side to which text goes, or how numbers are written,
        such as ``.3f``.
    notes : sequence of str, optional
        Lines below the rows.
    """

    heads: Sequence[str]
    rows: Sequence[Sequence[object]]
    forms: Sequence[str]
    notes: Sequence[str] = ()

    def __str__(self) -> str:
        lines = [[*self.heads], *self._cells()]
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        aligned = (
            [
                cell.ljust(width) if form == "<" else cell.rjust(width)
                for cell, width, form in zip(line, widths, self.forms, strict=True)
            ]
            for line in lines
        )
        return "\n".join([*("  ".join(line).rstrip() for line in aligned), *self.notes])

    def _repr_html_(self) -> str:
        def row(cells: Iterable[str], tag: str) -> str:
            return f"<tr>{''.join(f'<{tag}>{_safe(each)}</{tag}>' for each in cells)}</tr>"

        body = "".join(row(cells, "td") for cells in self._cells())
        notes = "".join(f"<p>{_safe(each)}</p>" for each in self.notes)
        return f"<table><thead>{row(self.heads, 'th')}</thead><tbody>{body}</tbody></table>{notes}"

    def _cells(self) -> list[list[str]]:
        return [list(map(_cell, row, self.forms)) for row in self.rows]


#: What a text is made of: tables, and lines between them.
Block: TypeAlias = Table | Iterable[str]


def text(blocks: Iterable[Block]) -> str:
    """Tables and lines, with an empty line between."""
    return "\n\n".join(str(each) if isinstance(each, Table) else "\n".join(each) for each in blocks)


def html(blocks: Iterable[Block]) -> str:
    """The same for a notebook."""
    return "".join(
        each._repr_html_() if isinstance(each, Table) else f"<pre>{_safe(chr(10).join(each))}</pre>"
        for each in blocks
    )


def listed(values: Iterable[float], form: str) -> str:
    """Numbers with commas between."""
    return ", ".join(format(value, form) for value in values)


def ranged(values: Sequence[float] | NDArray[np.float64], form: str) -> str:
    """The same, and of many numbers the smallest and the largest."""
    if len(values) <= MANY:
        return listed(values, form)
    return f"{min(values):{form}} to {max(values):{form}}"


def _cell(value: object, form: str) -> str:
    if isinstance(value, float) and form not in ("<", ">"):
        # What rounds to nought has no sign.
        return "-" if math.isnan(value) else format(value, f"z{form}")
    return "" if value is None else str(value)


def _safe(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
