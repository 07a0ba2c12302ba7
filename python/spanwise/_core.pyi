from collections.abc import Callable
from typing import Any, Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "FLM4_MIX",
    "HS20_REAR_SPACING",
    "T44_REAR_SPACING",
    "Bridge",
    "Clock",
    "Crossing",
    "Ensemble",
    "Road",
    "Vehicle",
    "__version__",
    "articulated_5_axle",
    "cl_625",
    "cross",
    "ensemble",
    "fingerprint",
    "flm3",
    "flm4",
    "half_car",
    "hs20",
    "hs20_44",
    "kishan_1973",
    "presets",
    "quarter_car",
    "road_classes",
    "static_loads",
    "t44",
    "varied",
]

__version__: Final[str]

_Friction: TypeAlias = tuple[float, float, float | None, float | None]
_Axle: TypeAlias = tuple[list[float], _Friction]
_Hinge: TypeAlias = tuple[int, float, float, float]
_Spring: TypeAlias = tuple[int, float, float, float, float, _Friction]
_Body: TypeAlias = tuple[list[float], list[_Axle], _Hinge | None, list[_Spring]]
_Array: TypeAlias = NDArray[np.float64]
_Support: TypeAlias = tuple[float, float, float]
_Along: TypeAlias = tuple[list[float] | None, list[float], int]
_Sides: TypeAlias = tuple[_Array, _Array | None]

@final
class Bridge:
    def __new__(
        cls,
        *,
        length: float,
        supports: list[_Support],
        hinges: list[float],
        flexural_rigidity: _Along,
        mass: _Along,
        stations_per_span: list[int],
        stations: list[float] | None,
        point_masses: list[tuple[float, float]],
    ) -> Bridge: ...
    @staticmethod
    def consecutive(spans: list[float], ends: tuple[str, str]) -> tuple[float, list[_Support]]: ...
    @staticmethod
    def from_flexibility(
        *,
        length: float,
        supports: list[_Support],
        stations: list[float],
        masses: list[float],
        redundants: list[tuple[float, float]],
        path: list[float],
        flexibility: _Array,
        slopes: _Array | None,
    ) -> Bridge: ...
    @staticmethod
    def from_modes(
        *,
        path: list[float],
        frequencies: list[float],
        shapes: _Sides,
        slopes: _Sides | None,
        sections: list[float],
        supports: list[_Support],
        influence: list[tuple[str, _Sides, _Sides | None, _Array | None]],
        masses: list[float] | None,
    ) -> Bridge: ...
    @property
    def described(self) -> bool: ...
    @property
    def length(self) -> float: ...
    @property
    def supports(self) -> list[_Support]: ...
    @property
    def hinges(self) -> _Array: ...
    @property
    def missing(self) -> list[str]: ...
    @property
    def span_bounds(self) -> _Array: ...
    @property
    def flexural_rigidity(self) -> _Array: ...
    @property
    def rigidity_bounds(self) -> _Array: ...
    @property
    def masses(self) -> tuple[_Array, _Array]: ...
    @property
    def mode_count(self) -> int: ...
    @property
    def nodes(self) -> _Array: ...
    def default_sections(self) -> _Array: ...
    def modes(
        self, count: int, x: _Array | None, derivative: bool, left: bool
    ) -> tuple[_Array, _Array, _Array | None]: ...
    def flexibility(self, name: str) -> tuple[_Array, _Array]: ...
    def deflections(
        self, x: _Array, loads: list[float], name: str, derivative: bool, left: bool
    ) -> _Array: ...
    def redundant_stiffness(self) -> _Array: ...
    def outer_reactions(self) -> list[tuple[float, str, _Array]]: ...
    def settlement(self, settlements: list[float], sections: list[float]) -> list[_Array]: ...
    def influence_line(
        self, quantity: str, at: float, x: _Array, name: str, derivative: bool, left: bool
    ) -> _Array: ...

@final
class Vehicle:
    def __new__(cls, bodies: list[_Body]) -> Vehicle: ...
    @staticmethod
    def force_train(loads: list[float], positions: list[float]) -> Vehicle: ...
    @staticmethod
    def moving_masses(masses: list[float], positions: list[float]) -> Vehicle: ...
    @property
    def mass(self) -> float: ...
    @property
    def positions(self) -> NDArray[np.float64]: ...
    @property
    def places(self) -> NDArray[np.float64]: ...
    @property
    def bodies(self) -> list[_Body]: ...
    @property
    def body_positions(self) -> NDArray[np.float64]: ...
    @property
    def axle_order(self) -> list[tuple[int, int]]: ...
    @property
    def coordinates(self) -> list[str]: ...
    def static_loads(self, gravity: float) -> NDArray[np.float64]: ...
    def frequencies(self, locked: bool) -> NDArray[np.float64]: ...

# Name, title and source of each entry of the catalogue, and whether it was recalled.
def presets() -> list[tuple[str, str, str, bool]]: ...
def kishan_1973() -> Vehicle: ...
def quarter_car(cg_height: float) -> Vehicle: ...
def half_car(cg_height: float) -> Vehicle: ...
def articulated_5_axle(cg_heights: list[float], hinge_height: float) -> Vehicle: ...
def hs20_44(cg_heights: list[float], hinge_height: float) -> Vehicle: ...
def hs20(rear_spacing: float) -> Vehicle: ...
def t44(rear_spacing: float) -> Vehicle: ...
def cl_625() -> Vehicle: ...
def flm3() -> Vehicle: ...
def flm4(lorry: int) -> Vehicle: ...

FLM4_MIX: Final[list[tuple[str, list[float]]]]
HS20_REAR_SPACING: Final[list[float]]
T44_REAR_SPACING: Final[list[float]]

@final
class Road:
    @staticmethod
    def sum(parts: list[Road]) -> Road: ...
    @staticmethod
    def random(
        *,
        roughness: float,
        waviness: float,
        band: tuple[float, float],
        contact_patch: float,
        period: float | None,
        seed: int,
        sample: int,
    ) -> Road: ...
    @staticmethod
    def profile(
        *,
        x: NDArray[np.float64],
        elevation: NDArray[np.float64],
        detrend: bool,
        contact_patch: float,
        max_gap: float | None,
    ) -> Road: ...
    @staticmethod
    def step(at: float, height: float, contact_patch: float) -> Road: ...
    @staticmethod
    def ramp(start: float, end: float, height: float, contact_patch: float) -> Road: ...
    @staticmethod
    def plateau(
        at: float, length: float, height: float, edge: float, contact_patch: float
    ) -> Road: ...
    @staticmethod
    def camber(start: float, end: float, rise: float, contact_patch: float) -> Road: ...
    @property
    def is_smooth(self) -> bool: ...
    @property
    def ends(self) -> tuple[float, float]: ...
    @property
    def period(self) -> float: ...
    def drift(self, start: float, far: float) -> list[float]: ...
    def check_holds(self, start: float, end: float) -> None: ...
    def at(
        self, x: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def averaged(self, length: float) -> Road: ...
    def waves(self, start: float, end: float) -> tuple[float, float]: ...
    def iri(self, start: float, end: float) -> float: ...
    def iri_segments(
        self, start: float, end: float, every: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], float]: ...

def road_classes() -> list[tuple[str, float, float | None]]: ...

@final
class Crossing:
    @staticmethod
    def received(
        bridge: Bridge,
        vehicles: list[Vehicle],
        state: bytes,
        *,
        modes: int,
        damping: list[float],
        damping_matrix: _Array | None,
        sections: list[float] | None,
        recovery: str,
    ) -> Crossing: ...
    @property
    def state(self) -> bytes: ...
    @property
    def sections(self) -> NDArray[np.float64]: ...
    @property
    def omega(self) -> NDArray[np.float64]: ...
    @property
    def static_loads(self) -> NDArray[np.float64]: ...
    @property
    def step(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def tail(self) -> float: ...
    @property
    def settled(self) -> bool: ...
    @property
    def growth(self) -> float: ...
    def reach(self, name: str) -> NDArray[np.float64] | None: ...
    @property
    def final_speeds(self) -> list[float]: ...
    @property
    def stopped(self) -> list[float | None]: ...
    @property
    def lift_offs(self) -> list[tuple[int, float, float]]: ...
    @property
    def load_coefficients(self) -> NDArray[np.float64]: ...
    def motion(self, vehicle: int, drift: list[float]) -> NDArray[np.float64]: ...
    def quasi_static_acceleration(self) -> NDArray[np.float64]: ...
    def histories(self, name: str) -> list[NDArray[np.float64]]: ...
    def states(self, name: str) -> NDArray[np.float64]: ...
    def envelope(self, quantity: str) -> list[NDArray[np.float64]]: ...
    def impact_factors(
        self, quantity: str, sense: str, ratio: str, mask: float
    ) -> NDArray[np.float64]: ...

# Vehicle, speed, drive, direction, entry, lane, road.
_Passage: TypeAlias = tuple[
    Vehicle,
    float | None,
    tuple[str, list[float], list[float]] | None,
    str,
    float,
    int,
    Road | None,
]

def cross(
    bridge: Bridge,
    passages: list[_Passage],
    *,
    modes: int,
    damping: list[float],
    damping_matrix: NDArray[np.float64] | None,
    beta: float,
    step: float | None,
    approach: float,
    ramp: float,
    tail: float | None,
    gravity: float,
    lift_off: bool,
    sections: list[float] | None,
    recovery: str,
) -> Crossing: ...

@final
class Ensemble:
    @property
    def numbers(self) -> _Array: ...
    @property
    def instants(self) -> NDArray[np.uint32]: ...
    @property
    def digests(self) -> NDArray[np.uint64]: ...
    @property
    def hash(self) -> int: ...
    @property
    def isa(self) -> str: ...
    @property
    def threads(self) -> int: ...
    @property
    def elapsed(self) -> float: ...
    @property
    def shares(self) -> bool: ...
    @property
    def sections(self) -> _Array: ...
    @property
    def omega(self) -> _Array: ...
    @property
    def at_rest(self) -> _Array: ...
    @property
    def failures(self) -> list[tuple[int, int | None, str]]: ...
    @property
    def marches(self) -> NDArray[np.uint32]: ...
    @property
    def widths(self) -> list[tuple[str, int]]: ...
    @property
    def columns(self) -> dict[str, tuple[int, int]]: ...
    @property
    def clock(self) -> Clock: ...

@final
class Clock:
    def __new__(cls, state: bytes) -> Clock: ...
    @property
    def state(self) -> bytes: ...
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...
    def when(
        self, instants: NDArray[np.uint32], marches: NDArray[np.uint32], speeds: _Array
    ) -> list[_Array]: ...
    def step(self, march: int, speed: float) -> tuple[float, int] | None: ...
    @staticmethod
    def joined(clocks: list[Clock]) -> tuple[Clock, list[list[int]]]: ...

_Factors: TypeAlias = tuple[str, int, _Array]

def varied(event: list[_Passage], factors: list[_Factors]) -> list[Vehicle]: ...
def static_loads(
    kinds: list[list[_Passage]],
    kind_of: NDArray[np.uint32],
    count: int,
    factors: list[_Factors],
    gravity: float,
) -> _Array: ...
def fingerprint(digests: NDArray[np.uint64]) -> int: ...
def ensemble(
    bridge: Bridge,
    kinds: list[list[_Passage]],
    *,
    drive: tuple[str, list[float], list[float]],
    road: Road,
    own_road: tuple[Any, ...] | None,
    modes: int,
    damping: list[float],
    damping_matrix: _Array | None,
    beta: float,
    step: float | None,
    advance: float | None,
    approach: float,
    ramp: float,
    tail: float | None,
    gravity: float,
    lift_off: bool,
    sections: list[float] | None,
    recovery: str,
    quantities: list[str],
    first: int,
    count: int,
    kind_of: NDArray[np.uint32],
    speeds: _Array,
    factors: list[_Factors],
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> Ensemble: ...
