"""What a crossing gives: histories, extremes, impact factors."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise import _core
from spanwise._checks import choice
from spanwise._computed import Computed
from spanwise._conditions import masked
from spanwise._door import view
from spanwise._freevibration import Growth, growths
from spanwise._plausible import doubts_of_roads
from spanwise._remarks import remarks
from spanwise._renamed import Renamed
from spanwise._value import frozen, same
from spanwise.bridge import Bridge
from spanwise.extremes import Envelope, Extremes
from spanwise.impact_factors import DEFINITIONS, ImpactFactors
from spanwise.motions import BodyMotion, ContactLoss, LiftOff, ModalMotion, Motion, VehicleMotion
from spanwise.quantities import RESPONSES, Axis, Response, factors, response, telling, there_are
from spanwise.responses import Responses
from spanwise.roads import Road
from spanwise.traffic import Passage
from spanwise.vehicles import AnyVehicle

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from spanwise.convergence import Convergence
    from spanwise.plotting import RunPlot

Array: TypeAlias = NDArray[np.float64]
Ratio: TypeAlias = Literal["extremes", "at-dynamic-extreme", "at-static-extreme"]


class Run(Responses):
    """The result of a crossing.

    Dynamic responses are attributes of the run itself, static ones of `static`.

    Attributes
    ----------
    bridge : Bridge
        The bridge.
    passages : tuple of Passage
        The vehicles and how each of them crossed.
    truck : Vehicle, ForceTrain or MovingMasses
        The first vehicle.
    road : Road
        The road.
    settings : dict
        The settings used, defaults filled in.
    sections : ndarray, shape (section,)
        Where responses are looked at [m].
    frequencies : ndarray, shape (mode,)
        Natural frequencies of the included modes [Hz].
    static_axle_loads : ndarray, shape (axle,)
        Static axle loads [N], of all vehicles in their order.
    static : Responses
        Responses to the static axle loads at the same positions.
    final_speed : float
        Speed of the first vehicle at the end [m/s].
    tail : float
        Free vibration that was kept after the last axle had left, or the last vehicle had
        stopped [s].
    settled : bool
        Whether it ended because no extreme could follow; not so where the tail was given, and
        where it was as long as may be.
    growth : float
        How far at most free vibration after the end can exceed an extreme, in parts of the largest
        of its kind along the bridge; of the one of `can_grow` that can grow most, 0 if there is
        none, NaN where a vehicle stands on the bridge.
    lift_offs : tuple of LiftOff
        Every time a wheel was off the road, on the approach too, until the last axle had left.
    steps : int
        Number of time steps.
    """

    def __init__(
        self,
        bridge: Bridge,
        passages: tuple[Passage, ...],
        road: Road,
        settings: dict[str, object],
        computed: Computed,
        doubts: tuple[str, ...] = (),
    ) -> None:
        super().__init__(computed)
        self._doubts = doubts
        self.static = Responses(computed, static=True)
        core = computed.core
        self.bridge, self.passages, self.road, self.settings = bridge, passages, road, settings
        self.truck: AnyVehicle = passages[0].vehicle
        self.sections: Array = core.sections
        self.frequencies: Array = core.omega / (2.0 * np.pi)
        self.static_axle_loads: Array = core.static_loads
        self.final_speed: float = core.final_speeds[0]
        self.stopped: tuple[float | None, ...] = tuple(core.stopped)
        self.lift_offs = tuple(LiftOff(axle + 1, *span) for axle, *span in core.lift_offs)
        self.steps: int = core.steps
        self.tail: float = core.tail
        self.settled: bool = core.settled
        self.growth: float = core.growth

    def __getstate__(self) -> dict[str, Any]:
        """Without what is worked out when asked for: the states of the crossing are enough."""
        worked_out = {
            name for name, each in vars(type(self)).items() if isinstance(each, cached_property)
        }
        return {name: each for name, each in vars(self).items() if name not in worked_out}

    def __eq__(self, other: object) -> bool:
        """Whether the same was asked, to the same states, bit for bit."""
        if type(other) is not Run:
            return NotImplemented
        names = ("passages", "road", "settings", "_computed")
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None

    off_road = Renamed("contact_loss")
    load_coefficients = Renamed("dynamic_load_coefficients")

    @property
    def _core(self) -> _core.Crossing:
        return self._computed.core

    @property
    def responses(self) -> list[Response]:
        """What there is: all that the bridge knows, without a clamp no clamp moments."""
        of_bridge = there_are(self.bridge.missing, clamps=len(self.bridge.clamps) > 0)
        return [each for each in RESPONSES.values() if each in of_bridge or each.axis == "axle"]

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """All that was warned of in this crossing and its measured roads, but damping."""
        roads = (self.road, *(each.road for each in self.passages if each.road is not None))
        return (*doubts_of_roads(roads), *self._doubts, *remarks(self))

    @property
    def axles(self) -> list[tuple[int, int]]:
        """Numbers of vehicle and axle in it, from 1, of each column by axle."""
        return [
            (number_, axle + 1)
            for number_, passage in enumerate(self.passages, 1)
            for axle in range(len(passage.vehicle.axle_positions))
        ]

    @property
    def axle_names(self) -> list[str]:
        """What the axles are called: by number, and by vehicle where there are several."""
        several = len(self.passages) > 1
        return [f"{f'vehicle {k} ' if several else ''}axle {axle}" for k, axle in self.axles]

    @cached_property
    def can_grow(self) -> tuple[Growth, ...]:
        """Extremes that free vibration after the end can exceed by more than a hundredth.

        Of each quantity and side the one that can grow most, if by more than a thousandth of the
        largest along the bridge too. Slope, velocity and acceleration of the deck, for which the
        tail is not made, are left out. Where a vehicle stands on the bridge nothing is known. After
        a tail that was given, the representation of the run says that there are some.
        """
        return tuple(growths(self))

    @cached_property
    def contact_loss(self) -> ContactLoss:
        """How often and how long wheels were off the road, axle by axle."""
        by_axle = [
            [each.duration for each in self.lift_offs if each.axle == axle]
            for axle in range(1, len(self.axles) + 1)
        ]
        return ContactLoss(
            count=np.array([len(each) for each in by_axle], dtype=np.int64),
            total=np.array([sum(each) for each in by_axle], dtype=np.float64),
            longest=np.array([max(each, default=0.0) for each in by_axle]),
        )

    @cached_property
    def time(self) -> Array:
        """Time since the front axle was at the start of the approach [s], shape (time,)."""
        return frozen(self._core.states("time").ravel())

    @cached_property
    def axle_loads(self) -> Array:
        """Axle loads [N], shape (time, axle)."""
        return frozen(self._core.states("axle_loads"))

    @cached_property
    def quasi_static_acceleration(self) -> Array:
        """What the modes left out add to ``acceleration`` [m/s2], shape (time, section).

        They carry the loads without inertia, and as these move on, so does what they carry. Exact
        for constant forces; of sprung vehicles without the change of the loads. To be added to
        ``acceleration``, which is that of the included modes alone.

        Raises
        ------
        ValueError
            If the recovery is not ``"force-summation"``.
        """
        return frozen(self._core.quasi_static_acceleration())

    @cached_property
    def dynamic_load_coefficients(self) -> Array:
        """How much the axle loads vary about their static values [-], shape (axle,).

        The root mean square of P - P_st by P_st, over the steps from the first with an axle of the
        same vehicle on the bridge to that with which the last of them leaves it. It is taken about
        the static load, not about the mean: on a short bridge an axle may be above it nearly all
        the time.
        """
        return frozen(self._core.load_coefficients)

    @cached_property
    def vehicles(self) -> tuple[VehicleMotion, ...]:
        """The motion of each vehicle."""
        by_axle = {
            "axle_positions": self._core.states("positions"),
            **{k: self._core.states(k) for k in ("elevations", "friction")},
            "suspension_travel": self._core.states("suspension_shortenings"),
        }
        motions, first = [], 0
        for number_, (passage, stopped) in enumerate(
            zip(self.passages, self._core.stopped, strict=True)
        ):
            columns = frozen(self._core.motion(number_)).T
            triples = [Motion(*columns[at : at + 3]) for at in range(0, len(columns) - 3, 3)]
            axles = len(passage.vehicle.axle_positions)
            bodies, hops = triples[: len(triples) - axles], triples[len(triples) - axles :]
            own = slice(first, first + axles)
            first += axles
            motions.append(
                VehicleMotion(
                    bodies=tuple(map(BodyMotion, bodies[::2], bodies[1::2])),
                    hops=tuple(hops),
                    **dict(zip(("travel", "speed", "acceleration"), columns[-3:], strict=True)),
                    **{kind: frozen(values[:, own]) for kind, values in by_axle.items()},
                    stopped=stopped,
                )
            )
        return tuple(motions)

    def stop(self, vehicle: int) -> tuple[float, Array] | None:
        """When a vehicle, counted from 0, came to rest [s], and where its axles are then [m]."""
        motion = self.vehicles[vehicle]
        if motion.stopped is None:
            return None
        columns = motion.axle_positions.T
        return motion.stopped, np.array([np.interp(motion.stopped, self.time, x) for x in columns])

    @property
    def vehicle(self) -> VehicleMotion:
        """The motion of the first vehicle."""
        return self.vehicles[0]

    @cached_property
    def modal(self) -> ModalMotion:
        """The motion of the bridge in modal coordinates."""
        rates = ("coordinates", "velocities", "accelerations")
        return ModalMotion(*(frozen(self._core.states(name)) for name in rates))

    def __repr__(self) -> str:
        # A tail that was given is meant, and so nothing is warned of.
        cut = self.settings["tail"] is not None and len(self.can_grow) > 0
        grow = f", tail {self.tail:.4g} s after which extremes can grow" if cut else ""
        return (
            f"Run({len(self.frequencies)} modes, "
            f"{self.steps} steps of {self.settings['step']:.4g} s, "
            f"{len(self.sections)} sections, recovery by {self.settings['recovery']}{grow})"
        )

    def summary(self) -> str:
        """Bridge, vehicles, road and settings, governing responses and impact factors, as text."""
        return view("_run_summary.summary")(self)

    def _repr_html_(self) -> str:
        return view("_run_summary.page")(self)

    def check(self, *, modes: bool = True, stations: bool = True) -> Convergence:
        """Estimate the errors of the extremes: cross again with half the step, and finer.

        By default the crossing is repeated with twice as many modes and, by itself, with twice as
        many stations as well, where the bridge has more of these; `Convergence.compared` says where
        it has not. Modes that a list of damping ratios leaves out are damped as its last. Record
        and sections are those of the run.

        Parameters
        ----------
        modes : bool, optional
            Whether to compare with more modes.
        stations : bool, optional
            Whether to compare with more stations.

        Returns
        -------
        Convergence
            Errors of each response by what they come from, and whether the step keeps `accuracy`.

        Raises
        ------
        ValueError
            If half the step would take more steps than there may be.
        RuntimeError
            As from `cross`.
        """
        return view("convergence.check")(self, modes, stations)

    @property
    def supports(self) -> Array:
        """Positions of the supports [m], in the order of `reactions`."""
        return np.array([x for x, _ in self.bridge.supports])

    def places(self, axis: Axis) -> Array:
        """Positions of the sections, supports or clamps [m], or numbers of the axles from 1."""
        return {
            "section": self.sections,
            "support": self.supports,
            "clamp": self.bridge.clamps,
            "axle": np.arange(1.0, len(self.static_axle_loads) + 1.0),
        }[axis]

    @telling
    def envelope(self, quantity: str) -> Envelope:
        """Extremes of a response along the bridge, with their times and vehicle positions.

        They include the instants at which an axle stands on a section, on both sides of it. The
        shears on the left and on the right of a section count together.

        Parameters
        ----------
        quantity : str
            The response:

            {responses}
        """
        of = response(quantity)
        columns = (np.ascontiguousarray(each.T) for each in self._core.envelope(of.name))
        return Envelope(self.places(of.axis), *(Extremes(*each) for each in columns))

    @cached_property
    def impact_factors(self) -> ImpactFactors:
        """Impact factors by section, support and axle: dynamic maximum by static maximum."""
        return self.ratios()

    def ratios(self, ratio: Ratio = "extremes", mask: float | None = None) -> ImpactFactors:
        """Impact factors by one of three definitions.

        Parameters
        ----------
        ratio : {"extremes", "at-dynamic-extreme", "at-static-extreme"}, optional
            Dynamic extreme by static extreme, which may occur at different times; dynamic extreme
            by the static value at that time; dynamic value at the time of the static extreme by
            that extreme.
        mask : float, optional
            Give none where the static value is at most this fraction of the largest along the
            bridge; by default as the run was told.

        Returns
        -------
        ImpactFactors
            NaN where masked.
        """
        choice("ratio", ratio, DEFINITIONS)
        least = masked(self.settings["mask"] if mask is None else mask)
        values = {
            name: self._core.impact_factors(of.name, factor.sense, ratio, least)
            for name, (of, factor) in factors().items()
        }
        return ImpactFactors(ratio, least, self.sections, self.supports, values)

    def to_dict(self) -> dict[str, Any]:
        """The results as plain lists and numbers, ``None`` where an impact factor is masked.

        Keys: ``version``; ``sections``, ``supports`` [m], ``frequencies`` [Hz]; for each quantity
        the lists ``max``, ``min``, ``static_max``, ``static_min``, each with its ``..._time`` [s],
        ``..._position`` [m] and ``..._partner`` (see `Extremes`); ``impact_factors``;
        ``warnings``; ``final_speed`` of the first vehicle [m/s]; ``vehicles``, for each its static
        axle loads [N], ``load_coefficients`` (by axle), ``final_speed``, ``stopped`` (time [s] and
        ``axle_positions`` [m], or None) and ``off_road`` (by axle); ``lift_offs``; ``steps``;
        ``tail``, its ``length`` [s], whether it ``settled`` and what ``can_grow`` after it (see
        `can_grow`); ``settings``, the tables of a case that computes the run again:
        ``Case.from_dict(settings).run()``.
        """
        return view("_run_files.as_dict")(self)

    def to_json(self, path: str | Path) -> None:
        """Write `to_dict` to a JSON file.

        Raises
        ------
        OSError
            If the file cannot be written; then there is none, or the old one.
        """
        view("_run_files.write_json")(self, path)

    def to_csv(self, directory: str | Path) -> None:
        """Write impact factors, extremes and histories into a folder, made if there is none.

        The files are ``impact_factors.csv``, ``lift_offs.csv``, ``envelope_<quantity>.csv``,
        ``history_<quantity>.csv`` and ``history_vehicle.csv``, or ``history_vehicle_<number>.csv``
        for each of several vehicles. Axles are numbered through all vehicles. The first row of a
        file names the columns and units; numbers have a decimal point and all their digits.

        Raises
        ------
        OSError
            If the folder or a file cannot be written; then no file has been changed.
        """
        view("_run_files.write_csv")(self, directory)

    def to_pandas(self, quantity: str = "moment") -> pd.DataFrame:
        """History of a response as a frame, time [s] down, sections, supports or axles across.

        Shears have two columns for each section, ``"left"`` and ``"right"`` of it. Needs the extra
        ``spanwise[pandas]``.
        """
        return view("_run_files.as_frame")(self, quantity)

    @property
    def plot(self) -> RunPlot:
        """Figures of the run; needs the extra ``spanwise[plot]``."""
        return view("plotting.RunPlot")(self)
