"""What of a road is hardly meant: values in other units, drop-outs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._shown import many

Array: TypeAlias = NDArray[np.float64]

#: Way over which slopes are taken [m]: over less, texture measured every millimetre is steep too.
_BASE: Final = 1.0

#: Slopes so far on both sides of one make the grade there, which vertical curves change [m].
_AROUND: Final = 10.0

#: Median slopes over that way, less the grade there, beyond which elevations are hardly in metres
#: [-]: on a road of class A of ISO 8608 it is 0.0012, of E 0.02, of A in inches 0.047, in
#: centimetres 0.12, in mm 1.2. Classes F to H, which no bridge should have, are doubted too.
_STEEP, _VERY_STEEP = 0.03, 0.5

#: Fewest slopes of which a median says something.
_FEWEST: Final = 6

#: How far a point is off the line through its neighbours to be no road [m], and by how many times
#: what is usual among the others.
_OFF, _UNUSUAL = 0.15, 20.0

#: A change of slope from point to point that no road has [-].
_NO_GRADE: Final = 0.5

#: G_d(n0) from which on a road is none [m3]: class H of ISO 8608, the roughest, begins at 0.13.
_NO_ROAD: Final = 1.0

#: Heights of a step or a bump, and widths of a joint, that are hardly exceeded [m].
HIGH, WIDE = 0.5, 1.0

#: Rise by length up to which a ramp, or a camber, may be higher; and a bump, up to a length [m].
STEEPEST, FLAT, LONG = 0.25, 0.05, 100.0


def doubts_of_roughness(G: float) -> Iterator[str]:
    """Of the roughness of a random road: tabulated digits without their power of ten."""
    if G >= _NO_ROAD:
        yield (
            f"G = {G:.6g}: in m3, where class H of ISO 8608, the roughest, begins at 0.13; the "
            f"standard tabulates 1e-6 m3: if {G:.6g} of these are meant, write {G * 1e-6:.6g}"
        )


def doubts_of_metres(of: object, largest: Mapping[str, float]) -> Iterator[str]:
    """Of arguments of a feature, by the values up to which they are usual: in mm."""
    for key, most in largest.items():
        value = getattr(of, key)
        if abs(value) > most:
            yield (
                f"{key} = {value:.6g}: in m, more than roads have; if mm are meant, write "
                f"{value * 1e-3:.6g}"
            )


def doubts(x: Array, elevations: Array) -> Iterator[str]:
    """Sentences to say of points that are in order."""
    dropped = _dropped(x, elevations)
    if dropped is not None:
        point, off = dropped
        others = int((elevations == elevations[point]).sum()) - 1
        also = f", as {many(others, 'other point')} of that value may be" if others else ""
        yield (
            f"elevations[{point}] = {elevations[point]:g}: is {off:.3g} m off the points beside "
            f"it{also}; is it a drop-out, or stands for a missing value? Leave such points out; of "
            f"a file missing does so, given their value as it is written there"
        )
        return
    slope = _slope(x, elevations)
    if slope > _VERY_STEEP:
        yield (
            f"elevations: their median slope is {slope:.3g}; are they in mm? Multiply them by "
            f"0.001, as scale = [1.0, 0.001] does in a file"
        )
    elif slope > _STEEP:
        yield (
            f"elevations: their median slope is {slope:.3g}, as of class F of ISO 8608 or worse; "
            "are they in inches, cm or mm? Multiply them by 0.0254, 0.01 or 0.001, as "
            "scale = [1.0, 0.0254] does in a file"
        )


def _slope(x: Array, elevations: Array) -> float:
    """Median deviation of slopes over a metre, or the points' distance, from the grade there."""
    length = float(x[-1] - x[0])
    base = max(min(_BASE, length / 8.0), length / 1e5, float(np.median(np.diff(x))))
    places = x[0] + base * np.arange(int(length / base) + 1)
    slopes = np.diff(np.interp(places, x, elevations)) / base
    if len(slopes) < _FEWEST:
        return 0.0
    sums = np.concatenate([[0.0], np.cumsum(slopes)])
    at = np.arange(len(slopes))
    beside = max(round(_AROUND / base), 1)
    first, end = np.maximum(at - beside, 0), np.minimum(at + beside + 1, len(slopes))
    grade = (sums[end] - sums[first]) / (end - first)
    return float(np.median(np.abs(slopes - grade)))


def _dropped(x: Array, elevations: Array) -> tuple[int, float] | None:
    """The worst point off the line through its neighbours, and how far, if that is no road."""
    if len(x) < 4:
        return None
    steps = np.diff(x)
    slopes = np.diff(elevations) / steps
    part = steps[:-1] / (x[2:] - x[:-2])
    between = elevations[:-2] + part * (elevations[2:] - elevations[:-2])
    # Off the lines that lead to a point from the left and from the right.
    left = elevations[2:] - (elevations[1:-1] + slopes[:-1] * steps[1:])
    right = elevations[:-2] - (elevations[1:-1] - slopes[1:] * steps[:-1])
    off = np.concatenate([right[:1], elevations[1:-1] - between, left[-1:]])
    unusual = np.abs(off) > max(_OFF, _UNUSUAL * float(np.median(np.abs(off))))
    # A spike is off both of these lines too, and a break of grade lies on them. Ends, which have
    # one of them alone, and drop-outs in a row are told from grades by what no road has.
    spike = np.full(len(x), True)
    spike[[0, -1]] = False
    spike[2:] &= left * np.sign(off[2:]) > 0.5 * np.abs(off[2:])
    spike[:-2] &= right * np.sign(off[:-2]) > 0.5 * np.abs(off[:-2])
    bends = np.abs(np.diff(slopes))
    bent = np.concatenate([bends[:1], bends, bends[-1:]]) > _NO_GRADE
    suspects = np.flatnonzero(unusual & (spike | bent))
    if len(suspects) == 0:
        return None
    # Good points beside a drop-out are off too, but not the farthest from all others.
    away = np.abs(elevations[suspects] - np.median(elevations))
    point = int(suspects[np.argmax(away)])
    return point, float(abs(off[point]))
