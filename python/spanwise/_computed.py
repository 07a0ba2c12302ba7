"""A crossing that has been computed, as it travels to other processes and archives."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._conditions import Conditions
from spanwise._core import __version__
from spanwise._value import frozen, same
from spanwise.bridge import Bridge
from spanwise.errors import InputError
from spanwise.roads import Road
from spanwise.traffic import Passage

Array: TypeAlias = NDArray[np.float64]

#: Conditions that histories depend on beside the states.
LOOKED = ("modes", "ratios", "matrix", "sections", "recovery")

#: What a crossing is made of again beside its states.
GIVEN = ("bridge", "passages", "_conditions", "_speed", "_road")


class Computed:
    """States and extremes, from which histories are worked out and kept.

    It travels as its states; the bridge is then analysed anew when histories are asked for.
    """

    def __init__(
        self,
        bridge: Bridge,
        passages: tuple[Passage, ...],
        conditions: Conditions,
        speed: float | None,
        road: Road,
        core: _core.Crossing,
    ) -> None:
        self.bridge, self.passages, self._speed, self._road = bridge, passages, speed, road
        # Where it was looked at, also if that was not asked for.
        self._conditions = replace(conditions, sections=core.sections.tolist())
        self._histories: dict[str, list[Array]] = {}
        # In place of what would be made of the states.
        self.__dict__["core"] = core

    @cached_property
    def core(self) -> _core.Crossing:
        """The crossing as the core has it."""
        return _core.Crossing.received(
            self.bridge._core,
            self.passages,
            self._conditions,
            self._state,
            speed=self._speed,
            road=self._road._core,
        )

    @cached_property
    def _state(self) -> bytes:
        return self.core.state

    def histories(self, name: str) -> list[Array]:
        """Dynamic and static responses of a kind at every instant, shape (time, place)."""
        if name not in self._histories:
            self._histories[name] = [frozen(values) for values in self.core.histories(name)]
        return self._histories[name]

    def __getstate__(self) -> dict[str, Any]:
        kept = {name: getattr(self, name) for name in (*GIVEN, "_state")}
        return {**kept, "version": __version__}

    def __setstate__(self, state: dict[str, Any]) -> None:
        made_by = state.pop("version")
        if made_by != __version__:
            raise InputError(
                "version",
                made_by,
                f"the run was kept by another version of spanwise than this, {__version__}; "
                "compute it again",
            )
        self.__dict__.update(state, _histories={})

    def __eq__(self, other: object) -> bool:
        if type(other) is not Computed:
            return NotImplemented
        states = same((self.bridge, self._state), (other.bridge, other._state))
        mine, others = self._conditions, other._conditions
        return states and all(same(getattr(mine, key), getattr(others, key)) for key in LOOKED)

    __hash__ = None  # type: ignore[assignment]
