"""A line on a terminal that tells how far a computation is."""

from __future__ import annotations

import time
from typing import Final, TextIO

#: Characters of the bar.
WIDTH: Final = 30


class Bar:
    """Writes a bar, the count, the rate and the time left over itself, and ends the line."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._started = time.monotonic()
        self._ended = False

    def __call__(self, done: int, total: int) -> None:
        """Show how many are done."""
        spent = max(time.monotonic() - self._started, 1e-9)
        part = done / total if total > 0 else 1.0
        filled = "#" * int(WIDTH * part)
        left = "" if done == 0 or done == total else f", {spent * (total - done) / done:.0f} s left"
        text = f"[{filled:<{WIDTH}}] {done} of {total}, {done / spent:.0f}/s{left}"
        self._stream.write(f"\r{text:<78}")
        if done == total:
            self.close()
        self._stream.flush()

    def close(self) -> None:
        """End the line, once."""
        if not self._ended:
            self._stream.write("\n")
            self._ended = True
