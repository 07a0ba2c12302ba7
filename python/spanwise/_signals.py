"""Lets a command that is told to end tidy up first."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class Terminated(BaseException):
    """The process was told to end, by the signal of this number."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def terminable() -> Iterator[None]:
    """Raises `Terminated` on a signal that would end the process with its files half written.

    Signals that are ignored stay ignored, as those of a terminal under ``nohup``.
    """
    before = {}
    # Other threads cannot, and have no need to: the command is the main one.
    if threading.current_thread() is threading.main_thread():
        numbers = [signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)]
        before = {each: signal.getsignal(each) for each in numbers}
    before = {each: handler for each, handler in before.items() if handler == signal.SIG_DFL}

    def end(number: int, _: FrameType | None) -> None:
        # Once is enough: what follows must not stop the tidying up.
        for each in before:
            signal.signal(each, signal.SIG_IGN)
        raise Terminated(number)

    for each in before:
        signal.signal(each, end)
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
