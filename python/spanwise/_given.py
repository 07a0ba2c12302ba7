"""Arrays of a bridge given by its flexibility or its modes, in the shape the core takes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import array, shown
from spanwise._keys import suggestion

Array: TypeAlias = NDArray[np.float64]
Sides: TypeAlias = tuple[Array, Array | None]
Lines: TypeAlias = tuple[str, Sides, Sides | None, Array | None]

QUANTITIES: Final = (
    "deflection",
    "moment",
    "shear-left",
    "shear-right",
    "reaction",
    "clamp-moment",
)


def matrix(key: str, value: object) -> Array:
    """An array of two dimensions."""
    values = array(key, value)
    if values.ndim != 2:
        raise ValueError(f"{key}: must have 2 dimensions, not {values.ndim}")
    return np.ascontiguousarray(values)


def sides(key: str, value: object) -> Sides:
    """Numbers on the right and, where a last axis gives the left and the right, on the left."""
    values = array(key, value)
    if values.ndim == 3 and values.shape[2] == 2:
        return np.ascontiguousarray(values[..., 1]), np.ascontiguousarray(values[..., 0])
    if values.ndim != 2:
        raise ValueError(
            f"{key}: must have 2 dimensions, or 3 with the left and the right side on the last; "
            f"not {values.ndim} of shape {values.shape}"
        )
    return np.ascontiguousarray(values), None


def influence_lines(influence: object, slopes: object, modal: object) -> list[Lines]:
    """The influence lines of each kind of response, with their slopes and the modes' responses."""
    lines = _table("influence", influence)
    derivatives, responses = _table("influence_slopes", slopes), _table("modal", modal)
    for key, table in (("influence_slopes", derivatives), ("modal", responses)):
        for name in table:
            if name not in lines:
                raise ValueError(f"{key}: {name!r} has no influence line; give it in influence")
    return [
        (
            name,
            sides(f"influence {name}", values),
            sides(f"influence_slopes {name}", derivatives[name]) if name in derivatives else None,
            matrix(f"modal {name}", responses[name]) if name in responses else None,
        )
        for name, values in lines.items()
    ]


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
    for name in value:
        if name not in QUANTITIES:
            hint = suggestion(str(name), QUANTITIES)
            raise ValueError(
                f"{key}: unknown response {name!r}{hint}; allowed: {', '.join(QUANTITIES)}"
            )
    return value
