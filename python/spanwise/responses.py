"""Responses of a bridge to a crossing, at every instant."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._computed import Computed
from spanwise.quantities import of_bridges, telling

Array: TypeAlias = NDArray[np.float64]


@telling
class Responses:
    """Responses at every instant, as arrays of shape (time, section), (time, support) and so on.

    Each is an attribute:

    {bridge}

    Of a shear there are ``shear_left`` and ``shear_right`` of the sections, and ``shear`` has both
    on a last axis. Deflections are down, moments sagging, shears sums of the upward forces to the
    left, reactions up; clamp moments are those of `Bridge.clamps`.

    They are computed from the states of the crossing when first asked for, kept, and not to be
    written to: copy them first. They are known at the steps; the extremes of `Run.envelope` are
    taken between them too, as axles pass a section, and can be a little larger.
    """

    def __init__(self, computed: Computed, *, static: bool = False) -> None:
        self._computed, self._static = computed, static

    def __getattr__(self, name: str) -> Array:
        for each in of_bridges():
            if name in each.parts:
                return self._computed.histories(name)[int(self._static)]
            if name == each.name:
                return np.stack([getattr(self, part) for part in each.parts], axis=-1)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        names = (name for each in of_bridges() for name in (each.name, *each.parts))
        return sorted({*super().__dir__(), *names})

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        assert isinstance(other, Responses)
        return (self._computed, self._static) == (other._computed, other._static)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        core = self._computed.core
        return f"Responses({len(core.sections)} sections, {core.steps + 1} instants)"
