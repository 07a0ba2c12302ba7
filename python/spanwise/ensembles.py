"""What an ensemble of crossings gives: extremes of every sample, and what is made of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import file_path, is_list, items, shown, whole
from spanwise._conditions import masked
from spanwise._door import view
from spanwise._plan import Plan
from spanwise._plan_of_arguments import usual_quantities
from spanwise._plausible import doubts_of_roads
from spanwise._renamed import Renamed, renamed
from spanwise._rows import Rows
from spanwise._shown import many
from spanwise._value import frozen
from spanwise.errors import InputError, refused
from spanwise.extremes import Array, SampleExtremes, When, governing
from spanwise.impact_factors import ByName
from spanwise.quantities import RESPONSES, Axis, Response, asked, factors, parts, telling
from spanwise.runs import Run
from spanwise.samples import BodyAccelerations, Failure, SampleContactLoss

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from spanwise.plotting import EnsemblePlot

By: TypeAlias = Literal["sample", "section", "support", "clamp", "axle"]

#: Most memory that the histories of some samples may take [bytes].
MOST_BYTES = 4 * 2**30


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
        Threads at most.
    elapsed : float
        Time that it took [s].
    shares_geometry : bool
        Whether the samples shared where their axles stand; if not, each went its own way, which
        takes a few times as long.
    """

    def __init__(self, plan: Plan, rows: Rows) -> None:
        self._plan, self._rows = plan, rows
        self.bridge, self.quantities = plan.bridge, plan.quantities
        self.samples, self.first, self.seed = plan.samples, plan.first, plan.seed
        self.speed = plan.speeds.given
        self.sections: Array = rows.sections
        self.frequencies: Array = frozen(rows.omega / (2.0 * np.pi))
        self.supports: Array = frozen(np.array([x for x, _ in self.bridge.supports]))
        self.failures = tuple(
            Failure(self.first + row, step, cause, row) for row, step, cause in rows.failures
        )
        self.digests: NDArray[np.uint64] = rows.digests
        self.hash = rows.hash
        self.isa, self.threads, self.elapsed = rows.isa, rows.threads, rows.elapsed
        self.shares_geometry = rows.shares

    def __reduce__(self) -> tuple[object, ...]:
        """Pickled as its plan and its rows."""
        return Ensemble, (self._plan, self._rows)

    def __eq__(self, other: object) -> bool:
        """Whether the same was asked, to the same results, bit for bit; not how fast, and where."""
        if type(other) is not Ensemble:
            return NotImplemented
        return self._plan == other._plan and self._rows == other._rows

    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def read(cls, path: str | Path) -> Ensemble:
        """What `to_npz` wrote, whole: `run` and `==` included.

        Parameters
        ----------
        path : str or Path
            The archive.

        Raises
        ------
        OSError
            If there is no such file, or it cannot be read.
        ValueError
            If it is not an archive of an ensemble, or a value in it is not allowed.
        """
        return view("_ensemble_files.read_npz")(file_path("path", path))

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """All that was warned of in these crossings and their measured roads, but damping."""
        plan = self._plan
        return (*doubts_of_roads(plan.roads), *plan.idle(), *plan.doubts())

    @property
    def rate(self) -> float:
        """Crossings per second."""
        return self.samples / self.elapsed

    @property
    def settings(self) -> dict[str, Any]:
        """Keyword arguments of `ensemble` that compute it again, defaults filled in."""
        return self._plan.settings

    @property
    def responses(self) -> list[Response]:
        """What was looked at, and axle loads."""
        return [each for each in RESPONSES.values() if self._looks_at(each)]

    def _looks_at(self, of: Response) -> bool:
        return of.axis == "axle" or of.name in self.quantities

    def places(self, axis: Axis) -> Array:
        """Positions of the sections, supports or clamps [m], or numbers of the axles from 1."""
        return {
            "section": self.sections,
            "support": self.supports,
            "clamp": self.bridge.clamps,
            "axle": np.arange(1.0, self._rows.axles + 1.0),
        }[axis]

    def _extremes(self, name: str) -> SampleExtremes:
        """Of one part of a response, or of the axle loads."""
        rows, of = self._rows, parts()[name]
        if of.axis == "axle":
            largest, width = rows.columns[name][0], rows.axles
            smallest = largest + width
            statics = self.static_axle_loads, self.static_axle_loads
        else:
            largest, width = rows.place(name)
            smallest = largest + rows.responses
            statics = rows.frozen_statics(largest, width), rows.frozen_statics(smallest, width)
        return SampleExtremes(
            self.places(of.axis),
            rows.numbers[:, largest : largest + width],
            rows.numbers[:, smallest : smallest + width],
            *statics,
            lambda: self._when(largest, width),
            lambda: self._when(smallest, width),
        )

    @property
    def _not_looked_at(self) -> str:
        have = ", ".join(self.quantities)
        return f"was not looked at; this ensemble has {have} (give quantities)"

    def _when(self, start: int, width: int) -> When:
        """Times and positions of some of the extremes, counted through responses and loads."""
        return self._rows.when(start, width, self._plan.front_speeds)

    @cached_property
    def _envelopes(self) -> dict[str, SampleExtremes]:
        """Those that have been asked for."""
        return {}

    @telling
    def envelope(self, quantity: str) -> SampleExtremes:
        """Extremes of a response in every sample, as `Run.envelope` has them of one crossing.

        Parameters
        ----------
        quantity : str
            The response, signed as in `Run`; shears on both sides of the sections together, or on
            one; axle loads until the last axle has left the bridge, the approach too, of all
            vehicles in order:

            {parts}

        Returns
        -------
        SampleExtremes
            ``.max`` and ``.min`` with their ``_time`` [s] and ``_position`` [m] (``.max_time``,
            ``.max_position``, ...), all of shape (samples, sections), and ``.static_max``,
            ``.static_min``, of shape (sections,) where all samples share them. Supports, clamps or
            axles stand in the place of sections where they have the quantity. ``.max`` and
            ``.max_time`` are arrays here, where a run has ``.max.value`` and ``.max.time``.

        Raises
        ------
        ValueError
            If there is no such quantity, or it was not looked at.
        """
        name = asked("quantity", quantity, parts(whole=True))
        of = parts(whole=True)[name]
        if not self._looks_at(of):
            raise InputError("quantity", f'"{name}"', self._not_looked_at)
        if name not in self._envelopes:
            if of.sided and name == of.name:
                left, right = map(self.envelope, of.parts)
                self._envelopes[name] = left.merged(right)
            else:
                self._envelopes[name] = self._extremes(name)
        return self._envelopes[name]

    def __getattr__(self, name: str) -> Any:
        """Attributes that have other names now; those of `Run` alike are histories."""
        of = parts(whole=True).get(name)
        if of is not None and not of.usual:
            hint = f"its extremes are envelope({of.name!r})"
            raise AttributeError(f"'Ensemble' object has no attribute {name!r}: {hint}")
        if of is not None:
            renamed(f"Ensemble.{name}", f'Ensemble.envelope("{name}")')
            if not self._looks_at(of):
                raise AttributeError(f"{name}: {self._not_looked_at}")
            return self.envelope(name)
        if name in ("lift_offs", "time_off_road"):
            new = "count" if name == "lift_offs" else "total"
            renamed(f"Ensemble.{name}", f"Ensemble.contact_loss.{new}")
            return getattr(self.contact_loss, new)
        raise AttributeError(f"'Ensemble' object has no attribute {name!r}")

    @cached_property
    def static_axle_loads(self) -> Array:
        """Static axle loads [N], shape (axle,), or (sample, axle) where samples differ in them."""
        return frozen(self._plan.static_loads())

    @property
    def tail(self) -> Array:
        """Free vibration kept after the last axle had left, or stood [s], shape (sample,)."""
        return self._rows.block("tail")[:, 0]

    @property
    def growth(self) -> Array:
        """How far at most free vibration after the end can exceed an extreme, shape (sample,).

        As `Run.growth`: in parts of the largest of its kind along the bridge, of the extreme that
        can grow most. Zero where none can by more than a hundredth of itself and a thousandth of
        the largest; NaN where a vehicle stands on the bridge, and of samples that failed.
        """
        return self._rows.block("growth")[:, 0]

    def _growing(self, row: int) -> str:
        """The extreme of a sample that can grow most, in words."""
        place, smallest = divmod(int(self._rows.block("growing")[row, 0]), 2)
        for name in self._rows.widths:
            start, width = self._rows.place(name)
            if place < start + width:
                break
        x = self.places(parts()[name].axis)[place - start]
        side = "smallest" if smallest else "largest"
        return f"{side} {name.replace('_', ' ')} at x = {x:.3f} m"

    off_road = Renamed("contact_loss")
    load_coefficients = Renamed("dynamic_load_coefficients")

    @property
    def dynamic_load_coefficients(self) -> Array:
        """How much the axle loads vary about their static values [-], shape (sample, axle).

        The root mean square of P - P_st by P_st, over the steps from the first with an axle of the
        same vehicle on the bridge to that with which the last of them leaves it:
        `Run.dynamic_load_coefficients`, bit for bit.
        """
        return self._rows.block("load_coefficients")

    @property
    def contact_loss(self) -> SampleContactLoss:
        """How often and how long the wheels were off the road, by sample and axle."""
        instants, total = self._rows.instants, self._rows.block("time_off_road")
        count = instants[:, instants.shape[1] - total.shape[1] :].astype(np.int64)
        return SampleContactLoss(count, total)

    @property
    def body_accelerations(self) -> BodyAccelerations:
        """Vertical accelerations of the bodies, by sample and body [m/s2]."""
        return BodyAccelerations(self._rows.block("accelerations"), self._rows.block("vibrations"))

    @cached_property
    def impact_factors(self) -> SampleFactors:
        """Impact factors of every sample: dynamic extreme by static extreme.

        As `Run.impact_factors`, with one row for each sample: ``impact_factors.sagging`` is of
        shape (sample, section).
        """
        return self.ratios()

    def ratios(self, mask: float | None = None) -> SampleFactors:
        """Impact factors with another mask.

        Parameters
        ----------
        mask : float, optional
            Give none where the static value is at most this fraction of the largest along the
            bridge; by default as the ensemble was told.

        Returns
        -------
        SampleFactors
            NaN where masked, and of samples that failed.
        """
        least = self._plan.conditions.mask if mask is None else masked(mask)
        return SampleFactors(self, least)

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
        return self._run(self._row("sample", sample), None)

    def _run(self, row: int, tail: float | None) -> Run:
        """The sample of a row, with a tail so long if that of the ensemble was not given."""
        for each in self.failures:
            if each.row == row:
                step = "" if each.step is None else f" in step {each.step}"
                raise RuntimeError(
                    f"row {row}: sample number {each.sample} failed{step}: {each.cause}"
                )
        if tail is None and list(self.quantities) != usual_quantities(self.bridge):
            # As long as it was for what was looked at.
            tail = float(self.tail[row])
        return self._plan.run(row, self._rows, tail)

    def _row(self, key: str, given: object) -> int:
        """A row that there is."""
        row = whole(key, given)
        if 0 <= row < self.samples:
            return row
        of_number = row - self.first
        there = 0 <= of_number < self.samples
        hint = f" (sample number {row} is row {of_number})" if there else ""
        raise IndexError(f"row {shown(row)}: must be from 0 to below {self.samples}{hint}")

    def histories(self, quantity: str, samples: int | Sequence[int]) -> Array:
        """Histories of a response, by a crossing of its own for each of some samples.

        Parameters
        ----------
        quantity : str
            The response, as for `envelope`, of shears one side.
        samples : int or sequence of int
            Their rows, from 0, or the row of one.

        Returns
        -------
        ndarray, shape (samples, time, section)
            Values in SI units; times are `Run.time` of `run`. Where tails were not given, all are
            as long as the longest of them.

        Raises
        ------
        IndexError
            If there is no such sample.
        ValueError
            If they differ in their number of instants, or would take too much memory.
        RuntimeError
            If one of them is one that failed.
        """
        quantity = asked("quantity", quantity, parts())
        if is_list(samples):
            rows = [
                self._row(f"samples[{i}]", each) for i, each in enumerate(items("samples", samples))
            ]
        elif isinstance(samples, Integral):
            rows = [self._row("samples", samples)]
        else:
            raise refused("samples", samples, "must be a row or a list of rows")
        found: Array | None = None
        tail = max((float(self.tail[row]) for row in rows), default=0.0)
        for i, row in enumerate(rows):
            values: Array = getattr(self._run(row, tail), quantity)
            if found is None:
                size = len(rows) * values.nbytes
                if size > MOST_BYTES:
                    raise InputError(
                        "samples",
                        f"{len(rows)} samples",
                        f"their histories would take {size / 1e9:.1f} GB, more than "
                        f"{MOST_BYTES / 1e9:.1f}; ask for fewer",
                    )
                found = np.empty((len(rows), *values.shape))
            if values.shape != found.shape[1:]:
                raise InputError(
                    f"samples[{i}]",
                    row,
                    f"has {len(values)} instants, not {found.shape[1]} as those before it; ask "
                    "for samples of different speeds or steps by themselves",
                )
            found[i] = values
        return np.empty((0, 0, 0)) if found is None else found

    def summary(self) -> str:
        """What crossed what, percentiles of extremes and impact factors, and failures, as text.

        Impact factors are those of one section, where the static value is largest; of sections
        alike in that, as on a symmetric bridge, the one with the larger dynamic value (medians).
        Then of each sample the largest dynamic value anywhere by the largest static one anywhere.
        """
        return view("_ensemble_summary.summary")(self)

    def _repr_html_(self) -> str:
        return view("_ensemble_summary.page")(self)

    def __repr__(self) -> str:
        failed = f", {len(self.failures)} failed" if self.failures else ""
        return (
            f"Ensemble({many(self.samples, 'sample')} from {self.first} of seed "
            f"{self.seed}{failed}, {many(len(self.sections), 'section')}, "
            f"{', '.join(self.quantities)}; hash {self.hash})"
        )

    def to_npz(self, path: str | Path) -> None:
        """Write all extremes, fingerprints and the settings to a NumPy archive.

        The file has the name that is given, with ``.npz`` or without. Names in it are those of the
        attributes, such as ``moment_max`` and ``axle_loads_min_time``; ``settings`` is JSON text.
        Read it with `read`, or with ``numpy.load(path)``.

        Raises
        ------
        OSError
            If the file cannot be written; none is left then.
        """
        view("_ensemble_files.write_npz")(self, file_path("path", path))

    def to_pandas(self, by: By = "sample") -> pd.DataFrame:
        """A frame with one row for each sample; needs the extra ``spanwise[pandas]``.

        Parameters
        ----------
        by : {"sample", "section", "support", "clamp", "axle"}, optional
            One row for each sample (default), or for each sample and section, support, clamp or
            axle.

        Returns
        -------
        DataFrame
            Rows are named by the numbers of the samples. By sample: ``kind`` where there are
            several, ``speed`` [m/s] and factors (one column each, or one for each part, from 1),
            ``failed``, the largest and the smallest value of each quantity along the bridge,
            ``impact_factor_...`` at the section where the static value is largest (where that is
            stands in ``attrs["governing"]`` [m]), and by axle and body the load coefficients, lift
            offs, times off the road and accelerations. Else the extremes of the quantities that
            have such places, with their times and positions, the static ones, and the impact
            factors there. Of samples that failed, numbers are NaN.

        Raises
        ------
        ValueError
            If there are no such places, or what is there was not looked at.
        ImportError
            If pandas is missing, naming the extra that brings it.
        """
        return view("_ensemble_tables.frame")(self, by)

    def to_parquet(self, path: str | Path, by: By = "sample") -> None:
        """Write `to_pandas` to a Parquet file of this name; needs the extra ``spanwise[parquet]``.

        Raises
        ------
        OSError
            If the file cannot be written; then there is none, or the old one.
        """
        view("_ensemble_tables.write_parquet")(self, file_path("path", path), by)

    def to_csv(self, path: str | Path, by: By = "sample") -> None:
        """Write `to_pandas` with all digits to a CSV file of this name; needs ``spanwise[pandas]``.

        Raises
        ------
        OSError
            If the file cannot be written; then there is none, or the old one.
        """
        view("_ensemble_tables.write_csv")(self, file_path("path", path), by)

    @property
    def plot(self) -> EnsemblePlot:
        """Figures of the ensemble; needs the extra ``spanwise[plot]``."""
        return view("plotting.EnsemblePlot")(self)


@telling
class SampleFactors(ByName):
    """Impact factors of every sample, as `ImpactFactors` has them of one crossing.

    Each kind is an attribute, an array of shape (sample, section), (sample, support) or
    (sample, axle); NaN where masked, and of samples that failed:

    {factors}

    They are worked out when asked for.

    Attributes
    ----------
    sections, supports : ndarray
        Positions [m].
    mask : float
        Factors are NaN where the static value is at most this fraction of the largest of its kind.
    ratio : str
        ``"extremes"``: dynamic by static extreme, which may occur at different times.

    Raises
    ------
    ValueError
        If a response was not looked at.
    """

    ratio: Final = "extremes"

    def __init__(self, ensemble: Ensemble, mask: float) -> None:
        self._ensemble, self.mask = ensemble, mask
        self.sections, self.supports = ensemble.sections, ensemble.supports

    @property
    def names(self) -> list[str]:
        """Kinds of factors there are of what was looked at."""
        return [name for name, (of, _) in factors().items() if self._ensemble._looks_at(of)]

    def governing(self, name: str) -> int:
        """Number of the section, support or axle where the static value is largest.

        Of those alike, of the one with the larger dynamic value, by their medians.
        """
        of, factor = factors()[name]
        return governing(*self._ensemble.envelope(of.name).of(factor.sense))

    def _of(self, name: str) -> Array:
        of, factor = factors()[name]
        if not self._ensemble._looks_at(of):
            what = "" if of.name == name else f"{of.name} "
            raise InputError("quantity", f'"{name}"', f"{what}{self._ensemble._not_looked_at}")
        return self._ensemble.envelope(of.name).factors(factor.sense, self.mask)

    def __call__(self, quantity: str, mask: float | None = None) -> Array:
        """As it was before: a method of the ensemble."""
        found = (self if mask is None else self._ensemble.ratios(mask))[quantity]
        new = "impact_factors" if mask is None else f"ratios(mask={mask})"
        renamed(f'Ensemble.impact_factors("{quantity}")', f"Ensemble.{new}.{quantity}")
        return found

    def __eq__(self, other: object) -> bool:
        """Whether they are the same factors of equal ensembles."""
        if type(other) is not SampleFactors:
            return NotImplemented
        return self.mask == other.mask and self._ensemble == other._ensemble

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"SampleFactors({self._ensemble.samples} samples, {len(self.sections)} sections)"


if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """The function of the same name, where it was before."""
        if name == "ensemble":
            renamed("spanwise.ensembles.ensemble", "spanwise.study.ensemble")
            return view("study.ensemble")
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
