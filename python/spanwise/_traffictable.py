"""The tables ``[road]`` and ``[[traffic]]`` of a case file: roads, and several vehicles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from spanwise._checks import shown
from spanwise._keys import Keys
from spanwise._vehicletable import Home, table_of, vehicle_of
from spanwise.roads import ISO8608, Road, Sum
from spanwise.roads.base import total
from spanwise.roads.table import road_of
from spanwise.traffic import Passage, plain_drive

Table: TypeAlias = Mapping[str, Any]

PASSAGE: Final = Keys.of(Passage)

#: Keys of ``[[traffic]]`` that no other table has.
OWN: Final = ("direction", "entry", "lane")


def road_in(table: object, folder: Path, elsewhere: Home) -> Road:
    """The road of a table, or the sum of the roads of a list of them; files are in the folder."""
    if isinstance(table, list):
        parts = []
        for k, each in enumerate(table):
            try:
                parts.append(road_of(_found(each, folder), elsewhere))
            except ValueError as error:
                raise ValueError(f"road[{k}]: {error}") from error
        return total(parts)
    return road_of(_found(table, folder), elsewhere)


def _found(table: object, folder: Path) -> object:
    """The table with the path of its file, if it names one."""
    if isinstance(table, Mapping) and isinstance(table.get("file"), str):
        return {**table, "file": str(folder / table["file"])}
    return table


def files_in(tables: Mapping[str, Any], folder: Path) -> Iterator[Path]:
    """The files that the roads of a case are read from."""
    for own in (tables, *tables.get("traffic", ())):
        roads = own.get("road", ())
        for each in roads if isinstance(roads, list) else [roads]:
            if isinstance(each, Mapping) and isinstance(each.get("file"), str):
                yield folder / each["file"]


def passage_of(table: object, folder: Path, elsewhere: Home) -> Passage:
    """One vehicle of the traffic."""
    if not isinstance(table, Mapping):
        raise ValueError(f"{shown(table)}: must be a table, [[traffic]]")
    PASSAGE.check_known(table, elsewhere)
    PASSAGE.check_complete(table)
    parts: dict[str, Any] = dict(table)
    if not isinstance(table["vehicle"], Mapping):
        raise ValueError(
            f"vehicle = {shown(table['vehicle'])}: must be a table, [traffic.vehicle] or "
            'vehicle = { preset = "..." }'
        )
    for key in ("vehicle", "road"):
        try:
            if key == "vehicle":
                parts[key] = vehicle_of(table[key], elsewhere)
            elif key in table:
                parts[key] = road_in(table[key], folder, elsewhere)
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from error
    return Passage(**parts)


def passage_table(passage: Passage) -> dict[str, Any]:
    """What `passage_of` makes this passage of."""
    table: dict[str, Any] = {"vehicle": table_of(passage.vehicle), "direction": passage.direction}
    table |= {"entry": passage.entry, "speed": passage.speed, "lane": passage.lane}
    if passage.drive is not None:
        table["drive"] = plain_drive(passage.drive)
    if passage.road is not None:
        table["road"] = passage.road.arguments
    return {key: value for key, value in table.items() if value is not None}


def is_alone(passages: tuple[Passage, ...]) -> bool:
    """Whether it is one vehicle that does what the crossing says."""
    return len(passages) == 1 and passages[0] == Passage(vehicle=passages[0].vehicle)


def is_random(road: Road) -> bool:
    """Whether a seed makes a difference."""
    return isinstance(road, ISO8608) or (isinstance(road, Sum) and any(map(is_random, road.parts)))


def reseeded(road: Road, seed: int) -> Road:
    """The road with another seed in all its random parts."""
    if isinstance(road, ISO8608):
        return replace(road, seed=seed)
    if isinstance(road, Sum):
        return Sum(tuple(reseeded(part, seed) for part in road.parts))
    return road
