"""The bridge: a straight beam on supports, its mass lumped at stations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise import _bridge_arrays, _core
from spanwise._checks import (
    array,
    count,
    counts,
    flag,
    items,
    number,
    numbers,
    pair,
    pairs,
    word,
)
from spanwise._door import view
from spanwise._keys import alike, suggesting
from spanwise._value import Value, key, same
from spanwise.errors import InputError, refused
from spanwise.layout import (
    Along,
    AlongBeam,
    AnySupport,
    Support,
    along,
    along_argument,
    support,
    support_argument,
)
from spanwise.layout import (
    supports as supports_of,
)
from spanwise.quantities import influence_lines

if TYPE_CHECKING:
    from spanwise.plotting import BridgePlot, SettlementPlot

Array: TypeAlias = NDArray[np.float64]
End: TypeAlias = Literal["pinned", "clamped", "free"]
Side: TypeAlias = Literal["left", "right"]
Structure: TypeAlias = Literal["actual", "basic"]


@dataclass(frozen=True, eq=False, repr=False)
class Modes(Value):
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


@dataclass(frozen=True, eq=False, repr=False)
class Settlement(Value):
    """What settling supports do to a bridge at rest.

    Attributes
    ----------
    sections : ndarray, shape (section,)
        Where it was looked at [m].
    supports : ndarray, shape (support,)
        Positions of the supports [m].
    deflection : ndarray, shape (section,)
        Deflections, down [m].
    moment : ndarray, shape (section,)
        Bending moments, sagging [N m].
    shear : ndarray, shape (section, 2)
        Shears just left and just right of the sections [N].
    reactions : ndarray, shape (support,)
        Reactions, up [N]; they balance each other.
    clamp_moments : ndarray, shape (clamp,)
        Moments of the supports that hold the rotation [N m]; see `Bridge.clamps`.
    bridge : Bridge
        The bridge itself.
    """

    sections: Array
    supports: Array
    deflection: Array
    moment: Array
    shear: Array
    reactions: Array
    clamp_moments: Array
    bridge: Bridge

    def __repr__(self) -> str:
        def between(values: Array, factor: float, unit: str) -> str:
            low, high = factor * values.min(initial=0.0), factor * values.max(initial=0.0)
            return f"{low:.4g} to {high:.4g} {unit}"

        return (
            f"Settlement({len(self.sections)} sections, {len(self.supports)} supports; deflection "
            f"{between(self.deflection, 1e3, 'mm')}, moment {between(self.moment, 1e-3, 'kN m')}, "
            f"reactions {between(self.reactions, 1e-3, 'kN')})"
        )

    @property
    def plot(self) -> SettlementPlot:
        """Its figure, when called; needs the extra ``spanwise[plot]``."""
        return view("plotting.SettlementPlot")(self)


class Bridge:
    """A straight beam bridge whose mass is lumped at stations.

    Give either `spans` (with `ends`), or `length` and `supports`. A *span* is a stretch between
    neighbouring supports or ends, so an overhang is a span of its own. A bridge that another
    program has modelled comes from `from_modes`, one of known flexibility from
    `from_flexibility`.

    Parameters
    ----------
    spans : sequence of float
        Lengths of consecutive spans [m]; there is a support between any two.
    ends : pair of {"pinned", "clamped", "free"}, optional
        How the left and the right end are held. Used with `spans`.
    length : float
        Length of the beam [m]. Used with `supports`.
    supports : sequence of (float, {"pinned", "clamped"}) or Support
        Position [m] and kind of every support, or `Support` with springs, which may also be given
        as a table with the keys ``at``, ``vertical`` and ``rotation``.
    hinges : sequence of float, optional
        Positions at which the beam carries no moment [m], inside the beam.
    EI : float, sequence of float or Along
        Flexural rigidity [N m2]: one value, one per span, or values between or at breakpoints,
        which may also be given as a table with the keys ``at``, ``values`` and ``pieces``.
    mass : float, sequence of float or Along
        Mass per unit length [kg/m], likewise.
    stations_per_span : int or sequence of int, optional
        Equal shares into which each span is divided; the mass of each is lumped in its middle.
        By default 10. No share reaches across a hinge, so between hinges they are nearly equal
        only. Frequencies converge with the square of their number; overhangs and beams with hinges
        need more of them than plain spans.
    stations : sequence of float, optional
        Positions of the masses [m], in place of `stations_per_span`. Each takes the mass up to
        half-way to its neighbours, but none from across a support.
    point_masses : sequence of (float, float), optional
        Position [m] and mass [kg] of additional masses.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is, if the supports leave the beam free to
        move, or if a hinge makes a mechanism of it.

    Notes
    -----
    Masses over rigid supports do not move and are left out of `stations` and `masses`.

    At a support inside the beam that holds the rotation the bending moment jumps: the moment of a
    section there is the one just left of it, and the moment of the support is the rise across it.
    """

    def __init__(
        self,
        *,
        spans: Sequence[float] | None = None,
        ends: tuple[End, End] | Sequence[End] | None = None,
        length: float | None = None,
        supports: Iterable[AnySupport] | None = None,
        hinges: Sequence[float] = (),
        EI: AlongBeam,
        mass: AlongBeam,
        stations_per_span: int | Sequence[int] | None = None,
        stations: Sequence[float] | None = None,
        point_masses: Iterable[tuple[float, float]] = (),
    ) -> None:
        if (spans is None) == (length is None or supports is None):
            raise ValueError("a bridge needs either spans, or length and supports")
        if spans is not None and (length is not None or supports is not None):
            key = "length" if length is not None else "supports"
            raise InputError(
                key, None, "not used with spans; give either spans, or length and supports"
            )
        if stations is not None and stations_per_span is not None:
            raise InputError(
                "stations", None, "not used with stations_per_span; give one of the two"
            )
        rigidity, masses = along("EI", EI), along("mass", mass)
        per_span = (
            [10] if stations_per_span is None else counts("stations_per_span", stations_per_span)
        )
        at = None if stations is None else numbers("stations", stations)
        points = [
            (number(f"point_masses[{i}] position", x), number(f"point_masses[{i}] mass", m))
            for i, (x, m) in enumerate(pairs("point_masses", point_masses))
        ]
        total, placed, consecutive = 0.0, [], None
        if spans is not None:
            held = _two_ends(("pinned", "pinned") if ends is None else ends)
            consecutive = (numbers("spans", spans), *held)
        else:
            if ends is not None:
                raise InputError(
                    "ends", None, "used with spans only; supports says how the ends are held"
                )
            total = number("length", length)
            placed = supports_of("supports", supports)
        self._core = _core.Bridge(
            spans=consecutive,
            length=total,
            supports=placed,
            hinges=numbers("hinges", hinges),
            flexural_rigidity=rigidity,
            mass=masses,
            stations_per_span=per_span,
            stations=at,
            point_masses=points,
        )
        self._arguments: dict[str, Any] = {
            "length": self.length,
            "supports": [support_argument(each) for each in self.springs],
            "hinges": self.hinges.tolist() or None,
            "EI": along_argument(rigidity if isinstance(rigidity, Along) else self.EI.tolist()),
            "mass": along_argument(masses),
            "stations_per_span": per_span if at is None else None,
            "stations": at,
            "point_masses": points,
        }

    @classmethod
    @suggesting
    def from_flexibility(
        cls,
        *,
        length: float,
        supports: Iterable[AnySupport],
        stations: Sequence[float],
        masses: Sequence[float],
        flexibility: ArrayLike,
        slopes: ArrayLike | None = None,
        path: Sequence[float] | None = None,
        redundants: Iterable[float | Support | Mapping[str, Any]] = (),
    ) -> Bridge:
        """A bridge of known flexibility, as Kishan and Traill-Nash describe it [1]_.

        Parameters
        ----------
        length : float
            Length of the beam [m].
        supports : sequence of (float, {"pinned", "clamped"}) or Support
            Supports of the basic bridge, which they must hold in a statically determinate way: two
            that let it turn, or one that does not.
        stations : sequence of float
            Reference stations [m], ascending: where there are masses, redundant supports, and
            sections to be looked at.
        masses : sequence of float
            Masses at the stations [kg], zero where there is none.
        flexibility : array_like, shape (path, stations)
            F*: deflections of the basic bridge at the points of the path for unit loads at the
            stations [m/N]. Symmetric at the stations, to 1e-4 of its largest element.
        slopes : array_like, shape (path, stations), optional
            Slopes of these deflections along the beam [1/N], which make the lines between the
            points exact. Without them natural cubic splines pass through the points and the
            supports, level at an end that is clamped: exact for constant EI, if all supports are
            pins or clamps at the ends or points of the path.
        path : sequence of float, optional
            Where deflections are known [m], ascending, the stations among them. By default the
            stations. It must contain supports on springs and changes of EI, and with slopes the
            supports inside the beam.
        redundants : sequence of float or Support, optional
            Stations at which redundant supports stand [m], or supports on vertical springs.

        Returns
        -------
        Bridge
            It can be crossed, and looked at in its stations and rigid supports.

        Raises
        ------
        ValueError
            If a value is not allowed, naming it and what is.

        References
        ----------
        .. [1] H. Kishan and R. W. Traill-Nash, IABSE Publications 33 (1973), section 2.3.
        """
        at, held = numbers("stations", stations), supports_of("supports", supports)
        given: dict[str, Any] = {
            "length": number("length", length),
            "supports": held,
            "stations": at,
            "masses": numbers("masses", masses),
            "redundants": [
                _redundant(i, each)
                for i, each in enumerate(items("redundants", redundants, "a list of stations"))
            ],
            "path": at if path is None else numbers("path", path),
            "flexibility": _bridge_arrays.matrix("flexibility", flexibility),
            "slopes": None if slopes is None else _bridge_arrays.matrix("slopes", slopes),
        }
        arguments: dict[str, Any] = {
            **given,
            "supports": [*map(support_argument, held)],
            "redundants": [
                support_argument(Support(at=x, vertical=k)) if np.isfinite(k) else x
                for x, k in given["redundants"]
            ],
            "flexibility": _bridge_arrays.plain(given["flexibility"]),
            "slopes": _bridge_arrays.plain(given["slopes"]),
        }
        return cls._of(_core.Bridge.from_flexibility(**given), {"from_flexibility": arguments})

    @classmethod
    @suggesting
    def from_modes(
        cls,
        *,
        path: Sequence[float],
        frequencies: Sequence[float],
        shapes: ArrayLike,
        slopes: ArrayLike | None = None,
        sections: Sequence[float],
        supports: Iterable[AnySupport] = (),
        influence: Mapping[str, ArrayLike],
        influence_slopes: Mapping[str, ArrayLike] | None = None,
        modal: Mapping[str, ArrayLike] | None = None,
        masses: Sequence[float] | None = None,
    ) -> Bridge:
        """A bridge modelled in another program, by what it says along the path of the wheels.

        Where something jumps along the path, an array may have one more axis at its end with the
        numbers just left and just right. Without it the numbers are those on the right, at the end
        of the path on the left; the jump of a shear and the kink of a moment at their own sections
        are known and need not be given.

        Parameters
        ----------
        path : sequence of float
            Points of the path [m], from 0 to the length.
        frequencies : sequence of float
            Natural frequencies [Hz], ascending.
        shapes : array_like, shape (path, modes)
            Deflections of the mode shapes, down, scaled to unit modal mass [kg^-1/2].
        slopes : array_like, shape (path, modes), optional
            Their derivatives along the path. Without them natural cubic splines pass through the
            points.
        sections : sequence of float
            Where deflections, moments and shears are looked at [m], points of the path.
        supports : sequence of (float, {"pinned", "clamped"}) or Support, optional
            Supports whose reactions are looked at.
        influence : mapping of str to array_like, shape (sections or supports, path)
            Responses to a unit load down at the points of the path: ``"deflection"``,
            ``"moment"``, ``"shear-left"`` with ``"shear-right"``, ``"reaction"``,
            ``"clamp-moment"``, signed as in `influence_line`. Lines of deflection are the
            flexibility between section and path.
        influence_slopes : mapping of str to array_like, optional
            Their derivatives along the path. Without them natural cubic splines pass through the
            points, less the jump or kink.
        modal : mapping of str to array_like, shape (sections or supports, modes), optional
            Response of the bridge deflected into each mode shape: its modal moment and so on.
            Not needed of deflections, nor with masses.
        masses : sequence of float, optional
            Masses at the points of the path [kg]; the shapes must be orthonormal with these to
            1e-3. They give the modal responses that `modal` leaves out.

        Returns
        -------
        Bridge
            It can be crossed, and looked at in these sections.

        Raises
        ------
        ValueError
            If a value is not allowed, naming it and what is; if the modes deflect a section more
            than its influence line of deflection, of which they are a part.

        Warns
        -----
        PlausibilityWarning
            If the modes explain very little of the lines of deflection, as with frequencies in
            rad/s.
        """
        held = supports_of("supports", supports)
        given: dict[str, Any] = {
            "path": numbers("path", path),
            "frequencies": numbers("frequencies", frequencies),
            "sections": numbers("sections", sections),
            "supports": held,
            "masses": None if masses is None else numbers("masses", masses),
        }
        both = _bridge_arrays.sides("shapes", shapes)
        lines = _bridge_arrays.influence_lines(influence, influence_slopes, modal)
        core = _core.Bridge.from_modes(
            **given,
            shapes=both,
            slopes=None if slopes is None else _bridge_arrays.sides("slopes", slopes),
            influence=lines,
        )
        for quantity, (values, _), *_ in lines:
            if quantity == "deflection":
                _bridge_arrays.check_flexibility(
                    given["path"], given["frequencies"], both[0], given["sections"], values
                )
        arrays = {
            "shapes": shapes,
            "slopes": slopes,
            "influence": influence,
            "influence_slopes": influence_slopes,
            "modal": modal,
        }
        plain = {key: _bridge_arrays.plain(value) for key, value in arrays.items()}
        arguments = {**given, "supports": [*map(support_argument, held)], **plain}
        return cls._of(core, {"from_modes": arguments})

    @classmethod
    def _of(cls, core: _core.Bridge, arguments: dict[str, Any]) -> Bridge:
        bridge = cls.__new__(cls)
        bridge._core = core
        bridge._arguments = arguments
        return bridge

    def __eq__(self, other: object) -> bool:
        """Whether both are made of the same arguments."""
        return same(self._arguments, other._arguments) if type(other) is Bridge else NotImplemented

    def __hash__(self) -> int:
        return hash(key(self._arguments))

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its arguments, so that it can go to another process."""
        return bridge_of, (self.arguments,)

    def __repr__(self) -> str:
        held = "".join(f", {kind} at {x:g} m" for x, kind in self.supports)
        hinged = "".join(f", hinge at {x:g} m" for x in self.hinges)
        if self.described or len(self.stations):
            return f"Bridge({self.length:g} m{held}{hinged}; {len(self.stations)} masses)"
        return f"Bridge({self.length:g} m{held}; {self.mode_count} modes given)"

    @property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments that make the same bridge, as plain numbers and lists.

        Those of `from_flexibility` or `from_modes` stand under this name.
        """
        return {key: value for key, value in self._arguments.items() if value is not None}

    @property
    def length(self) -> float:
        """Length [m]."""
        return self._core.length

    @property
    def described(self) -> bool:
        """Whether it was described by its spans, not given by its flexibility or its modes."""
        return self._core.described

    @property
    def supports(self) -> list[tuple[float, str]]:
        """Position [m] and kind of every support: "pinned", "clamped", or "elastic" on springs."""
        return [(each.at, each.kind) for each in self.springs]

    @property
    def springs(self) -> list[Support]:
        """The supports with their springs, left to right."""
        return [Support(at=x, vertical=k, rotation=c) for x, k, c in self._core.supports]

    @property
    def clamps(self) -> Array:
        """Positions of the supports that hold the rotation [m], rigidly or by a spring.

        In the order of the clamp moments: at an end of the beam the sagging moment there,
        elsewhere the couple of the support on the beam, clockwise, by which the moment is greater
        just right of it than just left.
        """
        return np.array([each.at for each in self.springs if each.rotation > 0.0])

    @property
    def hinges(self) -> Array:
        """Positions of the hinges [m], shape (hinges,)."""
        return self._core.hinges

    @property
    def span_bounds(self) -> Array:
        """Ends and supports, left to right [m], shape (spans + 1,)."""
        return self._core.span_bounds

    @property
    def EI(self) -> Array:
        """Flexural rigidity of each piece of the beam [N m2], by default each span."""
        return self._core.flexural_rigidity

    @property
    def EI_bounds(self) -> Array:
        """Ends of the pieces of constant `EI`, left to right [m], shape (pieces + 1,)."""
        return self._core.rigidity_bounds

    @property
    def nodes(self) -> Array:
        """Ends, supports, hinges, masses and changes of EI [m]: lines are one cubic in between."""
        return self._core.nodes

    @property
    def stations(self) -> Array:
        """Positions of the moving masses [m], shape (stations,); empty if unknown."""
        return self._core.masses[0]

    @property
    def masses(self) -> Array:
        """The moving masses [kg], shape (stations,); empty if unknown."""
        return self._core.masses[1]

    @property
    def mode_count(self) -> int:
        """Number of modes that there are."""
        return self._core.mode_count

    @property
    def missing(self) -> list[str]:
        """Kinds of response that the bridge was given without."""
        return self._core.missing

    def default_modes(self) -> int:
        """Modes included by default: two for each span, at least three, at most all."""
        return min(self.mode_count, max(3, 2 * (len(self.span_bounds) - 1)))

    def default_sections(self) -> Array:
        """Sections looked at by default [m].

        Mass stations, supports, hinges, breakpoints of EI and tenths of every span; of a given
        bridge all that it was given with.
        """
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
        omega, shapes, _ = self._core.modes(_modes(count), None, False, False)
        return Modes(omega / (2.0 * np.pi), self.stations, shapes)

    def mode_shapes(
        self, count: int, x: ArrayLike, *, derivative: bool = False, side: Side = "right"
    ) -> Array:
        """The lowest `count` mode shapes at x [m], exact between stations.

        Parameters
        ----------
        count : int
            How many.
        x : array_like
            Where [m].
        derivative : bool, optional
            Give the derivatives along the bridge instead.
        side : {"right", "left"}, optional
            On which side of x, where it matters: a shape has a kink at a hinge.

        Returns
        -------
        ndarray, shape (x, modes)
        """
        where = array("x", x).ravel()
        *_, along_x = self._core.modes(
            _modes(count), where, flag("derivative", derivative), _left(side)
        )
        assert along_x is not None
        return along_x

    def deflections(
        self,
        x: ArrayLike,
        loads: Sequence[float],
        structure: Structure = "actual",
        *,
        derivative: bool = False,
        side: Side = "right",
    ) -> Array:
        """Deflections, down, or their derivatives, at x for unit loads down [m/N or 1/N].

        Parameters
        ----------
        x : array_like
            Where deflections are looked at [m].
        loads : sequence of float
            Where the loads stand [m].
        structure : {"actual", "basic"}, optional
            The bridge with or without its hinges and intermediate supports.
        derivative : bool, optional
            Give the derivatives along the bridge instead.
        side : {"right", "left"}, optional
            On which side of x, where it matters.

        Returns
        -------
        ndarray, shape (x, loads)
        """
        return self._core.deflections(
            array("x", x).ravel(),
            numbers("loads", loads),
            word("structure", structure, *get_args(Structure)),
            flag("derivative", derivative),
            _left(side),
        )

    def settlement(
        self,
        settlements: Mapping[float, float] | Sequence[float],
        sections: Sequence[float] | None = None,
    ) -> Settlement:
        """Static effect of supports that settle.

        Parameters
        ----------
        settlements : mapping of float to float, or sequence of float
            Settlement, down [m], by the position of the support [m]; or one for each support. Of a
            support on a spring it is the ground that settles.
        sections : sequence of float, optional
            Where to look [m]; by default as `default_sections`.

        Returns
        -------
        Settlement

        Raises
        ------
        ValueError
            If no support stands at one of the positions.
        """
        at = np.array([x for x, _ in self.supports])
        if isinstance(settlements, Mapping):
            each = [0.0] * len(at)
            for key, value in settlements.items():
                x = number("settlements position", key)
                near = np.flatnonzero(np.abs(at - x) <= 1e-9 * self.length)
                if len(near) == 0:
                    there = ", ".join(f"{a:g}" for a in at)
                    raise InputError(
                        "settlements position", f"{x:g} m", f"must be a support, {there} m"
                    )
                each[near[0]] = number(f"settlements[{x:g}]", value)
        else:
            each = numbers("settlements", settlements)
        where = (
            self.default_sections().tolist() if sections is None else numbers("sections", sections)
        )
        w, moment, left, right, reactions, clamps = self._core.settlement(each, where)
        shear = np.stack([left, right], axis=-1)
        return Settlement(np.array(where), at, w, moment, shear, reactions, clamps, self)

    def flexibility(self, structure: Structure = "actual") -> tuple[Array, Array]:
        """Positions [m] and flexibility matrix [m/N]: deflections there for unit loads there.

        For ``"actual"`` this is F of the bridge at its mass stations. For ``"basic"`` it is F* of
        the bridge without its hinges and intermediate redundant supports, at the mass stations and
        at these supports [1]_.

        References
        ----------
        .. [1] Kishan and Traill-Nash, IABSE Publications 33 (1973), section 2.3.
        """
        return self._core.flexibility(word("structure", structure, *get_args(Structure)))

    def redundant_stiffness(self) -> Array:
        """K^R [N/m]: forces at the intermediate redundant supports for unit deflections there.

        Where such a support holds the rotation too, its couple and slope come after its force and
        deflection.
        """
        return self._core.redundant_stiffness()

    def outer_reactions(self) -> list[tuple[float, str, Array]]:
        """Reactions of the basic bridge for unit loads at its reference stations.

        Position [m], ``"force"`` or ``"moment"``, and influence coefficients (R*, Q* of Kishan and
        Traill-Nash 1973), forces up and moments sagging positive.
        """
        return self._core.outer_reactions()

    def influence_line(
        self,
        quantity: str,
        at: float,
        x: ArrayLike,
        structure: Structure = "actual",
        *,
        derivative: bool = False,
        side: Side = "right",
    ) -> Array:
        """Response at one section for unit loads down at x, exact everywhere.

        Parameters
        ----------
        quantity : str
            The response: ``"deflection"`` down, its ``"slope"``, sagging ``"moment"``, sum of the
            upward forces to the left as ``"shear-left"`` or ``"shear-right"``, ``"reaction"`` up,
            ``"clamp-moment"`` as in `clamps`.
        at : float
            The section, or the support for a reaction or a clamp moment [m].
        x : array_like
            Positions of the unit load [m].
        structure : {"actual", "basic"}, optional
            The bridge with or without its hinges and intermediate redundant supports.
        derivative : bool, optional
            Give the derivative along the bridge instead.
        side : {"right", "left"}, optional
            Where the line jumps or has a kink, its value or derivative on this side.

        Returns
        -------
        ndarray, shape of x
            Response per newton [m, rad, N m or N].

        Raises
        ------
        ValueError
            If a value is not allowed; if the bridge was given without this line.
        """
        where = array("x", x)
        line = self._core.influence_line(
            word("quantity", alike(quantity, influence_lines()), *influence_lines()),
            number("at", at),
            where.ravel(),
            word("structure", structure, *get_args(Structure)),
            flag("derivative", derivative),
            _left(side),
        )
        return line.reshape(where.shape)

    @property
    def plot(self) -> BridgePlot:
        """Figures of the bridge; needs the extra ``spanwise[plot]``."""
        return view("plotting.BridgePlot")(self)


def bridge_of(arguments: Mapping[str, Any]) -> Bridge:
    """The bridge of these `Bridge.arguments`."""
    for name in ("from_flexibility", "from_modes"):
        if name in arguments:
            bridge: Bridge = getattr(Bridge, name)(**arguments[name])
            return bridge
    return Bridge(**arguments)


def _redundant(i: int, value: object) -> tuple[float, float]:
    """Position [m] and stiffness [N/m] of a redundant support."""
    key = f"redundants[{i}]"
    if not isinstance(value, Support | Mapping):
        return number(key, value), np.inf
    one = support(key, value)
    if one.rotation != 0.0:
        said = "must be 0; only the deflection is known"
        raise InputError(f"{key} rotation", f"{one.rotation:g}", said)
    return one.at, one.vertical


def _left(side: object) -> bool:
    if not isinstance(side, str) or side not in get_args(Side):
        raise refused("side", side, "must be left or right")
    return side == "left"


def _modes(value: object) -> int:
    return count("modes", value)


def _two_ends(ends: object) -> tuple[str, str]:
    left, right = pair("ends", ends, "a pair, each pinned, clamped or free")
    return word("ends[0]", left), word("ends[1]", right)
