"""Arrays of a bridge given by its flexibility or its modes, in the shape the core takes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._build import Place, check_known
from spanwise._checks import array, shown
from spanwise._warnings import PlausibilityWarning, warn
from spanwise.errors import InputError
from spanwise.quantities import of_bridges

Array: TypeAlias = NDArray[np.float64]
Sides: TypeAlias = tuple[Array, Array | None]
Lines: TypeAlias = tuple[str, Sides, Sides | None, Array | None]

#: By how much modes may exceed the flexibility that they are part of, relative to it: frequencies
#: printed to two digits may be off by 10 % in the square, while shapes scaled to unit modal mass in
#: tonnes, or to a largest ordinate of 1, are off by a factor of 1000 and more.
_EXCESS: Final = 0.1

#: Flexibility that is nought but for printed digits, relative to the largest: over supports.
_NOUGHT: Final = 1e-4

#: Part of the flexibility below which modes explain little of it. Frequencies in rad/s explain at
#: most 1/(2 pi)^2 = 0.025; this is half-way, by factors, from there to all.
_LITTLE: Final = 0.16


def matrix(key: str, value: object) -> Array:
    """An array of two dimensions."""
    values = array(key, value)
    if values.ndim != 2:
        raise InputError(key, None, f"must have 2 dimensions, not {values.ndim}")
    return np.ascontiguousarray(values)


def sides(key: str, value: object) -> Sides:
    """Numbers on the right and, where a last axis gives the left and the right, on the left."""
    values = array(key, value)
    if values.ndim == 3 and values.shape[2] == 2:
        return np.ascontiguousarray(values[..., 1]), np.ascontiguousarray(values[..., 0])
    if values.ndim != 2:
        raise InputError(
            key,
            None,
            "must have 2 dimensions, or 3 with the left and the right side on the last; not "
            f"{values.ndim} of shape {values.shape}",
        )
    return np.ascontiguousarray(values), None


def influence_lines(influence: object, slopes: object, modal: object) -> list[Lines]:
    """The influence lines of each kind of response, with their slopes and the modes' responses."""
    lines = _table("influence", influence)
    derivatives, responses = _table("influence_slopes", slopes), _table("modal", modal)
    for key, table in (("influence_slopes", derivatives), ("modal", responses)):
        for name in table:
            if name not in lines:
                raise InputError(key, None, f"{name!r} has no influence line; give it in influence")
    return [
        (
            name,
            sides(f"influence {name}", values),
            sides(f"influence_slopes {name}", derivatives[name]) if name in derivatives else None,
            matrix(f"modal {name}", responses[name]) if name in responses else None,
        )
        for name, values in lines.items()
    ]


def check_flexibility(
    path: Sequence[float],
    frequencies: Sequence[float],
    shapes: Array,
    sections: Sequence[float],
    deflections: Array,
) -> None:
    """Refuse modes and lines of deflection that cannot be of one bridge; doubt those that hardly.

    The flexibility K^-1 is the sum of phi phi^T / omega^2 over all modes of unit modal mass, for
    any mass matrix, and no term of its diagonal is negative.

    Parameters
    ----------
    path, frequencies, sections : sequence of float
        As `Bridge.from_modes` takes them.
    shapes : ndarray, shape (path, modes)
        The mode shapes.
    deflections : ndarray, shape (sections, path)
        The influence lines of deflection.
    """
    at = [int(np.argmin(np.abs(np.subtract(path, x)))) for x in sections]
    if not at:
        return
    own = deflections[np.arange(len(at)), at]
    nought = _NOUGHT * float(np.abs(deflections).max(initial=0.0))
    low = int(np.argmin(own))
    if own[low] < -nought:
        raise InputError(
            "influence deflection",
            f"{own[low]:.4g} m/N at its own section, x = {sections[low]:g} m",
            "must be 0 or more; deflections are positive down: change the sign",
        )
    with np.errstate(all="ignore"):  # too much is too much
        modal = (shapes[at] ** 2 / (2.0 * np.pi * np.asarray(frequencies)) ** 2).sum(axis=1)
    excess = modal - ((1.0 + _EXCESS) * own + nought)
    worst = int(np.argmax(excess))
    if excess[worst] > 0.0:
        raise InputError(
            "shapes",
            None,
            f"the modes alone deflect x = {sections[worst]:g} m by {modal[worst]:.4g} m/N, the "
            f"influence line of deflection by {own[worst]:.4g} m/N, which must be more; the "
            "shapes are not scaled to unit modal mass [kg^-1/2], or the frequencies are too "
            "low",
        )
    free = own > nought
    if len(frequencies) > 1 and free.any():
        part = float((modal[free] / own[free]).max())
        if part < _LITTLE:
            warn(
                f"frequencies: the modes explain at most {100.0 * part:.2g} % of the deflection "
                "under a load at any section; are they in rad/s instead of Hz, the shapes not "
                "scaled to unit modal mass [kg^-1/2], or the modes too few?",
                PlausibilityWarning,
            )


def plain(value: Any) -> Any:
    """The arrays as lists."""
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    return None if value is None else np.asarray(value).tolist()


def _table(key: str, value: object) -> Mapping[str, Any]:
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ValueError(f"{key} = {shown(value)}: must name its responses: {{'moment': ...}}")
    known = [name for each in of_bridges() for name in each.lines]
    check_known(value, known, Place(key), "response")
    return value
