"""One crossing of the 1973 example from Python, alone and with every history fetched."""

from __future__ import annotations

import statistics
import time

import spanwise as sw
from spanwise.traffic import Drive, Plain

CALLS = 400
HISTORIES = ("deflection", "moment", "shear_left", "shear_right", "reactions")


def crossed(drive: Drive, *, fetch: bool) -> sw.Run:
    run = sw.cross(
        BRIDGE, TRUCK, speed=22.86, modes=3, damping=0.0, drive=drive, step=1e-3, tail=0.0
    )
    if fetch:
        for name in HISTORIES:
            getattr(run, name), getattr(run.static, name)
        _ = run.time, run.axle_loads, run.vehicle, run.modal
    return run


BRIDGE = sw.Bridge(spans=[18.288] * 2, EI=1941464053.44, mass=6037.70066, stations_per_span=3)
TRUCK = sw.vehicles.kishan_1973()

if __name__ == "__main__":
    drives: tuple[Plain, ...] = ("constant-traction", "constant-speed")
    for drive in drives:
        for fetch in (False, True):
            times = []
            for _ in range(CALLS):
                started = time.perf_counter()
                crossed(drive, fetch=fetch)
                times.append(1e3 * (time.perf_counter() - started))
            what = "with every history" if fetch else "alone"
            print(f"{drive}, {what}: {statistics.median(times):.2f} ms, least {min(times):.2f} ms")
