"""What is told of every sample beside its extremes: failures, accelerations, contact loss."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._value import Value

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Failure:
    """A sample that has no result; its rows are NaN.

    Attributes
    ----------
    sample : int
        Its number: `Ensemble.first` plus its row.
    row : int
        Its row, from 0.
    step : int or None
        The time step in which it failed, if it came so far.
    cause : str
        Why.
    """

    sample: int
    step: int | None
    cause: str
    row: int


@dataclass(frozen=True, eq=False, repr=False)
class BodyAccelerations(Value):
    """Vertical accelerations of the bodies of the first vehicle and those behind it.

    Attributes
    ----------
    max : ndarray, shape (sample, body)
        Largest magnitude until the last axle has left the bridge, on the approach too [m/s2].
    rms : ndarray, shape (sample, body)
        Root mean square from the vehicle's first axle on the bridge to its last off it [m/s2].
    """

    max: Array
    rms: Array


@dataclass(frozen=True, eq=False, repr=False)
class SampleContactLoss(Value):
    """How often and how long wheels were off the road, sample by sample.

    The longest time of a sample is ``ensemble.run(row).contact_loss.longest``.

    Attributes
    ----------
    count : ndarray of int, shape (sample, axle)
        How many times.
    total : ndarray, shape (sample, axle)
        How long in all [s].
    """

    count: NDArray[np.int64]
    total: Array
