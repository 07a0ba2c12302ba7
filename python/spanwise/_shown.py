"""How a message shows a value, whatever it is: on one line, short, and without failing."""

from __future__ import annotations

import math
import reprlib
import sys
import textwrap
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any, Final

#: Longest text of an offending value in a message.
LONGEST: Final = 80


class _Short(reprlib.Repr):
    """Text of values of any size and depth."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring, self.maxother = 2 * LONGEST, sys.maxsize
        self.maxtuple = self.maxlist = self.maxarray = self.maxdict = self.maxset = LONGEST

    def repr_int(self, value: int, level: int) -> str:
        """Of more digits than Python writes, their number."""
        if value.bit_length() < 1000:
            return repr(value)
        digits = int(value.bit_length() * math.log10(2.0)) + 1
        return f"a whole number of about {digits} digits"

    def repr_dict(self, value: dict[Any, Any], level: int) -> str:
        """In the order of the keys, which may not be comparable."""
        if level <= 0:
            return "{...}"
        some = islice(value.items(), self.maxdict)
        found = [f"{self.repr1(k, level - 1)}: {self.repr1(v, level - 1)}" for k, v in some]
        return f"{{{', '.join(found)}}}"


def many(number: int, what: str) -> str:
    """A number of things in words."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def warned(sentences: Iterable[str]) -> Iterator[str]:
    """Lines of a summary that tell what was warned of."""
    for said in sentences:
        first, *more = textwrap.wrap(said, 90, break_long_words=False, break_on_hyphens=False)
        yield f"warning   {first}"
        yield from (f"          {line}" for line in more)


def shown(value: object) -> str:
    """The value as text on one line, cut where it is long."""
    try:
        text = " ".join(_Short().repr(value).split())
    except Exception:
        # Whatever it is, it is not what was to be, and that is what is to be told.
        text = f"<{type(value).__name__}>"
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
