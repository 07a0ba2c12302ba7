"""Eight crossings of the headline case for each iteration of `prange`, vectorised by hand.

Their steps fill vectors, which those of one crossing cannot, as its contacts follow one from the
other, and they share what they read of the tables. 4 or 16 lanes, and chunks of 32 or 128 steps,
are slower than 8 and 64.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from headline_common import (
    CHUNK,
    COUNT,
    FAST,
    ROADS,
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

#: Crossings side by side.
LANES = 8

# Rows of the state, LANES numbers each, in one array so that LLVM knows them to be apart: modal
# coordinates, velocities, accelerations (9), the same of the body above the axles (6), shortenings
# of the suspensions (2), load increment of the second axle; then what recovery needs (5), the
# elevations (2), and extremes of the loads with their steps (8).
L = LANES
STATE, KEPT, ROAD, LOADS, ALL = 18, 18, 23, 25, 33


def step_of(on_bridge: bool) -> Any:
    """One step of all lanes, with or without an axle on the bridge."""

    @njit(**FAST)  # type: ignore[untyped-decorator]
    def step(st: Array, row: Array, constants: Array, elevation: Array, now: float) -> None:
        h, old, new, half = constants[0], constants[1], constants[2], constants[3]
        k0, k1, k2 = constants[4], constants[5], constants[6]
        m00, m01, m11 = constants[7], constants[8], constants[9]
        give0, give1, stroke0, stroke1 = constants[10], constants[11], constants[12], constants[13]
        load0, load1 = constants[14], constants[15]
        f00, f01, f02, f10, f11, f12 = row[0], row[1], row[2], row[3], row[4], row[5]
        offset0, offset1, stick0, stick1 = row[6], row[7], row[8], row[9]
        slip0, slip1, friction0, friction1 = row[10], row[11], row[12], row[13]
        stick01, stick10, slip01, slip10 = row[14], row[15], row[16], row[17]
        for s in range(2 * L):
            st[ROAD * L + s] = elevation[s]
        for s in range(L):
            # Everything at the end of the step without accelerations there.
            e0, e1 = st[13 * L + s], st[14 * L + s]
            w0, w1 = st[11 * L + s], st[12 * L + s]
            b0 = st[9 * L + s] + h * w0 + old * e0
            b1 = st[10 * L + s] + h * w1 + old * e1
            w0 += half * e0
            w1 += half * e1
            u0, u1 = st[ROAD * L + s] + b0, st[(ROAD + 1) * L + s] + b1
            if on_bridge:
                a0, a1, a2 = st[6 * L + s], st[7 * L + s], st[8 * L + s]
                v0, v1, v2 = st[3 * L + s], st[4 * L + s], st[5 * L + s]
                x0 = st[s] + h * v0 + old * a0
                x1 = st[L + s] + h * v1 + old * a1
                x2 = st[2 * L + s] + h * v2 + old * a2
                v0 += half * a0
                v1 += half * a1
                v2 += half * a2
                u0 += offset0 - (f00 * x0 + f01 * x1 + f02 * x2)
                u1 += offset1 - (f10 * x0 + f11 * x1 + f12 * x2)
            # Contacts: two sweeps, with all that does not change taken out of them.
            s0, s1, p1 = st[15 * L + s], st[16 * L + s], st[17 * L + s]
            held0, held1 = stick0 * (u0 - s0), stick1 * (u1 - s1)
            slipping0, slipping1 = slip0 * u0, slip1 * u1
            high0, high1 = slipping0 + friction0, slipping1 + friction1
            low0, low1 = slipping0 - friction0, slipping1 - friction1
            p0 = smaller(held0 - stick01 * p1, high0 - slip01 * p1)
            p0 = larger(-load0, larger(p0, low0 - slip01 * p1))
            p1 = smaller(held1 - stick10 * p0, high1 - slip10 * p0)
            p1 = larger(-load1, larger(p1, low1 - slip10 * p0))
            p0 = smaller(held0 - stick01 * p1, high0 - slip01 * p1)
            p0 = larger(-load0, larger(p0, low0 - slip01 * p1))
            p1 = smaller(held1 - stick10 * p0, high1 - slip10 * p0)
            p1 = larger(-load1, larger(p1, low1 - slip10 * p0))
            q0, q1 = give0 * p0, give1 * p1
            st[15 * L + s] = smaller(larger(s0, q0 - stroke0), q0 + stroke0)
            st[16 * L + s] = smaller(larger(s1, q1 - stroke1), q1 + stroke1)
            st[17 * L + s] = p1
            # Everything with the loads.
            e0, e1 = -(m00 * p0 + m01 * p1), -(m01 * p0 + m11 * p1)
            st[9 * L + s], st[10 * L + s] = b0 + new * e0, b1 + new * e1
            st[11 * L + s], st[12 * L + s] = w0 + half * e0, w1 + half * e1
            st[13 * L + s], st[14 * L + s] = e0, e1
            p0 += load0
            p1 += load1
            st[21 * L + s], st[22 * L + s] = p0, p1
            if on_bridge:
                a0 = f00 * p0 + f10 * p1 - k0 * x0
                a1 = f01 * p0 + f11 * p1 - k1 * x1
                a2 = f02 * p0 + f12 * p1 - k2 * x2
                x0 += new * a0
                x1 += new * a1
                x2 += new * a2
                st[s], st[L + s], st[2 * L + s] = x0, x1, x2
                st[3 * L + s], st[4 * L + s] = v0 + half * a0, v1 + half * a1
                st[5 * L + s] = v2 + half * a2
                st[6 * L + s], st[7 * L + s], st[8 * L + s] = a0, a1, a2
                st[18 * L + s], st[19 * L + s], st[20 * L + s] = x0, x1, x2
            max0, max1 = st[LOADS * L + s], st[(LOADS + 1) * L + s]
            min0, min1 = st[(LOADS + 2) * L + s], st[(LOADS + 3) * L + s]
            st[(LOADS + 4) * L + s] = now if p0 > max0 else st[(LOADS + 4) * L + s]
            st[(LOADS + 5) * L + s] = now if p1 > max1 else st[(LOADS + 5) * L + s]
            st[(LOADS + 6) * L + s] = now if p0 < min0 else st[(LOADS + 6) * L + s]
            st[(LOADS + 7) * L + s] = now if p1 < min1 else st[(LOADS + 7) * L + s]
            st[LOADS * L + s], st[(LOADS + 1) * L + s] = larger(max0, p0), larger(max1, p1)
            st[(LOADS + 2) * L + s] = smaller(min0, p0)
            st[(LOADS + 3) * L + s] = smaller(min1, p1)

    return step


step_before, step_on = step_of(False), step_of(True)


@njit(**FAST)  # type: ignore[untyped-decorator]
def look(kept: Array, rho: Array, g: Array, r: int, top: Array, bottom: Array) -> None:
    """Extremes of responses r and r + 1 of one lane over one chunk.

    Two at once, since both take the same states.
    """
    f0, f1, f2 = rho[0, r], rho[1, r], rho[2, r]
    g0, g1, g2 = rho[0, r + 1], rho[1, r + 1], rho[2, r + 1]
    max_f, min_f, max_g, min_g = 0.0, 0.0, 0.0, 0.0
    for t in range(CHUNK):
        a0, a1, a2, p0, p1 = kept[0, t], kept[1, t], kept[2, t], kept[3, t], kept[4, t]
        f = f0 * a0 + f1 * a1 + f2 * a2 + g[0, 0, t] * p0 + g[0, 1, t] * p1
        second = g0 * a0 + g1 * a1 + g2 * a2 + g[1, 0, t] * p0 + g[1, 1, t] * p1
        max_f, min_f = larger(max_f, f), smaller(min_f, f)
        max_g, min_g = larger(max_g, second), smaller(min_g, second)
    top[r], bottom[r], top[r + 1], bottom[r + 1] = max_f, min_f, max_g, min_g


@njit(**FAST)  # type: ignore[untyped-decorator]
def block(
    elevation: Array,
    first: int,
    rows: Array,
    constants: Array,
    rho: Array,
    influence: Array,
    stops: NDArray[np.int64],
    fractions: Array,
    stop_responses: NDArray[np.int64],
    stop_influence: Array,
    kept: Array,
    found: Array,
    loads: Array,
) -> None:
    """One crossing in each lane.

    `found` becomes largest, its step, smallest, its step: shape (lanes, 4, responses); `loads`
    likewise by axle. `kept` is room for A and P: shape (lanes, chunks + 1, 5, CHUNK), its last
    chunk for the instant before the first.
    """
    chunks, count = influence.shape[0], influence.shape[1]
    st = np.zeros(ALL * L)
    top, bottom = np.empty((L, count)), np.empty((L, count))
    numbered = np.empty(2 * CHUNK)
    numbered[CHUNK:] = np.arange(CHUNK)
    found[:] = 0.0
    for s in range(L):
        for k in range(2):
            st[(LOADS + k) * L + s] = st[(LOADS + 2 + k) * L + s] = constants[14 + k]
    for t in range(1, first):
        step_before(st, rows[t], constants, elevation[t], float(t))
    for s in range(L):
        for q in range(5):
            kept[s, chunks, q, CHUNK - 1] = st[(KEPT + q) * L + s]
    for j in range(chunks):
        begin = first + j * CHUNK
        steps = min(CHUNK, len(rows) - begin)
        if steps < CHUNK:
            kept[:, j] = 0.0
        for t in range(steps):
            now = begin + t
            step_on(st, rows[now], constants, elevation[now], float(now))
            for s in range(L):
                for q in range(5):
                    kept[s, j, q, t] = st[(KEPT + q) * L + s]
        for r in range(0, count, 2):
            for s in range(L):
                look(kept[s, j], rho, influence[j, r : r + 2], r, top[s], bottom[s])
        for s in range(L):
            take_chunk(found[s], top[s], bottom[s], j)
    for s in range(L):
        take_stops(found[s], kept[s], first, rho, stops, fractions, stop_responses, stop_influence)
        find_steps(found[s], kept[s], first, rho, influence, numbered)
    for s in range(L):
        for k in range(2):
            loads[s, 0, k], loads[s, 1, k] = st[(LOADS + k) * L + s], st[(LOADS + 4 + k) * L + s]
            loads[s, 2, k] = st[(LOADS + 2 + k) * L + s]
            loads[s, 3, k] = st[(LOADS + 6 + k) * L + s]


@njit(parallel=True, **FAST)  # type: ignore[untyped-decorator]
def crossings(
    pool: Array,
    first: int,
    rows: Array,
    constants: Array,
    rho: Array,
    influence: Array,
    stops: NDArray[np.int64],
    fractions: Array,
    stop_responses: NDArray[np.int64],
    stop_influence: Array,
    room: Array,
    found: Array,
    loads: Array,
) -> None:
    """Blocks of crossings on all threads, each of which has its own room."""
    for i in prange(len(found) // LANES):
        block(
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
            room[get_thread_id()],  # type: ignore[no-untyped-call]
            found[i * LANES : (i + 1) * LANES],
            loads[i * LANES : (i + 1) * LANES],
        )


class Lanes(Peer):
    """The loop over blocks."""

    name = "eight crossings per iteration, vectorised by hand"

    def __init__(self, tables: Tables, samples: int) -> None:
        super().__init__(tables, samples)
        blocks = elevations(tables.x).reshape(ROADS // LANES, LANES, *tables.x.shape)
        #: Shape (blocks of lanes, steps + 1, axles x lanes).
        self.pool = np.ascontiguousarray(blocks.transpose(0, 2, 3, 1)).reshape(
            ROADS // LANES, len(tables.x), 2 * LANES
        )
        self.room = aligned(np.zeros((THREADS, LANES, len(tables.influence) + 1, 5, CHUNK)))

    def run(self) -> None:
        """All samples."""
        t = self.tables
        crossings(
            self.pool,
            t.first,
            t.rows,
            t.constants,
            t.rho,
            t.influence,
            t.stops,
            t.fractions,
            t.stop_responses,
            t.stop_influence,
            self.room,
            self.found,
            self.loads,
        )

    def operations(self) -> tuple[int, int]:
        """Additions and multiplications of a crossing: of its steps, of recovery.

        A step takes 70 for vehicle and contacts and, with an axle on the bridge, 14 for what lies
        below the contacts and 45 for three modes; a response takes 9. Comparisons, and what
        finding the steps of the extremes repeats, do not count.
        """
        t = self.tables
        on = t.steps + 1 - t.first
        entries = len(t.stop_responses)
        return 70 * t.steps + 59 * on, 9 * (COUNT * on + entries) + 15 * len(t.stops)
