"""Random crossings of the 1973 bridge as a careful Numba loop, the peer of `sw.ensemble`.

Every crossing has its own road, given as elevations under the axles from a pool made beforehand:
unlike the engine, the peer synthesises none. All samples move alike, so one table of geometry
serves them, here with the speed in it too, which the engine leaves free.

Of the layouts tried this is the fastest. A crossing for each iteration of `prange`, with its state
in registers, cannot use vectors in the step, whose contacts follow one from the other, and reads
all influence rows anew: a third of this speed with responses innermost in the recovery, half with
instants innermost. 4 or 16 lanes, and chunks of 32 or 128 steps, are slower than 8 and 64.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numba
import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit, prange, types
from numba.extending import intrinsic
from numba.np.ufunc.parallel import get_thread_id
from numpy.typing import NDArray

import spanwise as sw

Array: TypeAlias = NDArray[np.float64]

BRIDGE = sw.Bridge(spans=[18.288] * 2, EI=1941464053.44, mass=6037.70066, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
SECTIONS = np.linspace(0.0, 36.576, 25)
SPEED, MODES, APPROACH, RAMP, ADVANCE, BETA = 22.86, 3, 30.0, 10.0, 0.02286, 1.0 / 6.0
SEED, PERIOD, ROADS, RUNS = 7, 128.0, 64, 5

#: Crossings side by side: their steps fill vectors, and they share what they read of the tables.
LANES = 8

#: Steps recovered together, so that their states and influence rows stay near the processor.
CHUNK = 64

#: As many threads as there are cores, unless NUMBA_NUM_THREADS says otherwise.
THREADS: int = numba.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]

#: Largest deviation that fast arithmetic excuses, by the largest of a kind.
AGREED = 1e-9

# ---- Tables: what all samples share. ----


@dataclass(frozen=True)
class Tables:
    """Responses are deflections, moments, shears left and right of the sections, and reactions,
    filled up to whole vectors; instants those with an axle on the bridge, filled up to chunks.
    What is filled up is zero, which no extreme of a bridge that starts at rest can miss.
    """

    steps: int
    h: float
    #: First step with an axle on the bridge, which is at rest until then.
    first: int
    #: Positions, shape (steps + 1, axles).
    x: Array
    #: By step what the step takes, in the order of `step_of`.
    rows: Array
    #: What holds for all steps, in the order of `step_of`.
    constants: Array
    #: rho, shape (modes, responses).
    rho: Array
    #: g, shape (chunks, responses, axles, CHUNK).
    influence: Array
    #: Instants between steps: the step after, the first of its entries and the one past the last.
    stops: NDArray[np.int64]
    #: How far through the step, shape (stops,).
    fractions: Array
    #: Response of every entry.
    stop_responses: NDArray[np.int64]
    #: g of its axles, shape (entries, axles).
    stop_influence: Array


def responses() -> list[tuple[Any, float]]:
    """Quantity and place of every response."""
    kinds = ("deflection", "moment", "shear-left", "shear-right")
    listed: list[tuple[Any, float]] = [(kind, float(x)) for kind in kinds for x in SECTIONS]
    return listed + [("reaction", x) for x, _ in BRIDGE.supports]


COUNT = len(responses())
PADDED = -(-COUNT // 8) * 8
KINDS = {
    "deflection": slice(0, 25),
    "moment": slice(25, 50),
    "shear": slice(50, 100),
    "reactions": slice(100, 103),
}


def modal_factors(omega: Array) -> Array:
    """rho, the responses to the loads M Phi Omega^2 of each mode, shape (responses, modes)."""
    rho = np.zeros((PADDED, MODES))
    momentum = BRIDGE.modes(MODES).shapes * BRIDGE.masses[:, None]
    for r, (kind, section) in enumerate(responses()):
        # A mass on the section itself is left of the right face only.
        line = BRIDGE.influence_line(kind, section, BRIDGE.stations, side="right")
        if kind == "shear-right":
            own = np.abs(BRIDGE.stations - section) < 1e-9
            line[own] = BRIDGE.influence_line(kind, section, BRIDGE.stations, side="left")[own]
        rho[r] = omega**2 * (line @ momentum)
    return rho


def influence(x: Array, rho: Array, omega: Array, side: sw.bridge.Side = "right") -> Array:
    """g(x) = IL(x) - sum of rho phi(x)/omega^2, zero off the bridge; shape (responses, x)."""
    g = np.zeros((PADDED, len(x)))
    on = (x >= 0.0) & (x <= BRIDGE.length)
    phi = BRIDGE.mode_shapes(MODES, x[on]) / omega**2
    for r, (kind, section) in enumerate(responses()):
        g[r, on] = BRIDGE.influence_line(kind, section, x[on], side=side) - phi @ rho[r]
    return g


def tables() -> Tables:
    """The tables of the headline case."""
    omega = BRIDGE.modes(MODES).omega
    rho = modal_factors(omega)
    at = np.array([axle.position for axle in TRUCK.axles])
    path = APPROACH + BRIDGE.length + at[0] - at[-1]
    steps = int(np.ceil(path / ADVANCE - 1e-9))
    h = path / steps / SPEED
    x = -APPROACH + path / steps * np.arange(steps + 1)[:, None] - (at[0] - at)
    on = (x >= 0.0) & (x <= BRIDGE.length)
    first = int(np.argmax(on.any(axis=1)))

    # Contacts: p = max(-P_st, min(max(stick, slip back), slip)), solved for p with its own part of
    # S; laws that rise keep their order when solved.
    phi = np.zeros((steps + 1, 2, MODES))
    for k in range(2):
        phi[on[:, k], k] = BRIDGE.mode_shapes(MODES, x[on[:, k], k])
    stiffened = 1.0 + BETA * h**2 * omega**2
    psi = phi / stiffened
    below = BETA * h**2 * np.einsum("tkm,tjm->tkj", phi, psi)
    assert TRUCK.mass is not None
    assert TRUCK.pitch_inertia is not None
    above = 1.0 / TRUCK.mass + np.outer(at, at) / TRUCK.pitch_inertia
    s = below + BETA * h**2 * above
    own, other = np.einsum("tkk->tk", s), s[:, :1, 1]
    tyre = np.array([axle.tyre_stiffness for axle in TRUCK.axles])
    spring = np.array([axle.suspension_stiffness for axle in TRUCK.axles])
    limit = np.array([axle.friction_limit for axle in TRUCK.axles])
    load = np.asarray(TRUCK.static_loads())
    both = tyre * spring / (tyre + spring)
    stick, slip = tyre / (1.0 + tyre * own), both / (1.0 + both * own)
    friction = limit * tyre / (tyre + spring) / (1.0 + both * own)
    # A sweep over both axles takes the error of the one before by this squared, as no law rises
    # more steeply; two sweeps are exact.
    assert np.max(np.abs(other) * stick) ** 3 < 1e-12
    columns = [psi[:, 0], psi[:, 1], -below @ load, stick, slip, friction]
    rows = np.hstack([*columns, other * stick, other * slip])
    constants = np.hstack(
        [
            [h, (0.5 - BETA) * h**2, BETA * h**2, 0.5 * h],
            omega**2 / stiffened,
            [above[0, 0], above[0, 1], above[1, 1]],
            1.0 / spring,
            limit / spring,
            load,
        ]
    )

    chunks = -(-(steps + 1 - first) // CHUNK)
    by_axle = np.zeros((2, PADDED, chunks * CHUNK))
    for k in range(2):
        by_axle[k, :, : steps + 1 - first] = influence(x[first:, k], rho, omega)
    g = by_axle.reshape(2, PADDED, chunks, CHUNK).transpose(2, 1, 0, 3)

    stops: list[tuple[int, int, int]] = []
    fractions: list[float] = []
    entries: list[tuple[int, Array]] = []
    tips = {0: (75, -1.0, "right"), 24: (74, 1.0, "left")}
    for k in range(2):
        for j, section in enumerate(SECTIONS):
            step = int(np.argmax(x[:, k] >= section - 1e-9))
            fraction = (section - x[step - 1, k]) / (x[step, k] - x[step - 1, k])
            between = x[step - 1] + fraction * (x[step] - x[step - 1])
            begin = len(entries)
            sides: tuple[sw.bridge.Side, ...] = ("left", "right")
            for side in sides:
                weights = influence(between, rho, omega)
                # Beyond an end the axle is off the bridge.
                off = j in tips and side != tips[j][2]
                there = influence(SECTIONS[j : j + 1], rho, omega, side)[:, 0]
                weights[:, k] = 0.0 if off else there
                # At an end everything counts, else what is looked at there.
                looked = range(COUNT) if j in tips else range(j, 100, 25)
                entries += [(r, weights[r]) for r in looked]
                if j in tips and not off:
                    # On the end itself the axle is beyond the section that looks from inside.
                    r, sign, _ = tips[j]
                    entries.append((r, weights[r] + sign * (np.arange(2) == k)))
            stops.append((step, begin, len(entries)))
            fractions.append(fraction)
    return Tables(
        steps=steps,
        h=h,
        first=first,
        x=x,
        rows=np.ascontiguousarray(rows),
        constants=constants,
        rho=np.ascontiguousarray(rho.T),
        influence=np.ascontiguousarray(g),
        stops=np.array(stops),
        fractions=np.array(fractions),
        stop_responses=np.array([r for r, _ in entries]),
        stop_influence=np.array([weights for _, weights in entries]),
    )


def road(number: int) -> sw.ISO8608:
    """The road of a sample."""
    return sw.ISO8608("B", seed=SEED, sample=number, period=PERIOD)


def elevations(x: Array) -> Array:
    """Elevations under the axles, shape (blocks of lanes, steps + 1, axles x lanes)."""
    t = np.clip((x + APPROACH) / RAMP, 0.0, 1.0)
    fade = t**3 * (10.0 + t * (6.0 * t - 15.0))
    each = np.array([fade * road(number).elevation(x) for number in range(ROADS)])
    blocks = each.reshape(ROADS // LANES, LANES, *x.shape).transpose(0, 2, 3, 1)
    return np.ascontiguousarray(blocks).reshape(ROADS // LANES, len(x), 2 * LANES)


# ---- The loop. ----

FAST: dict[str, Any] = {"fastmath": True, "error_model": "numpy"}


def extreme_of_two(name: str) -> Any:
    """The larger or smaller of two as one instruction.

    Python's own become a comparison and a choice, in which LLVM does not see a reduction.
    """

    @intrinsic
    def of_two(typing: Any, a: Any, b: Any) -> Any:
        def build(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
            double = ir.DoubleType()
            kind = ir.FunctionType(double, [double, double])
            function = builder.module.declare_intrinsic(name, [double], kind)
            return builder.call(function, arguments, fastmath=("fast",))

        return types.float64(types.float64, types.float64), build

    return of_two


larger, smaller = extreme_of_two("llvm.maxnum"), extreme_of_two("llvm.minnum")

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
def find(kept: Array, rho: Array, g: Array, r: int, sign: float, room: Array) -> float:
    """Where in a chunk a response is largest, or smallest with the sign turned.

    In `room` stand the values, then the numbers 0, 1, 2 and so on, so that nothing is converted.
    """
    f0, f1, f2 = sign * rho[0, r], sign * rho[1, r], sign * rho[2, r]
    best, where = 0.0, float(CHUNK)
    for t in range(CHUNK):
        loads = g[0, t] * kept[3, t] + g[1, t] * kept[4, t]
        value = f0 * kept[0, t] + f1 * kept[1, t] + f2 * kept[2, t] + sign * loads
        room[t] = value
        best = larger(best, value)
    for t in range(CHUNK):
        where = smaller(where, room[CHUNK + t] if room[t] == best else float(CHUNK))
    return where


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
    likewise by axle. `kept` is room for A and P: shape (chunks + 1, lanes, 5, CHUNK), its last
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
    # Until the step of an extreme is known, -1 - its chunk stands for it.
    for t in range(1, first):
        step_before(st, rows[t], constants, elevation[t], float(t))
    for s in range(L):
        for q in range(5):
            kept[chunks, s, q, CHUNK - 1] = st[(KEPT + q) * L + s]
    for j in range(chunks):
        begin = first + j * CHUNK
        steps = min(CHUNK, len(rows) - begin)
        if steps < CHUNK:
            kept[j] = 0.0
        for t in range(steps):
            now = begin + t
            step_on(st, rows[now], constants, elevation[now], float(now))
            for s in range(L):
                for q in range(5):
                    kept[j, s, q, t] = st[(KEPT + q) * L + s]
        for r in range(0, count, 2):
            for s in range(L):
                look(kept[j, s], rho, influence[j, r : r + 2], r, top[s], bottom[s])
        for s in range(L):
            high, low, own = top[s], bottom[s], found[s]
            chunk = -1.0 - j
            for r in range(count):
                own[1, r] = chunk if high[r] > own[0, r] else own[1, r]
                own[0, r] = larger(own[0, r], high[r])
                own[3, r] = chunk if low[r] < own[2, r] else own[3, r]
                own[2, r] = smaller(own[2, r], low[r])
    for i in range(len(stops)):
        step, begin, end = stops[i, 0], stops[i, 1], stops[i, 2]
        fraction = fractions[i]
        before, after = step - 1 - first, step - first
        j, t = (before // CHUNK, before % CHUNK) if before >= 0 else (chunks, CHUNK - 1)
        for s in range(L):
            own, b, a = found[s], kept[j, s], kept[after // CHUNK, s]
            n = after % CHUNK
            a0 = b[0, t] + fraction * (a[0, n] - b[0, t])
            a1 = b[1, t] + fraction * (a[1, n] - b[1, t])
            a2 = b[2, t] + fraction * (a[2, n] - b[2, t])
            p0 = b[3, t] + fraction * (a[3, n] - b[3, t])
            p1 = b[4, t] + fraction * (a[4, n] - b[4, t])
            for e in range(begin, end):
                r = stop_responses[e]
                value = rho[0, r] * a0 + rho[1, r] * a1 + rho[2, r] * a2
                value += stop_influence[e, 0] * p0 + stop_influence[e, 1] * p1
                if value > own[0, r]:
                    own[0, r], own[1, r] = value, step - 1 + fraction
                if value < own[2, r]:
                    own[2, r], own[3, r] = value, step - 1 + fraction
    # Only where no stop has gone beyond it.
    for s in range(L):
        own = found[s]
        for r in range(count):
            for side in range(2):
                if own[2 * side + 1, r] >= 0.0:
                    continue
                j = -1 - int(own[2 * side + 1, r])
                sign = 1.0 - 2.0 * side
                where = find(kept[j, s], rho, influence[j, r], r, sign, numbered)
                own[2 * side + 1, r] = first + j * CHUNK + where
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


class Peer:
    """The loop with its tables."""

    def __init__(self, samples: int) -> None:
        self.tables = t = tables()
        self.pool = elevations(t.x)
        chunks = len(t.influence)
        self.room = np.zeros((THREADS, chunks + 1, LANES, 5, CHUNK))
        # Touched here, so that no run pays for new pages.
        self.found = np.full((samples, 4, PADDED), np.nan)
        self.loads = np.full((samples, 4, 2), np.nan)

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


# ---- Agreement. ----


def deviation(values: Array, others: Array) -> float:
    """Largest difference by the largest of the kind."""
    return float(np.abs(values - others).max() / np.abs(others).max())


def envelopes(found: Array, loads: Array) -> dict[str, Array]:
    """By kind largest, its step, smallest, its step; both sides of shear together."""
    by_kind = {kind: found[:, where] for kind, where in KINDS.items()} | {"axle_loads": loads}
    left, right = by_kind["shear"][:, :25], by_kind["shear"][:, 25:]
    most = np.where(left[0] >= right[0], left[:2], right[:2])
    least = np.where(left[2] <= right[2], left[2:], right[2:])
    return by_kind | {"shear": np.concatenate([most, least])}


def against_crossings(peer: Peer, numbers: tuple[int, ...]) -> tuple[float, float]:
    """Deviation from `sw.cross`: of extremes, and of the steps at which they occur."""
    worst, apart = 0.0, 0.0
    for number in numbers:
        run = sw.cross(
            BRIDGE,
            TRUCK,
            speed=SPEED,
            modes=MODES,
            drive="constant-speed",
            approach=APPROACH,
            ramp=RAMP,
            road=road(number % ROADS),
            step=peer.tables.h * (1.0 + 1e-12),
            sections=SECTIONS.tolist(),
        )
        assert len(run.time) == peer.tables.steps + 1
        for kind, found in envelopes(peer.found[number], peer.loads[number]).items():
            envelope = run.envelope(kind)  # type: ignore[arg-type]
            values = np.concatenate([envelope.max.value, envelope.min.value])
            times = np.concatenate([envelope.max.time, envelope.min.time])
            worst = max(worst, deviation(np.concatenate([found[0], found[2]]), values))
            steps = np.concatenate([found[1], found[3]])
            apart = max(apart, float(np.abs(steps - times / peer.tables.h).max()))
    return worst, apart


def against_ensemble(peer: Peer, ensemble: Any) -> float:
    """Deviation from the first samples of `sw.ensemble`."""
    worst = 0.0
    for number in range(min(ROADS, len(peer.found))):
        for kind, found in envelopes(peer.found[number], peer.loads[number]).items():
            extremes = getattr(ensemble, kind, None)
            if extremes is not None:
                worst = max(worst, deviation(found[0], np.asarray(extremes.max)[number]))
                worst = max(worst, deviation(found[2], np.asarray(extremes.min)[number]))
    return worst


# ---- Timing. ----


def timed(runs: list[Callable[[], object]]) -> list[list[float]]:
    """Times [s] of runs that take turns, so that a busy machine treats them alike."""
    times: list[list[float]] = [[] for _ in runs]
    for _ in range(RUNS):
        for run, own in zip(runs, times, strict=True):
            started = time.perf_counter()
            run()
            own.append(time.perf_counter() - started)
    return times


def report(what: str, samples: int, times: list[float]) -> None:
    """Prints crossings per second."""
    median, least = statistics.median(times), min(times)
    print(
        f"{what}: {samples / median:.0f} crossings/s, median of {RUNS}; {samples / least:.0f} best"
    )


def main() -> None:
    """Checks, then times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=4000, help="crossings, a multiple of lanes")
    samples = int(parser.parse_args().samples)
    if samples < ROADS or samples % LANES:
        parser.error(f"--samples {samples}: must be a multiple of {LANES}, at least {ROADS}")
    started = time.perf_counter()
    peer = Peer(samples)
    print(f"tables and {ROADS} roads: {time.perf_counter() - started:.1f} s")
    started = time.perf_counter()
    peer.run()
    print(f"compiling and warming up: {time.perf_counter() - started:.1f} s")

    worst, apart = against_crossings(peer, (0, 1, 2, 21, 42, samples - 1))
    print(f"against sw.cross: extremes to {worst:.1e} of the largest, steps to {apart:.1e}")
    assert worst < AGREED
    stepping, recovery = peer.operations()
    total = stepping + recovery
    print(f"a crossing: {stepping} + {recovery} = {total / 1e6:.3f} million floating operations")

    for count in sorted({1, THREADS}):
        numba.set_num_threads(count)
        (times,) = timed([peer.run])
        report(f"numba, threads: {count}", samples, times)
        gigaflops = total * samples / statistics.median(times) / 1e9
        print(f"  {gigaflops:.1f} GFLOP/s")

    if not hasattr(sw, "ensemble"):
        return

    def engine() -> Any:
        return sw.ensemble(  # type: ignore[attr-defined, unused-ignore]
            BRIDGE,
            TRUCK,
            samples=samples,
            seed=SEED,
            road=sw.ISO8608("B", period=PERIOD),
            speed=SPEED,
            modes=MODES,
            approach=APPROACH,
            ramp=RAMP,
            advance=ADVANCE,
            sections=SECTIONS,
        )

    worst = against_ensemble(peer, engine())
    print(f"against sw.ensemble: extremes to {worst:.1e} of the largest")
    assert worst < AGREED
    by_peer, by_engine = timed([peer.run, engine])
    report("numba", samples, by_peer)
    report("sw.ensemble", samples, by_engine)
    ratio = statistics.median(by_peer) / statistics.median(by_engine)
    print(f"sw.ensemble, which makes its roads itself, is {ratio:.2f} times as fast")


if __name__ == "__main__":
    main()
