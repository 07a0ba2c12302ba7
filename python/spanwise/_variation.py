"""Factors that vary vehicles and bridge from sample to sample, and values turned into them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._build import Place, check_known
from spanwise._checks import array, mapping
from spanwise._events import Event
from spanwise._table import listed
from spanwise._value import Value
from spanwise.errors import InputError
from spanwise.trains import ForceTrain
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


@dataclass(frozen=True, eq=False, repr=False)
class Factors(Value):
    """Factors on one parameter, of shape (1, 1), (samples, 1) or (samples, parts)."""

    name: str
    values: Array

    def __str__(self) -> str:
        """What varies from where to where, or by what it differs in all samples."""
        values = self.values
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
    speeds: Array,
    samples: int,
) -> list[Factors]:
    """All factors, those that values come to included; they and speeds are checked."""
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
    order = sorted(absolute, key=lambda name: name == "initial_friction")
    meant = [Factors(name, _columns("values", name, absolute[name], samples)) for name in order]
    _core.check_samples(events, samples=samples, speeds=speeds, factors=found, values=meant)
    for each in meant:
        varied = [other.values for other in found if other.name == "friction_limit"]
        limits = varied[0] if varied and each.name == "initial_friction" else 1.0
        found.append(_relative(each, events, kinds, samples, limits))
    return found


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


def by_parameter(key: str, table: object) -> dict[str, Array]:
    """Numbers by the name of what varies."""
    if table is None:
        return {}
    table = mapping(key, table, "a mapping from name to numbers")
    allowed = [name for name in ATTRIBUTES if key == "factors" or name not in OF_BRIDGES]
    strange = {name: None for name in table if name not in ATTRIBUTES}
    check_known(strange, allowed, Place(key), "parameter")
    return {name: array(f"{key}[{name!r}]", each) for name, each in table.items()}


def _columns(key: str, name: str, values: Array, samples: int) -> Array:
    """Shape (1, 1) for a number, else one row for each sample."""
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
    meant: Factors,
    events: Sequence[Event],
    kinds: NDArray[np.uint32],
    samples: int,
    limits: Array | float,
) -> Factors:
    """What multiplies the nominal values to give these; `limits` are factors on those besides."""
    name, values = meant.name, meant.values
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
    if width == 1 and name in OF_SUSPENSIONS and _has_springs(events):
        raise InputError(
            f"values[{name!r}]",
            None,
            "with a single axle these would vary the springs between bodies too; give factors",
        )
    for number, each in enumerate(nominal):
        wrong = np.flatnonzero(each == 0.0)
        if len(wrong) > 0:
            what, part = ATTRIBUTES[name], "body" if name in OF_BODIES else "axle"
            kind = f" of kind {number}" if len(nominal) > 1 else ""
            raise InputError(
                f"values[{name!r}]",
                None,
                f"{part} {wrong[0] + 1}{kind} has no {what}, so that "
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
        relative = np.broadcast_to(relative, (samples, width)).copy()
    return Factors(name, relative)


def _nominal(name: str, vehicle: AnyVehicle) -> Array:
    """Values of a vehicle as it is, by body or by axle, front first."""
    if isinstance(vehicle, Vehicle):
        of = vehicle.parts if name in OF_BODIES else vehicle.axles
        attribute = ATTRIBUTES[name]
        assert attribute is not None
        found = [getattr(each, attribute) for each in of]
        # Of a body that does not pitch any inertia would do.
        return np.array([0.0 if each is None else each for each in found], dtype=np.float64)
    # The core has let nothing but body_mass pass.
    return np.array(vehicle.loads if isinstance(vehicle, ForceTrain) else vehicle.masses)


def _has_springs(events: Sequence[Event]) -> bool:
    vehicles = [each.vehicle for event in events for each in event]
    return any(
        isinstance(vehicle, Vehicle) and any(body.springs for body in vehicle.parts)
        for vehicle in vehicles
    )
