"""The headline case of the ensemble from Python: crossings per second, everything included.

Run it with ``make headline`` or ``python benches/headline.py --samples 100000``. The last line has
the rate, the instruction set and the fingerprint of all results, the same on every machine.
"""

from __future__ import annotations

import argparse
from typing import Any, Final

import numpy as np

import spanwise as sw

LENGTH: Final = 36.576
SECTIONS: Final = 25
ROAD_CLASS: Final = "B"
WARM_UP: Final = 2000

PARAMETERS: Final[dict[str, Any]] = {
    "modes": 3,
    "damping": 0.0,
    "approach": 30.0,
    "ramp": 10.0,
    "speed": 22.86,
    "advance": 0.02286,
    "beta": 1.0 / 6.0,
    "seed": 7,
}


def headline(samples: int, threads: int | None) -> sw.Ensemble:
    """The truck of 1973 on its bridge, each time on a road of its own."""
    bridge = sw.Bridge(
        spans=[LENGTH / 2] * 2, EI=1941464053.44, mass=6037.70066, stations_per_span=3
    )
    return sw.ensemble(
        bridge,
        sw.vehicles.kishan_1973(),
        samples=samples,
        road=sw.ISO8608(ROAD_CLASS, period=128.0),
        sections=np.linspace(0.0, LENGTH, SECTIONS).tolist(),
        quantities=["deflection", "moment", "shear", "reactions"],
        tail=0.0,
        threads=threads,
        **PARAMETERS,
    )


def main() -> None:
    """Warm up, run, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=100_000, help="crossings (default: 100000)")
    parser.add_argument("--threads", type=int, help="threads (default: all)")
    options = parser.parse_args()
    headline(min(WARM_UP, options.samples), options.threads)
    found = headline(options.samples, options.threads)
    given = ", ".join(f"{name} {value:g}" for name, value in PARAMETERS.items())
    print("bridge    2 x 18.288 m, 3 masses a span; vehicle kishan-1973")
    print(f"road      ISO 8608 class {ROAD_CLASS}, period 128 m, another for each sample")
    print(f"settings  {given}")
    print(f"looked at {SECTIONS} sections: {', '.join(found.quantities)}")
    print(f"threads   {found.threads}; {found.elapsed:.2f} s; {len(found.failures)} failures")
    print(
        f"headline: {found.rate:.0f} crossings/s, {found.samples} samples, {found.isa}, "
        f"hash {found.hash}"
    )


if __name__ == "__main__":
    main()
