"""An ensemble in words and tables, for reading on a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from spanwise.columns import SampleExtremes
from spanwise.population import FACTORS, Ensemble
from spanwise.roads import ISO8608, Road, Sum
from spanwise.traffic import plain_drive

if TYPE_CHECKING:
    from spanwise._events import Event

#: Percentiles that are shown.
PERCENTILES: Final = (5.0, 50.0, 95.0, 99.0)

#: Failures that are shown.
SHOWN: Final = 5

#: Rows of extremes: name, quantity, side, factor from SI.
ROWS: Final = (
    ("deflection, down [mm]", "deflection", "max", 1e3),
    ("moment, sagging [kN m]", "moment", "max", 1e-3),
    ("moment, hogging [kN m]", "moment", "min", -1e-3),
    ("shear [kN]", "shear", "both", 1e-3),
    ("reaction, up [kN]", "reactions", "max", 1e-3),
    ("clamp moment [kN m]", "clamp_moments", "both", 1e-3),
    ("axle load [kN]", "axle_loads", "max", 1e-3),
)


def summary(ensemble: Ensemble) -> str:
    """What crossed what and how fast it was, percentiles, and samples that failed."""
    lines = [*_description(ensemble), ""]
    if ensemble.samples > len(ensemble.failures):
        lines += [*_extremes(ensemble), "", *_factors(ensemble), "", *_ride(ensemble)]
    lines += _failures(ensemble)
    return "\n".join(lines).rstrip()


def _description(ensemble: Ensemble) -> Iterator[str]:
    recipe, settings = ensemble._recipe, ensemble.settings
    failed = f", {len(ensemble.failures)} failed" if ensemble.failures else ""
    yield (
        f"ensemble  {ensemble.samples} samples from number {ensemble.first} of seed "
        f"{ensemble.seed}{failed}"
    )
    yield f"bridge    {ensemble.bridge!r}; {len(ensemble.frequencies)} modes"
    for number, event in enumerate(recipe.events):
        kind = f"kind {number}: " if len(recipe.events) > 1 else ""
        yield f"vehicle   {kind}{_event(event)}"
    speeds = recipe.speeds.column
    if ensemble.speed is not None:
        span = (
            f"{speeds.min():g}"
            if np.ptp(speeds) == 0.0
            else f"{speeds.min():g} to {speeds.max():g}"
        )
        drive = plain_drive(recipe.drive)
        yield f"          {span} m/s, {drive if isinstance(drive, str) else drive['kind']}"
    yield f"road      {_road(recipe.road, recipe.own)}"
    for each in recipe.factors:
        yield f"varied    {each.name} from {each.values.min():.4g} to {each.values.max():.4g}"
    yield (
        f"crossing  approach {settings['approach']:g} m, tail {settings['tail']:g} s; recovery by "
        f"{settings['recovery']}; {len(ensemble.sections)} sections"
    )
    way = (
        "side by side, for they share their geometry"
        if ensemble.shares_geometry
        else "one by one, for they do not share their geometry, which takes about ten times as long"
    )
    yield f"marched   {way}"
    yield (
        f"speed     {ensemble.rate:.0f} crossings/s: {ensemble.elapsed:.2f} s, "
        f"{ensemble.threads} thread{'s' if ensemble.threads > 1 else ''}, {ensemble.isa}"
    )
    yield f"hash      {ensemble.hash}"


def _event(event: Event) -> str:
    return ", ".join(repr(each.vehicle) if len(event) == 1 else repr(each) for each in event)


def _road(shared: Road, own: ISO8608 | None) -> str:
    parts = shared.parts if isinstance(shared, Sum) else (shared,)
    words = [each.kind for each in parts if not each.is_smooth]
    if own is not None:
        letter = f" class {own.road_class}" if own.road_class else f" G_d(n0) {own.G:.4g} m3"
        words.append(f"{own.kind}{letter}, drawn anew for each sample")
    return " + ".join(words) or "smooth"


def _extremes(ensemble: Ensemble) -> Iterator[str]:
    """Of the largest along the bridge in each sample."""
    head = "".join(f"{f'{p:g} %':>10}" for p in PERCENTILES)
    yield f"{'largest in a sample':<24}{head}{'max':>10}{'static':>10}{'at':>14}"
    for name, quantity, side, scale in ROWS:
        if quantity != "axle_loads" and quantity not in ensemble.quantities:
            continue
        extremes: SampleExtremes = getattr(ensemble, quantity)
        if extremes.max.shape[1] == 0:
            continue
        dynamic, static = (scale * each for each in _one_side(extremes, side))
        most = np.nanmax(dynamic, axis=1, initial=-np.inf)
        sound = most[np.isfinite(most)]
        where = int(np.unravel_index(int(np.nanargmax(dynamic)), dynamic.shape)[1])
        place = f"{extremes.x[where]:.0f}" if quantity == "axle_loads" else None
        at = f"axle {place}" if place else f"x = {extremes.x[where]:.3f} m"
        columns = [*np.percentile(sound, PERCENTILES), sound.max(), np.nanmax(static)]
        yield f"{name:<24}{''.join(f'{value + 0.0:>10.3f}' for value in columns)}{at:>14}"
    yield "static: the largest under the static axle loads; at: where the largest of all occurs"


def _one_side(
    extremes: SampleExtremes, side: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if side == "max":
        return extremes.max, extremes.static_max
    if side == "min":
        return extremes.min, extremes.static_min
    return (
        np.maximum(np.abs(extremes.max), np.abs(extremes.min)),
        np.maximum(np.abs(extremes.static_max), np.abs(extremes.static_min)),
    )


def _factors(ensemble: Ensemble) -> Iterator[str]:
    """Impact factors where the static value is largest."""
    head = "".join(f"{f'{p:g} %':>10}" for p in PERCENTILES)
    yield f"{'impact factor':<24}{'mean':>10}{head}{'max':>10}{'at':>14}"
    for name, (quantity, sense) in FACTORS.items():
        if quantity != "axle_loads" and quantity not in ensemble.quantities:
            continue
        extremes: SampleExtremes = getattr(ensemble, quantity)
        side = {"positive": "max", "negative": "min", "either": "both"}[sense]
        sign = -1.0 if sense == "negative" else 1.0
        static = np.nanmean(np.atleast_2d(sign * _one_side(extremes, side)[1]), axis=0)
        where = int(np.nanargmax(static))
        found = ensemble.impact_factors(name)[:, where]
        found = found[np.isfinite(found)]
        x = extremes.x[where]
        at = f"axle {x:.0f}" if name == "axle_loads" else f"x = {x:.3f} m"
        if len(found) == 0:
            yield f"{name:<24}{'-':>10}"
            continue
        columns = [found.mean(), *np.percentile(found, PERCENTILES), found.max()]
        yield f"{name:<24}{''.join(f'{value:>10.3f}' for value in columns)}{at:>14}"
    yield "at: where the static value is largest"


def _ride(ensemble: Ensemble) -> Iterator[str]:
    coefficients = np.nanmean(ensemble.load_coefficients, axis=0)
    yield (
        "standard deviation of the axle loads on the bridge by their static values, mean of the "
        f"samples: {', '.join(f'{100.0 * each:.1f}' for each in coefficients)} %"
    )
    off = (ensemble.lift_offs > 0).any(axis=1).sum()
    if off > 0:
        longest = np.nanmax(ensemble.time_off_road)
        yield f"wheels leave the road in {off} samples, in one for {longest:.3f} s in all"
    else:
        yield "wheels never leave the road"


def _failures(ensemble: Ensemble) -> Iterator[str]:
    for each in ensemble.failures[:SHOWN]:
        step = "" if each.step is None else f" in step {each.step}"
        yield f"failed    sample {each.sample}{step}: {each.cause}"
    if len(ensemble.failures) > SHOWN:
        yield f"          and {len(ensemble.failures) - SHOWN} more, see failures"
