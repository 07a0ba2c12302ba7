from typing import Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = ["Bridge", "Crossing", "Vehicle", "__version__", "cross"]

__version__: Final[str]

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
    def __new__(
        cls, *, mass: float, pitch_inertia: float, cg_height: float, axles: list[list[float]]
    ) -> Vehicle: ...
    def static_loads(self, gravity: float) -> NDArray[np.float64]: ...
    def frequencies(self, locked: bool) -> NDArray[np.float64]: ...

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
    def final_speed(self) -> float: ...
    def histories(self, name: str) -> list[NDArray[np.float64]]: ...
    def states(self, name: str) -> NDArray[np.float64]: ...
    def envelope(self, quantity: str) -> list[NDArray[np.float64]]: ...
    def impact_factors(
        self, quantity: str, sense: str, ratio: str, mask: float
    ) -> NDArray[np.float64]: ...

def cross(
    bridge: Bridge,
    vehicle: Vehicle,
    *,
    speed: float,
    drive: str,
    modes: int,
    damping: list[float],
    damping_matrix: NDArray[np.float64] | None,
    beta: float,
    step: float | None,
    approach: float,
    tail: float,
    gravity: float,
    sections: list[float] | None,
    recovery: str,
) -> Crossing: ...
