"""Damping of the bridge: ratios, Rayleigh's two constants, or a matrix."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spanwise._build import Maker, Place, within
from spanwise._checks import (
    array,
    is_list,
    items,
    not_negative,
    number,
    numbers,
    pair,
    refuse_where,
    shown,
)
from spanwise.errors import InputError

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Rayleigh:
    """Damping in proportion to mass and stiffness, C = alpha M + beta K.

    The ratio of a mode of circular frequency omega is alpha / (2 omega) + beta omega / 2.

    Attributes
    ----------
    alpha : float
        Factor of the mass [1/s].
    beta : float
        Factor of the stiffness [s].

    Raises
    ------
    ValueError
        If either is negative or not finite.
    """

    alpha: float
    beta: float

    def __post_init__(self) -> None:
        for key in ("alpha", "beta"):
            value = not_negative(f"Rayleigh {key}", getattr(self, key))
            object.__setattr__(self, key, value)

    @classmethod
    def from_ratios(cls, first: tuple[float, float], second: tuple[float, float]) -> Rayleigh:
        """With two pairs of frequency [Hz] and ratio to critical."""
        (f, z), (g, y) = (
            (number(f"{name} frequency", pair[0]), number(f"{name} ratio", pair[1]))
            for name, pair in (
                ("first", pair("first", first, "a pair of frequency and ratio")),
                ("second", pair("second", second, "a pair of frequency and ratio")),
            )
        )
        for name, frequency, ratio in (("first", f, z), ("second", g, y)):
            if not (np.isfinite(frequency) and frequency > 0.0):
                raise InputError(f"{name} frequency", frequency, "must be greater than 0")
            if not 0.0 <= ratio < 1.0:
                raise InputError(f"{name} ratio", ratio, "must be from 0 to below 1")
        if f == g:
            raise InputError("second frequency", g, "must differ from the first")
        w, v = 2.0 * np.pi * f, 2.0 * np.pi * g
        beta = 2.0 * (v * y - w * z) / (v**2 - w**2)
        alpha = 2.0 * w * z - beta * w**2
        if alpha < 0.0 or beta < 0.0:
            raise ValueError(
                f"ratios {z:g} at {f:g} Hz and {y:g} at {g:g} Hz: would take alpha = {alpha:.3g} "
                f"and beta = {beta:.3g}, neither of which may be negative; choose ratios that "
                "differ less"
            )
        return cls(float(alpha), float(beta))

    def ratios(self, frequencies: ArrayLike) -> Array:
        """Ratios to critical at frequencies [Hz], of the same shape."""
        given = array("frequencies", frequencies)
        refuse_where(~(given > 0.0), "frequencies", given, "must be greater than 0", " Hz")
        with np.errstate(over="ignore"):
            omega = 2.0 * np.pi * given
            found: Array = 0.5 * (self.alpha / omega + self.beta * omega)
        refuse_where(~np.isfinite(found), "frequencies", given, "is too far from any", " Hz")
        return found


#: Forms of the key ``rayleigh``.
FORMS: Final = "[alpha, beta] or { alpha = ..., beta = ... }"

#: Accepted as damping: ratios, a matrix C, `Rayleigh`, or a table ``{rayleigh = [alpha, beta]}`` or
#: ``{rayleigh = {alpha = ..., beta = ...}}``.
Damping: TypeAlias = ArrayLike | Rayleigh | Mapping[str, Any]


DAMPING: Final = Place("damping")


def damping_of(value: object, place: Place = DAMPING) -> Rayleigh | list[float] | Array:
    """Damping as `Rayleigh`, a list of ratios, or a matrix C."""
    if isinstance(value, Mapping):
        if [*map(str, value)] != ["rayleigh"]:
            raise place.wrong(
                dict(value),
                f"a number, a list or a matrix, or a table with the key rayleigh, {FORMS}",
            )
        return _rayleigh(value["rayleigh"], f"{place.name} rayleigh")
    if isinstance(value, Rayleigh):
        return value
    if not isinstance(value, np.ndarray) and is_list(value):
        value = items(place.name, value)
    try:
        dimensions = np.ndim(value)  # type: ignore[arg-type]
    except Exception:  # rows of different lengths, or an object that says that it is an array
        dimensions = 3
    if dimensions < 2:
        return numbers(place.name, value)
    if dimensions == 2:
        return array(place.name, value)
    raise place.wrong(
        value, "a ratio, a list of ratios, a square matrix C or Rayleigh(alpha, beta)"
    )


def resolved(
    damping: Rayleigh | list[float] | Array, frequencies: Callable[[], Array]
) -> tuple[list[float], Array | None]:
    """The ratios, or the matrix C; `frequencies` [Hz] are those of the included modes."""
    if isinstance(damping, np.ndarray):
        return [], damping
    if isinstance(damping, list):
        for ratio in damping:
            if 1.0 <= ratio < 100.0:
                percent = f"for {ratio:g} % write {ratio / 100.0:g}"
                said = f"must be a ratio to critical, from 0 to below 1; {percent}"
                raise InputError("damping", f"{ratio:g}", said)
        return damping, None
    ratios = damping.ratios(frequencies())
    for mode, ratio in enumerate(ratios, start=1):
        if ratio >= 1.0:
            raise InputError(
                "damping",
                damping,
                f"is {ratio:.3g} of critical in mode {mode}; must be from 0 to below 1 in "
                "every included mode",
            )
    return ratios.tolist(), None


def plain_damping(damping: Rayleigh | list[float] | Array) -> object:
    """What `damping_of` takes, as a case file writes it."""
    if isinstance(damping, Rayleigh):
        return {"rayleigh": [damping.alpha, damping.beta]}
    if isinstance(damping, np.ndarray):
        return damping.tolist()
    return damping[0] if len(damping) == 1 else damping


def in_words(plain: Any, frequencies: ArrayLike) -> str:
    """How much damping there is, of `plain_damping` and the frequencies of the modes [Hz]."""
    if isinstance(plain, Mapping):
        rayleigh = Rayleigh(*plain["rayleigh"])
        found = ", ".join(f"{100.0 * ratio:.3g}" for ratio in rayleigh.ratios(frequencies))
        return (
            f"Rayleigh alpha {rayleigh.alpha:.4g} /s, beta {rayleigh.beta:.4g} s: {found} % of "
            "critical"
        )
    values = np.asarray(plain)
    if values.ndim > 1:
        return "by a matrix"
    if not values.any():
        return "none"
    percent = [f"{100.0 * ratio:.4g}" for ratio in np.atleast_1d(values)]
    return f"{', '.join(percent)} % of critical{' in each mode' if values.ndim == 0 else ''}"


def _rayleigh(value: object, key: str) -> Rayleigh:
    """From a pair or a table."""
    if not isinstance(value, Mapping):
        return Rayleigh(*pair(key, value, f"a pair, {FORMS}"))
    with within(f"{key} = {shown(value)}: must be {FORMS}"):
        return Maker(Rayleigh).build(value, Place())
