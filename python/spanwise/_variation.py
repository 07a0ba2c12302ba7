"""Factors that vary vehicles and bridge from sample to sample, and values turned into them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import array, shown
from spanwise._events import Event
from spanwise._keys import suggestion
from spanwise.trains import ForceTrain, MovingMasses
from spanwise.vehicle import Vehicle
from spanwise.vehicles import AnyVehicle

Array: TypeAlias = NDArray[np.float64]

#: What is varied, and the attribute of a body or an axle whose unit its values have.
ATTRIBUTES: Final[Mapping[str, str | None]] = {
    "body_mass": "mass",
    "pitch_inertia": "pitch_inertia",
    "tyre_stiffness": "tyre_stiffness",
    "tyre_damping": "tyre_damping",
    "suspension_stiffness": "suspension_stiffness",
    "suspension_damping": "suspension_damping",
    "friction_limit": "friction_limit",
    "initial_friction": "friction_limit",
    "bridge_stiffness": None,
    "bridge_damping": None,
}

#: Parameters of the suspensions, which a single number varies between bodies too.
OF_SUSPENSIONS: Final = (
    "suspension_stiffness",
    "suspension_damping",
    "friction_limit",
    "initial_friction",
)


@dataclass(frozen=True)
class Factors:
    """Factors on one parameter, of shape (1, 1), (samples, 1) or (samples, parts)."""

    name: str
    values: Array

    @property
    def core(self) -> tuple[str, int, Array]:
        """As the core takes them."""
        return self.name, self.values.shape[1], np.ascontiguousarray(self.values).ravel()

    @property
    def plain(self) -> float | Array:
        """As a caller gives them."""
        if self.values.shape == (1, 1):
            return float(self.values[0, 0])
        return self.values[:, 0] if self.values.shape[1] == 1 else self.values


def factors_of(
    factors: object,
    values: object,
    events: Sequence[Event],
    kinds: NDArray[np.uint32],
    samples: int,
) -> list[Factors]:
    """All factors, those that values come to included."""
    given, absolute = _table("factors", factors), _table("values", values)
    for name in absolute:
        if name in given:
            raise ValueError(f"values: {name} is among the factors too; give one of the two")
    found = [
        Factors(name, _columns("factors", name, each, samples)) for name, each in given.items()
    ]
    for name, each in absolute.items():
        columns = _columns("values", name, each, samples)
        found.append(Factors(name, _relative(name, columns, events, kinds, samples)))
    _refuse_parts_of_mixed(found, events)
    return found


def _table(key: str, table: object) -> Mapping[str, object]:
    if table is None:
        return {}
    if not isinstance(table, Mapping):
        raise ValueError(f"{key} = {shown(table)}: must be a mapping from name to numbers")
    for name in table:
        if name not in ATTRIBUTES:
            near = suggestion(name, ATTRIBUTES) if isinstance(name, str) else ""
            raise ValueError(
                f"{key}: unknown parameter {name!r}{near}; allowed: {', '.join(ATTRIBUTES)}"
            )
    return table


def _columns(key: str, name: str, given: object, samples: int) -> Array:
    """Shape (1, 1) for a number, else one row for each sample."""
    values = array(f"{key}[{name!r}]", given)
    if values.ndim == 0:
        return values.reshape(1, 1)
    if values.ndim > 2 or (values.ndim == 2 and values.shape[1] == 0) or len(values) != samples:
        raise ValueError(
            f"{key}[{name!r}] = shape {values.shape}: must be a number, or of shape ({samples},) "
            f"or ({samples}, parts), one row for each of the {samples} samples"
        )
    return (
        values.reshape(samples, -1) if samples else values.reshape(0, max(1, *values.shape[1:], 1))
    )


def _relative(
    name: str,
    values: Array,
    events: Sequence[Event],
    kinds: NDArray[np.uint32],
    samples: int,
) -> Array:
    """What multiplies the nominal values to give these."""
    if ATTRIBUTES[name] is None:
        raise ValueError(f"values[{name!r}]: a bridge has no single value of it; give factors")
    nominal = [np.concatenate([_nominal(name, each.vehicle) for each in event]) for event in events]
    widths = {len(each) for each in nominal}
    if len(widths) > 1:
        raise ValueError(
            f"values[{name!r}]: the kinds of event have different numbers of parts, "
            f"{', '.join(map(str, sorted(widths)))}; give factors, one for each sample"
        )
    (width,) = widths
    if values.shape[1] not in (1, width):
        raise ValueError(
            f"values[{name!r}] = {values.shape[1]} values a sample: must be one, or one for each "
            f"of its {width} parts"
        )
    if width == 1 and name in OF_SUSPENSIONS and _has_springs(events):
        raise ValueError(
            f"values[{name!r}]: with a single axle these would vary the springs between bodies "
            "too; give factors"
        )
    lowest = -np.inf if name == "initial_friction" else 0.0
    if (values < lowest).any():
        wrong = values[values < lowest][0]
        raise ValueError(f"values[{name!r}] = {wrong:g}: must not be negative")
    for number, each in enumerate(nominal):
        if (each == 0.0).any() or not np.isfinite(each).all():
            what = "friction limit" if name == "initial_friction" else name
            kind = f" of kind {number}" if len(nominal) > 1 else ""
            raise ValueError(
                f"values[{name!r}]: the {what} of part {int(np.argmin(np.abs(each)))}{kind} is "
                f"{each.min():g}, of which nothing is a multiple; give the vehicle another one"
            )
    if len(nominal) == 1:
        relative: Array = values / nominal[0]
    else:
        relative = np.broadcast_to(values, (samples, values.shape[1])) / np.array(nominal)[kinds]
    # One number for all parts keeps its place only if there is one part.
    if len(relative) == 1 and width > 1 and samples != 1:
        return np.broadcast_to(relative, (samples, width)).copy()
    return relative


def _nominal(name: str, vehicle: AnyVehicle) -> Array:
    """Values of a vehicle as it is, by body or by axle, front first."""
    if isinstance(vehicle, Vehicle):
        of = vehicle.parts if name in ("body_mass", "pitch_inertia") else vehicle.axles
        attribute = ATTRIBUTES[name]
        assert attribute is not None
        found = [getattr(each, attribute) for each in of]
        # Of a body that does not pitch any inertia would do.
        return np.array([0.0 if each is None else each for each in found], dtype=np.float64)
    if name == "body_mass" and isinstance(vehicle, ForceTrain):
        return np.array(vehicle.loads)
    if name == "body_mass" and isinstance(vehicle, MovingMasses):
        return np.array(vehicle.masses)
    what = "forces" if isinstance(vehicle, ForceTrain) else "masses"
    raise ValueError(f"values[{name!r}]: a train of {what} has no such thing, only body_mass")


def _has_springs(events: Sequence[Event]) -> bool:
    vehicles = [each.vehicle for event in events for each in event]
    return any(
        isinstance(vehicle, Vehicle) and any(body.springs for body in vehicle.parts)
        for vehicle in vehicles
    )


def _refuse_parts_of_mixed(factors: Sequence[Factors], events: Sequence[Event]) -> None:
    """Masses by part have no order where vehicles and trains cross in one event."""
    is_train: Callable[[Any], bool] = lambda each: not isinstance(each.vehicle, Vehicle)  # noqa: E731
    for each in factors:
        by_part = each.name in ("body_mass", "pitch_inertia") and each.values.shape[1] > 1
        if by_part and any(len({*map(is_train, event)}) > 1 for event in events):
            raise ValueError(
                f"{each.name}: vehicles and trains in one event have no common parts; give one "
                "number for each sample"
            )
