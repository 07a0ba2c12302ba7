"""What the Numba peers of the headline case share: its tables and roads, and what follows recovery.

Every crossing has its own road, given as elevations under the axles from a pool made beforehand:
unlike the engine, the peers synthesise none. All samples move alike, so one table of geometry
serves them, here with the speed in it too, which the engine leaves free.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numba
import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

import spanwise as sw

Array: TypeAlias = NDArray[np.float64]

BRIDGE = sw.Bridge(spans=[18.288] * 2, EI=1941464053.44, mass=6037.70066, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()
SECTIONS = np.linspace(0.0, 36.576, 25)
SPEED, MODES, APPROACH, RAMP, ADVANCE, BETA = 22.86, 3, 30.0, 10.0, 0.02286, 1.0 / 6.0
SEED, PERIOD, ROADS = 7, 128.0, 64

#: Steps recovered together, so that their states and influence rows stay near the processor.
CHUNK = 64

#: As many threads as there are cores, unless NUMBA_NUM_THREADS says otherwise.
THREADS: int = numba.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]

# ---- Tables: what all samples share. ----


def aligned(values: Array) -> Array:
    """A copy that starts where a cache line does, as vectors across two lines take longer."""
    bare = np.empty(values.size + 8)
    start = -bare.ctypes.data % 64 // 8
    copy = bare[start : start + values.size].reshape(values.shape)
    copy[:] = values
    return copy


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
        influence=aligned(g),
        stops=np.array(stops),
        fractions=np.array(fractions),
        stop_responses=np.array([r for r, _ in entries]),
        stop_influence=np.array([weights for _, weights in entries]),
    )


def road(number: int) -> sw.ISO8608:
    """The road of a sample."""
    return sw.ISO8608("B", seed=SEED, sample=number, period=PERIOD)


def elevations(x: Array) -> Array:
    """Elevations under the axles, shape (roads, steps + 1, axles)."""
    t = np.clip((x + APPROACH) / RAMP, 0.0, 1.0)
    fade = t**3 * (10.0 + t * (6.0 * t - 15.0))
    return np.array([fade * road(number).elevation(x) for number in range(ROADS)])


class Peer(ABC):
    """A loop over crossings with its tables; its results stay in place from run to run."""

    name: ClassVar[str]

    def __init__(self, tables: Tables, samples: int) -> None:
        self.tables = tables
        # Touched here, so that no run pays for new pages.
        #: Largest, its step, smallest, its step of every response, shape (samples, 4, responses).
        self.found = np.full((samples, 4, PADDED), np.nan)
        #: Likewise by axle, shape (samples, 4, axles).
        self.loads = np.full((samples, 4, 2), np.nan)

    @abstractmethod
    def run(self) -> None:
        """All samples."""


# ---- Compiled: arithmetic, and what happens to a crossing once its chunks are looked at. ----

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


@njit(**FAST)  # type: ignore[untyped-decorator]
def take_chunk(own: Array, high: Array, low: Array, j: int) -> None:
    """Takes in the extremes of a chunk.

    Until the step of an extreme is known, -1 - its chunk stands for it.
    """
    chunk = -1.0 - j
    for r in range(PADDED):
        # Read before what decides about it, or LLVM makes branches of the choices, not vectors.
        most, most_at, least, least_at = own[0, r], own[1, r], own[2, r], own[3, r]
        own[1, r] = chunk if high[r] > most else most_at
        own[3, r] = chunk if low[r] < least else least_at
        own[0, r], own[2, r] = larger(most, high[r]), smaller(least, low[r])


@njit(**FAST)  # type: ignore[untyped-decorator]
def take_stops(
    own: Array,
    kept: Array,
    first: int,
    rho: Array,
    stops: NDArray[np.int64],
    fractions: Array,
    stop_responses: NDArray[np.int64],
    stop_influence: Array,
) -> None:
    """Takes in the instants with an axle on a section.

    `kept` has A and P by chunk, shape (chunks + 1, 5, CHUNK), its last chunk the instant before the
    first.
    """
    for i in range(len(stops)):
        step, begin, end = stops[i, 0], stops[i, 1], stops[i, 2]
        fraction = fractions[i]
        before, after = step - 1 - first, step - first
        j, t = (before // CHUNK, before % CHUNK) if before >= 0 else (len(kept) - 1, CHUNK - 1)
        b, a, n = kept[j], kept[after // CHUNK], after % CHUNK
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
def find_steps(
    own: Array, kept: Array, first: int, rho: Array, influence: Array, room: Array
) -> None:
    """Puts the step of an extreme for its chunk, only where no stop has gone beyond it."""
    for r in range(own.shape[1]):
        for side in range(2):
            if own[2 * side + 1, r] >= 0.0:
                continue
            j = -1 - int(own[2 * side + 1, r])
            sign = 1.0 - 2.0 * side
            where = find(kept[j], rho, influence[j, r], r, sign, room)
            own[2 * side + 1, r] = first + j * CHUNK + where
