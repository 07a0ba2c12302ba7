"""What takes long before anything moves ends when it is interrupted, and is bounded.

`python tests/test_interrupts.py` lists how long each takes to end.
"""

from __future__ import annotations

import functools
import signal
import sys
import time
from typing import Any

import numpy as np
import pytest

import spanwise as sw

#: How long work goes on before the signal comes [s].
UNDISTURBED = 0.05

#: Most time from the signal to its exception [s]: half a second, and more on slower machines.
PATIENCE = 1.5

#: Seventy wagons of four axles.
TRAIN = """
def axle(x):
    return sw.Axle(position=x, mass=1500.0, tyre_stiffness=1e9, suspension_stiffness=2e6)

bodies = []
for wagon in range(70):
    k = len(bodies)
    ahead = [sw.Spring(to=k - 3, at=-13.0, own=13.0, stiffness=1e5)] if k else []
    bodies.append(sw.Body(mass=4e4, pitch_inertia=2e6, springs=ahead))
    for at in (8.0, -8.0):
        secondary = [sw.Spring(to=k, at=at, own=0.0, stiffness=1e6, damping=3e4)]
        axles = [axle(1.2), axle(-1.2)]
        bodies.append(sw.Body(mass=3e3, pitch_inertia=3e3, axles=axles, springs=secondary))
"""

#: Long preparations: what is made once, and what is repeated until the signal comes.
LONG = {
    "redundant supports": (
        "",
        "sw.Bridge(spans=[20.0] * 1500, EI=3e9, mass=9e3, stations_per_span=1).modes(2)",
    ),
    "hinges": (
        "",
        "sw.Bridge(spans=[20.0] * 1500, hinges=[20.0 * i for i in range(1, 1500)], EI=3e9,"
        " mass=9e3, stations_per_span=1)",
    ),
    "stations": (
        "",
        "sw.Bridge(spans=[20.0], EI=3e9, mass=9e3, stations_per_span=1999).modes(2)",
    ),
    "sections": (
        "b = sw.Bridge(spans=[20.0] * 300, EI=3e9, mass=9e3, stations_per_span=1)\n"
        "b.modes(2)",
        "sw.cross(b, TRUCK, speed=30.0, damping=0.02, modes=2,"
        " sections=np.linspace(0.0, 5999.0 + np.random.rand(), 1500))",
    ),
    "an influence line": (
        "b = sw.Bridge(spans=[20.0] * 1500, EI=3e9, mass=9e3, stations_per_span=1)",
        "b.influence_line('moment', 100.0, [1.0, 2.0])",
    ),
    "a damping matrix": (
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3, stations_per_span=1000)\n"
        "b.modes(800)",
        "sw.cross(b, TRUCK, speed=30.0, modes=2, step=0.01, beta=0.25,"
        " damping=np.eye(1000) * (1.0 + np.random.rand()))",
    ),
    "given flexibility": (
        "x = np.linspace(0.0, 20.0, 1502)[1:-1]\n"
        "a, c = np.minimum.outer(x, x), np.maximum.outer(x, x)\n"
        "f = a * (20.0 - c) * (400.0 - (20.0 - c) ** 2 - a**2) / (6.0 * 3e9 * 20.0)",
        "sw.Bridge.from_flexibility(stations=x, flexibility=f, masses=np.full(1500, 9.0),"
        " supports=[(0.0, 'pinned'), (20.0, 'pinned')], length=20.0).modes(2)",
    ),
    "a long train": (TRAIN, "sw.Vehicle(bodies=bodies)"),
    "its crossing": (
        TRAIN + "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)\n"
        "train = sw.Vehicle(bodies=bodies)",
        "sw.cross(b, train, speed=60.0, damping=0.02, modes=1, step=0.05, beta=0.25)",
    ),
    "many masses": (
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)\n"
        "train = sw.MovingMasses(masses=[100.0] * 500, spacings=[2.0] * 499)",
        "sw.cross(b, train, speed=60.0, damping=0.02, modes=1, step=0.005, beta=0.25)",
    ),
    "static loads": (
        "from spanwise._plan_of_arguments import Asked, plan_of\n"
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)\n"
        "masses = {'body_mass': np.linspace(0.9, 1.1, 300000)}\n"
        "plan, _ = plan_of(b, TRUCK, Asked(samples=300000, speed=20.0, damping=0.02,"
        " factors=masses))",
        "plan.static_loads()",
    ),
    "a varied train": (
        TRAIN + "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)\n"
        "train = sw.Vehicle(bodies=bodies)",
        "sw.ensemble(b, train, samples=8, speed=60.0, damping=0.02, modes=1, step=0.05, beta=0.25,"
        " factors={'body_mass': np.linspace(0.9, 1.1, 8)})",
    ),
    "modes damped together": (
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3, stations_per_span=1000)\n"
        "b.modes(800)",
        "sw.cross(b, TRUCK, speed=30.0, modes=800, step=0.01, beta=0.25, sections=[10.0],"
        " damping=np.eye(1000) * (1.0 + np.random.rand()))",
    ),
    "a large table": (
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)\n"
        "train = sw.ForceTrain(loads=np.ones(200), spacings=np.full(199, 2.0))",
        "sw.ensemble(b, train, samples=16, speed=20.0, damping=0.02,"
        " sections=np.linspace(0.01, 19.0 + np.random.rand(), 500))",
    ),
    "a road of many points": (
        "",
        "sw.ISO8608('A', band=(0.01, 100.0), period=10000.0, seed=1).iri(0.0, 100.0)",
    ),
    "a sum of roads": (
        "road = sum([sw.ISO8608('A', band=(0.01, 40.0), period=8192.0)] * 40, sw.Smooth())",
        "road.iri(0.0, 100.0)",
    ),
    "a sum of roads, averaged": (
        "road = sum([sw.ISO8608('A', band=(0.01, 40.0), period=8192.0)] * 40, sw.Smooth())",
        "road.psd(0.0, 900.0)",
    ),
    "a long profile": (
        "x = np.arange(8_000_000) * 1e-3\n"
        "r = 0.01 * np.sin(x)",
        "sw.Profile(x, r)",
    ),
    "its roughness": (
        "x = np.arange(1_000_000) * 1e-3\n"
        "road = sw.Profile(x, 0.01 * np.sin(x))",
        "road.iri(0.0, 900.0)",
    ),
    "many threads": (
        "b = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)",
        "sw.ensemble(b, TRUCK, samples=50000, speed=20.0, damping=0.02, threads=2048)",
    ),
    "an ensemble": (
        "b = sw.Bridge(spans=[18.288] * 2, EI=1.94148e9, mass=6037.7, stations_per_span=3)",
        "sw.ensemble(b, TRUCK, samples=60000, speed=20.0, road=sw.ISO8608('B'), damping=0.0)",
    ),
    "an ensemble in time": (
        "b = sw.Bridge(spans=[18.288] * 2, EI=1.94148e9, mass=6037.7, stations_per_span=3)",
        "sw.ensemble(b, TRUCK, samples=60000, speed=20.0, road=sw.ISO8608('B'), damping=0.0,"
        " drive='constant-traction')",
    ),
    "the bridge of an ensemble": (
        "b = sw.Bridge(spans=[20.0] * 8, EI=2e9, mass=6e3, stations_per_span=20)\n"
        "b.modes(3)",
        "sw.ensemble(b, TRUCK, samples=1, speed=20.0, modes=3, damping=0.0,"
        " sections=np.linspace(0.0, 159.0 + np.random.rand(), 900))",
    ),
}  # fmt: skip


@functools.cache
def prepared(before: str) -> dict[str, object]:
    """What some have in common is made once."""
    names: dict[str, object] = {"np": np, "sw": sw, "TRUCK": sw.vehicles.kishan_1973()}
    exec(compile(before, "before", "exec"), names)
    return names


def latency(what: str) -> float:
    """Time from a signal amid the work to its exception [s].

    By the clock or of the processor, whichever is less: noise lengthens one, threads the other.
    """
    before, text = LONG[what]
    names, again = prepared(before), compile(text, what, "exec")
    # From the system's clock: a thread would have to wait for work that keeps the interpreter.
    handler = signal.signal(signal.SIGALRM, signal.default_int_handler)
    started = time.perf_counter(), time.process_time()
    signal.setitimer(signal.ITIMER_REAL, UNDISTURBED)
    try:
        while True:
            exec(again, names)
    except KeyboardInterrupt:
        ended = time.perf_counter(), time.process_time()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, handler)
    return min(end - start for start, end in zip(started, ended, strict=True)) - UNDISTURBED


@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
@pytest.mark.parametrize("what", LONG)
def test_what_is_prepared_ends_when_it_is_interrupted(what: str) -> None:
    assert latency(what) < PATIENCE


@pytest.mark.skipif(sys.platform == "win32", reason="signals differ")
def test_a_bridge_serves_on_after_an_interrupt(start: Any) -> None:
    program = """
        import signal
        import spanwise as sw

        signal.signal(signal.SIGALRM, signal.default_int_handler)
        bridge = sw.Bridge(spans=[20.0] * 400, EI=3e9, mass=9e3, stations_per_span=1)
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        try:
            while True:
                bridge.flexibility("actual")
        except KeyboardInterrupt:
            pass
        again = sw.Bridge(spans=[20.0] * 400, EI=3e9, mass=9e3, stations_per_span=1)
        assert (bridge.modes(2).frequencies == again.modes(2).frequencies).all()
    """
    done = start(program).wait()
    assert done.stderr == ""


def test_what_nobody_has_is_refused_before_it_takes_an_hour() -> None:
    axles = [
        sw.Axle(position=-float(i), mass=10.0, tyre_stiffness=1e6, suspension_stiffness=1e6)
        for i in range(3000)
    ]
    with pytest.raises(ValueError, match=r"axles = 3000 axles: at most 500 of one vehicle"):
        sw.Vehicle(mass=1e5, pitch_inertia=1e6, axles=axles)
    many = [sw.Body(mass=1.0)] * 501
    with pytest.raises(ValueError, match=r"bodies = 501 bodies: at most 500 of one vehicle"):
        sw.Vehicle(bodies=many)
    springs = [sw.Spring(to=0, at=0.0, own=0.0, stiffness=1.0)] * 2001
    pair = [sw.Body(mass=1.0), sw.Body(mass=1.0, springs=springs)]
    with pytest.raises(ValueError, match=r"couplings = 2001 couplings: at most 2000"):
        sw.Vehicle(bodies=pair)


@pytest.mark.parametrize("hinged", [False, True])
def test_a_viaduct_of_many_spans_is_as_one_of_few(hinged: bool) -> None:
    # Far from the ends of a continuous beam its length does not matter.
    def deflection(spans: int) -> float:
        at = 20.0 * (spans // 2) + 10.0
        hinges = [20.0 * (spans // 2) + x for x in (4.0, 56.0)] if hinged else []
        bridge = sw.Bridge(
            spans=[20.0] * spans, hinges=hinges, EI=3e9, mass=9e3, stations_per_span=1
        )
        return float(bridge.deflections([at], [at])[0, 0])

    few = deflection(21)
    assert deflection(61) == pytest.approx(few, rel=1e-8)
    assert deflection(801) == pytest.approx(few, rel=1e-4)


if __name__ == "__main__":
    for name in LONG:
        print(f"| {name} | {latency(name):.2f} s |")
