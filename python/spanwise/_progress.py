"""A line that tells how far a computation is: over itself on a terminal, seldom elsewhere."""

from __future__ import annotations

import time
from typing import Final, TextIO

#: Characters of the bar.
WIDTH: Final = 30

#: Time between two lines where they stay, in a file or a pipe [s].
INTERVAL: Final = 60.0


class Bar:
    """Writes a bar, the count, the rate and the time left.

    On a terminal it writes them over themselves, and ends the line. In a file or a pipe, which
    keeps all, it writes a line a minute, and nothing of what takes less. Nor does it end a
    computation that nobody can be told of.
    """

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream
        self._over_itself = stream is not None and stream.isatty()
        self._started = self._told = time.monotonic()
        self._open = False

    def __call__(self, done: int, total: int) -> None:
        """Show how many are done."""
        now = time.monotonic()
        last = done == total and self._told > self._started
        if not self._over_itself and now - self._told < INTERVAL and not last:
            return
        self._told = now
        spent = max(now - self._started, 1e-9)
        part = done / total if total > 0 else 1.0
        filled = "#" * int(WIDTH * part)
        left = "" if done == 0 or done == total else f", {spent * (total - done) / done:.0f} s left"
        text = f"[{filled:<{WIDTH}}] {done} of {total}, {done / spent:.0f}/s{left}"
        self._write(f"\r{text:<78}" if self._over_itself else f"{text}\n")
        self._open = self._over_itself
        if done == total:
            self.close()

    def close(self) -> None:
        """End the line, once."""
        if self._open:
            self._write("\n")
            self._open = False

    def _write(self, text: str) -> None:
        if self._stream is None:
            return
        try:
            self._stream.write(text)
            self._stream.flush()
        except (OSError, ValueError):  # its reader has gone, or it has been closed
            self._stream = None
