"""What all that rolls over a bridge has in common: wheel lines, their loads, frequencies."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._checks import flag, number
from spanwise._door import view
from spanwise._shown import many
from spanwise._table import listed

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from spanwise.plotting import VehiclePlot

Array: TypeAlias = NDArray[np.float64]

#: Standard gravity [m/s2].
GRAVITY: Final = 9.80665


class Wheels:
    """A vehicle or a train, as the engine knows it."""

    if TYPE_CHECKING:

        @property
        def _core(self) -> _core.Vehicle: ...

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its fields, so that it can go to another process."""
        names = [each.name for each in fields(cast("DataclassInstance", self))]
        return _rebuilt, (type(self), {name: getattr(self, name) for name in names})

    @property
    def plot(self) -> VehiclePlot:
        """Figures of the vehicle or train; needs the extra ``spanwise[plot]``."""
        return view("plotting.VehiclePlot")(self)

    @property
    def total_mass(self) -> float:
        """Mass of all there is, unsprung masses included [kg]; of a train of forces none."""
        return self._core.mass

    @property
    def axle_positions(self) -> Array:
        """Distances of the axles ahead of the centre of mass of the whole vehicle [m].

        Front first, shape (axles,). A train of forces has the centre of its loads in its place.
        """
        return self._core.positions

    @property
    def axle_spacings(self) -> Array:
        """Distances from axle to axle [m], front first, shape (axles - 1,)."""
        return -np.diff(self.axle_positions)

    @property
    def wheelbase(self) -> float:
        """Distance from the first to the last axle [m]."""
        return float(self.axle_positions[0] - self.axle_positions[-1])

    def _row(self) -> str:
        """How many axles, and over what length, for a short text."""
        return f"{many(len(self.axle_positions), 'axle')}, {self.wheelbase:.4g} m"

    @property
    def _total(self) -> str:
        """Its mass, or the sum of its forces, for a short text."""
        return f"{self.total_mass / 1e3:.2f} t"

    @property
    def _bodies_in_words(self) -> str:
        """How many bodies there are, if it is made of several."""
        return ""

    @property
    def _frequencies_in_words(self) -> list[str]:
        """Those on rigid ground: of both states, if friction makes two."""
        holding, sliding = (self.frequencies(locked=locked) for locked in (True, False))
        if len(holding) == 0:
            return []
        if np.array_equal(holding, sliding):
            return [f"{listed(holding, '.3f')} Hz"]
        return [
            f"{listed(holding, '.3f')} Hz while friction holds",
            f"{listed(sliding, '.3f')} Hz sliding",
        ]

    @property
    def _unsprung(self) -> list[float]:
        """Unsprung masses of the axles [kg], if there are any."""
        return []

    @property
    def coordinates(self) -> list[str]:
        """Names of the independent coordinates, such as ``body 1 heave`` and ``axle 3 hop``."""
        return self._core.coordinates

    def static_loads(self, gravity: float = GRAVITY) -> Array:
        """Static axle loads [N], front first, shape (axles,).

        Those of a train of forces are as given, whatever gravity is.
        """
        return self._core.static_loads(number("gravity", gravity))

    def frequencies(self, *, locked: bool = False) -> Array:
        """Natural frequencies on rigid ground [Hz], ascending: bounce, pitch, axle hop.

        There is one for each of `coordinates`; of a single axle there is no pitch, of a train none.

        Parameters
        ----------
        locked : bool, optional
            Whether friction holds, so that of a massless axle the tyre alone is a spring and
            elsewhere the stick acts beside the spring; or all slides (default), and springs act
            alone. Without friction both are the same.
        """
        return self._core.frequencies(flag("locked", locked))


def _rebuilt(kind: type[Wheels], arguments: dict[str, Any]) -> Wheels:
    return kind(**arguments)
