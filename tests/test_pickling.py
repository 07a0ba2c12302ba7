"""Bridges and vehicles go to other processes, copies and archives."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import spanwise as sw


@pytest.fixture
def bridge() -> sw.Bridge:
    return sw.Bridge(
        length=30.0,
        supports=[(0.0, "clamped"), (20.0, "pinned")],
        EI=[2e9, 1e9],
        mass=5e3,
        stations_per_span=4,
        point_masses=[(25.0, 1e3)],
    )


def test_copies_are_the_same(bridge: sw.Bridge) -> None:
    vehicle = sw.vehicles.kishan_1973().with_initial_friction(1e4, -1e4)
    for again in (pickle.loads(pickle.dumps(bridge)), copy.deepcopy(bridge)):
        assert again.supports == bridge.supports
        np.testing.assert_array_equal(again.masses, bridge.masses)
        np.testing.assert_array_equal(again.modes(5).frequencies, bridge.modes(5).frequencies)
    assert pickle.loads(pickle.dumps(vehicle)) == vehicle
    for make in sw.vehicles.PRESETS.values():
        for same in (pickle.loads(pickle.dumps(make())), copy.deepcopy(make())):
            assert same == make()
            np.testing.assert_array_equal(same.static_loads(), make().static_loads())
    assert copy.deepcopy(vehicle) == vehicle


@pytest.mark.parametrize("name", sw.vehicles.PRESETS)
def test_copies_of_the_catalogue_are_the_same(name: str) -> None:
    vehicle = sw.vehicles.PRESETS[name]()
    for again in (pickle.loads(pickle.dumps(vehicle)), copy.deepcopy(vehicle)):
        assert again == vehicle
        np.testing.assert_array_equal(again.static_loads(), vehicle.static_loads())


def test_crossings_in_other_processes(bridge: sw.Bridge) -> None:
    vehicle = sw.vehicles.kishan_1973()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = pool.submit(sw.cross, bridge, vehicle, speed=20.0).result()
    here = sw.cross(bridge, vehicle, speed=20.0)
    assert there.envelope("moment") == here.envelope("moment")
