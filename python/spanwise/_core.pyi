from typing import Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Bridge", "Crossing", "Road", "Vehicle", "__version__", "cross", "road_classes"]

__version__: Final[str]

_Friction: TypeAlias = tuple[float, float, float | None, float | None]
_Axle: TypeAlias = tuple[list[float], _Friction]
_Hinge: TypeAlias = tuple[int, float, float, float]
_Spring: TypeAlias = tuple[int, float, float, float, float, _Friction]
_Body: TypeAlias = tuple[list[float], list[_Axle], _Hinge | None, list[_Spring]]

@final
class Bridge:
    def __new__(
        cls,
        *,
        length: float,
        supports: list[tuple[float, str]],
        flexural_rigidity: list[float],
        mass: list[float],
        stations_per_span: list[int],
        stations: list[float] | None,
        point_masses: list[tuple[float, float]],
    ) -> Bridge: ...
    @staticmethod
    def continuous(
        *,
        spans: list[float],
        ends: tuple[str, str],
        flexural_rigidity: list[float],
        mass: list[float],
        stations_per_span: list[int],
        stations: list[float] | None,
        point_masses: list[tuple[float, float]],
    ) -> Bridge: ...
    @property
    def length(self) -> float: ...
    @property
    def supports(self) -> list[tuple[float, str]]: ...
    @property
    def span_bounds(self) -> NDArray[np.float64]: ...
    @property
    def flexural_rigidity(self) -> NDArray[np.float64]: ...
    @property
    def stations(self) -> NDArray[np.float64]: ...
    @property
    def masses(self) -> NDArray[np.float64]: ...
    def default_sections(self) -> NDArray[np.float64]: ...
    def modes(
        self, count: int, x: NDArray[np.float64] | None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]: ...
    def flexibility(self, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def redundant_stiffness(self) -> NDArray[np.float64]: ...
    def outer_reactions(self) -> list[tuple[float, str, NDArray[np.float64]]]: ...
    def influence_line(
        self, quantity: str, at: float, x: NDArray[np.float64], name: str
    ) -> NDArray[np.float64]: ...

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
    def body_positions(self) -> NDArray[np.float64]: ...
    @property
    def axle_order(self) -> list[tuple[int, int]]: ...
    @property
    def coordinates(self) -> list[str]: ...
    def static_loads(self, gravity: float) -> NDArray[np.float64]: ...
    def frequencies(self, locked: bool) -> NDArray[np.float64]: ...

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
    def check_holds(self, start: float, end: float) -> None: ...
    def at(
        self, x: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...
    def iri(self, start: float, end: float) -> float: ...

def road_classes() -> list[tuple[str, float, float | None]]: ...

@final
class Crossing:
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
    def final_speeds(self) -> list[float]: ...
    @property
    def stopped(self) -> list[float | None]: ...
    @property
    def lift_offs(self) -> list[tuple[int, float, float]]: ...
    def motion(self, vehicle: int) -> NDArray[np.float64]: ...
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
    tail: float,
    gravity: float,
    lift_off: bool,
    sections: list[float] | None,
    recovery: str,
) -> Crossing: ...
