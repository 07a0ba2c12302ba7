"""Roads from plain tables, as a case file has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeAlias

from spanwise._build import Maker, Place, build_kind
from spanwise._checks import text
from spanwise.roads.base import Road, Smooth, total
from spanwise.roads.features import Bump, Camber, Joint, Pothole, Ramp, Step
from spanwise.roads.profile import Profile
from spanwise.roads.random import ISO8608, bridge_study, from_iri

Table: TypeAlias = Mapping[str, Any]


def _from_file(file: str, **options: Any) -> Profile:
    return Profile.read(text("file", file), **options)


_ROUGHNESS: Final = ("road_class", "G")

#: What makes each kind of road.
KINDS: Final[dict[str, Sequence[Maker[Road]]]] = {
    ISO8608.kind: (
        Maker(ISO8608, called={"class": "road_class"}),
        Maker(from_iri, options_of=ISO8608, without=_ROUGHNESS),
    ),
    "bridge-study": (Maker(bridge_study, options_of=ISO8608, without=_ROUGHNESS),),
    Profile.kind: (Maker(Profile), Maker(_from_file, options_of=Profile.read, without=("path",))),
    **{each.kind: (Maker(each),) for each in (Smooth, Step, Ramp, Bump, Pothole, Joint, Camber)},
}


def from_table(table: Table | list[Table]) -> Road:
    """A road from a table of plain values, such as ``[road]`` of a case file.

    Parameters
    ----------
    table : mapping or list of mapping
        Its ``kind`` (``"smooth"``, ``"iso-8608"``, ``"bridge-study"``, ``"profile"``, ``"step"``,
        ``"ramp"``, ``"bump"``, ``"pothole"``, ``"joint"`` or ``"camber"``), and beside it the
        arguments of that road: of ``"iso-8608"`` a ``class``, ``G`` or ``iri``, of
        ``"bridge-study"`` a ``condition``, of ``"profile"`` the points or a ``file`` with the
        arguments of `Profile.read`. A list of tables is the sum of their roads.

    Returns
    -------
    Road
        The road; its `arguments` make it again.

    Raises
    ------
    ValueError
        If a kind, key or value is not allowed, naming it and what is.
    OSError
        If a file cannot be read.

    Examples
    --------
    >>> road = from_table({"kind": "iso-8608", "class": "B", "seed": 1})
    >>> bumpy = from_table([road.arguments, {"kind": "step", "at": 0.0, "height": 0.01}])
    """
    return road_of(table, Place("road"))


def road_of(table: object, place: Place) -> Road:
    """The road of a table, or the sum of the roads of a list of them."""
    if isinstance(table, list | tuple):
        return total([build_kind(KINDS, each, place[k]) for k, each in enumerate(table)])
    return build_kind(KINDS, table, place)
