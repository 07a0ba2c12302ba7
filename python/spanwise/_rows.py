"""What an ensemble leaves of its samples: rows of numbers, and all that says what they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._value import Value, frozen
from spanwise.extremes import When

Array: TypeAlias = NDArray[np.float64]
Whole: TypeAlias = NDArray[np.uint32]


@dataclass(frozen=True, eq=False, repr=False)
class Rows(Value):
    """Results of samples, one row for each, as the core leaves them.

    Attributes
    ----------
    numbers : ndarray, shape (sample, number)
        Extremes and statistics; `columns` says where each kind of them is.
    instants : ndarray of uint32, shape (sample, instant)
        Instants of the extremes of responses and axle loads, and how often axles left the road.
    digests : ndarray of uint64, shape (sample,)
        Fingerprint of each sample.
    marches : ndarray of uint32, shape (sample,)
        What kind of steps each took, in `at_rest` and `clock`.
    at_rest : ndarray, shape (march, 2 * response)
        Static extremes, largest and smallest; no row where samples have their own.
    clock : Clock
        What the instants mean; it knows nothing where samples have times of their own.
    columns : dict
        First column of each kind of number, and the one behind its last.
    widths : dict
        How many responses there are of each kind, in their order.
    failures : list of tuple
        Row, step and cause of every failure.
    sections, omega : ndarray
        Sections [m], and circular frequencies [rad/s].
    shares : bool
        Whether the samples shared where their axles stand.
    isa, threads, elapsed
        How it was computed.
    """

    numbers: Array
    instants: Whole
    digests: NDArray[np.uint64]
    marches: Whole
    at_rest: Array
    clock: _core.Clock = field(compare=False)
    columns: dict[str, tuple[int, int]]
    widths: dict[str, int]
    failures: list[tuple[int, int | None, str]]
    sections: Array
    omega: Array
    shares: bool
    isa: str = field(compare=False)
    threads: int = field(compare=False)
    elapsed: float = field(compare=False)

    @classmethod
    def of(cls, core: _core.Ensemble) -> Rows:
        """Those of a run."""
        found = {each.name: getattr(core, each.name) for each in fields(cls)}
        return cls(**{**found, "widths": dict(core.widths)})

    def __post_init__(self) -> None:
        for each in vars(self).values():
            if isinstance(each, np.ndarray):
                each.setflags(write=False)

    @classmethod
    def joined(cls, parts: Sequence[Rows]) -> Rows:
        """Several as one, in this order; all are of one plan."""
        first = parts[0]
        clock, renumbered = _core.Clock.joined([each.clock for each in parts])
        marches = [
            np.array(number, dtype=np.uint32)[each.marches] if number else each.marches
            for number, each in zip(renumbered, parts, strict=True)
        ]
        at_rest = first.at_rest
        if len(at_rest):
            known = 1 + max((max(number) for number in renumbered if number), default=-1)
            at_rest = np.empty((known, first.at_rest.shape[1]))
            for number, each in zip(renumbered, parts, strict=True):
                at_rest[number] = each.at_rest
        starts = np.cumsum([0, *(len(each.numbers) for each in parts)])
        return replace(
            first,
            numbers=np.concatenate([each.numbers for each in parts]),
            instants=np.concatenate([each.instants for each in parts]),
            digests=np.concatenate([each.digests for each in parts]),
            marches=np.concatenate(marches),
            at_rest=at_rest,
            clock=clock,
            failures=[
                (int(start) + row, step, cause)
                for start, each in zip(starts, parts, strict=False)
                for row, step, cause in each.failures
            ],
            isa=", ".join(dict.fromkeys(each.isa for each in parts)),
            threads=max(each.threads for each in parts),
            elapsed=sum(each.elapsed for each in parts),
        )

    @property
    def hash(self) -> str:
        """Fingerprint of all samples together."""
        return f"{_core.fingerprint(self.digests):016x}"

    def block(self, name: str) -> Array:
        """The columns of one kind of number."""
        return self.numbers[:, slice(*self.columns[name])]

    def place(self, name: str) -> tuple[int, int]:
        """The first response of a kind among all, and how many there are."""
        names = [*self.widths]
        return sum(self.widths[each] for each in names[: names.index(name)]), self.widths[name]

    @property
    def responses(self) -> int:
        """How many there are in all."""
        return sum(self.widths.values())

    @property
    def axles(self) -> int:
        """How many axles there are at most."""
        start, end = self.columns["axle_loads"]
        return (end - start) // 2

    @property
    def statics(self) -> Array:
        """Static extremes, largest and then smallest: one row for all samples, or one for each."""
        low, high = self.columns["statics"]
        if high > low:
            return self.block("statics")
        # In their own steps, which are halved for some.
        return self.at_rest[0] if len(self.at_rest) == 1 else self.at_rest[self.marches]

    def when(self, start: int, width: int, speeds: Array) -> When:
        """Times and positions of some of the extremes, counted through responses and loads."""
        some = slice(start, start + width)
        low, high = self.columns["times"]
        if high > low:
            return self.block("times")[:, some], self.block("positions")[:, some]
        chosen = np.ascontiguousarray(self.instants[:, some])
        time, position = self.clock.when(chosen, self.marches, speeds)
        missing = np.isnan(self.numbers[:, : self.columns["axle_loads"][1]][:, some])
        time[missing] = position[missing] = np.nan
        return time, position

    def step(self, row: int, speed: float) -> tuple[float, int] | None:
        """The time step of a sample at its speed [s] and how often it was halved, if known."""
        return self.clock.step(int(self.marches[row]), speed)

    def frozen_statics(self, start: int, width: int) -> Array:
        """Static extremes of some responses, not to be written to."""
        return frozen(np.array(self.statics[..., start : start + width]))
