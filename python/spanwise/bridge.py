"""The bridge: a straight beam on supports, its mass lumped at stations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise import _core
from spanwise._checks import Numbers, array, count, counts, number, numbers, pairs, word

if TYPE_CHECKING:
    from spanwise.plotting import BridgePlot

Array: TypeAlias = NDArray[np.float64]
End: TypeAlias = Literal["pinned", "clamped", "free"]
Quantity: TypeAlias = Literal[
    "deflection", "slope", "moment", "shear-left", "shear-right", "reaction"
]
Structure: TypeAlias = Literal["actual", "basic"]


@dataclass(frozen=True, eq=False)
class Modes:
    """Undamped natural modes, lowest first, scaled to unit modal mass.

    The component of largest magnitude of each shape is positive.

    Attributes
    ----------
    frequencies : ndarray, shape (modes,)
        Natural frequencies [Hz].
    stations : ndarray, shape (stations,)
        Positions of the moving masses [m].
    shapes : ndarray, shape (stations, modes)
        Mode shapes at the stations [kg^-1/2]; ``shapes.T @ diag(masses) @ shapes`` is the unit
        matrix.
    """

    frequencies: Array
    stations: Array
    shapes: Array

    @property
    def omega(self) -> Array:
        """Circular frequencies [rad/s], shape (modes,)."""
        return 2.0 * np.pi * self.frequencies


class Bridge:
    """A straight beam bridge whose mass is lumped at stations.

    Give either `spans` (with `ends`), or `length` and `supports`. A *span* is a stretch between
    neighbouring supports or ends, so an overhang is a span of its own.

    Parameters
    ----------
    spans : sequence of float
        Lengths of consecutive spans [m]; there is a support between any two.
    ends : pair of {"pinned", "clamped", "free"}, optional
        How the left and the right end are held. Used with `spans`.
    length : float
        Length of the beam [m]. Used with `supports`.
    supports : sequence of (float, {"pinned", "clamped"})
        Position [m] and kind of every support; only an end can be clamped.
    EI : float or sequence of float
        Flexural rigidity [N m2], one value or one per span.
    mass : float or sequence of float
        Mass per unit length [kg/m], one value or one per span.
    stations_per_span : int or sequence of int, optional
        Equal shares into which each span is divided; the mass of each is lumped in its middle.
        By default 10.
    stations : sequence of float, optional
        Positions of the masses [m], in place of `stations_per_span`. Each takes the mass up to
        half-way to its neighbours, but none from across a support.
    point_masses : sequence of (float, float), optional
        Position [m] and mass [kg] of additional masses.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is, or if the supports leave the beam free to
        move.

    Notes
    -----
    Masses over supports do not move and are left out of `stations` and `masses`.
    """

    def __init__(
        self,
        *,
        spans: Sequence[float] | None = None,
        ends: tuple[End, End] | Sequence[End] | None = None,
        length: float | None = None,
        supports: Iterable[tuple[float, str]] | None = None,
        EI: Numbers,
        mass: Numbers,
        stations_per_span: int | Sequence[int] | None = None,
        stations: Sequence[float] | None = None,
        point_masses: Iterable[tuple[float, float]] = (),
    ) -> None:
        if (spans is None) == (length is None or supports is None):
            raise ValueError("a bridge needs either spans, or length and supports")
        if spans is not None and (length is not None or supports is not None):
            key = "length" if length is not None else "supports"
            raise ValueError(
                f"{key}: not used with spans; give either spans, or length and supports"
            )
        if stations is not None and stations_per_span is not None:
            raise ValueError("stations: not used with stations_per_span; give one of the two")
        flexural_rigidity = numbers("EI", EI)
        masses = numbers("mass", mass)
        per_span = (
            [10] if stations_per_span is None else counts("stations_per_span", stations_per_span)
        )
        at = None if stations is None else numbers("stations", stations)
        points = [
            (number(f"point_masses[{i}] position", x), number(f"point_masses[{i}] mass", m))
            for i, (x, m) in enumerate(pairs("point_masses", point_masses))
        ]
        if spans is not None:
            left, right = _two_ends(("pinned", "pinned") if ends is None else ends)
            self._core = _core.Bridge.continuous(
                spans=numbers("spans", spans),
                ends=(left, right),
                flexural_rigidity=flexural_rigidity,
                mass=masses,
                stations_per_span=per_span,
                stations=at,
                point_masses=points,
            )
        else:
            if ends is not None:
                raise ValueError("ends: used with spans only; supports says how the ends are held")
            self._core = _core.Bridge(
                length=number("length", length),
                supports=[
                    (number(f"supports[{i}] position", x), word(f"supports[{i}]", kind))
                    for i, (x, kind) in enumerate(pairs("supports", supports))
                ],
                flexural_rigidity=flexural_rigidity,
                mass=masses,
                stations_per_span=per_span,
                stations=at,
                point_masses=points,
            )
        self._arguments: dict[str, Any] = {
            "length": self.length,
            "supports": self.supports,
            "EI": self.EI.tolist(),
            "mass": masses,
            "stations_per_span": per_span if at is None else None,
            "stations": at,
            "point_masses": points,
        }

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its arguments, so that it can go to another process."""
        return _rebuilt, (self.arguments,)

    def __repr__(self) -> str:
        held = ", ".join(f"{kind} at {x:g} m" for x, kind in self.supports)
        return f"Bridge({self.length:g} m, {held}; {len(self.stations)} masses)"

    @property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments that make the same bridge, as plain numbers and lists."""
        return {key: value for key, value in self._arguments.items() if value is not None}

    @property
    def length(self) -> float:
        """Length [m]."""
        return self._core.length

    @property
    def supports(self) -> list[tuple[float, str]]:
        """Position [m] and kind of every support, left to right."""
        return self._core.supports

    @property
    def span_bounds(self) -> Array:
        """Ends and supports, left to right [m], shape (spans + 1,)."""
        return self._core.span_bounds

    @property
    def EI(self) -> Array:
        """Flexural rigidity of each span [N m2], shape (spans,)."""
        return self._core.flexural_rigidity

    @property
    def stations(self) -> Array:
        """Positions of the moving masses [m], shape (stations,)."""
        return self._core.stations

    @property
    def masses(self) -> Array:
        """The moving masses [kg], shape (stations,)."""
        return self._core.masses

    def default_sections(self) -> Array:
        """Sections looked at by default [m]: mass stations, supports, tenths of every span."""
        return self._core.default_sections()

    def modes(self, count: int) -> Modes:
        """The lowest `count` natural modes.

        Raises
        ------
        ValueError
            If there are fewer moving masses than that.
        RuntimeError
            If the eigensolution fails its own check of residual and orthogonality.
        """
        omega, shapes, _ = self._core.modes(_modes(count), None)
        return Modes(omega / (2.0 * np.pi), self.stations, shapes)

    def mode_shapes(self, count: int, x: ArrayLike) -> Array:
        """The lowest `count` mode shapes at x [m], shape (x, modes), exact between stations."""
        *_, along = self._core.modes(_modes(count), array("x", x).ravel())
        assert along is not None
        return along

    def flexibility(self, structure: Structure = "actual") -> tuple[Array, Array]:
        """Positions [m] and flexibility matrix [m/N]: deflections there for unit loads there.

        For ``"actual"`` this is F of the bridge at its mass stations. For ``"basic"`` it is F* of
        the bridge without its intermediate redundant supports, at the mass stations and at these
        supports [1]_.

        References
        ----------
        .. [1] Kishan and Traill-Nash, IABSE Publications 33 (1973), section 2.3.
        """
        return self._core.flexibility(word("structure", structure, *get_args(Structure)))

    def redundant_stiffness(self) -> Array:
        """K^R [N/m]: forces at the intermediate redundant supports for unit deflections there."""
        return self._core.redundant_stiffness()

    def outer_reactions(self) -> list[tuple[float, str, Array]]:
        """Reactions of the basic bridge for unit loads at its reference stations.

        Position [m], ``"force"`` or ``"moment"``, and influence coefficients (R*, Q* of Kishan and
        Traill-Nash 1973), forces up and moments sagging positive.
        """
        return self._core.outer_reactions()

    def influence_line(
        self, quantity: Quantity, at: float, x: ArrayLike, structure: Structure = "actual"
    ) -> Array:
        """Response at one section for unit loads down at x, exact everywhere.

        Parameters
        ----------
        quantity : {"deflection", "slope", "moment", "shear-left", "shear-right", "reaction"}
            The response: deflection down, slope of the deflection, sagging moment, sum of the
            upward forces to the left, reaction up.
        at : float
            The section, or the support for a reaction [m].
        x : array_like
            Positions of the unit load [m]; where the line jumps, its value to the right.
        structure : {"actual", "basic"}, optional
            The bridge with or without its intermediate redundant supports.

        Returns
        -------
        ndarray, shape of x
            Response per newton [m, rad, N m or N].
        """
        where = array("x", x)
        line = self._core.influence_line(
            word("quantity", quantity, *get_args(Quantity)),
            number("at", at),
            where.ravel(),
            word("structure", structure, *get_args(Structure)),
        )
        return line.reshape(where.shape)

    @property
    def plot(self) -> BridgePlot:
        """Figures of the bridge; needs the extra ``spanwise[plot]``."""
        from spanwise.plotting import BridgePlot

        return BridgePlot(self)


def _rebuilt(arguments: dict[str, Any]) -> Bridge:
    return Bridge(**arguments)


def _modes(value: object) -> int:
    return count("modes", value)


def _two_ends(ends: object) -> tuple[str, str]:
    if isinstance(ends, list | tuple) and len(ends) == 2:
        return word("ends[0]", ends[0]), word("ends[1]", ends[1])
    raise ValueError(f"ends = {ends!r}: must be a pair, each pinned, clamped or free")
