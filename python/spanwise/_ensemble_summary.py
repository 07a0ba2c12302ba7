"""An ensemble in words and tables, for reading on a terminal or in a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._events import Event
from spanwise._shown import many, warned
from spanwise._table import Block, Table, html, listed, text
from spanwise.damping import in_words
from spanwise.ensembles import Ensemble
from spanwise.extremes import ROUNDING, SampleExtremes, differ, largest_of_each, quotients
from spanwise.quantities import Response, factors
from spanwise.roads import ISO8608, Road
from spanwise.traffic import Passage, plain_drive

Array: TypeAlias = NDArray[np.float64]

#: Percentiles that are shown.
PERCENTILES: Final = (5.0, 50.0, 95.0, 99.0)
HEADS: Final = (*(f"{each:g} %" for each in PERCENTILES), "max")

#: What is written below the tables.
STATIC: Final = (
    "static: the largest under the static axle loads; at: where the largest of all occurs",
)
STATIC_BY_SAMPLE: Final = (
    "static, median: the largest under the static axle loads, which differs from sample to sample",
    "at: where the largest of all occurs",
)
GOVERNING: Final = (
    "at: the one section, support or axle where the static value is largest; of static values "
    "alike",
    "the one with the larger dynamic value, by their medians",
    "factors far from where a response governs are to be read with the response itself",
)
ANYWHERE: Final = (
    "of each sample the largest dynamic value anywhere along the bridge by the largest static one "
    "anywhere",
)

#: Failures and kinds of event that are shown.
SHOWN: Final = 5

#: Samples that should lie beyond a percentile for it to say much.
BEYOND: Final = 10


def summary(ensemble: Ensemble) -> str:
    """What crossed what and how fast it was, percentiles, and samples that failed."""
    return text(_blocks(ensemble))


def page(ensemble: Ensemble) -> str:
    """The same for a notebook."""
    return html(_blocks(ensemble))


def _blocks(ensemble: Ensemble) -> Iterator[Block]:
    yield _description(ensemble)
    if ensemble.samples > len(ensemble.failures):
        yield _extremes(ensemble)
        yield _factors(ensemble)
        if (largest := _largest(ensemble)).rows:
            yield largest
        if few := [*_few(ensemble)]:
            yield few
        yield [*_ride(ensemble), *_failures(ensemble)]
    elif ensemble.failures:
        yield _failures(ensemble)


def _description(ensemble: Ensemble) -> Iterator[str]:
    plan, settings = ensemble._plan, ensemble.settings
    failed = f", {len(ensemble.failures)} failed" if ensemble.failures else ""
    yield (
        f"ensemble  {many(ensemble.samples, 'sample')} from number {ensemble.first} of seed "
        f"{ensemble.seed}{failed}"
    )
    yield f"bridge    {ensemble.bridge!r}"
    damping = in_words(settings["damping"], ensemble.frequencies)
    yield f"modes     {len(ensemble.frequencies)}; damping {damping}"
    for number, event in enumerate(plan.events[:SHOWN]):
        kind = f"kind {number}: " if len(plan.events) > 1 else ""
        yield f"vehicle   {kind}{', '.join(map(_passage, event))}"
        yield from _own_roads(event)
    if len(plan.events) > SHOWN:
        yield f"          and {len(plan.events) - SHOWN} kinds more"
    if ensemble.speed is not None:
        drive = plain_drive(plan.drive)
        name = drive if isinstance(drive, str) else drive["kind"]
        yield f"          {_span(plan.speeds.column, 'g')} m/s, {name}"
    passages = [each for event in plan.events for each in event]
    if all(each.road is not None for each in passages):
        one = "its own, see vehicle" if len(passages) == 1 else "each vehicle's own"
        yield f"road      {one}"
    else:
        yield f"road      {_road(plan.road, plan.own)}"
    for each in plan.factors:
        yield str(each)
    if ensemble.samples > 1 and plan.alike:
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
        else "each on its own way, for they do not share it, which takes a few times as long"
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
            yield f"          {who}on a road of its own: {each.road}"


def _road(shared: Road, own: ISO8608 | None) -> str:
    words = [each.kind for each in shared._summands if not each.is_smooth]
    if own is not None:
        letter = f" class {own.road_class}" if own.road_class else f" G_d(n0) {own.G:.4g} m3"
        words.append(f"{own.kind}{letter}, drawn anew for each sample")
    return " + ".join(words) or "smooth"


def _span(values: Array, form: str) -> str:
    """One value, or the least and the largest."""
    least, most = format(values.min(), form), format(values.max(), form)
    return least if least == most else f"{least} to {most}"


def _step(ensemble: Ensemble) -> str:
    rows, column = ensemble._rows, ensemble._plan.front_speeds
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


def _extremes(ensemble: Ensemble) -> Table:
    """Of the largest along the bridge in each sample."""
    rows, varied, unsigned = [], False, []
    for of, sense in ((each, sense) for each in ensemble.responses for sense in each.reported):
        extremes, (unit, scale) = ensemble.envelope(of.name), of.shown
        if len(extremes.x) == 0:
            continue
        dynamic, static = (scale * each for each in extremes.of(sense))
        most = largest_of_each(dynamic)
        sound = np.isfinite(most)
        where = int(np.unravel_index(int(np.nanargmax(dynamic)), dynamic.shape)[1])
        beside = largest_of_each(static[sound] if len(static) == len(sound) else static)
        varied = varied or differ(beside[:, None])
        name = f"{of.called(sense)}{_all_the_way(ensemble, of)} [{unit}]"
        # Deck motion has no static value.
        still = np.median(beside) if beside.any() else np.nan
        columns = *np.percentile(most[sound], PERCENTILES), most[sound].max(), still
        rows.append([name, *columns, _at(of, extremes, where)])
        if sense == "either" and (extremes.min < 0.0).any():
            unsigned.append(of.noun)
    notes = STATIC_BY_SAMPLE if varied else STATIC
    if unsigned:
        notes = (*notes, f"{', '.join(unsigned)}: the larger of both signs, without its sign")
    title = "static, median" if varied else "static"
    heads = ["largest in a sample", *HEADS, title, "at"]
    return Table(heads, rows, ["<", *[".3f"] * 6, "<"], notes)


def _all_the_way(ensemble: Ensemble, of: Response) -> str:
    """Axle loads are those of the whole way, not on the bridge alone."""
    apart = of.axis == "axle" and ensemble.settings["approach"] > 0.0
    return ", approach too" if apart else ""


def _at(of: Response, extremes: SampleExtremes, where: int) -> str:
    x = extremes.x[where]
    return f"axle {x:.0f}" if of.axis == "axle" else f"x = {x:.3f} m"


def _factors(ensemble: Ensemble) -> Table:
    """Impact factors where the static value is largest."""
    rows = []
    for name in ensemble.impact_factors.names:
        of, _ = factors()[name]
        where = ensemble.impact_factors.governing(name)
        row = _statistics(ensemble.impact_factors[name][:, where])
        at = _at(of, ensemble.envelope(of.name), where)
        rows.append([f"{name}{_all_the_way(ensemble, of)}", *row, None if row[-1] is None else at])
    heads = ["impact factor", "mean", *HEADS, "at"]
    return Table(heads, rows, ["<", *[".3f"] * 6, "<"], GOVERNING)


def _largest(ensemble: Ensemble) -> Table:
    """The largest dynamic value of a sample by its largest static value, wherever they are."""
    rows = []
    for name in ensemble.impact_factors.names:
        of, factor = factors()[name]
        if of.axis == "axle":
            continue
        extremes = ensemble.envelope(of.name)
        dynamic, static = map(largest_of_each, extremes.of(factor.sense))
        magnitude = largest_of_each(extremes.of("either")[1])
        found = quotients(dynamic, static, static > ROUNDING * magnitude)
        rows.append([name, *_statistics(found)])
    heads = ["largest by largest", "mean", *HEADS]
    return Table(heads, rows, ["<", *[".3f"] * 6], ANYWHERE)


def _statistics(found: Array) -> list[float | None]:
    """Mean, percentiles and largest of the samples that have a value."""
    found = found[np.isfinite(found)]
    if len(found) == 0:
        return [np.nan, *[None] * len(HEADS)]
    return [found.mean(), *np.percentile(found, PERCENTILES), found.max()]


def _few(ensemble: Ensemble) -> Iterator[str]:
    """Which of the percentiles rest on too few samples."""
    samples = ensemble.samples - len(ensemble.failures)
    weak = [f"{p:g} %" for p in PERCENTILES if p * samples > 100.0 * (samples - BEYOND)]
    if not weak or ensemble._plan.alike:
        return
    listed = " and ".join(filter(None, [", ".join(weak[:-1]), weak[-1]]))
    yield f"of {many(samples, 'sample')} {listed} say little: fewer than {BEYOND} lie beyond"


def _ride(ensemble: Ensemble) -> Iterator[str]:
    coefficients = np.nanmean(ensemble.dynamic_load_coefficients, axis=0)
    if coefficients.any():
        yield (
            "root mean square of the axle loads about their static values, on the bridge, mean of "
            f"the samples: {listed(100.0 * coefficients, '.1f')} %"
        )
    off = (ensemble.contact_loss.count > 0).any(axis=1).sum()
    if off > 0:
        longest = np.nanmax(ensemble.contact_loss.total)
        yield f"wheels leave the road in {off} samples, in one for {longest:.3f} s in all"
    else:
        yield "wheels never leave the road"


def _failures(ensemble: Ensemble) -> Iterator[str]:
    for each in ensemble.failures[:SHOWN]:
        step = "" if each.step is None else f" in step {each.step}"
        yield f"failed    sample {each.sample}{step}: {each.cause}"
    if len(ensemble.failures) > SHOWN:
        yield f"          and {len(ensemble.failures) - SHOWN} more, see failures"
