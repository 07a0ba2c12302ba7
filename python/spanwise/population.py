"""What an ensemble of crossings gives: extremes, impact factors and failures of every sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import choice, file_path, is_list, items, shown, whole
from spanwise._conditions import masked
from spanwise._recipe import Recipe
from spanwise.bridge import Bridge
from spanwise.columns import Array, Moments, SampleExtremes, Sense, frozen
from spanwise.run import Run

if TYPE_CHECKING:
    from spanwise import _core
    from spanwise.plotting import EnsemblePlot

Quantity: TypeAlias = Literal["deflection", "moment", "shear", "reactions", "clamp_moments"]
Factor: TypeAlias = Literal["deflection", "sagging", "hogging", "shear", "reactions", "axle_loads"]
History: TypeAlias = Literal[
    "deflection", "moment", "shear_left", "shear_right", "reactions", "clamp_moments", "axle_loads"
]

#: Quantity and sense of every impact factor, as for a single crossing.
FACTORS: dict[Factor, tuple[str, Sense]] = {
    "deflection": ("deflection", "positive"),
    "sagging": ("moment", "positive"),
    "hogging": ("moment", "negative"),
    "shear": ("shear", "either"),
    "reactions": ("reactions", "either"),
    "axle_loads": ("axle_loads", "positive"),
}

#: What static axle loads depend on: masses, and springs that share them out.
SHARED_OUT = ("body_mass", "tyre_stiffness", "suspension_stiffness")

#: Most memory that the histories of some samples may take [bytes].
MOST_BYTES = 4 * 2**30


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


@dataclass(frozen=True, eq=False)
class BodyAccelerations:
    """Vertical accelerations of the bodies of the first vehicle and those behind it.

    Attributes
    ----------
    max : ndarray, shape (sample, body)
        Largest magnitude over the whole crossing [m/s2].
    rms : ndarray, shape (sample, body)
        Root mean square from the first axle on the bridge to the last off it [m/s2].
    """

    max: Array
    rms: Array


class Ensemble:
    """The result of many crossings of one bridge, one row for each sample.

    Attributes
    ----------
    bridge : Bridge
        The bridge.
    samples : int
        How many.
    first, seed : int
        Number of the first sample, and the seed: with its number they make a sample what it is.
    speed : float or ndarray or None
        Speeds as given, or as passages have their own [m/s].
    settings : dict
        Keyword arguments of `ensemble` that compute it again, defaults filled in.
    sections : ndarray, shape (section,)
        Where responses are looked at [m].
    supports : ndarray, shape (support,)
        Positions of the supports [m].
    frequencies : ndarray, shape (mode,)
        Natural frequencies of the included modes of the bridge as given [Hz]: no factor on its
        stiffness is in them.
    quantities : tuple of str
        What was looked at.
    failures : tuple of Failure
        Samples without a result.
    digests : ndarray of uint64, shape (sample,)
        Fingerprint of all numbers of each sample.
    hash : str
        Fingerprint of the whole, 16 hexadecimal digits: the same for the same ensemble on every
        machine, whatever its instruction set and however many threads.
    isa : str
        Instruction set used.
    threads : int
        Threads used.
    elapsed : float
        Time that it took [s].
    shares_geometry : bool
        Whether the samples were marched side by side; if not, each was a crossing of its own, which
        takes about ten times as long.
    """

    def __init__(
        self, bridge: Bridge, recipe: Recipe, quantities: Sequence[Quantity], core: _core.Ensemble
    ) -> None:
        self._recipe, self._core = recipe, core
        self.bridge = bridge
        self.quantities = tuple(quantities)
        self.samples, self.first, self.seed = recipe.samples, recipe.first, recipe.seed
        self.speed = recipe.speeds.given
        self.sections: Array = frozen(core.sections)
        self.frequencies: Array = frozen(core.omega / (2.0 * np.pi))
        self.supports: Array = frozen(np.array([x for x, _ in bridge.supports]))
        self.failures = tuple(
            Failure(self.first + row, step, cause, row) for row, step, cause in core.failures
        )
        self._numbers: Array = frozen(core.numbers)
        self._instants: NDArray[np.uint32] = core.instants
        self._instants.setflags(write=False)
        self.digests: NDArray[np.uint64] = core.digests
        self.digests.setflags(write=False)
        self.hash = f"{core.hash:016x}"
        self.isa, self.threads, self.elapsed = core.isa, core.threads, core.elapsed
        self.shares_geometry = core.shares

    @property
    def rate(self) -> float:
        """Crossings per second."""
        return self.samples / self.elapsed

    @property
    def settings(self) -> dict[str, Any]:
        """Keyword arguments of `ensemble` that compute it again, defaults filled in."""
        return self._recipe.settings

    @cached_property
    def _starts(self) -> dict[str, tuple[int, int]]:
        """The first response of every kind among all, and how many there are."""
        found, start = {}, 0
        for name in _cores(self.quantities):
            width = self._core.width(name)
            found[name] = (start, width)
            start += width
        found[""] = (start, 0)
        return found

    def _extremes(self, name: str) -> SampleExtremes:
        """Of one kind of response."""
        if name not in self._starts:
            raise AttributeError(f"{name}: {self._not_looked_at}")
        start, width = self._starts[name]
        all_ = self._starts[""][0]
        x = {"reactions": self.supports, "clamp_moments": self.bridge.clamps}
        low, high = self._core.columns("statics")
        statics = self._numbers[:, low:high]
        if high == low:
            statics = self._core.at_rest
            # In their own steps, which are halved for some.
            statics = statics[0] if len(statics) == 1 else statics[self._core.marches]
        largest, smallest = slice(start, start + width), slice(all_ + start, all_ + start + width)
        return SampleExtremes(
            x.get(name, self.sections),
            self._numbers[:, largest],
            self._numbers[:, smallest],
            frozen(statics[..., largest]),
            frozen(statics[..., smallest]),
            lambda of_largest: self._moments(start if of_largest else all_ + start, width),
        )

    @property
    def _not_looked_at(self) -> str:
        have = ", ".join(self.quantities)
        return f"was not looked at; this ensemble has {have} (give quantities)"

    def _moments(self, start: int, width: int) -> Moments:
        """Times and positions of some of the extremes, counted through responses and loads."""
        if self._core.own_times:
            time, position = (
                self._numbers[:, at + start : at + start + width]
                for at, _ in map(self._core.columns, ("times", "positions"))
            )
            return time, position
        time, position = self._core.when(self._instants[:, start : start + width])
        missing = np.isnan(self._extreme_values[:, start : start + width])
        time[missing] = position[missing] = np.nan
        return time, position

    @property
    def _extreme_values(self) -> Array:
        """Extremes of responses and loads in the order of their instants."""
        return self._numbers[:, : self._core.columns("axle_loads")[1]]

    @cached_property
    def deflection(self) -> SampleExtremes:
        """Deflections down [m].

        A `SampleExtremes` as `moment` is, of shape (samples, sections).
        """
        return self._extremes("deflection")

    @cached_property
    def moment(self) -> SampleExtremes:
        """Bending moments, sagging positive [N m].

        A `SampleExtremes`: ``.max`` and ``.min`` with their ``_time`` [s] and ``_position`` [m]
        (``.max_time``, ``.max_position``, ...), all of shape (samples, sections), and
        ``.static_max``, ``.static_min``, of shape (sections,) where all samples share them.
        """
        return self._extremes("moment")

    @cached_property
    def shear_left(self) -> SampleExtremes:
        """Shear just left of the sections [N].

        A `SampleExtremes` as `moment` is, of shape (samples, sections).
        """
        return self._extremes("shear_left")

    @cached_property
    def shear_right(self) -> SampleExtremes:
        """Shear just right of the sections [N].

        A `SampleExtremes` as `moment` is, of shape (samples, sections).
        """
        return self._extremes("shear_right")

    @cached_property
    def shear(self) -> SampleExtremes:
        """Shear on both sides of the sections together [N].

        A `SampleExtremes` as `moment` is, of shape (samples, sections).
        """
        return self.shear_left.merged(self.shear_right)

    @cached_property
    def reactions(self) -> SampleExtremes:
        """Support reactions, up [N].

        A `SampleExtremes` as `moment` is, of shape (samples, supports).
        """
        return self._extremes("reactions")

    @cached_property
    def clamp_moments(self) -> SampleExtremes:
        """Moments of the supports of `Bridge.clamps` [N m].

        A `SampleExtremes` as `moment` is, of shape (samples, clamps).
        """
        return self._extremes("clamp_moments")

    @cached_property
    def axle_loads(self) -> SampleExtremes:
        """Axle loads [N], over the whole crossing, of all vehicles in their order.

        A `SampleExtremes` as `moment` is, of shape (samples, axles). The approach counts too.
        """
        start, end = self._core.columns("axle_loads")
        axles = (end - start) // 2
        return SampleExtremes(
            np.arange(1.0, axles + 1.0),
            self._numbers[:, start : start + axles],
            self._numbers[:, start + axles : end],
            self.static_axle_loads,
            self.static_axle_loads,
            lambda largest: self._moments(start if largest else start + axles, axles),
        )

    @cached_property
    def static_axle_loads(self) -> Array:
        """Static axle loads [N], shape (axle,), or (sample, axle) where samples differ in them."""
        loads = self._core.static_loads()
        varied = len(self._recipe.events) > 1 or any(
            each.name in SHARED_OUT for each in self._recipe.factors
        )
        return frozen(loads if varied else loads[0])

    def _block(self, name: str) -> Array:
        start, end = self._core.columns(name)
        return self._numbers[:, start:end]

    @property
    def load_coefficients(self) -> Array:
        """How much the axle loads vary about their static values [-], shape (sample, axle).

        The root mean square of P - P_st by P_st, over the steps from the first with an axle on the
        bridge to that with which the last axle leaves it: `Run.load_coefficients`, bit for bit.
        """
        return self._block("load_coefficients")

    @property
    def time_off_road(self) -> Array:
        """How long each wheel was off the road in all [s], shape (sample, axle)."""
        return self._block("time_off_road")

    @property
    def lift_offs(self) -> NDArray[np.int64]:
        """How often each wheel left the road, shape (sample, axle)."""
        axles = self.load_coefficients.shape[1]
        return self._instants[:, self._instants.shape[1] - axles :].astype(np.int64)

    @property
    def body_accelerations(self) -> BodyAccelerations:
        """Vertical accelerations of the bodies, by sample and body [m/s2]."""
        return BodyAccelerations(self._block("accelerations"), self._block("vibrations"))

    def impact_factors(self, quantity: Factor, mask: float | None = None) -> Array:
        """Impact factors of every sample: dynamic extreme by static extreme.

        Parameters
        ----------
        quantity : {"deflection", "sagging", "hogging", "shear", "reactions", "axle_loads"}
            Of what, as in `Run.impact_factors`.
        mask : float, optional
            Give none where the static value is at most this fraction of the largest along the
            bridge; by default as the ensemble was told.

        Returns
        -------
        ndarray, shape (sample, section)
            One column for each section, support or axle; NaN where masked, and of samples that
            failed.

        Raises
        ------
        ValueError
            If there are no such factors.
        """
        choice("quantity", quantity, FACTORS)
        name, sense = FACTORS[quantity]
        least = self._recipe.conditions.mask if mask is None else masked(mask)
        if name not in (*self.quantities, "axle_loads"):
            what = "" if name == quantity else f"{name} "
            raise ValueError(f'quantity = "{quantity}": {what}{self._not_looked_at}')
        extremes: SampleExtremes = getattr(self, name)
        return extremes.factors(sense, least)

    def run(self, sample: int) -> Run:
        """A sample by a crossing of its own, with all histories.

        Parameters
        ----------
        sample : int
            Its row, from 0; its number less `first`.

        Returns
        -------
        Run
            The same extremes, bit for bit; to rounding where the stiffness or the damping of the
            bridge is varied, which is then another bridge.

        Raises
        ------
        IndexError
            If there is no such sample.
        ValueError
            If the stiffness varies of a bridge given by its flexibility or its modes.
        RuntimeError
            If the sample is one that failed.
        """
        row = self._row("sample", sample)
        for each in self.failures:
            if each.row == row:
                step = "" if each.step is None else f" in step {each.step}"
                raise RuntimeError(
                    f"row {row}: sample number {each.sample} failed{step}: {each.cause}"
                )
        return self._recipe.run(row, self._core)

    def _row(self, key: str, given: object) -> int:
        """A row that there is."""
        row = whole(key, given)
        if 0 <= row < self.samples:
            return row
        of_number = row - self.first
        there = 0 <= of_number < self.samples
        hint = f" (sample number {row} is row {of_number})" if there else ""
        raise IndexError(f"row {shown(row)}: must be from 0 to below {self.samples}{hint}")

    def histories(self, quantity: History, samples: int | Sequence[int]) -> Array:
        """Histories of a response, by a crossing of its own for each of some samples.

        Parameters
        ----------
        quantity : str
            ``"deflection"``, ``"moment"``, ``"shear_left"``, ``"shear_right"``, ``"reactions"``,
            ``"clamp_moments"`` or ``"axle_loads"``.
        samples : int or sequence of int
            Their rows, from 0, or the row of one.

        Returns
        -------
        ndarray, shape (samples, time, section)
            Values in SI units; times are `Run.time` of `run`.

        Raises
        ------
        IndexError
            If there is no such sample.
        ValueError
            If they differ in their number of instants, or would take too much memory.
        RuntimeError
            If one of them is one that failed.
        """
        choice("quantity", quantity, get_args(History))
        if is_list(samples):
            rows = [
                self._row(f"samples[{i}]", each) for i, each in enumerate(items("samples", samples))
            ]
        elif isinstance(samples, Integral):
            rows = [self._row("samples", samples)]
        else:
            raise ValueError(f"samples = {shown(samples)}: must be a row or a list of rows")
        found: Array | None = None
        for i, row in enumerate(rows):
            values: Array = getattr(self.run(row), quantity)
            if found is None:
                size = len(rows) * values.nbytes
                if size > MOST_BYTES:
                    raise ValueError(
                        f"samples = {len(rows)} samples: their histories would take "
                        f"{size / 1e9:.1f} GB, more than {MOST_BYTES / 1e9:.1f}; ask for fewer"
                    )
                found = np.empty((len(rows), *values.shape))
            if values.shape != found.shape[1:]:
                raise ValueError(
                    f"samples[{i}] = {row}: has {len(values)} instants, not {found.shape[1]} as "
                    "those before it; ask for samples of different speeds or steps by themselves"
                )
            found[i] = values
        return np.empty((0, 0, 0)) if found is None else found

    def summary(self) -> str:
        """What crossed what, percentiles of extremes and impact factors, and failures, as text.

        Impact factors are those of one section, where the static value is largest; of sections
        alike in that, as on a symmetric bridge, the one with the larger dynamic value (medians).
        Then of each sample the largest dynamic value anywhere by the largest static one anywhere.
        """
        from spanwise._ensemblesummary import summary

        return summary(self)

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.summary())}</pre>"

    def __repr__(self) -> str:
        failed = f", {len(self.failures)} failed" if self.failures else ""
        return (
            f"Ensemble({_many(self.samples, 'sample')} from {self.first} of seed "
            f"{self.seed}{failed}, {_many(len(self.sections), 'section')}, "
            f"{', '.join(self.quantities)}; hash {self.hash})"
        )

    def to_npz(self, path: str | Path) -> None:
        """Write all extremes, fingerprints and the settings to a NumPy archive.

        Names are those of the attributes, such as ``moment_max`` and ``axle_loads_min_time``;
        ``settings`` is JSON text. Read it with ``numpy.load(path)``.

        Raises
        ------
        OSError
            If the file cannot be written; none is left then.
        """
        from spanwise._ensemblefile import write_npz

        write_npz(self, file_path("path", path))

    @property
    def plot(self) -> EnsemblePlot:
        """Figures of the ensemble; needs the extra ``spanwise[plot]``."""
        from spanwise.plotting import EnsemblePlot

        return EnsemblePlot(self)


def _many(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _cores(quantities: Sequence[str]) -> list[str]:
    """The kinds of response that the core knows for these quantities."""
    return [
        name
        for each in quantities
        for name in (("shear_left", "shear_right") if each == "shear" else (each,))
    ]
