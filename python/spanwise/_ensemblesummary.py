"""An ensemble in words and tables, for reading on a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from spanwise._events import Event
from spanwise._recipe import Recipe
from spanwise._shown import many, warned
from spanwise._variation import Factors
from spanwise.columns import ROUNDING, SampleExtremes, Sense
from spanwise.damping import in_words
from spanwise.population import Ensemble
from spanwise.roads import ISO8608, Road, Sum
from spanwise.samples import FACTORS
from spanwise.summary import road_in_words
from spanwise.traffic import Passage, plain_drive
from spanwise.traffic import Speeds as SpeedsInTime

Array = NDArray[np.float64]

#: Percentiles that are shown.
PERCENTILES: Final = (5.0, 50.0, 95.0, 99.0)

#: Failures and kinds of event that are shown.
SHOWN: Final = 5

#: Samples that should lie beyond a percentile for it to say much.
BEYOND: Final = 10

#: Width of the names of rows.
NAME: Final = 30

#: Which extremes a sense is about.
SIDES: Final[dict[Sense, str]] = {"positive": "max", "negative": "min", "either": "both"}

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
        lines += [*_extremes(ensemble), "", *_factors(ensemble), "", *_largest(ensemble), ""]
        lines += [*_few(ensemble), *_ride(ensemble)]
    lines += _failures(ensemble)
    return "\n".join(lines).rstrip()


def differ(static: Array) -> bool:
    """Whether static values, one row for each sample, differ by more than rounding."""
    if static.ndim < 2 or np.isnan(static).all():
        return False
    there = static[:, ~np.isnan(static).all(axis=0)]
    spread = np.nanmax(there, axis=0) - np.nanmin(there, axis=0)
    return bool(spread.max() > ROUNDING * np.nanmax(np.abs(there)))


def _description(ensemble: Ensemble) -> Iterator[str]:
    recipe, settings = ensemble._recipe, ensemble.settings
    failed = f", {len(ensemble.failures)} failed" if ensemble.failures else ""
    yield (
        f"ensemble  {many(ensemble.samples, 'sample')} from number {ensemble.first} of seed "
        f"{ensemble.seed}{failed}"
    )
    yield f"bridge    {ensemble.bridge!r}"
    damping = in_words(settings["damping"], ensemble.frequencies)
    yield f"modes     {len(ensemble.frequencies)}; damping {damping}"
    for number, event in enumerate(recipe.events[:SHOWN]):
        kind = f"kind {number}: " if len(recipe.events) > 1 else ""
        yield f"vehicle   {kind}{', '.join(map(_passage, event))}"
        yield from _own_roads(event)
    if len(recipe.events) > SHOWN:
        yield f"          and {len(recipe.events) - SHOWN} kinds more"
    if ensemble.speed is not None and recipe.speeds.column.size > 0:
        drive = plain_drive(recipe.drive)
        name = drive if isinstance(drive, str) else drive["kind"]
        yield f"          {_span(recipe.speeds.column, 'g')} m/s, {name}"
    passages = [each for event in recipe.events for each in event]
    if all(each.road is not None for each in passages):
        one = "its own, see vehicle" if len(passages) == 1 else "each vehicle's own"
        yield f"road      {one}"
    else:
        yield f"road      {_road(recipe.road, recipe.own)}"
    for each in recipe.factors:
        yield _factor(each)
    if ensemble.samples > 1 and _alike(recipe):
        yield "note      all samples are alike: nothing is random"
    yield (
        f"crossing  approach {settings['approach']:g} m; recovery by {settings['recovery']}; "
        f"{len(ensemble.sections)} sections"
    )
    yield from _tail(ensemble)
    yield f"step      {_step(ensemble)}"
    way = (
        "side by side, for they share their geometry"
        if ensemble.shares_geometry
        else "one by one, for they do not share their geometry, which takes 15 to 20 times as long"
    )
    yield f"marched   {way}"
    yield (
        f"speed     {ensemble.rate:.0f} crossings/s: {ensemble.elapsed:.2f} s, "
        f"{ensemble.threads} thread{'s' if ensemble.threads > 1 else ''}, {ensemble.isa}"
    )
    yield f"hash      {ensemble.hash}"
    yield from warned(ensemble.warnings)


def _tail(ensemble: Ensemble) -> Iterator[str]:
    """How long the free vibration was kept, and in how many samples not long enough."""
    tails = ensemble.tail[np.isfinite(ensemble.tail)]
    why = ", until no extreme can follow" if ensemble.settings.get("tail") is None else ""
    if len(tails):
        yield f"          tail {_span(tails, '.4g')} s{why}"
    growths = np.nan_to_num(ensemble.growth)
    if not (early := int((growths > 0.0).sum())):
        return
    row = int(np.argmax(growths))
    yield (
        f"note      in {many(early, 'sample')} free vibration after the end can exceed an extreme "
        "by more than 1 %,"
    )
    yield (f"          most in sample {ensemble.first + row}, the {ensemble._growing(row)},")
    yield f"          by at most {100.0 * growths[row]:.1f} % of the largest along the bridge"


def _passage(passage: Passage) -> str:
    """The vehicle, and how it crosses if not as all do; roads have lines of their own."""
    without = replace(passage, road=None)
    plain = without == Passage(vehicle=passage.vehicle)
    return repr(passage.vehicle) if plain else repr(without)


def _own_roads(event: Event) -> Iterator[str]:
    """The roads of vehicles that do not take that of the ensemble."""
    for number, each in enumerate(event):
        if each.road is not None:
            who = f"vehicle {number + 1} " if len(event) > 1 else ""
            yield f"          {who}on a road of its own: {road_in_words(each.road)}"


def _road(shared: Road, own: ISO8608 | None) -> str:
    parts = shared.parts if isinstance(shared, Sum) else (shared,)
    words = [each.kind for each in parts if not each.is_smooth]
    if own is not None:
        letter = f" class {own.road_class}" if own.road_class else f" G_d(n0) {own.G:.4g} m3"
        words.append(f"{own.kind}{letter}, drawn anew for each sample")
    return " + ".join(words) or "smooth"


def _span(values: Array, form: str) -> str:
    """One value, or the least and the largest."""
    least, most = format(values.min(), form), format(values.max(), form)
    return least if least == most else f"{least} to {most}"


def _factor(factors: Factors) -> str:
    values = factors.values
    if values.size == 0:
        return f"varied    {factors.name}"
    if (values == values[0]).all():
        found = ", ".join(f"{each:.4g}" for each in values[0])
        if (values[0] == values[0, 0]).all():
            found = f"{values[0, 0]:.4g}"
        return f"factor    {factors.name} {found} for all samples"
    return f"varied    {factors.name} from {values.min():.4g} to {values.max():.4g}"


def _alike(recipe: Recipe) -> bool:
    """Whether all samples are the same crossing."""
    used = np.unique(recipe.kinds) if len(recipe.kinds) else np.zeros(1, dtype=np.uint32)
    by_sample = [each.values for each in recipe.factors]
    for passage in recipe.event(0):
        if passage.speed is None and not isinstance(passage.drive or recipe.drive, SpeedsInTime):
            column = recipe.speeds.column
            by_sample.append(column.reshape(1 if len(column) == 1 else recipe.samples, -1))
    constant = all((each == each[:1]).all() for each in by_sample)
    return recipe.own is None and len(used) == 1 and constant


def _step(ensemble: Ensemble) -> str:
    rows, column = ensemble._rows, ensemble._recipe.front_speeds
    if rows.step(0, float(column[0])) is not None:
        # All samples of a march take steps of one way: the fastest has the shortest of them.
        marches = rows.marches
        speeds = np.broadcast_to(column, len(marches))
        order = np.lexsort((speeds, marches))
        first = np.flatnonzero(np.diff(marches[order], prepend=-1))
        last = np.append(first[1:] - 1, len(order) - 1)
        found = [rows.step(i, speeds[i]) for i in order[np.concatenate([first, last])]]
        return f"{_span(np.array([each[0] for each in found if each is not None]), '.4g')} s"
    given = ensemble.settings.get("step")
    if given is not None:
        return f"at most {given:.4g} s"
    return 'of each sample as for cross, run(i).settings["step"] tells'


def _head(title: str) -> str:
    percentiles = "".join(f"{f'{p:g} %':>10}" for p in PERCENTILES)
    return f"{title:<{NAME}}{percentiles}{'max':>10}"


def _extremes(ensemble: Ensemble) -> Iterator[str]:
    """Of the largest along the bridge in each sample."""
    rows, varied = [], False
    for name, quantity, side, scale in ROWS:
        if not ensemble._looks_at(quantity):
            continue
        extremes: SampleExtremes = ensemble.envelope(quantity)
        if extremes.max.shape[1] == 0:
            continue
        dynamic, static = (scale * each for each in _one_side(extremes, side))
        most = np.nanmax(dynamic, axis=1, initial=-np.inf)
        sound = np.isfinite(most)
        where = int(np.unravel_index(int(np.nanargmax(dynamic)), dynamic.shape)[1])
        beside = _along(static[sound] if static.ndim == 2 else static[None])
        varied = varied or differ(beside[:, None])
        columns = [*np.percentile(most[sound], PERCENTILES), most[sound].max(), np.median(beside)]
        rows.append((_all_the_way(ensemble, name, quantity), columns, _at(extremes, where, name)))
    width = 16 if varied else 10
    title = "static, median" if varied else "static"
    yield f"{_head('largest in a sample')}{title:>{width}}{'at':>14}"
    for name, columns, at in rows:
        numbers = [f"{value + 0.0:>10.3f}" for value in columns]
        yield f"{name:<{NAME}}{''.join(numbers[:-1])}{numbers[-1]:>{width}}{at:>14}"
    if varied:
        yield (
            "static, median: the largest under the static axle loads, which differs from sample "
            "to sample"
        )
        yield "at: where the largest of all occurs"
    else:
        yield "static: the largest under the static axle loads; at: where the largest of all occurs"


def _all_the_way(ensemble: Ensemble, name: str, quantity: str) -> str:
    """The name of a row; axle loads are those of the whole way, not on the bridge alone."""
    if quantity != "axle_loads" or ensemble.settings["approach"] == 0.0:
        return name
    head, bracket, unit = name.partition(" [")
    return f"{head}, approach too{bracket}{unit}"


def _at(extremes: SampleExtremes, where: int, name: str) -> str:
    x = extremes.x[where]
    return f"axle {x:.0f}" if name.startswith("axle") else f"x = {x:.3f} m"


def _one_side(extremes: SampleExtremes, side: str) -> tuple[Array, Array]:
    if side == "max":
        return extremes.max, extremes.static_max
    if side == "min":
        return extremes.min, extremes.static_min
    return (
        np.maximum(np.abs(extremes.max), np.abs(extremes.min)),
        np.maximum(np.abs(extremes.static_max), np.abs(extremes.static_min)),
    )


def by_sense(extremes: SampleExtremes, sense: Sense) -> tuple[Array, Array]:
    """Dynamic and static values by sample, larger where they matter; one row where all share it."""
    sign = -1.0 if sense == "negative" else 1.0
    dynamic, static = _one_side(extremes, SIDES[sense])
    return sign * dynamic, np.atleast_2d(sign * static)


def _along(values: Array) -> Array:
    """The largest along the bridge in each sample; NaN where there is none."""
    found: Array = np.nanmax(values, axis=1, initial=-np.inf)
    return np.where(np.isfinite(found), found, np.nan)


def _medians(values: Array) -> Array:
    """By section, over the samples; minus infinity where there is no value."""
    columns = (each[~np.isnan(each)] for each in values.T)
    return np.array([np.median(each) if len(each) else -np.inf for each in columns])


def governing(dynamic: Array, static: Array) -> int:
    """The section of the largest static value; of some that are alike, of the largest dynamic one.

    On a symmetric bridge rounding alone tells static values apart.
    """
    beside = _medians(static)
    most = beside.max()
    alike = np.flatnonzero(beside >= most - ROUNDING * abs(most))
    return int(alike[np.argmax(_medians(dynamic[:, alike]))]) if len(alike) > 1 else int(alike[0])


def _factors(ensemble: Ensemble) -> Iterator[str]:
    """Impact factors where the static value is largest."""
    yield f"{_with_mean('impact factor')}{'at':>14}"
    for name, (quantity, sense) in FACTORS.items():
        if not ensemble._looks_at(quantity):
            continue
        extremes: SampleExtremes = ensemble.envelope(quantity)
        where = governing(*by_sense(extremes, sense))
        found = ensemble.impact_factors[name][:, where]
        at = _at(extremes, where, name)
        yield _factor_row(_all_the_way(ensemble, name, quantity), found, at)
    yield (
        "at: the one section, support or axle where the static value is largest; of static values "
        "alike"
    )
    yield "the one with the larger dynamic value, by their medians"
    yield "factors far from where a response governs are to be read with the response itself"


def _largest(ensemble: Ensemble) -> Iterator[str]:
    """The largest dynamic value of a sample by its largest static value, wherever they are."""
    yield _with_mean("largest by largest")
    for name, (quantity, sense) in FACTORS.items():
        if quantity not in ensemble.quantities:
            continue
        extremes: SampleExtremes = ensemble.envelope(quantity)
        dynamic, static = map(_along, by_sense(extremes, sense))
        magnitude = _along(np.atleast_2d(_one_side(extremes, "both")[1]))
        found = np.full(len(dynamic), np.nan)
        there = np.broadcast_to(static > ROUNDING * magnitude, found.shape)
        np.divide(dynamic, static, out=found, where=there)
        yield _factor_row(name, found, "")
    yield (
        "of each sample the largest dynamic value anywhere along the bridge by the largest static "
        "one anywhere"
    )


def _with_mean(title: str) -> str:
    head = _head("")
    return f"{title:<{NAME}}{'mean':>10}{head[NAME:]}"


def _factor_row(name: str, found: Array, at: str) -> str:
    found = found[np.isfinite(found)]
    if len(found) == 0:
        return f"{name:<{NAME}}{'-':>10}"
    columns = [found.mean(), *np.percentile(found, PERCENTILES), found.max()]
    return f"{name:<{NAME}}{''.join(f'{value:>10.3f}' for value in columns)}{at:>14}".rstrip()


def _few(ensemble: Ensemble) -> Iterator[str]:
    """Which of the percentiles rest on too few samples."""
    samples = ensemble.samples - len(ensemble.failures)
    weak = [f"{p:g} %" for p in PERCENTILES if p * samples > 100.0 * (samples - BEYOND)]
    if not weak or _alike(ensemble._recipe):
        return
    listed = " and ".join(filter(None, [", ".join(weak[:-1]), weak[-1]]))
    yield f"of {many(samples, 'sample')} {listed} say little: fewer than {BEYOND} lie beyond"
    yield ""


def _ride(ensemble: Ensemble) -> Iterator[str]:
    coefficients = np.nanmean(ensemble.load_coefficients, axis=0)
    yield (
        "root mean square of the axle loads about their static values, on the bridge, mean of the "
        f"samples: {', '.join(f'{100.0 * each:.1f}' for each in coefficients)} %"
    )
    off = (ensemble.off_road.count > 0).any(axis=1).sum()
    if off > 0:
        longest = np.nanmax(ensemble.off_road.total)
        yield f"wheels leave the road in {off} samples, in one for {longest:.3f} s in all"
    else:
        yield "wheels never leave the road"


def _failures(ensemble: Ensemble) -> Iterator[str]:
    for each in ensemble.failures[:SHOWN]:
        step = "" if each.step is None else f" in step {each.step}"
        yield f"failed    sample {each.sample}{step}: {each.cause}"
    if len(ensemble.failures) > SHOWN:
        yield f"          and {len(ensemble.failures) - SHOWN} more, see failures"
