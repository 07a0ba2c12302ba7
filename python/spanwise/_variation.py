"""Factors that vary vehicles and bridge from sample to sample, and values turned into them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._build import Place, check_known
from spanwise._checks import array, refuse_where
from spanwise._events import Event
from spanwise._table import listed
from spanwise._value import Value
from spanwise.errors import InputError, refused
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


#: Parameters of the bodies, and those of the bridge; the others are of the axles.
OF_BODIES: Final = ("body_mass", "pitch_inertia")
OF_BRIDGES: Final = tuple(name for name, attribute in ATTRIBUTES.items() if attribute is None)

#: Parameters that vehicles cannot do without.
ABOVE_ZERO: Final = ("body_mass", "pitch_inertia", "tyre_stiffness", "suspension_stiffness")


@dataclass(frozen=True, eq=False, repr=False)
class Factors(Value):
    """Factors on one parameter, of shape (1, 1), (samples, 1) or (samples, parts)."""

    name: str
    values: Array

    def __str__(self) -> str:
        """What varies from where to where, or by what it differs in all samples."""
        values = self.values
        if values.size == 0:
            return f"varied    {self.name}"
        if (values == values[0]).all():
            alike = (values[0] == values[0, 0]).all()
            found = listed(values[0, :1] if alike else values[0], ".4g")
            return f"factor    {self.name} {found} for all samples"
        return f"varied    {self.name} from {values.min():.4g} to {values.max():.4g}"

    def of(self, sample: int) -> Factors:
        """Those of one sample."""
        row = sample if len(self.values) > 1 else 0
        return Factors(self.name, self.values[row : row + 1])

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
    given, absolute = by_parameter("factors", factors), by_parameter("values", values)
    for name in absolute:
        if name in given:
            raise InputError(
                "values", None, f"{name} is among the factors too; give one of the two"
            )
    found = [
        Factors(name, _columns("factors", name, each, samples)) for name, each in given.items()
    ]
    # The limit first: initial friction counts by what the limit of a sample is.
    for name, each in sorted(absolute.items(), key=lambda item: item[0] == "initial_friction"):
        columns = _columns("values", name, each, samples)
        limits = [other.values for other in found if other.name == "friction_limit"]
        if name == "initial_friction" and limits:
            relative = _relative(name, columns, events, kinds, samples, limits[0])
        else:
            relative = _relative(name, columns, events, kinds, samples)
        found.append(Factors(name, relative))
    _refuse_parts_of_mixed(found, events)
    for factor in found:
        if factor.name in given:
            _check_width(factor, events)
    return found


def refuse_overdamped(factors: Sequence[Factors], ratios: Sequence[float], first: int) -> None:
    """Refuses factors that bring the damping of the bridge to its critical value."""
    most = max(ratios, default=0.0)
    if not 0.0 <= most < 1.0:  # refused by itself
        return
    for each in factors:
        if each.name != "bridge_damping":
            continue
        wrong = each.values[:, :1] * most >= 1.0
        if wrong.any():
            row = int(np.flatnonzero(wrong)[0])
            factor = each.values[row, 0]
            one = len(each.values) == 1
            raise InputError(
                f"factors['bridge_damping']{'' if one else f'[{row}]'}",
                f"{factor:g}",
                f"makes of damping = {most:g} in "
                f"{'every sample' if one else f'sample {first + row}'} {factor * most:g} of "
                "critical; must stay below 1",
            )


def idle(
    factors: Sequence[Factors],
    events: Sequence[Event],
    ratios: Sequence[float],
    matrix: Array | None,
) -> Iterator[str]:
    """What to say of factors on what is 0 wherever they act, with the damping of the bridge."""
    all_ = [each.vehicle for event in events for each in event]
    vehicles = [each for each in all_ if isinstance(each, Vehicle)]
    for each in factors:
        name, there = each.name, False
        if name == "bridge_damping":
            there = bool(np.any(ratios if matrix is None else matrix))
            what = "damping"
        elif name == "bridge_stiffness" or len(vehicles) < len(all_):
            continue
        else:
            of_springs = name in OF_SUSPENSIONS and each.values.shape[1] == 1
            there = any(
                _nominal(name, vehicle).any() or (of_springs and _springs_have(name, vehicle))
                for vehicle in vehicles
            )
            what = ATTRIBUTES[name] or name
        if not there:
            yield f"{name}: the {what} is 0, and a factor on it does nothing"


def _springs_have(name: str, vehicle: Vehicle) -> bool:
    """Whether a spring between bodies has what a single factor varies along."""
    attribute = (ATTRIBUTES[name] or name).removeprefix("suspension_")
    springs = [each for body in vehicle.parts for each in body.springs]
    return any(getattr(each, attribute) != 0.0 for each in springs)


def _check_width(factors: Factors, events: Sequence[Event]) -> None:
    """Refuses factors by part where a kind of event has another number of parts."""
    name, width = factors.name, factors.values.shape[1]
    if width == 1:
        return
    given = f"factors[{name!r}]", f"{width} factors a sample"
    if name in OF_BRIDGES:
        raise InputError(*given, "must be one for each sample, for there is one bridge")
    for number, event in enumerate(events):
        parts = _parts(name, event)
        if width != parts:
            kind = f"kind {number}" if len(events) > 1 else "the event"
            raise InputError(*given, _allowed(name, parts, kind))


def _parts(name: str, event: Event) -> int:
    """How many parts an event has that a parameter is one of."""
    vehicles = [each.vehicle for each in event]
    if name in OF_BODIES and all(isinstance(each, Vehicle) for each in vehicles):
        return sum(len(each.parts) for each in vehicles if isinstance(each, Vehicle))
    return sum(len(each.static_loads()) for each in vehicles)


def _allowed(name: str, parts: int, kind: str) -> str:
    """How many numbers a parameter takes that `kind` has so many parts of."""
    if parts == 1:
        return f"must be one for each sample, for {kind} has one {_part(name)}"
    return f"must be one for each sample, or one for each of the {parts} {_plural(name)} of {kind}"


def _part(name: str) -> str:
    return "body" if name in OF_BODIES else "axle"


def _plural(name: str) -> str:
    return "bodies" if name in OF_BODIES else "axles"


def by_parameter(key: str, table: object) -> dict[str, Array]:
    """Numbers by the name of what varies."""
    if table is None:
        return {}
    if not isinstance(table, Mapping):
        raise refused(key, table, "must be a mapping from name to numbers")
    allowed = [name for name in ATTRIBUTES if key == "factors" or name not in OF_BRIDGES]
    strange = {name: None for name in table if name not in ATTRIBUTES}
    check_known(strange, allowed, Place(key), "parameter")
    return {name: array(f"{key}[{name!r}]", each) for name, each in table.items()}


def _columns(key: str, name: str, values: Array, samples: int) -> Array:
    """Shape (1, 1) for a number, else one row for each sample."""
    if key == "values" and name != "initial_friction":
        refuse_where(values < 0.0, f"values[{name!r}]", values, "must not be negative")
        if name in ABOVE_ZERO:
            refuse_where(values == 0.0, f"values[{name!r}]", values, "must be greater than 0")
    if values.ndim == 0:
        return values.reshape(1, 1)
    if values.ndim > 2 or (values.ndim == 2 and values.shape[1] == 0) or len(values) != samples:
        raise InputError(
            f"{key}[{name!r}]",
            f"shape {values.shape}",
            f"must be a number, or of shape ({samples},) or ({samples}, parts), one row for "
            f"each of the {samples} samples",
        )
    return values.reshape(samples, -1)


def _relative(
    name: str,
    values: Array,
    events: Sequence[Event],
    kinds: NDArray[np.uint32],
    samples: int,
    limits: Array | float = 1.0,
) -> Array:
    """What multiplies the nominal values to give these; `limits` are factors on those besides."""
    if ATTRIBUTES[name] is None:
        raise InputError(
            f"values[{name!r}]", None, "a bridge has no single value of it; give factors"
        )
    nominal = [np.concatenate([_nominal(name, each.vehicle) for each in event]) for event in events]
    widths = {len(each) for each in nominal}
    if len(widths) > 1:
        raise InputError(
            f"values[{name!r}]",
            None,
            f"the kinds of event have different numbers of parts, "
            f"{', '.join(map(str, sorted(widths)))}; give factors, one for each sample",
        )
    (width,) = widths
    if values.shape[1] not in (1, width):
        raise InputError(
            f"values[{name!r}]",
            f"{values.shape[1]} values a sample",
            _allowed(name, width, "the event"),
        )
    if width == 1 and name in OF_SUSPENSIONS and _has_springs(events):
        raise InputError(
            f"values[{name!r}]",
            None,
            "with a single axle these would vary the springs between bodies too; give factors",
        )
    for number, each in enumerate(nominal):
        wrong = np.flatnonzero((each == 0.0) | ~np.isfinite(each))
        if len(wrong) > 0:
            what = ATTRIBUTES[name]
            kind = f" of kind {number}" if len(nominal) > 1 else ""
            lacks = f"no {what}" if each[wrong[0]] == 0.0 else f"an infinite {what}"
            raise InputError(
                f"values[{name!r}]",
                None,
                f"{_part(name)} {wrong[0] + 1}{kind} has {lacks}, so that "
                f"{'it' if what == name else name} cannot be set by values",
            )
    if len(nominal) == 1:
        relative: Array = values / nominal[0]
    else:
        relative = np.broadcast_to(values, (samples, values.shape[1])) / np.array(nominal)[kinds]
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = relative / limits
    beyond = ~(np.abs(relative) <= 1.0)
    if name == "initial_friction" and beyond.any():
        row, part = np.argwhere(beyond)[0]
        one = values.shape[1] == 1
        place = (row if len(values) > 1 else 0, 0 if one else part)
        index = "" if values.shape == (1, 1) else f"[{row}]" if one else f"[{row}, {part}]"
        limit = nominal[int(kinds[row]) if len(nominal) > 1 else 0][part]
        limit *= np.broadcast_to(limits, relative.shape)[row, part]
        raise InputError(
            f"values[{name!r}]{index}",
            f"{values[place]:g}",
            f"must be within the friction limit of axle {part + 1}, {limit:g} N",
        )
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
    raise InputError(
        f"values[{name!r}]", None, f"a train of {what} has no such thing, only body_mass"
    )


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
            raise InputError(
                each.name,
                None,
                "vehicles and trains in one event have no common parts; give one number for "
                "each sample",
            )
