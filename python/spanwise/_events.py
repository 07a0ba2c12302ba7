"""Who crosses in the samples of an ensemble, how fast, and on which road of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import array, as_array, refuse_where
from spanwise._value import Value
from spanwise._wheels import Wheels
from spanwise.crossing import made_by, passages_of
from spanwise.errors import InputError, KindError, refused, wrong_kind
from spanwise.roads import ISO8608, Road
from spanwise.roads.base import total
from spanwise.roads.random import is_random
from spanwise.traffic import Drive, Passage
from spanwise.traffic import Speeds as SpeedsInTime

Array: TypeAlias = NDArray[np.float64]
Event: TypeAlias = tuple[Passage, ...]


def events_of(vehicle: object) -> tuple[Event, ...]:
    """The kinds of event: one of a vehicle, a passage or a list of these, else one for each entry.

    A list of `Passage` is one event, a list of vehicles is a fleet of which one crosses at a time,
    and a list of lists of `Passage` are several events.
    """
    if isinstance(vehicle, Wheels | Passage):
        return (passages_of(vehicle),)
    if not isinstance(vehicle, list | tuple) or not vehicle:
        raise wrong_kind(
            "vehicle",
            vehicle,
            "must be a Vehicle, a train, a Passage, a list of Passage for one event, or a list of "
            "vehicles or of lists of Passage, of which sample i drives number kind[i]"
            f"{made_by(vehicle)}",
        )
    if all(isinstance(each, Passage) for each in vehicle):
        return (tuple(vehicle),)
    events = []
    for i, each in enumerate(vehicle):
        if isinstance(each, Passage) and any(isinstance(other, Wheels) for other in vehicle):
            raise wrong_kind(
                f"vehicle[{i}]",
                each,
                "a Passage beside vehicles could be part of one event or an event of its own; give "
                "a list of Passage, or a list of lists of them",
            )
        try:
            events.append(passages_of(each))
        except KindError:
            allowed = f"must be a vehicle, a train, or a list of Passage{made_by(each)}"
            raise wrong_kind(f"vehicle[{i}]", each, allowed) from None
    return tuple(events)


def own_road(road: Road, events: Sequence[Event], own_roads: bool) -> tuple[Road, ISO8608 | None]:
    """What all samples share of a road, and what is drawn anew for each."""
    if not own_roads:
        return road, None
    parts = road._summands
    random = [part for part in parts if isinstance(part, ISO8608)]
    if len(random) > 1:
        raise refused(
            "road",
            road,
            f"has {len(random)} random parts, of which one alone can be drawn anew for each "
            "sample; give one, or own_roads=False to take all as they stand",
        )
    for event in events:
        for k, passage in enumerate(event):
            if passage.road is not None and is_random(passage.road):
                raise refused(
                    f"vehicles[{k}].road",
                    passage.road,
                    "is random, but only the road of the ensemble is drawn anew for each "
                    "sample; give it as road, or own_roads=False to take all roads as they "
                    "stand",
                )
    if not random:
        return road, None
    return total(part for part in parts if not isinstance(part, ISO8608)), random[0]


def kind_column(kind: object, events: Sequence[Event], samples: int) -> NDArray[np.uint32]:
    """The kind of event of every sample; empty if there is one kind."""
    if kind is None:
        if len(events) > 1:
            raise InputError(
                "kind",
                None,
                f"missing; give for each of the {samples} samples which of the {len(events)} "
                "kinds of event it is, from 0",
            )
        return np.zeros(0, dtype=np.uint32)
    kinds = as_array("kind", kind)
    if kinds.dtype.kind not in "iu" and kinds.size > 0:
        raise refused("kind", kind, "must be whole numbers, one for each sample")
    if kinds.shape != (samples,):
        raise InputError(
            "kind", f"shape {kinds.shape}", f"must be one number for each of the {samples} samples"
        )
    # As numbers without sign some others would be in range.
    wrong = (kinds < 0) | (kinds >= len(events))
    refuse_where(wrong, "kind", kinds, f"must be from 0 to {len(events) - 1}")
    return kinds.astype(np.uint32) if len(events) > 1 else np.zeros(0, dtype=np.uint32)


@dataclass(frozen=True, eq=False, repr=False)
class Speeds(Value):
    """The speeds of an ensemble [m/s].

    Attributes
    ----------
    given : float or ndarray or None
        As the caller gave them; where a passage has its own, that.
    column : ndarray
        As the core takes them: one for all, one for each sample, or one for each vehicle of it.
    """

    given: float | Array | None
    column: Array

    def rows(self, samples: int) -> Array:
        """Shape (sample, 1) or (sample, vehicle); one row where it is the same for all."""
        return self.column.reshape(1 if len(self.column) == 1 else samples, -1)

    def driven(
        self, events: Sequence[Event], kinds: NDArray[np.uint32], samples: int, drive: Drive
    ) -> Array:
        """With those that passages have of their own; NaN by time, and of no vehicle."""
        used = _used(events, drive)
        brought = np.full(used.shape, np.nan)
        for number, event in enumerate(events):
            speeds = [np.nan if each.speed is None else each.speed for each in event]
            brought[number, : len(event)] = speeds
        of = kinds if len(events) > 1 else slice(None)
        return np.where(used[of], self.rows(samples), brought[of])


def speeds_of(speed: object, events: Sequence[Event], samples: int) -> Speeds:
    """Speeds as they were given: a number, one for each sample, or one for each of its vehicles."""
    if speed is None:
        return Speeds(None, np.ones(1))
    values = array("speed", speed)
    if values.ndim == 0:
        return Speeds(float(values), values.reshape(1))
    most = max(map(len, events))
    allowed = [(samples,)] if most == 1 else [(samples,), (samples, most)]
    if values.shape not in allowed and values.shape != (samples, 1):
        shapes = " or ".join(map(str, allowed))
        raise InputError("speed", f"shape {values.shape}", f"must be a number or of shape {shapes}")
    return Speeds(values, np.ascontiguousarray(values).ravel())


def refuse_unused(speeds: Speeds, events: Sequence[Event], drive: Drive) -> None:
    """Refuses speeds that no passage of any kind uses, for all have their own."""
    given = speeds.given
    if given is None:
        return
    used = _used(events, drive).any(axis=0)
    what = f"{given:g}" if isinstance(given, float) else f"shape {given.shape}"
    if not used.any():
        raise InputError(
            "speed",
            what,
            "not used, for every passage has a speed of its own; leave one of the two out",
        )
    if isinstance(given, float) or given.shape[1:] != used.shape:
        return
    for k in np.flatnonzero(~used):
        if (given[:, k] != given[:1, k]).any():
            raise InputError(
                f"speed[:, {k}]",
                f"{given[:, k].min():g} to {given[:, k].max():g}",
                f"not used, for vehicles[{k}] has a speed of its own; leave it out there, or "
                "give one number in this column",
            )


def _used(events: Sequence[Event], drive: Drive) -> NDArray[np.bool_]:
    """Whether the speed of the ensemble is that of a vehicle, by kind and vehicle."""
    found = np.zeros((len(events), max(map(len, events))), dtype=np.bool_)
    for number, event in enumerate(events):
        for k, passage in enumerate(event):
            in_time = isinstance(passage.drive or drive, SpeedsInTime)
            found[number, k] = passage.speed is None and not in_time
    return found


def speeds_told(
    speeds: Speeds,
    events: Sequence[Event],
    kinds: NDArray[np.uint32],
    samples: int,
    drive: Drive,
) -> Speeds:
    """The speeds with those that passages bring in their places, as far as these have one."""
    given = speeds.given
    if given is None or all(each.speed is None for event in events for each in event):
        return speeds
    used = _used(events, drive)
    by_vehicle = isinstance(given, np.ndarray) and given.shape[1:] == used.shape[1:]
    width = used.shape[1] if by_vehicle else 1
    before = np.reshape(given, (-1, width))
    columns = np.broadcast_to(before, (samples, width))
    # What each kind brings, as far as it does: kinds may be as many as samples.
    brought = np.full((len(events), width), np.nan)
    for number, event in enumerate(events):
        for k in range(width):
            own = {each.speed for each in (event[k : k + 1] if by_vehicle else event)}
            if len(own) == 1 and (speed := own.pop()) is not None:
                brought[number, k] = speed
    # One number cannot tell several, and what nothing uses must not differ.
    if by_vehicle and len(events) > 1:
        brought[:, ~used.any(axis=0)] = np.nan
    own_speeds = brought[kinds] if len(events) > 1 else brought[:1]
    columns = np.where(np.isnan(own_speeds), columns, own_speeds)
    if (columns == before).all():
        return speeds
    values = columns.reshape(given.shape) if isinstance(given, np.ndarray) else columns[:, 0]
    return Speeds(values, np.ascontiguousarray(values).ravel())


def is_simple(event: Event, drive: Drive) -> bool:
    """Whether it is one vehicle at constant speed from the left, which shares its geometry."""
    if len(event) > 1:
        return False
    (passage,) = event
    plain = passage.direction == "right" and passage.entry == 0.0 and passage.road is None
    return plain and (passage.drive or drive) == "constant-speed"
