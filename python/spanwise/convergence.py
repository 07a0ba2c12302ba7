"""How far a crossing is from converged: the same with half the step, more modes, more stations."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from spanwise._checks import flag
from spanwise._table import Block, Table, html, text
from spanwise._value import Value
from spanwise.bridge import Bridge
from spanwise.crossing import cross
from spanwise.extremes import ROUNDING
from spanwise.quantities import RESPONSES
from spanwise.runs import Run

#: What errors come from, and what part of them twice as many steps, modes or stations take away:
#: three quarters where they go with the square; of modes what the next ones add.
SOURCES: Final = {"step": 0.75, "modes": 1.0, "stations": 0.75}


@dataclass(frozen=True, eq=False, repr=False)
class Convergence(Value):
    """Estimated errors of the extremes of a run.

    Each is the largest of all places along the bridge (of axle loads, of all axles), of maxima and
    minima, in parts of the largest value of that response along the bridge [-], by the name of the
    response. They are estimates: differences between two crossings, times 4/3 for step and stations
    (Richardson's, for errors that go with the square of these). docs/theory.md, "Time step", tells
    how far they were tried.

    Attributes
    ----------
    accuracy : float
        What the run promises, its setting of this name.
    step : dict of str to float
        Errors because of the step: against half of it.
    modes : dict of str to float
        Errors because of the modes left out: against twice as many, or all. By superposition those
        after these can add more. Empty if not known.
    stations : dict of str to float
        Errors because masses are lumped: against twice as many stations. Empty if not known.
    compared : tuple of str
        What was compared, and why something that was asked for was not.
    """

    accuracy: float
    step: dict[str, float]
    modes: dict[str, float]
    stations: dict[str, float]
    compared: tuple[str, ...]

    @property
    def kept(self) -> bool:
        """Whether the step keeps the accuracy in all responses but the motion of the deck.

        Velocity and acceleration, of which higher modes make more, have no part in the promise.
        """
        return all(
            error <= self.accuracy for name, error in self.step.items() if RESPONSES[name].influence
        )

    @property
    def errors(self) -> dict[str, float]:
        """Errors of each response, from all that is known to make them [-]."""
        return {name: sum(self._by_source(name).values()) for name in self.step}

    @property
    def sources(self) -> dict[str, str]:
        """Which of ``"step"``, ``"modes"``, ``"stations"`` makes most of each; "" if none does."""
        by_name = {name: self._by_source(name) for name in self.step}
        most = {name: max(each, key=each.__getitem__) for name, each in by_name.items()}
        return {name: of if by_name[name][of] > ROUNDING else "" for name, of in most.items()}

    def _by_source(self, name: str) -> dict[str, float]:
        known = {source: getattr(self, source) for source in SOURCES}
        return {source: errors[name] for source, errors in known.items() if errors}

    def __repr__(self) -> str:
        most = max(self.errors, key=self.errors.__getitem__)
        kept = "kept" if self.kept else "not kept"
        return (
            f"Convergence({most} off by {self.errors[most]:.2g}, most from "
            f"{self.sources[most] or 'nothing'}; accuracy {self.accuracy:g} {kept} by the step)"
        )

    def blocks(self) -> Iterator[Block]:
        """What was compared, and a table of the errors."""
        yield self.compared
        heads = ["error of extremes [1e-3]", *SOURCES, "all", "most from"]
        rows = []
        for name, error in self.errors.items():
            known = self._by_source(name)
            each = [1e3 * value for value in (*(known.get(s, np.nan) for s in SOURCES), error)]
            rows.append([RESPONSES[name].noun, *each, self.sources[name] or "-"])
        kept = "keeps" if self.kept else "does not keep"
        notes = [
            "in parts of the largest of each response along the bridge",
            f"the step {kept} the accuracy, {1e3 * self.accuracy:g}e-3; velocity and acceleration "
            "have no part in it",
        ]
        yield Table(heads, rows, ["<", *[".3f"] * (len(SOURCES) + 1), "<"], notes)

    def summary(self) -> str:
        """What was compared, the errors and where they come from, as text."""
        return text(self.blocks())

    def _repr_html_(self) -> str:
        return html(self.blocks())


def check(run: Run, modes: object, stations: object) -> Convergence:
    """See `Run.check`."""
    step: Any = run.settings["step"]
    found: dict[str, dict[str, float]] = {source: {} for source in SOURCES}
    found["step"] = _errors("step", run, _again(run, step=0.5 * step))
    compared = [f"step      {step:.4g} s, against half of it"]
    for source, asked, more in (
        ("modes", flag("modes", modes), _more_modes),
        ("stations", flag("stations", stations), _more_stations),
    ):
        if asked:
            try:
                said, changed = more(run)
                # Higher modes may ask for shorter steps than those of the run: both take these.
                finer = _again(run, **changed, step=None)
                like = _again(run, step=finer.settings["step"])
                found[source] = _errors(source, like, finer)
            except ValueError as error:
                said = f"not compared: {error}"
            compared.append(f"{source:<10}{said}")
    accuracy: Any = run.settings["accuracy"]
    return Convergence(accuracy, **found, compared=tuple(compared))


def _again(run: Run, bridge: Bridge | None = None, **changed: Any) -> Run:
    """The crossing with other settings, which has been warned of already."""
    given: Any = {**run.settings, "sections": run.sections, "tail": run.tail, **changed}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cross(bridge or run.bridge, run.passages, road=run.road, **given)


def _more_modes(run: Run) -> tuple[str, dict[str, Any]]:
    """Twice as many, or all that there are, damped as the last where each has its ratio."""
    count, damping = len(run.frequencies), run.settings["damping"]
    more = min(2 * count, run.bridge.mode_count)
    if more == count:
        raise ValueError(f"all {count} that the bridge has are included")
    if isinstance(damping, list) and not isinstance(damping[0], list):
        damping = [*damping, *damping[-1:] * (more - count)]
    return f"{count}, against {more}", {"modes": more, "damping": damping}


def _more_stations(run: Run) -> tuple[str, dict[str, Any]]:
    """Twice as many in each span."""
    arguments, damping = run.bridge.arguments, run.settings["damping"]
    if not run.bridge.described:
        raise ValueError("the bridge was given by its flexibility or its modes")
    if "stations_per_span" not in arguments:
        raise ValueError("the masses of the bridge were placed one by one")
    if isinstance(damping, list) and isinstance(damping[0], list):
        raise ValueError("the damping matrix is one of the stations as they are")
    more = [2 * count for count in arguments["stations_per_span"]]
    bridge = Bridge(**{**arguments, "stations_per_span": more})
    said = f"{len(run.bridge.stations)}, against {len(bridge.stations)}"
    return said, {"bridge": bridge}


def _errors(source: str, coarse: Run, fine: Run) -> dict[str, float]:
    """Of each response the largest difference, by the part of the error that it is."""
    found = {}
    for each in fine.responses:
        both = (run.envelope(each.name) for run in (coarse, fine))
        a, b = (np.array([one.max.value, one.min.value]) for one in both)
        if b.size > 0:
            largest = float(np.abs(b).max())
            error = float(np.abs(a - b).max()) / SOURCES[source]
            found[each.name] = error / largest if largest > 0.0 else 0.0
    return found
