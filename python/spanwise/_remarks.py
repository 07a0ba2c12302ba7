"""What a run should not leave unsaid: a drive that does other than it seems to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from spanwise.traffic import Acceleration, Braking, Drive, Passage, Speeds, drive_of
from spanwise.vehicle import Vehicle

if TYPE_CHECKING:
    from spanwise.runs import Run


def remarks(run: Run) -> list[str]:
    """Of all vehicles, by number where there are several."""
    return [
        said if len(run.passages) == 1 else f"vehicles[{k}]: {said}"
        for k in range(len(run.passages))
        for said in _remarks(run, k)
    ]


def _remarks(run: Run, vehicle: int) -> list[str]:
    """Of a vehicle, counted from 0."""
    passage = run.passages[vehicle]
    drive = drive_of(run.settings["drive"]) if passage.drive is None else passage.drive
    found = []
    if _is_level(passage, drive):
        found.append("centres of mass at road level: no load transfer from braking or accelerating")
    if isinstance(drive, Braking) and not _comes_to(run, vehicle, drive.start):
        found.append(
            f"the brakes never come on: its front axle never comes to start = {drive.start:g} m"
        )
    if run.stopped[vehicle] is not None and not _comes_to(run, vehicle, 0.0):
        found.append("stops before it reaches the bridge")
    return found


def _comes_to(run: Run, vehicle: int, way: float) -> bool:
    """Whether the front axle does, from the end of the bridge at which the vehicle enters [m].

    Before the tail, that is: what it does behind the bridge makes no difference.
    """
    before = run.time <= run.time[-1] - run.tail + run._core.step
    x = run.vehicles[vehicle].axle_positions[before, 0]
    if run.passages[vehicle].direction == "right":
        return bool(x.max() >= way)
    return bool(run.bridge.length - x.min() >= way)


def _is_level(passage: Passage, drive: Drive) -> bool:
    """Whether a vehicle that could dip or squat has all its heights at the road."""
    changes = (
        isinstance(drive, Braking)
        or (isinstance(drive, Acceleration) and drive.acceleration != 0.0)
        or (isinstance(drive, Speeds) and len({*drive.speeds}) > 1)
    )
    truck = passage.vehicle
    # The load of a single axle has nowhere to go.
    if not changes or not isinstance(truck, Vehicle) or len(truck.axles) < 2:
        return False
    hinges = [body.hinge for body in truck.parts if body.hinge is not None]
    heights = [*(body.cg_height for body in truck.parts), *(hinge.height for hinge in hinges)]
    return not any(heights)
