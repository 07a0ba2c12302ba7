"""Random roads after ISO 8608."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Final

from spanwise import _core
from spanwise._checks import choice, count, number, numbers, positive, shown
from spanwise.errors import InputError, refused
from spanwise.roads._doubts import doubts_of_roughness
from spanwise.roads.base import CONTACT_PATCH, Road, Sum
from spanwise.roads.roughness import CLASSES

#: IRI of a random road of waviness 2 over the square root of its G_d(n0) in 1e-6 m3 [m/km].
IRI_FACTOR: Final = 0.543

#: Classes of ISO 8608 by what its older edition calls them (as recalled, to be checked).
NAMED: Final = {"very good": "A", "good": "B", "average": "C", "poor": "D", "very poor": "E"}

#: G_d(n0) at n0 = 0.1 cycle/m by condition [m3]; see `bridge_study`.
BRIDGE_STUDY: Final[Mapping[str, float]] = {
    "very good": 5e-6,
    "good": 20e-6,
    "average": 80e-6,
    "poor": 256e-6,
}


@dataclass(frozen=True, repr=False)
class ISO8608(Road):
    """A random road whose power spectral density is G_d(n) = G_d(n0) (n/n0)^-w.

    One `seed` and `sample` are one function of x, whatever the step, the vehicle or the path.

    Parameters
    ----------
    road_class : str, optional
        ``"A"`` to ``"H"``, for the geometric mean of G_d(n0) in that class: 16e-6 m3 for A, and
        four times as much from class to class. Under ``class`` in a case file.
    G : float, optional
        G_d(n0) at n0 = 0.1 cycle/m [m3], in place of a class.
    waviness : float, optional
        The exponent w [-].
    band : tuple of float, optional
        Lowest and highest wave number [cycle/m].
    contact_patch : float, optional
        Length of road that a tyre averages [m]; 0 for none.
    period : float, optional
        Length after which the road repeats [m], at least one of the longest waves; without, the
        shortest of at least 1000 m that suits the grid: 1024 m for waves down to 0.25 m.
    seed : int, optional
        Seed of the random phases.
    sample : int, optional
        Number of the road among those of the same seed; all are independent.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.

    Warns
    -----
    PlausibilityWarning
        If `G` is 1 m3 or more, nearly twice where class H begins to be rougher than any road.

    Notes
    -----
    A sum of waves with random phases. Their amplitudes are not random: each is the integral of
    G_d over its share of the band, so that every single road has the variance and the spectrum of
    its class. The waves have their exact amplitudes at any x; the cubic B-splines that they are
    kept in add waves beyond three times the highest wave number, smaller by (m/(N - m))^4 for wave
    m on a grid of N points: at most 1.3 % of the shortest wave. Elevation, slope and
    curvature are continuous. The contact patch is exact for every wave: sinc(n contact_patch).

    References
    ----------
    ISO 8608:2016, Mechanical vibration - Road surface profiles - Reporting of measured data.
    """

    kind: ClassVar[str] = "iso-8608"

    road_class: str | None = None
    _: KW_ONLY
    G: float = None  # type: ignore[assignment]  # a number, once made
    waviness: float = 2.0
    band: tuple[float, float] = (0.01, 4.0)
    contact_patch: float = CONTACT_PATCH
    period: float = None  # type: ignore[assignment]  # a number, once made
    seed: int = 0
    sample: int = 0

    def _words(self) -> list[str]:
        letter = f" class {self.road_class}" if self.road_class else ""
        sample = f" sample {self.sample}" if self.sample else ""
        return [f"{self.kind}{letter}", f"G_d(n0) {self.G:.4g} m3", f"seed {self.seed}{sample}"]

    def _made(self) -> _core.Road:
        band = numbers("band", self.band)
        if len(band) != 2:
            raise refused("band", self.band, "must be two wave numbers")
        self._set(
            G=self._roughness(),
            waviness=number("waviness", self.waviness),
            band=(band[0], band[1]),
            contact_patch=number("contact_patch", self.contact_patch),
            seed=count("seed", self.seed),
            sample=count("sample", self.sample),
        )
        road = _core.Road.random(
            roughness=self.G,
            waviness=self.waviness,
            band=self.band,
            contact_patch=self.contact_patch,
            period=_optional("period", self.period),
            seed=self.seed,
            sample=self.sample,
        )
        self._set(period=road.period)
        return road

    @cached_property
    def _doubts(self) -> tuple[str, ...]:
        return tuple(doubts_of_roughness(self.G))

    def _roughness(self) -> float:
        given = _optional("G", self.G)
        if self.road_class is None:
            if given is None:
                raise InputError("class, G", None, "give one of the two")
            return given
        try:
            letter = choice("class", self.road_class, CLASSES)
        except InputError as error:
            given_class: object = self.road_class
            words = given_class.lower() if isinstance(given_class, str) else ""
            meant = f"; {words} is class {NAMED[words]}" if words in NAMED else ""
            raise InputError(error.key, error.value, error.allowed + meant) from None
        if given is not None and given != CLASSES[letter]:
            raise refused("G", given, f"not used with class = {shown(letter)}")
        return CLASSES[letter]

    def _times(self, factor: float) -> Road:
        return replace(self, road_class=None, G=factor * factor * self.G)

    @property
    def arguments(self) -> dict[str, Any]:
        """Plain values that `from_table` makes this road of; of a class, its letter alone."""
        table = super().arguments
        assert isinstance(table, dict)
        letter = table.pop("road_class", None)
        if letter is None:
            return table
        del table["G"]
        return {"kind": table.pop("kind"), "class": letter, **table}


def is_random(road: Road) -> bool:
    """Whether a seed makes a difference."""
    return any(isinstance(each, ISO8608) for each in road._summands)


def reseeded(road: Road, seed: int) -> Road:
    """The road with another seed in all its random parts."""
    if isinstance(road, ISO8608):
        return replace(road, seed=seed)
    if isinstance(road, Sum):
        return Sum(tuple(reseeded(part, seed) for part in road.parts))
    return road


def bridge_study(condition: str, **options: Any) -> ISO8608:
    """A random road of a condition as older studies of bridges define it.

    Parameters
    ----------
    condition : str
        ``"very good"``, ``"good"``, ``"average"`` or ``"poor"``: G_d(n0) of 5, 20, 80 or
        256e-6 m3 at n0 = 0.1 cycle/m. These are not the classes of ISO 8608.
    **options
        Other arguments of `ISO8608`.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.

    Notes
    -----
    The values used by D. Huang, T.-L. Wang and co-workers in the 1990s, here as recalled from the
    literature and not read at the source.
    """
    return ISO8608(G=BRIDGE_STUDY[choice("condition", condition, BRIDGE_STUDY)], **options)


def from_iri(iri: float, **options: Any) -> ISO8608:
    """A random road with a given international roughness index.

    Parameters
    ----------
    iri : float
        The index [m/km].
    **options
        Other arguments of `ISO8608` but the waviness, which is 2.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is.

    Notes
    -----
    IRI = 0.543 (G_d(n0) / 1e-6 m3)^(1/2) m/km on average over roads: the mean rectified Gaussian,
    (2/pi)^(1/2) times the standard deviation of the golden car's response to the spectrum of
    waviness 2 (its band from 0.01 to 4 cycle/m or wider changes nothing in these digits).
    """
    value = number("iri", iri)
    if not 0.0 < value < float("inf"):
        raise refused("iri", iri, "must be finite and greater than 0")
    if "waviness" in options:
        raise refused("waviness", options["waviness"], "not used with iri, it is 2")
    try:
        roughness = positive("iri", (value / IRI_FACTOR) ** 2 * 1e-6)
    except (ValueError, OverflowError):
        raise refused("iri", iri, "is of no road") from None
    return ISO8608(G=roughness, **options)


def _optional(key: str, value: object) -> float | None:
    return None if value is None else number(key, value)
