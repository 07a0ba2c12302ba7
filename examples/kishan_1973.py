"""The example of Kishan and Traill-Nash (1973): a lorry, a bridge of two spans, three modes.

H. Kishan and R. W. Traill-Nash, "Calculation of response and loading of highway bridges from modal
coordinates", IABSE Publications 33 (1973), https://doi.org/10.5169/seals-25635, section 4.

Prints the tables of the paper beside those computed here and draws its figures. Run it with
``make example``, or ``python examples/kishan_1973.py --out DIRECTORY``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

import spanwise as sw
from spanwise.plotting import compare_convergence, compare_impact_factors

HERE = Path(__file__).parent

# The paper computes in feet, pounds and slugs.
FOOT = 0.3048  # m
POUND = 4.4482216152605  # N
SLUG = POUND / FOOT  # kg

# What the paper prints: F* [1e-6 ft/lb], K^R [lb/ft], R* [-] and the mass at a station [slug].
PRINTED_FLEXIBILITY = np.array(
    [
        [0.716, 1.65, 1.94, 1.90, 1.74, 1.19, 0.420],
        [1.65, 4.31, 5.34, 5.26, 4.88, 3.35, 1.19],
        [1.94, 5.34, 7.24, 7.36, 6.95, 4.88, 1.74],
        [1.90, 5.26, 7.36, 7.66, 7.36, 5.26, 1.90],
        [1.74, 4.88, 6.95, 7.36, 7.24, 5.34, 1.94],
        [1.19, 3.35, 4.88, 5.26, 5.34, 4.31, 1.65],
        [0.420, 1.19, 1.74, 1.90, 1.94, 1.65, 0.716],
    ]
)
PRINTED_REDUNDANT_STIFFNESS = 130_500.0
PRINTED_REACTION = np.array([0.917, 0.750, 0.583, 0.500, 0.417, 0.250, 0.0833])
PRINTED_MASS = 2522.0

#: Every foot of the bridge, so that the curves are smooth [m].
SECTIONS = (FOOT * np.arange(121)).tolist()

#: Where the masses are [ft].
MASSES = (10, 30, 50, 70, 90, 110)

NUMBERS = {1: "one mode", 2: "two modes", 3: "three modes"}
FACTORS = ("deflection", "sagging", "hogging")


def main(argv: Sequence[str] | None = None) -> None:
    """Print the tables and write the figures."""
    parser = argparse.ArgumentParser(description="The example of Kishan and Traill-Nash (1973).")
    parser.add_argument(
        "--out", type=Path, default=HERE / "figures", help="directory for the figures"
    )
    out: Path = parser.parse_args(argv).out

    case = sw.Case.read(HERE / "kishan_1973.toml")
    print_bridge(case.bridge)
    print_frequencies(case.bridge, case.vehicle)

    # One crossing for each number of modes, by the method of the paper and by Eq. 2 alone.
    proposed = {n: case.run(modes=n, sections=SECTIONS) for n in NUMBERS}
    direct = {n: case.run(modes=n, sections=SECTIONS, recovery="superposition") for n in NUMBERS}
    print_impact_factors("by force summation, as the paper proposes", proposed)
    print_impact_factors("by direct superposition of the modes", direct)
    print_verdict(proposed, direct)

    out.mkdir(parents=True, exist_ok=True)
    for name, figure in figures(case, proposed, direct):
        save(figure, out / name)
    print(f"\nFigures are in {out}")


def print_bridge(bridge: sw.Bridge) -> None:
    """Masses, flexibility of the basic bridge, redundant stiffness and reaction influence."""
    heading("The bridge, computed and as printed")
    masses = ", ".join(f"{mass / SLUG:.1f}" for mass in bridge.masses)
    print(f"Masses [slug], printed {PRINTED_MASS:.1f}:\n  {masses}")

    at, flexibility = bridge.flexibility("basic")
    # 1 m/N = (1/0.3048 ft) / (1/4.448 lb) = POUND / FOOT ft/lb.
    computed = 1e6 * flexibility * POUND / FOOT
    off = 100.0 * (computed / PRINTED_FLEXIBILITY - 1.0)
    stations = "".join(f"{x / FOOT:8.0f}" for x in at)
    print("\nFlexibility of the basic bridge F* [1e-6 ft/lb] at x [ft]; support B is at 60 ft")
    print(f"{'':10}{stations}")
    for title, matrix, digits in (
        ("computed", computed, "8.4f"),
        ("printed", PRINTED_FLEXIBILITY, "8.4g"),
        ("off [%]", off, "+8.2f"),
    ):
        for x, row in zip(at, matrix, strict=True):
            print(f"{title if x == at[0] else '':10}" + "".join(f"{v:{digits}}" for v in row))
    print(f"Largest difference {np.abs(off).max():.2f} %: the printed values have three digits.")

    stiffness = bridge.redundant_stiffness()[0, 0] * FOOT / POUND
    print(
        f"\nRedundant stiffness K^R [lb/ft]: {stiffness:.0f}, "
        f"printed {PRINTED_REDUNDANT_STIFFNESS:.0f}"
    )
    _, _, reaction = bridge.outer_reactions()[0]
    print("Reaction at A for unit loads R* [-]:")
    print("computed  " + "".join(f"{r:8.4f}" for r in reaction))
    print("printed   " + "".join(f"{r:8.4g}" for r in PRINTED_REACTION))


def print_frequencies(bridge: sw.Bridge, vehicle: sw.vehicles.AnyVehicle) -> None:
    """Natural frequencies of the bridge and of the vehicle on rigid ground."""
    heading("Natural frequencies [Hz]")

    def row(name: str, frequencies: np.ndarray) -> None:
        print(f"{name:42}" + "".join(f"{f:8.3f}" for f in frequencies))

    row("Bridge", bridge.modes(len(bridge.masses)).frequencies)
    row("Vehicle, friction holds: on its tyres", vehicle.frequencies(locked=True))
    row("Vehicle, friction slides: on both springs", vehicle.frequencies(locked=False))


def print_impact_factors(title: str, runs: Mapping[int, sw.Run]) -> None:
    """Impact factors at the mass stations and about support B, with one, two and three modes."""
    heading(f"Impact factors {title}")
    print(f"{'':8}" + "".join(f"{factor + ', modes':>24}" for factor in FACTORS))
    print("  x [ft]" + "".join(f"{n:8d}" for n in runs) * len(FACTORS))
    for feet in sorted({*MASSES, 55, 60, 65}):
        values = [getattr(r.impact_factors, name)[feet] for name in FACTORS for r in runs.values()]
        print(f"{feet:8d}" + "".join(f"{'-':>8}" if np.isnan(v) else f"{v:8.3f}" for v in values))
    print("Support B is at 60 ft, between masses at 50 and 70 ft; -: static value too small.")


def print_verdict(proposed: Mapping[int, sw.Run], direct: Mapping[int, sw.Run]) -> None:
    """What agrees with the paper and what does not, in numbers."""
    feet = np.arange(121)
    masses = np.isin(feet, MASSES)
    middles = np.isin(feet, (30, 90))
    beside_b = np.abs(feet - 60) < 10
    near_ends = (feet <= 20) | (feet >= 100)

    heading("How well two modes agree with three, by force summation")
    print("Largest difference between the impact factors for")
    for text, factor, where in (
        ("deflection at the masses", "deflection", masses),
        ("sagging at the masses in the middle of the spans", "sagging", middles),
        ("sagging at the other masses, 10 ft from a support", "sagging", masses & ~middles),
        ("sagging between these and support B", "sagging", beside_b),
        ("hogging more than 20 ft from the ends", "hogging", ~near_ends),
        ("hogging within 20 ft of the ends", "hogging", near_ends),
    ):
        print(f"  {text:50}{largest_gap(proposed[2], proposed[3], factor, where):8.3f}")
    print_text(
        """The paper finds generally good agreement; so it is for deflection everywhere and for
        moments where they are large. Sagging beside B and hogging near the ends are small to divide
        by, and there a third mode still changes the factor."""
    )

    heading("Force summation and direct superposition")
    low, high = extent(direct[1].impact_factors.deflection[masses])
    summed = extent(proposed[1].impact_factors.deflection[masses])
    near_b = np.nanmax(direct[1].impact_factors.deflection)
    deflection, sagging, hogging = (largest_gap(proposed[3], direct[3], f) for f in FACTORS)
    print_text(
        f"""With one mode, superposition gives deflection impact factors from {low:.2f} to
        {high:.2f} at the masses, less than unity as the paper says (between the masses beside B
        they rise to {near_b:.2f}); force summation gives {summed[0]:.2f} to {summed[1]:.2f}.""",
        f"""With three modes the two differ by at most {deflection:.3f} in deflection, less than the
        words of the paper suggest, but by up to {sagging:.2f} in sagging and {hogging:.2f} in
        hogging.""",
        """The curves of the paper are not tabulated: they can be compared by eye only. It does not
        state the friction in the suspensions at the start, taken as zero here, nor any damping of
        the bridge.""",
    )


def largest_gap(a: sw.Run, b: sw.Run, factor: str, where: Any = slice(None)) -> float:
    """Largest difference between impact factors of two runs, at some sections or at all."""
    gap = getattr(a.impact_factors, factor) - getattr(b.impact_factors, factor)
    return float(np.nanmax(np.abs(gap[where])))


def extent(values: np.ndarray) -> tuple[float, float]:
    """Smallest and largest value."""
    return float(np.nanmin(values)), float(np.nanmax(values))


def figures(
    case: sw.Case, proposed: Mapping[int, sw.Run], direct: Mapping[int, sw.Run]
) -> Iterator[tuple[str, Figure]]:
    """The figures of the paper, by name, and one that it argues for."""
    general = sw.Bridge(
        spans=[14.0, 20.0, 16.0],
        ends=("clamped", "pinned"),
        EI=2.0e9,
        mass=6000.0,
        stations_per_span=[3, 4, 3],
    )
    yield "fig01_bridge", general.plot.model()
    yield "fig02_vehicle", case.vehicle.plot.model()
    yield "fig03_basic_bridge", general.plot.basic_bridge()
    yield "fig04_model", case.bridge.plot.model()
    yield "fig05_modes", case.bridge.plot.modes(3)

    by_modes = {NUMBERS[n]: proposed[n] for n in (3, 2, 1)}
    yield "fig06_deflection", compare_impact_factors(by_modes, "deflection")
    yield "fig07a_sagging", compare_impact_factors(by_modes, "sagging")
    yield "fig07b_hogging", compare_impact_factors(by_modes, "hogging")
    by_method = {
        f"{name}, {NUMBERS[n]}": runs[n]
        for n in (3, 1)
        for name, runs in (("force summation", proposed), ("superposition", direct))
    }
    yield "fig08_superposition", compare_impact_factors(by_method, "deflection")
    yield "fig09_convergence", convergence(case)


def convergence(case: sw.Case) -> Figure:
    """Errors of the largest deflection, moment and shear by both methods against modes included.

    The bridge has ten masses in each span; the reference has all its twenty modes, by force
    summation. All runs march with the same time step.
    """
    spans = np.diff(case.bridge.span_bounds)
    fine = replace(
        case,
        bridge=sw.Bridge(
            spans=spans.tolist(),
            EI=case.bridge.EI.tolist(),
            mass=case.bridge.masses.sum() / spans.sum(),
            stations_per_span=10,
        ),
    )
    reference = fine.run(modes=20, sections=SECTIONS)
    quantities: tuple[str, ...] = ("deflection", "moment", "shear")
    methods = {"force summation": "force-summation", "direct superposition": "superposition"}
    modes = range(1, 21)
    errors: dict[str, dict[str, list[float]]] = {
        quantity: {name: [] for name in methods} for quantity in quantities
    }
    for name, recovery in methods.items():
        for n in modes:
            run = fine.run(
                modes=n,
                recovery=recovery,
                sections=SECTIONS,
                step=reference.settings["step"],
            )
            for quantity in quantities:
                errors[quantity][name].append(relative_error(run, reference, quantity))
    return compare_convergence(
        modes,
        errors,
        reference="the same bridge of 20 masses, all 20 modes, force summation",
    )


def relative_error(run: sw.Run, reference: sw.Run, quantity: str) -> float:
    """Largest error of the extremes at any section, by the largest extreme along the bridge."""
    got, true = run.envelope(quantity), reference.envelope(quantity)
    pairs = ((got.max.value, true.max.value), (got.min.value, true.min.value))
    error = max(np.abs(a - b).max() for a, b in pairs)
    return float(error / max(np.abs(b).max() for _, b in pairs))


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG and as SVG, the latter the same to the last byte every time."""
    figure.savefig(path.with_suffix(".png"), dpi=200)
    figure.set_layout_engine("none")  # it is laid out
    with mpl.rc_context({"svg.hashsalt": "kishan-1973"}):
        figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})


def heading(text: str) -> None:
    """A line of text, underlined."""
    print(f"\n{text}\n{'-' * len(text)}")


def print_text(*paragraphs: str) -> None:
    """Paragraphs in lines of even length."""
    print("\n\n".join(fill(" ".join(text.split()), 98) for text in paragraphs))


if __name__ == "__main__":
    main()
