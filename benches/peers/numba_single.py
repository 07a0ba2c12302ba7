"""One crossing of the headline case for each iteration of `prange`, with its state in registers.

What bounds it is the way from the loads of one step to those of the next, since the contacts follow
one from the other, and the influence rows: every crossing reads all 3 MB of them anew.

Of the layouts tried this is the fastest: 64 steps first, then their recovery, four responses at
once with instants innermost. Rows of responses by step, recovered after every two steps, take a
quarter longer, after every one two fifths, for what is largest so far goes through memory then.
Two responses at once and chunks of 32 or 128 steps come within some hundredths. With the usual form
of Newmark's method in place of `step_of`, and sums in any order, it all takes a sixth longer.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from headline_common import (
    CHUNK,
    FAST,
    MODES,
    PADDED,
    THREADS,
    Array,
    Peer,
    Tables,
    aligned,
    elevations,
    find_steps,
    larger,
    smaller,
    take_chunk,
    take_stops,
)
from numba import njit, prange
from numba.np.ufunc.parallel import get_thread_id
from numpy.typing import NDArray

Numbers: TypeAlias = tuple[float, ...]

#: Of fast arithmetic all but other orders of sums, which lengthen the way from loads to loads.
STEP: dict[str, Any] = {
    "fastmath": {"nnan", "ninf", "nsz", "arcp", "contract"},
    "error_model": "numpy",
    "forceinline": True,
}

#: Modal coordinates and velocities (6), the same of the body above the axles (4), shortenings of
#: the suspensions (2), load increment of the second axle. Coordinates are what they would be at the
#: end of the step without accelerations there, velocities those half a step before: all that
#: Newmark's method needs from step to step.
REST: Numbers = (0.0,) * 13


def rows_of(tables: Tables) -> Array:
    """By step what the step takes, shape (steps + 2, 25).

    To the columns of `Tables` come the modal accelerations under the static loads, and what a unit
    of each load adds to each axle's compression one step later: the next step need not wait for the
    motion to know it.
    """
    h, load = tables.constants[0], tables.constants[14:16]
    f = tables.rows[:, :6].reshape(-1, 2, MODES)
    m00, m01, m11 = tables.constants[7:10]
    later = np.concatenate([f[1:], np.zeros_like(f[:1])])
    below = np.einsum("tkm,tjm->tkj", later, f)
    adds = -(h**2) * (below + np.array([[m00, m01], [m01, m11]]))
    rows = np.hstack([tables.rows, np.einsum("tkm,k->tm", f, load), adds.reshape(-1, 4)])
    # Until an axle is on the bridge all are alike, so that one is read.
    assert np.ptp(rows[1 : tables.first - 1], axis=0).max() == 0.0
    return np.concatenate([rows, np.zeros_like(rows[:1])])


def constants_of(tables: Tables) -> Numbers:
    """What holds for all steps, in the order of `step_of`."""
    h, _, new, _, k0, k1, k2, m00, m01, m11, *contacts = tables.constants.tolist()
    return (h, h * h, new, k0, k1, k2, h * m00, h * m01, h * m11, *contacts)


# ---- The loop. ----


def step_of(on_bridge: bool) -> Any:
    """One step, with or without an axle on the bridge."""

    @njit(**STEP)  # type: ignore[untyped-decorator]
    def step(
        state: Numbers,
        u0: float,
        u1: float,
        rows: Array,
        t: int,
        constants: Numbers,
        next0: float,
        next1: float,
    ) -> tuple[Numbers, float, float, float, float, float, float, float]:
        """From compressions u to those of the next step, at elevations `next0` and `next1`."""
        x0, x1, x2, v0, v1, v2, b0, b1, w0, w1, s0, s1, p1 = state
        h, hh, new, k0, k1, k2, m00, m01, m11 = constants[:9]
        give0, give1, stroke0, stroke1, load0, load1 = constants[9:]
        # Contacts: two sweeps, with all that does not change taken out of them.
        held0, held1 = rows[t, 8] * (u0 - s0), rows[t, 9] * (u1 - s1)
        slipping0, slipping1 = rows[t, 10] * u0, rows[t, 11] * u1
        high0, high1 = slipping0 + rows[t, 12], slipping1 + rows[t, 13]
        low0, low1 = slipping0 - rows[t, 12], slipping1 - rows[t, 13]
        stick01, stick10, slip01, slip10 = rows[t, 14], rows[t, 15], rows[t, 16], rows[t, 17]
        p0 = 0.0
        for _ in range(2):
            p0 = smaller(held0 - stick01 * p1, high0 - slip01 * p1)
            p0 = larger(p0, larger(low0 - slip01 * p1, -load0))
            p1 = smaller(held1 - stick10 * p0, high1 - slip10 * p0)
            p1 = larger(p1, larger(low1 - slip10 * p0, -load1))
        q0, q1 = give0 * p0, give1 * p1
        s0 = smaller(larger(s0, q0 - stroke0), q0 + stroke0)
        s1 = smaller(larger(s1, q1 - stroke1), q1 + stroke1)
        # The next compressions: what does not wait for the loads, then what they add.
        u0, u1 = next0 + (b0 + h * w0), next1 + (b1 + h * w1)
        a0, a1, a2 = 0.0, 0.0, 0.0
        if on_bridge:
            a0 = rows[t, 18] - k0 * x0
            a1 = rows[t, 19] - k1 * x1
            a2 = rows[t, 20] - k2 * x2
            y0 = x0 + h * v0 + hh * a0
            y1 = x1 + h * v1 + hh * a1
            y2 = x2 + h * v2 + hh * a2
            n = t + 1
            u0 += rows[n, 6] - (rows[n, 0] * y0 + rows[n, 1] * y1 + rows[n, 2] * y2)
            u1 += rows[n, 7] - (rows[n, 3] * y0 + rows[n, 4] * y1 + rows[n, 5] * y2)
        u0 = u0 + rows[t, 21] * p0 + rows[t, 22] * p1
        u1 = u1 + rows[t, 23] * p0 + rows[t, 24] * p1
        # Everything with the loads.
        w0 = w0 - m00 * p0 - m01 * p1
        w1 = w1 - m01 * p0 - m11 * p1
        b0 += h * w0
        b1 += h * w1
        y0, y1, y2 = 0.0, 0.0, 0.0
        if on_bridge:
            a0 = a0 + rows[t, 0] * p0 + rows[t, 3] * p1
            a1 = a1 + rows[t, 1] * p0 + rows[t, 4] * p1
            a2 = a2 + rows[t, 2] * p0 + rows[t, 5] * p1
            y0, y1, y2 = x0 + new * a0, x1 + new * a1, x2 + new * a2
            x0 = x0 + h * v0 + hh * a0
            x1 = x1 + h * v1 + hh * a1
            x2 = x2 + h * v2 + hh * a2
            v0 += h * a0
            v1 += h * a1
            v2 += h * a2
        state = (x0, x1, x2, v0, v1, v2, b0, b1, w0, w1, s0, s1, p1)
        return state, u0, u1, y0, y1, y2, p0 + load0, p1 + load1

    return step


step_before, step_on = step_of(False), step_of(True)


@njit(forceinline=True, **FAST)  # type: ignore[untyped-decorator]
def response(rho: Array, influence: Array, kept: Array, r: int, t: int) -> float:
    """A response at an instant of a chunk."""
    modal = rho[0, r] * kept[0, t] + rho[1, r] * kept[1, t] + rho[2, r] * kept[2, t]
    loads = influence[r, 0, t] * kept[3, t] + influence[r, 1, t] * kept[4, t]
    return modal + loads  # type: ignore[no-any-return]


@njit(**FAST)  # type: ignore[untyped-decorator]
def look(kept: Array, rho: Array, influence: Array, top: Array, bottom: Array) -> None:
    """Extremes of all responses over one chunk, four at once, since all take the same states."""
    for r in range(0, PADDED, 4):
        max0, max1, max2, max3 = 0.0, 0.0, 0.0, 0.0
        min0, min1, min2, min3 = 0.0, 0.0, 0.0, 0.0
        for t in range(CHUNK):
            y0 = response(rho, influence, kept, r, t)
            y1 = response(rho, influence, kept, r + 1, t)
            y2 = response(rho, influence, kept, r + 2, t)
            y3 = response(rho, influence, kept, r + 3, t)
            max0, min0 = larger(max0, y0), smaller(min0, y0)
            max1, min1 = larger(max1, y1), smaller(min1, y1)
            max2, min2 = larger(max2, y2), smaller(min2, y2)
            max3, min3 = larger(max3, y3), smaller(min3, y3)
        top[r], top[r + 1], top[r + 2], top[r + 3] = max0, max1, max2, max3
        bottom[r], bottom[r + 1], bottom[r + 2], bottom[r + 3] = min0, min1, min2, min3


@njit(**FAST)  # type: ignore[untyped-decorator]
def extremes(values: Array, numbers: Array, own: Array) -> None:
    """Largest, its step, smallest, its step."""
    top, bottom, none = values[0], values[0], float(len(values))
    for t in range(len(values)):
        top, bottom = larger(top, values[t]), smaller(bottom, values[t])
    at_top, at_bottom = none, none
    for t in range(len(values)):
        at_top = smaller(at_top, numbers[t] if values[t] == top else none)
        at_bottom = smaller(at_bottom, numbers[t] if values[t] == bottom else none)
    own[0], own[1], own[2], own[3] = top, at_top, bottom, at_bottom


@njit(**FAST)  # type: ignore[untyped-decorator]
def crossing(
    elevation: Array,
    first: int,
    rows: Array,
    constants: Numbers,
    rho: Array,
    influence: Array,
    stops: NDArray[np.int64],
    fractions: Array,
    stop_responses: NDArray[np.int64],
    stop_influence: Array,
    kept: Array,
    carried: Array,
    high_low: Array,
    numbered: Array,
    found: Array,
    loads: Array,
) -> None:
    """One crossing.

    `found` becomes largest, its step, smallest, its step: shape (4, responses); `loads` likewise by
    axle. The rest is room: `kept` for A and P, shape (chunks + 1, 5, CHUNK), its last chunk for the
    instant before the first; `carried` for the loads at all steps; `high_low` for the extremes of a
    chunk; `numbered` as `find` wants it, with numbers for all steps.
    """
    chunks, steps = len(influence), carried.shape[1]
    state, u0, u1 = REST, elevation[1, 0], elevation[1, 1]
    a0, a1, a2, p0, p1 = 0.0, 0.0, 0.0, constants[13], constants[14]
    carried[0, 0], carried[1, 0] = p0, p1
    for t in range(1, first):
        state, u0, u1, a0, a1, a2, p0, p1 = step_before(
            state, u0, u1, rows, 1, constants, elevation[t + 1, 0], elevation[t + 1, 1]
        )
        carried[0, t], carried[1, t] = p0, p1
    u0 += rows[first, 6]
    u1 += rows[first, 7]
    kept[chunks] = 0.0
    kept[chunks, 3, CHUNK - 1], kept[chunks, 4, CHUNK - 1] = p0, p1
    found[:] = 0.0
    for j in range(chunks):
        begin, own = first + j * CHUNK, kept[j]
        if steps - begin < CHUNK:
            own[:] = 0.0
        for n in range(min(CHUNK, steps - begin)):
            t = begin + n
            state, u0, u1, a0, a1, a2, p0, p1 = step_on(
                state, u0, u1, rows, t, constants, elevation[t + 1, 0], elevation[t + 1, 1]
            )
            own[0, n], own[1, n], own[2, n], own[3, n], own[4, n] = a0, a1, a2, p0, p1
            carried[0, t], carried[1, t] = p0, p1
        look(own, rho, influence[j], high_low[0], high_low[1])
        take_chunk(found, high_low[0], high_low[1], j)
    take_stops(found, kept, first, rho, stops, fractions, stop_responses, stop_influence)
    find_steps(found, kept, first, rho, influence, numbered)
    for k in range(2):
        extremes(carried[k], numbered[CHUNK:], loads[:, k])


@njit(parallel=True, **FAST)  # type: ignore[untyped-decorator]
def crossings(
    pool: Array,
    first: int,
    rows: Array,
    constants: Numbers,
    rho: Array,
    influence: Array,
    stops: NDArray[np.int64],
    fractions: Array,
    stop_responses: NDArray[np.int64],
    stop_influence: Array,
    kept: Array,
    carried: Array,
    high_low: Array,
    numbered: Array,
    found: Array,
    loads: Array,
) -> None:
    """Crossings on all threads, each of which has its own room."""
    for i in prange(len(found)):
        thread = get_thread_id()  # type: ignore[no-untyped-call]
        crossing(
            pool[i % len(pool)],
            first,
            rows,
            constants,
            rho,
            influence,
            stops,
            fractions,
            stop_responses,
            stop_influence,
            kept[thread],
            carried[thread],
            high_low[thread],
            numbered[thread],
            found[i],
            loads[i],
        )


class Single(Peer):
    """The loop over crossings."""

    name = "one crossing per iteration"

    def __init__(self, tables: Tables, samples: int) -> None:
        super().__init__(tables, samples)
        # A step looks one ahead, the last one at nothing.
        self.pool = np.pad(elevations(tables.x), ((0, 0), (0, 1), (0, 0)))
        self.rows, self.constants = rows_of(tables), constants_of(tables)
        self.kept = aligned(np.zeros((THREADS, len(tables.influence) + 1, 5, CHUNK)))
        self.carried = np.zeros((THREADS, 2, tables.steps + 1))
        self.high_low = np.zeros((THREADS, 2, PADDED))
        self.numbered = np.tile(np.arange(-CHUNK, tables.steps + 1.0), (THREADS, 1))

    def run(self) -> None:
        """All samples."""
        t = self.tables
        crossings(
            self.pool,
            t.first,
            self.rows,
            self.constants,
            t.rho,
            t.influence,
            t.stops,
            t.fractions,
            t.stop_responses,
            t.stop_influence,
            self.kept,
            self.carried,
            self.high_low,
            self.numbered,
            self.found,
            self.loads,
        )
