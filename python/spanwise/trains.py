"""Trains: loads or masses in a row, without anything that vibrates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import InitVar, dataclass
from itertools import accumulate

from spanwise import _core
from spanwise._checks import numbers
from spanwise._wheels import Wheels
from spanwise.errors import InputError, refused


@dataclass(frozen=True, kw_only=True, repr=False)
class ForceTrain(Wheels):
    """Constant forces in a row: the axle loads of a code, or of a truck that has been weighed.

    Parameters
    ----------
    loads : sequence of float
        Forces [N], front first. They do not depend on gravity.
    positions : sequence of float, optional
        Distances ahead of any point [m], front first.
    spacings : sequence of float, optional
        Distances from each to the next [m], in place of `positions`.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.
    """

    loads: Sequence[float]
    positions: Sequence[float] = ()
    spacings: InitVar[Sequence[float] | None] = None

    def __post_init__(self, spacings: Sequence[float] | None) -> None:
        loads = numbers("loads", self.loads)
        positions = _positions(self.positions, spacings, "loads", len(loads))
        object.__setattr__(self, "loads", tuple(loads))
        object.__setattr__(self, "positions", tuple(positions))
        object.__setattr__(self, "_core", _core.Vehicle.force_train(loads, positions))

    def __repr__(self) -> str:
        return f"ForceTrain({sum(self.loads) / 1e3:.4g} kN, {self._row()})"

    @property
    def _total(self) -> str:
        return f"{sum(self.loads) / 1e3:.1f} kN"


@dataclass(frozen=True, kw_only=True, repr=False)
class MovingMasses(Wheels):
    """Masses in a row that follow the road and the bridge rigidly.

    Parameters
    ----------
    masses : sequence of float
        Masses [kg], front first.
    positions : sequence of float, optional
        Distances ahead of any point [m], front first.
    spacings : sequence of float, optional
        Distances from each to the next [m], in place of `positions`.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.

    Notes
    -----
    They stay in contact even where that takes tension. What would strike them is refused when they
    cross: hinges of the bridge, kinks and jumps of the road. As a mass enters or leaves the bridge,
    the blow of the slope that others have given it there is left out; it is small.
    """

    masses: Sequence[float]
    positions: Sequence[float] = ()
    spacings: InitVar[Sequence[float] | None] = None

    def __post_init__(self, spacings: Sequence[float] | None) -> None:
        masses = numbers("masses", self.masses)
        positions = _positions(self.positions, spacings, "masses", len(masses))
        object.__setattr__(self, "masses", tuple(masses))
        object.__setattr__(self, "positions", tuple(positions))
        object.__setattr__(self, "_core", _core.Vehicle.moving_masses(masses, positions))

    def __repr__(self) -> str:
        return f"MovingMasses({self.total_mass / 1e3:.4g} t, {self._row()})"


def _positions(
    positions: Sequence[float], spacings: Sequence[float] | None, key: str, count: int
) -> list[float]:
    """Positions as given, or with the first at 0 from the spacings."""
    if count == 0:
        raise InputError(key, "[]", "must have at least one value")
    given = numbers("positions", positions)
    if spacings is None:
        if not given and count == 1:
            return [0.0]
        if not given:
            said = f"missing spacings, one less than the {count} {key}, or positions"
            raise InputError("", None, said)
        return given
    if given:
        raise refused("spacings", spacings, "not beside positions; give one of the two")
    gaps = numbers("spacings", spacings)
    if len(gaps) != count - 1:
        raise InputError(
            "spacings", f"{len(gaps)} values", f"must be one less than the {count} {key}"
        )
    for k, gap in enumerate(gaps):
        if not 0.0 < gap < float("inf"):
            raise InputError(f"spacings[{k}]", f"{gap:g} m", "must be finite and greater than 0")
    return [0.0 - x for x in accumulate(gaps, initial=0.0)]
