"""What a bridge is laid out with: supports on springs, and quantities that vary along the beam."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, TypeVar

from spanwise._build import Maker, Place, within
from spanwise._checks import Numbers, count, items, number, numbers, one_of, pair, shown
from spanwise._value import Hashed

T = TypeVar("T")

#: Springs of rigid supports by their kind [N/m, N m/rad].
RIGID: Final = {"pinned": (math.inf, 0.0), "clamped": (math.inf, math.inf)}

#: Pieces into which a stretch of linear EI is cut unless told otherwise.
TAPER_PIECES: Final = 32


@dataclass(frozen=True, kw_only=True)
class Support:
    """A support of the beam, rigid or on springs.

    Attributes
    ----------
    at : float
        Position from the left end [m].
    vertical : float
        Force for a unit of deflection [N/m], greater than 0; infinite where deflection is held, as
        it is by default.
    rotation : float
        Couple for a unit of rotation [N m/rad]: 0, the default, where rotation is free, infinite
        where it is held.
    """

    at: float
    vertical: float = math.inf
    rotation: float = 0.0

    def __post_init__(self) -> None:
        for key in ("at", "vertical", "rotation"):
            object.__setattr__(self, key, _stiffness(f"support {key}", getattr(self, key)))

    @property
    def kind(self) -> str:
        """``"pinned"``, ``"clamped"`` or, with a spring, ``"elastic"``."""
        springs = (self.vertical, self.rotation)
        return next((kind for kind, each in RIGID.items() if each == springs), "elastic")


@dataclass(frozen=True, eq=False, repr=False)
class Along(Hashed):
    """EI or mass that varies along the beam.

    A stretch of linear EI is cut into equal pieces, each with the harmonic mean of its EI. The
    error of deflections falls with the square of the number of pieces: of a cantilever whose EI
    falls to a quarter from the root to the tip, with the default 32, the tip deflects 0.03 % too
    much. Linear mass is integrated exactly.

    Attributes
    ----------
    at : sequence of float
        Breakpoints from 0 to the length [m], ascending, n + 1 of them.
    values : sequence of float
        n values are constant between the breakpoints, n + 1 values stand at the breakpoints and
        are linear between them.
    pieces : int
        Pieces into which each stretch of linear EI is cut.
    """

    at: Sequence[float]
    values: Sequence[float]
    pieces: int = TAPER_PIECES


#: Accepted for EI and mass: a number, one per span, `Along`, or its arguments in a table.
AlongBeam: TypeAlias = Numbers | Along | Mapping[str, Any]

#: Accepted for a support: position and kind, `Support`, or its arguments in a table.
AnySupport: TypeAlias = tuple[float, str] | Sequence[Any] | Support | Mapping[str, Any]


def along(key: str, value: object) -> Along | list[float]:
    """Values at or between breakpoints, or one value or one for each span."""
    if isinstance(value, Mapping):
        value = _of_table(Along, key, value, "a number, one for each span,")
    if isinstance(value, Along):
        pieces = count(f"{key} pieces", value.pieces)
        return Along(numbers(f"{key} at", value.at), numbers(f"{key} values", value.values), pieces)
    return numbers(key, value)


def along_argument(given: Along | list[float]) -> Any:
    """What makes the same again, as plain numbers and lists."""
    return given if isinstance(given, list) else vars(given)


def support(key: str, value: object) -> Support:
    """A support, of what is accepted for one."""
    if isinstance(value, Mapping):
        return _of_table(Support, key, value, "a pair of position and kind")
    if isinstance(value, Support):
        return value
    other = "or a Support or table with at, vertical and rotation"
    at, kind = pair(key, value, f"a pair of position and kind, {other}")
    vertical, rotation = RIGID[one_of(key, kind, [*RIGID])]
    return Support(at=number(f"{key} position", at), vertical=vertical, rotation=rotation)


def supports(key: str, value: object) -> list[Support]:
    """The supports, of what is accepted for them."""
    given = items(key, value, "a list of supports")
    return [support(f"{key}[{i}]", each) for i, each in enumerate(given)]


def support_argument(one: Support) -> Any:
    """What makes the same support again, as plain numbers, text and lists."""
    if one.kind != "elastic":
        return (one.at, one.kind)
    springs = {"vertical": one.vertical, "rotation": one.rotation}
    return {"at": one.at} | {k: v if math.isfinite(v) else "inf" for k, v in springs.items()}


def _stiffness(key: str, value: object) -> float:
    """A number; infinity may be spelled out, as JSON has none."""
    return math.inf if isinstance(value, str) and value == "inf" else number(key, value)


def _of_table(kind: type[T], key: str, table: Mapping[str, Any], otherwise: str) -> T:
    """What is made of a table, in place of which something else may be given."""
    maker = Maker(kind)
    allowed = f"must be {otherwise} or a table with {', '.join(maker.keys)}"
    with within(f"{key} = {shown(dict(table))}: {allowed}"):
        return maker.build(table, Place())
