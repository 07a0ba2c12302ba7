"""Roads from Python: what they are, how rough they are, what they are made of, what is refused."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import re
import tracemalloc
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import spanwise as sw
from spanwise.roads.roughness import fitted

nan, inf = float("nan"), float("inf")

#: Closed forms of a few operations.
EXACT = 1e-12
#: Longest time in which nonsense may be refused [s].
SOON = 0.5
#: Memory that may be taken in doing so [MiB].
LITTLE = 50

#: Elevation, slope and curvature of `ISO8608("B", seed=7)` at 12.5 m.
PINNED = ["-0x1.8467f8582e982p-8", "-0x1.2462d63aecd80p-12", "-0x1.6a6fa10981db8p-3"]

QUARTER = sw.vehicles.quarter_car()

X = np.arange(-20.0, 60.01, 0.25)


def measured(**options: Any) -> sw.Profile:
    return sw.Profile(X, 0.01 * np.sin(0.7 * X), **options)


def every_kind() -> list[sw.roads.Road]:
    single = [
        sw.Smooth(),
        sw.ISO8608("C", seed=3, sample=2),
        sw.ISO8608(G=50e-6, waviness=2.3, band=(0.02, 3.0), contact_patch=0, period=1500, seed=4),
        sw.roads.bridge_study("average", seed=5),
        sw.roads.from_iri(3.0),
        measured(detrend=True, contact_patch=0.1, max_gap=1.0),
        sw.Step(1.0, 0.02),
        sw.Ramp(1.0, 2.0, 0.02, contact_patch=0.0),
        sw.Bump(5.0, 1.0, 0.03),
        sw.Pothole(7.0, 0.6, 0.05, edge=0.1),
        sw.Joint(0.0, 0.04, 0.02),
        sw.Camber(0.0, 30.0, 0.05),
    ]
    return [*single, single[1] + single[5] + single[8]]


# Evaluation.


@pytest.mark.parametrize("road", every_kind(), ids=lambda road: str(road.kind))
def test_arrays_of_any_shape(road: sw.roads.Road) -> None:
    x = np.linspace(-10.0, 50.0, 24)
    for of in (road.elevation, road.slope, road.curvature):
        values = of(x)
        assert_array_equal(of(x.reshape(2, 3, 4)), values.reshape(2, 3, 4))
        assert of(x[5]).shape == ()
        assert float(of(x[5])) == values[5]
        assert of([]).shape == (0,)
    assert np.isfinite(road.curvature(x)).all()


def test_shapes_of_features() -> None:
    # By hand; the patches of 0.24 m do not reach these places, or average a straight line.
    assert float(sw.Step(1.0, 0.02).elevation(1.0)) == pytest.approx(0.01, rel=EXACT)
    assert float(sw.Step(1.0, 0.02).slope(1.0)) == pytest.approx(0.02 / 0.24, rel=EXACT)
    assert float(sw.Ramp(1.0, 3.0, 0.02).elevation(2.0)) == pytest.approx(0.01, rel=EXACT)
    bump = sw.Bump(5.0, 2.0, 0.03, contact_patch=0.0)
    assert_allclose(
        bump.elevation([4.0, 4.5, 5.0, 5.5, 6.0]), [0, 0.015, 0.03, 0.015, 0], atol=1e-15
    )
    hole = sw.Pothole(7.0, 1.0, 0.05)
    assert_allclose(hole.elevation([6.3, 7.0, 7.2, 7.7]), [0.0, -0.05, -0.05, 0.0], atol=1e-15)
    joint = sw.Joint(0.0, 0.06, 0.02)
    assert float(joint.elevation(0.05)) == pytest.approx(-0.02 * 0.06 / 0.24, rel=EXACT)
    camber = sw.Camber(0.0, 30.0, 0.05, contact_patch=0.0)
    assert_allclose(camber.elevation([0.0, 15.0, 30.0, 40.0]), [0.0, 0.05, 0.0, 0.0], atol=1e-15)
    assert float(camber.curvature(10.0)) == pytest.approx(-8 * 0.05 / 30.0**2, rel=EXACT)


def test_roads_add_up() -> None:
    random, bump = sw.ISO8608("B", seed=1), sw.Bump(5.0, 1.0, 0.03)
    both = random + bump
    assert_allclose(both.elevation(X), random.elevation(X) + bump.elevation(X), rtol=0, atol=1e-16)
    assert (both + sw.Step(1.0, 0.1)) == (random + (bump + sw.Step(1.0, 0.1)))
    assert bump + sw.Smooth() == bump
    assert (sw.Smooth() + sw.Smooth()).is_smooth
    assert not both.is_smooth
    assert both.repeats_after == 1024.0
    assert (both + measured()).ends == (-20.0, 60.0)
    with pytest.raises(TypeError):
        bump + 1.0


@pytest.mark.parametrize("road", every_kind(), ids=lambda road: str(road.kind))
def test_roads_times_a_number(road: sw.roads.Road) -> None:
    x = np.linspace(-10.0, 50.0, 24)
    once = road.elevation(x)
    for twice in (2 * road, road * 2.0):
        assert_allclose(twice.elevation(x), 2 * once, rtol=EXACT, atol=1e-12)
    assert (0 * road).is_smooth
    both = sum([road, road])
    assert isinstance(both, sw.roads.Road)
    assert_array_equal(both.elevation(x), (road + road).elevation(x))
    with pytest.raises(TypeError):
        road * road


def test_profiles_pass_through_their_points() -> None:
    road = measured(contact_patch=0.0)
    assert_allclose(road.elevation(X), road.elevations, rtol=0, atol=1e-16)
    level = sw.Profile(X, 120.0 + 0.03 * X, detrend=True)
    assert_allclose(level.elevation(X), 0.0, atol=1e-11)


def test_the_road_is_the_same_at_any_sampling() -> None:
    road = sw.ISO8608("B", seed=7)
    fine = road.elevation(np.arange(0.0, 100.0, 0.125))
    assert_array_equal(road.elevation(np.arange(0.0, 100.0, 0.25)), fine[::2])


def test_random_roads_stay_as_they_are() -> None:
    # Not a reference: what this version gives, so that no later one changes the roads of a seed
    # unnoticed, on any machine.
    road = sw.ISO8608("B", seed=7)
    found = [float(of(12.5)).hex() for of in (road.elevation, road.slope, road.curvature)]
    assert found == PINNED


# Roughness.


def test_classes_are_those_of_the_standard() -> None:
    # ISO 8608 at n0 = 0.1 cycle/m, in 1e-6 m3.
    means = np.array([*sw.roads.CLASSES.values()]) / 1e-6
    assert_allclose(means, [16, 64, 256, 1024, 4096, 16_384, 65_536, 262_144], rtol=EXACT)
    assert "".join(sw.roads.CLASSES) == "ABCDEFGH"
    for letter, mean in sw.roads.CLASSES.items():
        found = sw.roads.classify(mean)
        assert found.letter == letter
        assert_array_equal(found.G, mean)
        assert found.upper == (inf if letter == "H" else pytest.approx(2 * mean, rel=EXACT))
        assert found.lower == (0.0 if letter == "A" else pytest.approx(mean / 2, rel=EXACT))
        if letter != "H":
            # The upper limit belongs to the class.
            assert sw.roads.classify(found.upper).letter == letter
            assert sw.roads.classify(np.nextafter(found.upper, inf)).lower == found.upper
    assert sw.roads.classify(33e-6).letter == "B"
    assert sw.roads.classify(1.0).letter == "H"


def test_conditions_of_bridge_studies_are_not_classes() -> None:
    roads = [sw.roads.bridge_study(each) for each in ("very good", "good", "average", "poor")]
    assert_allclose([road.G for road in roads], [5e-6, 20e-6, 80e-6, 256e-6], rtol=EXACT)
    assert sw.roads.bridge_study("poor", seed=2) == sw.ISO8608(G=256e-6, seed=2)


def test_density_of_waves() -> None:
    # a sin(2 pi n x) has the variance a^2/2, all of it near n.
    x = np.arange(0.0, 200.01, 0.05)
    road = sw.Profile(x, 0.02 * np.sin(2 * np.pi * 0.5 * x))
    n, density = road.psd(0.0, 200.0, segment=50.0)
    assert_allclose(n[:3], [0.02, 0.04, 0.06], rtol=EXACT)
    assert n[-1] == pytest.approx(8.0)  # 0.8 of half a wave per point
    near = np.abs(n - 0.5) < 0.05
    assert density[near].sum() * n[0] == pytest.approx(0.02**2 / 2, rel=1e-3)
    # The line that is taken off each segment is in the first two.
    assert density[~near][2:].sum() < 1e-5 * density.sum()
    assert n[np.argmax(density)] == pytest.approx(0.5)


def test_segments_overlap_by_half() -> None:
    # The bump is at the end of the first and third, where their windows are 0.
    road = sw.Bump(49.5, 1.0, 0.1)
    x = np.arange(49.0, 51.0, 1e-3)
    n, density = road.psd(0.0, 100.0, segment=50.0)
    square = np.sum(road.surface.elevation(x) ** 2) * 1e-3
    assert density.sum() * n[0] == pytest.approx(square / 50.0 / (3 / 8) / 3, rel=0.05)
    assert n[-1] == pytest.approx(8.0)  # known exactly
    # Wherever it is counted from.
    x = np.arange(0.0, 100.0, 0.25)
    z = sw.ISO8608("B").elevation(x)
    here, there = (sw.Profile(x + at, z).psd(at, at + 99.0) for at in (0.0, 32.0))
    assert_allclose(here, there, rtol=1e-6)
    with pytest.raises(ValueError, match=r"segment = 101 m: must be .* to 100 m, the section"):
        road.psd(0.0, 100.0, segment=101.0)


def test_the_window_does_not_change_the_variance() -> None:
    # Waves of at most 5 m in segments of 50 m; over 20 roads within 2 %.
    parts = []
    for sample in range(20):
        road = sw.ISO8608("B", band=(0.2, 4.0), sample=sample)
        n, density = road.psd(0.0, 500.0, segment=50.0)
        variance = road.surface.elevation(np.arange(0.0, 500.0, 0.05)).var()
        parts.append(density.sum() * n[0] / variance)
    print(f"{np.mean(parts):.4f}")
    assert np.mean(parts) == pytest.approx(1.0, abs=0.02)


def test_density_of_random_roads() -> None:
    # The mean over 100 roads of 1 km in octaves, from three times the resolution on, against
    # 64e-6 (n/0.1)^-2 within four standard errors.
    densities = []
    for sample in range(100):
        n, density = sw.ISO8608("B", seed=2, sample=sample).psd(0.0, 1000.0)
        densities.append(density)
    levels = np.array(densities) * (n / 0.1) ** 2
    edges = [0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.28, 2.56, 3.8]
    for low, high in pairwise(edges):
        octave = levels[:, (n >= low) & (n < high)].mean(axis=1)
        error = octave.std(ddof=1) / 10.0
        print(f"{low} to {high} cycle/m: {octave.mean():.3e} +- {error:.1e} m3")
        assert abs(octave.mean() - 64e-6) <= 4.0 * error
        assert error < 0.03 * 64e-6
    assert 3.99 < n[-1] <= 4.0


@pytest.mark.parametrize(("wavelength", "spacing"), [(0.051, 0.005), (0.03, 0.004), (0.11, 0.01)])
def test_no_wave_is_taken_for_a_longer_one(wavelength: float, spacing: float) -> None:
    # Shorter than the average of the index, on points that hold them; single points every 50 mm
    # made 2.6 m/km of the first.
    x = np.arange(0.0, 100.0, spacing)
    road = sw.Profile(x, 1e-3 * np.sin(2 * np.pi * x / wavelength))
    assert road.iri(0.0, 99.9) < 0.1
    n, density = road.psd(0.0, 99.9)
    assert n[-1] == pytest.approx(0.4 / spacing, abs=n[0])
    assert n[np.argmax(density)] == pytest.approx(1.0 / wavelength, abs=2 * n[0])
    near = np.abs(n * wavelength - 1.0) < 0.05
    assert density[near].sum() * n[0] == pytest.approx(1e-3**2 / 2, rel=0.02)
    assert density[~near].sum() < 1e-4 * density.sum()
    # Nor where only longer waves are asked for.
    n, density = road.psd(0.0, 99.9, spacing=0.2)
    assert n[-1] == pytest.approx(2.5, abs=n[0])
    assert density.sum() * n[0] < 1e-4 * 1e-3**2 / 2


def test_the_march_averages_before_it_samples() -> None:
    # A wave shorter than the contact patch, on points that hold it, hardly moves the vehicle; a
    # tyre that follows it exactly is thrown about.
    x = np.arange(-20.0, 60.0, 0.005)
    z = 1e-3 * np.sin(2 * np.pi * x / 0.048)
    bridge = sw.Bridge(spans=[20.0], EI=3e9, mass=9e3)
    spread = []
    for patch in (0.24, 0.0):
        road = sw.Profile(x, z, contact_patch=patch)
        run = sw.cross(
            bridge, QUARTER, speed=20.0, road=road, damping=0.02, approach=15.0, step=1e-4
        )
        spread.append(float(np.ptp(run.axle_loads)))
    smooth = sw.cross(bridge, QUARTER, speed=20.0, damping=0.02, approach=15.0, step=1e-4)
    level = float(np.ptp(smooth.axle_loads))
    print(f"{level:.0f} N smooth, {spread[0]:.0f} N with a patch, {spread[1]:.0f} N without")
    assert spread[0] == pytest.approx(level, rel=0.02)
    assert spread[1] > 1.3 * level


def test_the_class_does_not_depend_on_the_spacing() -> None:
    # Class B, 64e-6 m3. Points cannot hold more than half a wave each; what is looked at beyond
    # made A of a class B road of points 0.5 m apart.
    road = sw.ISO8608("B", seed=6, contact_patch=0.0)
    for spacing, expected in ((0.1, 6.7e-5), (0.25, 6.6e-5), (0.5, 6.9e-5), (1.0, 7.1e-5)):
        x = np.arange(0.0, 1000.0, spacing)
        found = sw.Profile(x, road.elevation(x)).iso_class(0.0, 990.0)
        print(f"{spacing} m: {found}")
        assert found.letter == "B"
        assert pytest.approx(expected, rel=0.12) == found.G
        assert found.band is not None
        assert found.band[1] == pytest.approx(min(0.4 / spacing, 2.83), rel=0.01)
        # A sum is known as far as its coarsest measured part.
        fine = sw.Profile(np.arange(0.0, 1000.0, 0.1), np.zeros(10_000))
        both = fine + sw.Profile(x, road.elevation(x)) + sw.Bump(-5.0, 1.0, 0.1)
        assert both.iso_class(0.0, 990.0).band == found.band


@pytest.mark.parametrize("spacing", [0.25, 0.5, 1.0])
def test_the_class_hardly_depends_on_the_ends(spacing: float) -> None:
    # Where an octave beyond what the points hold came in, 542 m had twice the roughness of 544 m.
    road = sw.ISO8608("B", seed=1, contact_patch=0.0)
    x = np.arange(0.0, 600.0, spacing)
    measured = sw.Profile(x, road.elevation(x))
    found = np.array([measured.iso_class(0.0, end).G for end in np.arange(560.0, 500.0, -2.0)])
    jump = np.max(np.abs(np.diff(np.log(found))))
    print(f"{found.min():.3g} to {found.max():.3g} m3, at once by {jump:.3f}")
    assert jump < 0.1
    # Nor on height and grade.
    x = np.arange(0.0, 500.0, 0.25)
    low, high = (sw.Profile(x, road.elevation(x) + c) for c in (0.0, 500.0 + 0.03 * x))
    assert pytest.approx(low.iso_class(0.0, 499.0).G, rel=1e-3) == high.iso_class(0.0, 499.0).G
    assert_allclose(high.psd(0.0, 499.0), low.psd(0.0, 499.0), rtol=1e-3)
    assert high.iri(0.0, 499.0) == pytest.approx(low.iri(0.0, 499.0), rel=1e-2)


def test_the_standard_error_of_a_class() -> None:
    # The scatter of G among roads and sections is what a single one says of itself.
    found = [sw.ISO8608("C", seed=3, sample=k).iso_class(0.0, 400.0) for k in range(60)]
    said = np.mean([each.error for each in found])
    scatter = np.std(np.log([each.G for each in found]))
    print(f"said {said:.3f}, scatter {scatter:.3f}")
    assert 0.5 < said / scatter < 2.0
    # It grows where a line of slope -2 does not fit.
    other = sw.ISO8608(G=64e-6, waviness=3.0).iso_class(0.0, 1000.0)
    assert other.error is not None
    assert other.error > 0.3
    assert (sw.roads.classify(1e-4).error, sw.roads.classify(1e-4).band) == (None, None)


@pytest.mark.parametrize(("known", "band", "end"), [(2.0, 0.9, 0.9), (0.9, 2.83, 0.905)])
def test_octaves_all_alike_and_a_part_by_its_width(known: float, band: float, end: float) -> None:
    n = np.arange(1, round(100 * known) + 1) / 100
    level = 64e-6 * np.select([n < 0.2, n < 0.4, n < 0.8], [1.0, 4.0, 16.0], 100.0)
    found = fitted(n, level * (n / 0.1) ** -2, (0.1, band))
    # The last wave number stands for the width around it.
    width = np.log2(end / 0.8)
    mean = (np.log(4.0) + np.log(16.0) + width * np.log(100.0)) / (3.0 + width)
    assert pytest.approx(64e-6 * np.exp(mean), rel=EXACT) == found.G
    squares = (np.log([1.0, 4.0, 16.0, 100.0]) - mean) ** 2
    scatter = (squares[:3].sum() + width * squares[3]) / (3.0 + width)
    octaves = (3.0 + width) ** 2 / (3.0 + width**2)
    assert found.error == pytest.approx(np.sqrt(scatter / (octaves - 1.0)), rel=EXACT)
    assert found.band == (0.1, 0.9)
    # Without the first two waves of a segment, which the window and the removed line distort.
    assert fitted(n, (n / 0.1) ** -2, (0.01, 0.85)).band == (0.03, 0.85)
    with pytest.raises(ValueError, match=r"band = \(0\.1, 0\.39\): must span two octaves"):
        fitted(n, level, (0.1, 0.39))


@pytest.mark.parametrize(
    ("length", "spacing", "seen"),
    [
        (60.0, 1.0, "only 0.2 to 0.4 cycle/m"),
        (100.0, 2.0, "only 0.12 to 0.2 cycle/m"),
        (2000.0, 25.0, "only 0.006 to 0.016 cycle/m"),
        (272.0, 25.0, "nothing"),
    ],
)
def test_too_little_for_a_class(length: float, spacing: float, seen: str) -> None:
    x = np.arange(0.0, length + spacing, spacing)
    road = sw.Profile(x, sw.ISO8608("B").elevation(x))
    needed = f"start, end: this section shows {seen}, and two octaves of 0.011 to 2.83 cycle/m are "
    with pytest.raises(ValueError, match=re.escape(needed)):
        road.iso_class(0.0, length)


@pytest.mark.parametrize("ask", ["psd", "iso_class"])
@pytest.mark.parametrize("length", [1e-300, 20.0, 49.9])
def test_what_was_not_given_is_not_blamed(ask: str, length: float) -> None:
    x = np.arange(0.0, 100.0, 5.0)
    road = sw.Profile(x, 1e-3 * np.sin(x))
    said = f"end = {length:g} m: must lie 50 m or more beyond start, 0 m"
    with pytest.raises(ValueError, match=re.escape(said)) as refused:
        getattr(road, ask)(0.0, length)
    assert "segment" not in str(refused.value)


def on_points(spacing: float) -> sw.Profile:
    """A class B road whose index is 4.36 m/km, on points."""
    x = np.arange(0.0, 600.0, spacing)
    return sw.Profile(x, sw.ISO8608("B", seed=4, contact_patch=0.0).elevation(x))


@pytest.mark.parametrize("spacing", [0.05, 0.1, 0.25, 0.3, 0.3048])
def test_points_that_hold_an_index(spacing: float) -> None:
    assert on_points(spacing).iri(0.0, 544.0) == pytest.approx(4.36, rel=0.03)


@pytest.mark.parametrize(("spacing", "expected"), [(0.5, 4.07), (1.0, 3.24), (1.2, 2.93)])
def test_an_index_of_coarse_points_is_doubted(spacing: float, expected: float) -> None:
    road = on_points(spacing)
    said = rf"road: its points are {spacing:g} m apart"
    with pytest.warns(sw.PlausibilityWarning, match=said):
        assert road.iri(0.0, 544.0) == pytest.approx(expected, abs=0.01)
    with pytest.warns(sw.PlausibilityWarning, match=said):
        road.iri(0.0, 500.0, every=100.0)
    # In a sum the coarsest counts, whatever is fine beside it.
    with pytest.warns(sw.PlausibilityWarning, match=said):
        (on_points(0.1) + sw.Bump(5.0, 1.0, 0.01) + road).iri(0.0, 544.0)


@pytest.mark.parametrize("spacing", [2.0, 5.0, 20.0])
def test_an_index_that_points_cannot_hold_is_refused(spacing: float) -> None:
    # They gave 2.2, 1.22 and 0.16 m/km.
    road = on_points(spacing)
    said = rf"road: its points are {spacing:g} m apart, .*at most 1.2 m"
    with pytest.raises(ValueError, match=said):
        road.iri(0.0, 544.0)
    with pytest.raises(ValueError, match=said):
        (on_points(0.1) + road).iri(0.0, 500.0, every=100.0)


def test_index_by_segments() -> None:
    road = sw.ISO8608("B", seed=1)
    found = road.iri(20.0, 130.0, every=20.0)
    assert_array_equal(found.starts, [20.0, 40.0, 60.0, 80.0, 100.0, 120.0])
    assert_array_equal(found.ends, [40.0, 60.0, 80.0, 100.0, 120.0, 130.0])
    assert found.lead_in == 50.0
    assert len(found) == len(found.values) == 6
    said = "IriSegments(6 from 20 m to 130 m, 3.28 to 6.1 m/km, mean 4.35, lead-in 50 m)"
    assert repr(found) == said
    head, first, *_ = str(found).splitlines()
    assert head == "start [m]  end [m]  IRI [m/km]"
    assert first == "    20.00    40.00        4.35"
    table = found.to_pandas()
    assert list(table.columns) == ["start [m]", "end [m]", "IRI [m/km]"]
    assert_array_equal(table, np.transpose([found.starts, found.ends, found.values]))
    with pytest.raises(ValueError, match="read-only"):
        found.values[0] = 0.0
    # One drive: the segment is that of a longer section, whose car has settled by then.
    longer = road.iri(-40.0, 130.0, every=20.0)
    assert_allclose(longer.values[3:], found.values, rtol=0.01)
    # Starting anew on each is off by several per cent.
    anew = [road.iri(a, b) for a, b in zip(found.starts[:5], found.ends[:5], strict=True)]
    assert np.abs(anew / found.values[:5] - 1.0).max() > 0.02
    # Where the road begins there is nothing before it.
    x = np.arange(0.0, 200.0, 0.1)
    measured = sw.Profile(x, road.elevation(x))
    assert measured.iri(0.0, 100.0, every=25.0).lead_in == 0.0
    assert measured.iri(10.9, 100.0, every=25.0).lead_in == 0.0
    assert measured.iri(11.5, 100.0, every=25.0).lead_in == 11.5


@pytest.mark.parametrize("letter", [*"ABCDEFGH"])
def test_random_roads_are_of_their_class(letter: str) -> None:
    road = sw.ISO8608(letter, seed=6)  # with a contact patch, which the surface does not have
    found = road.iso_class(0.0, 1000.0)
    assert found.letter == letter
    assert_allclose(found.G, sw.roads.CLASSES[letter], rtol=0.1)


def test_index_of_random_roads() -> None:
    # 0.543 sqrt(G/1e-6), and the other way round.
    found = [sw.roads.from_iri(3.0, seed=9, sample=k).iri(0.0, 1000.0) for k in range(50)]
    assert np.mean(found) == pytest.approx(3.0, rel=0.01)
    assert_allclose(sw.roads.from_iri(0.543 * 8.0).G, 64e-6, rtol=EXACT)


def test_index_is_of_the_surface() -> None:
    felt, bare = sw.ISO8608("B", seed=1), sw.ISO8608("B", seed=1, contact_patch=0.0)
    assert felt.iri(0.0, 500.0) == bare.iri(0.0, 500.0)
    assert felt.surface == bare
    assert bare.surface is bare
    both = felt + sw.Step(1.0, 0.1) + sw.Smooth()
    assert both.surface == bare + sw.Step(1.0, 0.1, contact_patch=0.0)
    assert both.iri(0.0, 500.0) == both.surface.iri(0.0, 500.0) > felt.iri(0.0, 500.0)
    # Linear in the amplitude.
    high = sw.ISO8608(G=4 * 64e-6, seed=1)
    assert high.iri(0.0, 500.0) == pytest.approx(2 * felt.iri(0.0, 500.0), rel=1e-10)


# Values.


@pytest.mark.parametrize("road", every_kind(), ids=lambda road: str(road.kind))
def test_roads_are_values(road: sw.roads.Road) -> None:
    for again in (
        pickle.loads(pickle.dumps(road)),
        copy.deepcopy(road),
        sw.roads.from_table(road.arguments),  # type: ignore[arg-type]
    ):
        assert again == road
        assert type(again) is type(road)
        assert hash(again) == hash(road)
        assert repr(again) == repr(road)
        assert_array_equal(again.elevation(X), road.elevation(X))
    assert road != sw.Bump(1.0, 1.0, 0.1)
    with pytest.raises(dataclasses.FrozenInstanceError):
        road.contact_patch = 1.0  # type: ignore[attr-defined]


def test_points_cannot_be_changed() -> None:
    x = X.copy()
    road = sw.Profile(x, 0.1 * X)
    x[3] = 1e3
    assert road == sw.Profile(X, 0.1 * X)
    assert road != sw.Profile(X, 0.2 * X)
    with pytest.raises(ValueError, match="read-only"):
        road.x[3] = 1e3
    assert repr(road).startswith("Profile(321 points from -20 m to 60 m")


def test_numbers_are_kept_as_they_are_understood() -> None:
    assert sw.Step(1, 0) == sw.Step(1.0, 0.0)
    assert sw.ISO8608("A", band=[np.float32(0.5), 2]).band == (0.5, 2.0)  # type: ignore[arg-type]
    assert sw.ISO8608("A").G == 16e-6
    assert dataclasses.replace(sw.ISO8608("A", seed=1), seed=2) == sw.ISO8608("A", seed=2)


def test_tables() -> None:
    make = sw.roads.from_table
    assert make({"kind": "iso-8608", "class": "B", "seed": 1}) == sw.ISO8608("B", seed=1)
    assert make({"kind": "iso-8608", "iri": 2.5}) == sw.roads.from_iri(2.5)
    assert make({"kind": "bridge-study", "condition": "good"}) == sw.ISO8608(G=20e-6)
    step = {"kind": "step", "at": 0.0, "height": 0.01}
    assert make([{"kind": "smooth"}, step]) == sw.Step(0.0, 0.01)
    assert make([step, step]) == sw.Step(0.0, 0.01) + sw.Step(0.0, 0.01)
    assert make([]) == sw.Smooth()
    table = sw.ISO8608("B", seed=1).arguments
    assert isinstance(table, dict)
    assert list(table)[:2] == ["kind", "class"]
    assert "G" not in table


# Files.


def test_profiles_from_files(tmp_path: Path) -> None:
    file = tmp_path / "road.csv"
    file.write_text(
        "# surveyed\nplace,left,right\n\n" + "".join(f"{x},0,{0.01 * x**2}\n" for x in range(6))
    )
    road = sw.Profile.read(file, columns=("place", "right"), scale=(1.0, 1e-3), detrend=True)
    x = np.arange(6.0)
    z = np.array([float(f"{0.01 * each**2}") for each in range(6)])
    assert road == sw.Profile(x, 1e-3 * z, detrend=True)
    assert sw.Profile.read(file, columns=(0, 2)) == sw.Profile(x, z)
    table = {"kind": "profile", "file": str(file), "columns": [0, 2], "contact_patch": 0.1}
    assert sw.roads.from_table(table) == sw.Profile(x, z, contact_patch=0.1)
    file.write_text("0;1\n1;1\n2;1\n3;1\n")
    assert sw.Profile.read(file, delimiter=";") == sw.Profile(x[:4], np.ones(4))


def test_points_out_of_order_and_double(tmp_path: Path) -> None:
    file = tmp_path / "road.csv"
    file.write_text("0,1\n2,3\n1,2\n2,5\n3,1\n")
    road = sw.Profile.read(file, sort=True, duplicates="mean", scale=(1, 0.01))
    assert_array_equal(road.x, [0, 1, 2, 3])
    assert_allclose(road.elevations, [0.01, 0.02, 0.04, 0.01], rtol=EXACT)


#: Ends of a road for a bridge of 20.1 m [m], the approach, what is given, and what cures it.
TOO_SHORT: list[tuple[tuple[float, float, float], dict[str, Any], str]] = [
    ((0.0, 20.4, 100.0), {}, "give a longer road, or approach = 0 at most"),
    ((-3.0, 20.4, 100.0), {}, "give a longer road, or approach = 3 at most"),
    ((-3.0, 20.4, 100.0), {"ramp": 0.0}, "give a longer road, or approach = 3 at most"),
    (
        (-3.0, 200.0, 100.0),
        {},
        "give a longer road, or say where this one begins as it is read from a file: start = its "
        "first station minus the station of the bridge's left end, -100 at most, "
        "or approach = 3 at most",
    ),
    (
        (-100.0, 100.0, 100.0),
        {"direction": "left"},
        "give a longer road, or say where this one begins as it is read from a file: start = its "
        "first station minus the station of the bridge's left end, 0 at most, "
        "or approach = 79.9 at most",
    ),
    ((-1.0, 25.0, 100.0), {"direction": "left"}, "give a longer road, or approach = 4.899 at most"),
    # Of which there may be none; nor does it help where the road ends too early.
    ((1.0, 20.4, 0.0), {}, "give a longer road"),
    ((0.0, 19.0, 0.0), {}, "give a longer road"),
    ((-101.0, 19.0, 100.0), {}, "give a longer road"),
    ((-50.0, 19.0, 100.0), {}, "give a longer road"),
]


@pytest.mark.parametrize(("road", "given", "cure"), TOO_SHORT)
def test_a_road_too_short_for_the_path(
    road: tuple[float, float, float], given: dict[str, Any], cure: str
) -> None:
    first, last, approach = road
    bridge = sw.Bridge(spans=[20.1], EI=4e9, mass=8e3)
    x = np.linspace(first, last, 999)
    passage = sw.Passage(vehicle=QUARTER, direction=given.get("direction", "right"))
    common: dict[str, Any] = {"speed": 20.0, "damping": 0.0, "ramp": given.get("ramp")}
    common |= {"bridge": bridge, "vehicle": passage}

    def cross(from_: float, approach: float) -> sw.Run:
        measured = sw.Profile(x - x[0] + from_, 1e-9 * np.arange(999) ** 2)
        return sw.cross(**common, approach=approach, road=measured)

    with pytest.raises(ValueError, match=rf"the road covers only .*; {re.escape(cure)}$"):
        cross(first, approach)
    # What is said to help does.
    if start := re.search(r"left end, (\S+) at most", cure):
        cross(float(start[1]), approach)
    if most := re.search(r"approach = (\S+)", cure):
        cross(first, float(most[1]))


def test_elevations_in_millimetres_are_doubted(tmp_path: Path) -> None:
    x = np.arange(0.0, 100.0, 0.5)
    best, worst = (sw.ISO8608(each).elevation(x) for each in ("A", "E"))
    sw.Profile(x, worst)
    with pytest.warns(UserWarning, match=r"elevations: their median slope is .*in mm\?.*scale"):
        sw.Profile(x, 1e3 * best)
    file = tmp_path / "road.csv"
    file.write_text("".join(f"{a},{1e3 * b}\n" for a, b in zip(x, best, strict=True)))
    with pytest.warns(UserWarning, match="in mm"):
        sw.Profile.read(file)
    sw.Profile.read(file, scale=(1.0, 1e-3))


# Refusals.

POSITIVE = "greater than 0"
NOT_NEGATIVE = "0 or more"
NUMBER = "must be a number"

Refusal = tuple[Callable[[], object], tuple[str, ...]]


def table(**given: Any) -> Callable[[], object]:
    return lambda: sw.roads.from_table(given)


REFUSALS: list[Refusal] = [
    (lambda: sw.ISO8608(), ("class, G", "one of the two")),
    (lambda: sw.ISO8608("K"), ("class = 'K'", "A, B, C, D, E, F, G, H")),
    (lambda: sw.ISO8608("b"), ("class = 'b'", "did you mean 'B'")),
    (lambda: sw.ISO8608(2), ("class = 2", "must be one of A, B")),  # type: ignore[arg-type]
    (lambda: sw.ISO8608("A", G=64e-6), ("G = 6.4e-05", "not used with class = 'A'")),
    (lambda: sw.ISO8608(G=0.0), ("G = 0", POSITIVE)),
    (lambda: sw.ISO8608(G=nan), ("G = NaN", POSITIVE)),
    (lambda: sw.ISO8608("A", waviness=-1.0), ("waviness = -1", NOT_NEGATIVE)),
    (lambda: sw.ISO8608("A", waviness=1e9), ("waviness = 1000000000", "variance")),
    (lambda: sw.ISO8608("A", band=(0.0, 4.0)), ("band[0] = 0", POSITIVE)),
    (lambda: sw.ISO8608("A", band=(4.0, 4.0)), ("band[1] = 4 cycle/m", "greater than")),
    (lambda: sw.ISO8608("A", band=(0.1,)), ("band = (0.1,)", "two")),  # type: ignore[arg-type]
    (lambda: sw.ISO8608("A", band=(0.01, 1e9)), ("band = 100 m with waves of", "4194304 grid")),
    (lambda: sw.ISO8608("A", band=(1e-300, 4.0)), ("band = ", "4194304 grid")),
    (lambda: sw.ISO8608("A", contact_patch=-0.1), ("contact_patch = -0.1", NOT_NEGATIVE)),
    (lambda: sw.ISO8608("A", period=99.0), ("period = 99 m", "longest wave: 100 m")),
    (lambda: sw.ISO8608("A", period=inf), ("period = inf", "finite")),
    (lambda: sw.ISO8608("A", period=1e12), ("period = 1000000000000 m", "4194304 grid")),
    (lambda: sw.ISO8608("A", seed=-1), ("seed = -1", "not be negative")),
    (lambda: sw.ISO8608("A", seed=1.5), ("seed = 1.5", "whole")),  # type: ignore[arg-type]
    (lambda: sw.ISO8608("A", sample=10**30), ("sample", "too large")),
    (lambda: sw.roads.bridge_study("bad"), ("condition = 'bad'", "very good, good, average, poor")),
    (lambda: sw.roads.bridge_study("Good"), ("condition = 'Good'", "did you mean 'good'")),
    (
        lambda: sw.roads.bridge_study("very poor"),
        ("condition = 'very poor'", "did you mean 'poor'"),
    ),
    (lambda: sw.roads.from_iri(0.0), ("iri = 0.0", POSITIVE)),
    (lambda: sw.roads.from_iri(2.0, waviness=2.5), ("waviness = 2.5", "not used with iri")),
    (lambda: sw.roads.classify(nan), ("G = nan", POSITIVE)),
    (lambda: sw.Profile([0, 1, 1, 2], [0] * 4), ("x[2] = 1 m", "greater than x[1] = 1 m")),
    (lambda: sw.Profile([0, 2, 1, 3], [0] * 4), ("x[2] = 1 m", "greater than x[1] = 2 m")),
    (lambda: sw.Profile([0, nan, 1, 3], [0] * 4), ("x[1] = NaN", "finite")),
    (lambda: sw.Profile([0, 1, 2, 3], [0, 0, 0, inf]), ("elevations[3] = inf", "finite")),
    (lambda: sw.Profile([0, 1, 2, 9], [0] * 4), ("x[3] = 9 m: 7 m", "max_gap = 5 m")),
    (lambda: sw.Profile(X, X, max_gap=0.1), ("x[1] = -19.75 m", "max_gap = 0.1 m")),
    (lambda: sw.Profile(X, X, max_gap=nan), ("max_gap = NaN", POSITIVE)),
    (lambda: sw.Profile([0, 1, 2], [0, 0, 0]), ("x = 3 points", "4 or more")),
    (lambda: sw.Profile(X, X[1:]), ("elevations = 320 values", "one for each x, 321")),
    (lambda: sw.Profile(X, "road"), ("elevations = 'road'", "list of numbers")),
    (lambda: sw.Profile([X], X), ("x = [array", "list of numbers")),
    (lambda: sw.Profile(X, X, detrend=1), ("detrend = 1", "true or false")),  # type: ignore[arg-type]
    (lambda: sw.Step(nan, 0.1), ("at = NaN", "finite")),
    (lambda: sw.Step(0.0, "1"), ("height = '1'", NUMBER)),  # type: ignore[arg-type]
    (lambda: sw.Step(0.0, 0.1, contact_patch=-1.0), ("contact_patch = -1", NOT_NEGATIVE)),
    (lambda: sw.Ramp(2.0, 2.0, 0.1), ("end = 2 m", "greater than start, 2 m")),
    (lambda: sw.Camber(2.0, 1.0, 0.1), ("end = 1 m", "greater than start, 2 m")),
    (lambda: sw.Camber(0.0, 1.0, inf), ("rise = inf", "finite")),
    (lambda: sw.Bump(0.0, 0.0, 0.1), ("length = 0", POSITIVE)),
    (lambda: sw.Bump(0.0, 1.0, nan), ("height = NaN", "finite")),
    (lambda: sw.Pothole(0.0, 1.0, 0.1, edge=0.6), ("edge = 0.6 m", "half the length, 0.5 m")),
    (lambda: sw.Pothole(0.0, 1.0, inf), ("depth = inf", "finite")),
    (lambda: sw.Joint(0.0, -0.1, 0.1), ("gap = -0.1", POSITIVE)),
    (lambda: sw.Step(0.0, 0.1) * -1, ("factor = -1", NOT_NEGATIVE)),
    (lambda: inf * sw.Step(0.0, 0.1), ("factor = inf", "finite")),
    (lambda: sw.roads.Sum([1.0]), ("parts[0] = 1.0", "road")),  # type: ignore[arg-type]
    (lambda: measured().elevation(61.0), ("path from 61 m to 61 m", "-20 m to 60 m")),
    (lambda: measured().slope([0.0, -21.0]), ("path from -21 m", "-20 m to 60 m")),
    (lambda: sw.Smooth().elevation(nan), ("x = nan", "finite")),
    (lambda: measured().iri(0.0, 61.0), ("path from 0 m to 61 m", "-20 m to 60 m")),
    (lambda: measured().iri(0.0, 10.0), ("end = 10 m", "11 to 100000 m beyond start, 0 m")),
    (lambda: sw.Smooth().iri(0.0, 1e12), ("end = 1000000000000 m", "11 to 100000 m")),
    (lambda: measured().psd(5.0, 5.0), ("end = 5 m", "greater than start, 5 m")),
    (lambda: measured().psd(0.0, 61.0), ("-20 m to 60 m",)),
    (lambda: sw.Smooth().psd(0.0, 1e9), ("end = 1e+09 m", "at most 200000 m")),
    (lambda: measured().psd(0.0, 50.0, spacing=2.0), ("spacing = 2 m", "1.5625 m")),
    (lambda: measured().psd(0.0, 50.0, segment=0.1), ("segment = 0.1 m", "0.4 m", "50 m")),
    (lambda: measured().psd(0.0, 50.0, segment=0.5), ("segment = 0.5 m", "hold a wave of 0.625 m")),
    (lambda: measured().psd(0.0, 2.0), ("end = 2 m", "2.5 m or more beyond start, 0 m")),
    (lambda: measured().iri(0.0, 50.0, every=0.1), ("every = 0.1 m", "0.25 m")),
    (lambda: measured().iri(0.0, 50.0, every="all"), ("every = 'all'", NUMBER)),  # type: ignore[call-overload]
    (
        lambda: measured().iso_class(0.0, 50.0, band=(0.1, 0.3)),
        ("band = (0.1, 0.3)", "two octaves"),
    ),
    (lambda: sw.Smooth().iso_class(0.0, 100.0), ("smooth", "no class")),
    (lambda: measured().iso_class(0.0, 50.0, band=(1.0, 0.5)), ("band = (1.0, 0.5)", "greater")),
    (
        lambda: measured().iso_class(0.0, 50.0, band=(0.01, 0.1)),
        ("band = (0.01, 0.1)", "only 0.24 to 1.6 cycle/m"),
    ),
    (table(), ("road: missing kind", "iso-8608, bridge-study")),
    (table(kind="iso8608"), ("road.kind = 'iso8608'", "did you mean 'iso-8608'")),
    (table(kind=3), ("kind = 3", "must be one of iso-8608")),
    (table(kind="iso-8608", clas="B"), ("unknown key 'clas'", "did you mean 'class'", "allowed")),
    (table(kind="iso-8608", road_class="B"), ("unknown key 'road_class'",)),
    (table(kind="iso-8608", iri=2.0, G=1e-6), ("G = 1e-06", "not used with iri")),
    (table(kind="bridge-study", seed=1), ("missing condition",)),
    (table(kind="step", at=1.0), ("road: missing height",)),
    (table(kind="smooth", seed=1), ("unknown key 'seed'",)),
    (table(kind="profile"), ("missing x, elevations",)),
    (table(kind="profile", file="a.csv", x=[1.0]), ("x = [1.0]: not used with file",)),
    (table(kind="profile", x=[1.0], scale=[1, 1]), ("scale = [1, 1]", "with file only")),
    (table(kind="profile", file=3), ("file = 3", "text")),
    (lambda: sw.roads.from_table([{"kind": "smooth"}, {}]), ("road[1]: missing kind",)),
    (lambda: sw.roads.from_table("B"), ("road = 'B'", "table")),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("ask", "parts"), REFUSALS)
def test_refused_soon_and_cheaply(ask: Callable[[], object], parts: tuple[str, ...]) -> None:
    tracemalloc.start()
    start = process_time()
    with pytest.raises(ValueError) as refused:  # noqa: PT011 - the parts are the match
        ask()
    elapsed, (_, peak) = process_time() - start, tracemalloc.get_traced_memory()
    tracemalloc.stop()
    for part in parts:
        assert part in str(refused.value), str(refused.value)
    assert elapsed < SOON
    assert peak < LITTLE * 2**20


def test_a_road_needs_a_kind() -> None:
    with pytest.raises(TypeError, match="all kinds"):
        sw.roads.Road()


def test_the_file_of_a_profile_may_lie_deep(tmp_path: Path) -> None:
    folder = tmp_path / ("deep" * 30)
    folder.mkdir()
    file = folder / "road.csv"
    file.write_text("".join(f"{x},0.0\n" for x in range(20)), encoding="utf-8")
    road = sw.roads.from_table({"kind": "profile", "file": str(file)})
    assert road == sw.Profile.read(file)
