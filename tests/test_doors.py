"""Every door checks what comes in: each argument of what is public meets odd values, one at a time.

A call with one odd value either works, or is refused with a short message that names the argument.
No other error, no warning of NumPy, no call that takes long.
"""

from __future__ import annotations

import inspect
import itertools
import os
import re
import signal
import time
import types
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import date
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

import spanwise as sw
from spanwise import plotting, roads, vehicles
from spanwise._variation import ATTRIBUTES, OF_BRIDGES

nan, inf = float("nan"), float("inf")

#: What is varied of vehicles.
OF_VEHICLES: Final = [name for name in ATTRIBUTES if name not in OF_BRIDGES]

#: Longest time that a call may take [s of the processor]: others may keep it busy.
SOON: Final = 2.0

#: Longest message.
SHORT: Final = 600

#: Of how many odd values each argument meets one, unless all are asked for, as `make soak` does.
ONE_OF: Final = 1 if os.environ.get("SPANWISE_SOAK") else 10


class Mute:
    """Something that cannot be shown."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")


class Deaf:
    """Something that says it can be gone through, and cannot."""

    def __iter__(self) -> Iterator[float]:
        raise RuntimeError("no iteration")


class Liar:
    """A number that is none."""

    def __float__(self) -> float:
        raise RuntimeError("no number")

    def __array__(self, *_: object, **__: object) -> np.ndarray[Any, Any]:
        raise RuntimeError("no array")

    def __len__(self) -> int:
        raise RuntimeError("no length")


def deep(levels: int = 3000) -> list[Any]:
    """Lists within lists."""
    made: list[Any] = []
    for _ in range(levels):
        made = [made]
    return made


def itself() -> list[Any]:
    """A list that is in itself."""
    made: list[Any] = [1.0]
    made.append(made)
    return made


def bridge() -> sw.Bridge:
    return sw.Bridge(spans=[18.0, 18.0], EI=1.9e9, mass=6e3, stations_per_span=3)


def clamped() -> sw.Bridge:
    return sw.Bridge(
        spans=[18.0], ends=("clamped", "pinned"), EI=1.9e9, mass=6e3, stations_per_span=3
    )


#: Odd values by name, each made anew.
ODD: Final[dict[str, Callable[[], object]]] = {
    "None": lambda: None,
    "True": lambda: True,
    "empty text": lambda: "",
    "text": lambda: "x",
    "long text": lambda: "x" * 100_000,
    "number as text": lambda: "1",
    "a surrogate": lambda: "\udc80",
    "NUL": lambda: "a\0b",
    "bytes": lambda: b"\xff\x00",
    "bytearray": lambda: bytearray(b"12"),
    "nan": lambda: nan,
    "inf": lambda: inf,
    "-inf": lambda: -inf,
    "-1": lambda: -1,
    "0": lambda: 0,
    "-0.0": lambda: -0.0,
    "1": lambda: 1,
    "0.5": lambda: 0.5,
    "1e308": lambda: 1e308,
    "-1e308": lambda: -1e308,
    "1e150": lambda: 1e150,
    "1e30": lambda: 1e30,
    "1e9": lambda: 1e9,
    "5e-324": lambda: 5e-324,
    "1e-300": lambda: 1e-300,
    "1e-30": lambda: 1e-30,
    "10**9": lambda: 10**9,
    "2**63": lambda: 2**63,
    "10**30": lambda: 10**30,
    "-10**30": lambda: -(10**30),
    "10**400": lambda: 10**400,
    "10**5000": lambda: 10**5000,
    "complex": lambda: 1 + 2j,
    "Fraction": lambda: Fraction(10**400, 3),
    "Decimal": lambda: Decimal("NaN"),
    "a date": lambda: date(1973, 1, 1),
    "np.int64": lambda: np.int64(1),
    "np.uint8": lambda: np.uint8(255),
    "np.float16": lambda: np.float16("inf"),
    "np.float32": lambda: np.float32(0.1),
    "np.longdouble": lambda: np.longdouble("1e4000"),
    "np.bool": lambda: np.bool_(True),
    "np.str": lambda: np.str_("x"),
    "np.datetime64": lambda: np.datetime64("2020-01-01"),
    "np.complex128": lambda: np.complex128(1j),
    "0-d array": lambda: np.array(1.0),
    "0-d object": lambda: np.array({}, dtype=object),
    "empty list": list,
    "empty array": lambda: np.empty((0, 3)),
    "one in a list": lambda: [1.0],
    "nan in a list": lambda: [1.0, nan],
    "huge in a list": lambda: [1e308, 1e308],
    "descending": lambda: [3.0, 2.0, 2.0],
    "integer beyond floats in a list": lambda: [10**400],
    "2-d": lambda: np.ones((2, 2)),
    "3-d": lambda: np.ones((2, 2, 2)),
    "ragged": lambda: [[1.0], [1.0, 2.0]],
    "objects": lambda: np.array([None, object()], dtype=object),
    "texts": lambda: np.array(["a", "b"]),
    "list of None": lambda: [None],
    "list of dict": lambda: [{}],
    "structured": lambda: np.zeros(2, dtype=[("a", float)]),
    "masked array": lambda: np.ma.array([1.0, 2.0], mask=[True, False]),
    "endless array": lambda: np.broadcast_to(1.0, 10**12),
    "huge range": lambda: range(10**12),
    "lists in lists": deep,
    "a list in itself": itself,
    "dict": dict,
    "dict of nonsense": lambda: {None: object(), "x": 1},
    "dict by text": lambda: {"at": 1.0, "kind": "x", "x": [1]},
    "set": lambda: {1.0, 2.0},
    "generator": lambda: (x for x in (1.0, 2.0)),
    "endless": lambda: itertools.count(),
    "endless text": lambda: itertools.repeat("x"),
    "object": object,
    "class": lambda: int,
    "function": lambda: len,
    "module": lambda: types,
    "ellipsis": lambda: ...,
    "mute": Mute,
    "list of mute": lambda: [Mute()],
    "deaf": Deaf,
    "liar": Liar,
    "a bridge": bridge,
    "a vehicle": vehicles.quarter_car,
    "a road": sw.Smooth,
    "a path": lambda: Path("no/such/file"),
    "a folder": lambda: Path("/"),
    "endless file": lambda: "/dev/zero",
}


@dataclass(frozen=True)
class Door:
    """Something public that takes arguments."""

    call: Callable[..., object]
    given: dict[str, Any] = field(default_factory=dict)
    #: Where the arguments stand, if not in the signature of `call`.
    like: Callable[..., object] | None = None
    #: What an argument is called in messages, where it has another name too.
    also: dict[str, str] = field(default_factory=dict)
    #: Arguments besides those of the signature.
    more: tuple[str, ...] = ()
    #: Errors besides ValueError and TypeError that are documented.
    raises: tuple[type[Exception], ...] = ()
    #: Arguments that are left alone.
    but: tuple[str, ...] = ()

    @property
    def arguments(self) -> list[str]:
        of = inspect.signature(self.like or self.call).parameters.values()
        plain = [p.name for p in of if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
        return [each for each in (*plain, *self.more) if each not in (*self.but, "self")]


AXLE: Final[dict[str, Any]] = {"position": 2.0, "tyre_stiffness": 2e6, "suspension_stiffness": 5e5}
REAR: Final[dict[str, Any]] = {**AXLE, "position": -2.0}


def with_axle(**given: Any) -> sw.Vehicle:
    axles = [sw.Axle(**given), sw.Axle(**REAR)]
    return sw.Vehicle(mass=2e4, pitch_inertia=6e4, axles=axles)


def with_body(**given: Any) -> sw.Vehicle:
    front = sw.Body(mass=6e3, pitch_inertia=9e3, axles=[sw.Axle(**AXLE), sw.Axle(**REAR)])
    return sw.Vehicle(bodies=[front, sw.Body(**given)])


def with_hinge(**given: Any) -> sw.Vehicle:
    return with_body(**{**BODY, "hinge": sw.Hinge(**given)})


def with_spring(**given: Any) -> sw.Vehicle:
    return with_body(**{**BODY, "hinge": None, "springs": [sw.Spring(**given)]})


def with_support(**given: Any) -> sw.Bridge:
    return sw.Bridge(
        length=20.0, supports=[sw.Support(**given), (20.0, "pinned")], EI=1e9, mass=1e3
    )


def with_along(**given: Any) -> sw.Bridge:
    return sw.Bridge(spans=[20.0], EI=sw.Along(**given), mass=1e3)


def with_drive(kind: Callable[..., Any]) -> Callable[..., object]:
    def driven(**given: Any) -> object:
        speed = None if kind is sw.Speeds else 20.0
        return sw.cross(bridge(), vehicles.quarter_car(), speed=speed, drive=kind(**given))

    return driven


def with_passage(**given: Any) -> object:
    return sw.cross(bridge(), sw.Passage(**given))


def with_table(key: str, **given: Any) -> Callable[..., object]:
    def made(**changes: Any) -> object:
        table = {**given, **changes}
        return sw.Case.from_dict({**TABLES, key: table})

    return made


BODY: Final[dict[str, Any]] = {
    "mass": 2e4,
    "pitch_inertia": 9e4,
    "axles": [sw.Axle(**{**AXLE, "position": -3.0})],
    "hinge": sw.Hinge(to=0, at=-1.5, own=5.0),
}
TABLES: Final[dict[str, Any]] = {
    "bridge": {"spans": [18.0, 18.0], "EI": 1.9e9, "mass": 6e3, "stations_per_span": 3},
    "vehicle": {"preset": "quarter-car"},
    "crossing": {"speed": 20.0},
}
TEXT: Final = """
[bridge]
spans = [18.0, 18.0]
EI = 1.9e9
mass = 6e3
[vehicle]
preset = "quarter-car"
[crossing]
speed = 20.0
"""
x = np.linspace(0.0, 36.0, 13)
LINES: Final[dict[str, Any]] = {
    "path": [0.0, 9.0, 18.0],
    "frequencies": [3.0],
    "shapes": [[0.0], [1e-3], [0.0]],
    "sections": [9.0],
    "influence": {"deflection": [[0.0, 1e-7, 0.0]]},
}
BRAKING: Final[dict[str, Any]] = {"kind": "braking", "deceleration": 1.0}
#: Two hundred metres of road on points.
PROFILE: Final = {"x": np.arange(-100.0, 100.0), "elevations": np.sin(np.arange(200.0)) * 1e-3}

B, Q = bridge(), vehicles.quarter_car()
RUN: Final = sw.cross(B, Q, speed=20.0, damping=0.02)
MANY: Final = sw.ensemble(B, Q, samples=3, speed=20.0, damping=0.02, road=sw.ISO8608("A"))
ROUGH: Final = sw.ISO8608("A")
CASE: Final = sw.Case.from_dict(TABLES)
NUMERICS: Final = (RuntimeError,)

#: An end of a section may make it too long or too short for its spacing.
ENDS: Final = {"start": "section", "end": "section"}

DOORS: Final[dict[str, Door]] = {
    "Bridge": Door(sw.Bridge, {"spans": [18.0, 18.0], "EI": 1.9e9, "mass": 6e3}),
    "Bridge(length)": Door(
        sw.Bridge,
        {"length": 20.0, "supports": [(0.0, "pinned"), (20.0, "pinned")], "EI": 1e9, "mass": 1e3},
        also={"length": "supports"},
    ),
    "Bridge.from_flexibility": Door(
        sw.Bridge.from_flexibility,
        {
            "length": 20.0,
            "supports": [(0.0, "pinned"), (20.0, "pinned")],
            "stations": [5.0, 15.0],
            "masses": [1e3, 1e3],
            "flexibility": [[2e-7, 1e-7], [1e-7, 2e-7]],
        },
        also={"length": "supports station"},
    ),
    "Bridge.from_modes": Door(sw.Bridge.from_modes, LINES, also={"frequencies": "mode"}),
    "Support": Door(with_support, {"at": 0.0}, sw.Support, also={"at": "supports"}),
    "Along": Door(with_along, {"at": [0.0, 20.0], "values": [1e9, 2e9]}, sw.Along),
    "Bridge.modes": Door(B.modes, {"count": 2}, also={"count": "modes"}),
    "Bridge.mode_shapes": Door(B.mode_shapes, {"count": 2, "x": [1.0]}, also={"count": "modes"}),
    "Bridge.deflections": Door(B.deflections, {"x": [1.0], "loads": [2.0]}),
    "Bridge.settlement": Door(B.settlement, {"settlements": [0.0, 0.01, 0.0]}),
    "Bridge.flexibility": Door(B.flexibility),
    "Bridge.influence_line": Door(
        B.influence_line, {"quantity": "moment", "at": 9.0, "x": [1.0, 2.0]}
    ),
    "Rayleigh": Door(sw.Rayleigh, {"alpha": 0.1, "beta": 0.001}),
    "Rayleigh.from_ratios": Door(
        sw.Rayleigh.from_ratios, {"first": (3.0, 0.02), "second": (9.0, 0.03)}
    ),
    "Rayleigh.ratios": Door(sw.Rayleigh(0.1, 0.001).ratios, {"frequencies": [1.0]}),
    "Axle": Door(with_axle, AXLE, sw.Axle),
    "Body": Door(with_body, BODY, sw.Body),
    "Hinge": Door(
        with_hinge,
        {"to": 0, "at": -1.5, "own": 5.0},
        sw.Hinge,
        also={"at": "hinge", "own": "hinge"},
    ),
    "Spring": Door(
        with_spring,
        {"to": 0, "at": -1.5, "own": 5.0, "stiffness": 1e6},
        sw.Spring,
        also={"at": "spring axle", "own": "spring axle"},
    ),
    "Vehicle": Door(
        sw.Vehicle,
        {"mass": 2e4, "pitch_inertia": 6e4, "axles": [sw.Axle(**AXLE), sw.Axle(**REAR)]},
    ),
    "Vehicle.with_initial_friction": Door(
        lambda initial_friction: Q.with_initial_friction(initial_friction),
        {"initial_friction": 0.0},
    ),
    "Vehicle.static_loads": Door(Q.static_loads),
    "Vehicle.frequencies": Door(Q.frequencies),
    "ForceTrain": Door(sw.ForceTrain, {"loads": [1e4, 2e4], "spacings": [3.0]}),
    "ForceTrain(positions)": Door(sw.ForceTrain, {"loads": [1e4, 2e4], "positions": [0.0, -3.0]}),
    "MovingMasses": Door(sw.MovingMasses, {"masses": [1e4, 2e4], "spacings": [3.0]}),
    "Acceleration": Door(
        with_drive(sw.Acceleration), {"acceleration": 1.0}, sw.Acceleration, raises=NUMERICS
    ),
    "Braking": Door(with_drive(sw.Braking), {"deceleration": 1.0}, sw.Braking, raises=NUMERICS),
    "Speeds": Door(with_drive(sw.Speeds), {"times": [0.0, 1.0], "speeds": [10.0, 20.0]}, sw.Speeds),
    "Passage": Door(with_passage, {"vehicle": Q, "speed": 20.0}, sw.Passage, raises=NUMERICS),
    "convoy": Door(sw.convoy, {"vehicles": [Q, Q], "headway": 1.0, "speed": 20.0}),
    "cross": Door(sw.cross, {"bridge": B, "vehicle": Q, "speed": 20.0}, raises=NUMERICS),
    "cross(road)": Door(
        sw.cross,
        {"bridge": B, "vehicle": Q, "speed": 20.0, "road": ROUGH, "drive": "constant-traction"},
        raises=NUMERICS,
        also={"approach": "path"},
    ),
    "ensemble": Door(
        sw.ensemble,
        {"bridge": B, "vehicle": Q, "speed": 20.0, "samples": 2, "road": ROUGH},
        but=("progress",),
    ),
    # What is called may raise what it likes.
    "ensemble(progress)": Door(
        lambda progress: (
            callable(progress) or sw.ensemble(B, Q, speed=20.0, samples=2, progress=progress)
        ),
        {"progress": None},
    ),
    "ensemble(factors)": Door(
        lambda **factors: sw.ensemble(B, Q, speed=20.0, samples=2, factors=factors),
        more=tuple(ATTRIBUTES),
    ),
    "ensemble(values)": Door(
        lambda **values: sw.ensemble(B, Q, speed=20.0, samples=2, values=values),
        more=tuple(OF_VEHICLES),
    ),
    "ensemble(kinds)": Door(
        sw.ensemble,
        {
            "bridge": B,
            "vehicle": [[sw.Passage(vehicle=Q), sw.Passage(vehicle=Q, entry=1.0)]] * 2,
            "kind": [0, 1],
            "speed": 20.0,
            "samples": 2,
        },
        also={"vehicle": "kind"},
        but=("progress",),
    ),
    "Case": Door(
        lambda **k: sw.Case(**k).run(),
        {"bridge": B, "passages": (sw.Passage(vehicle=Q),), "crossing": {"speed": 20.0}},
        sw.Case,
        also={"crossing": "key"},
    ),
    "Case.read": Door(
        sw.Case.read, {"path": "case.toml"}, raises=(OSError,), also={"path": "case"}
    ),
    "Case.parse": Door(
        sw.Case.parse, {"text": TEXT}, raises=(OSError,), also={"text": "TOML case"}
    ),
    "Case.from_dict": Door(
        sw.Case.from_dict, {"tables": TABLES}, raises=(OSError,), also={"tables": "table bridge"}
    ),
    "Case.from_dict(tables)": Door(
        lambda **t: sw.Case.from_dict({**TABLES, **t}).run(), more=(*TABLES, "road", "traffic")
    ),
    "Case.from_dict(bridge)": Door(with_table("bridge", **TABLES["bridge"]), like=sw.Bridge),
    "Case.from_dict(preset)": Door(
        with_table("vehicle", preset="articulated-5-axle"),
        more=("preset", "cg_heights", "hinge_height", "initial_friction"),
    ),
    "Case.from_dict(vehicle)": Door(
        with_table("vehicle", mass=1e4, pitch_inertia=1e4, axles=[AXLE, REAR]),
        more=("mass", "pitch_inertia", "axles", "cg_height", "bodies", "loads"),
    ),
    "Case.from_dict(axles)": Door(
        lambda **k: with_table("vehicle", mass=1e4, pitch_inertia=1e4)(axles=[{**AXLE, **k}, REAR]),
        like=sw.Axle,
    ),
    "Case.from_dict(traffic)": Door(
        lambda **k: sw.Case.from_dict(
            {
                "bridge": TABLES["bridge"],
                "crossing": TABLES["crossing"],
                "traffic": [{"vehicle": {"preset": "quarter-car"}, **k}],
            }
        ),
        like=sw.Passage,
    ),
    "Case.from_dict(drive)": Door(
        lambda **k: sw.Case.from_dict(
            {
                **TABLES,
                "crossing": {
                    "speed": 20.0,
                    "drive": {"kind": "braking", "deceleration": 1.0, **k},
                },
            }
        ).run(),
        more=("kind", "deceleration", "start", "ramp"),
        raises=NUMERICS,
    ),
    "Case.run": Door(CASE.run, like=sw.cross, but=("bridge", "vehicle"), raises=NUMERICS),
    "Case.ensemble": Door(
        CASE.ensemble, {"samples": 2}, like=sw.ensemble, but=("bridge", "vehicle", "progress")
    ),
    "Run.envelope": Door(RUN.envelope, {"quantity": "moment"}),
    "Run.ratios": Door(RUN.ratios),
    "Run.to_json": Door(RUN.to_json, raises=(OSError,)),
    "Run.to_csv": Door(RUN.to_csv, raises=(OSError,)),
    "Run.to_pandas": Door(RUN.to_pandas),
    "Ensemble.histories": Door(
        MANY.histories,
        {"quantity": "moment", "samples": 0},
        raises=(IndexError,),
        also={"samples": "row"},
    ),
    "Ensemble.envelope": Door(MANY.envelope, {"quantity": "moment"}),
    "Ensemble.ratios": Door(MANY.ratios),
    "Ensemble.impact_factors": Door(MANY.impact_factors.__getitem__, {"quantity": "sagging"}),
    "Ensemble.read": Door(sw.Ensemble.read, raises=(OSError,)),
    "Ensemble.to_pandas": Door(MANY.to_pandas),
    "Ensemble.to_csv": Door(MANY.to_csv, {"path": "many.csv"}, raises=(OSError,)),
    "Ensemble.to_parquet": Door(MANY.to_parquet, {"path": "many.parquet"}, raises=(OSError,)),
    "concat": Door(sw.concat, {"ensembles": [MANY]}),
    "Ensemble.run": Door(MANY.run, {"sample": 0}, raises=(IndexError,), also={"sample": "row"}),
    "Ensemble.to_npz": Door(MANY.to_npz, raises=(OSError,)),
    "ISO8608": Door(sw.ISO8608, {"road_class": "A"}, also={"road_class": "class"}),
    "ISO8608(G)": Door(sw.ISO8608, {"G": 1e-6}, also={"road_class": "class"}),
    "Profile": Door(sw.Profile, PROFILE),
    "Profile.read": Door(
        sw.Profile.read,
        {"path": "profile.csv"},
        raises=(OSError,),
        also={"path": "profile file"},
    ),
    "Bump": Door(sw.Bump, {"at": 3.0, "length": 1.0, "height": 0.01}),
    "Camber": Door(sw.Camber, {"start": 0.0, "end": 18.0, "rise": 0.01}),
    "Joint": Door(sw.Joint, {"at": 3.0, "gap": 0.1, "depth": 0.01}),
    "Pothole": Door(sw.Pothole, {"at": 3.0, "length": 1.0, "depth": 0.01}),
    "Ramp": Door(sw.Ramp, {"start": 0.0, "end": 18.0, "height": 0.01}),
    "Step": Door(sw.Step, {"at": 3.0, "height": 0.01}),
    "Sum": Door(roads.Sum, {"parts": (ROUGH, ROUGH)}),
    "Road.elevation": Door(ROUGH.elevation, {"x": 1.0}, also={"x": "path"}),
    "Road.slope": Door(ROUGH.slope, {"x": 1.0}),
    "Road.curvature": Door(sw.Profile(**PROFILE).curvature, {"x": 1.0}, also={"x": "path"}),
    "Road.iri": Door(ROUGH.iri, {"start": 0.0, "end": 100.0}),
    "Road.psd": Door(ROUGH.psd, {"start": 0.0, "end": 100.0}, also=ENDS),
    "Road.iso_class": Door(ROUGH.iso_class, {"start": 0.0, "end": 300.0}, also=ENDS),
    "factor * Road": Door(
        lambda factor: factor * ROUGH, {"factor": 1.0}, also={"factor": "operand"}
    ),
    "factor * Bump": Door(
        lambda factor: factor * sw.Bump(3.0, 1.0, 0.01), {"factor": 1.0}, also={"factor": "operand"}
    ),
    "factor * Sum": Door(
        lambda factor: (ROUGH + sw.Bump(3.0, 1.0, 0.01)) * factor,
        {"factor": 1.0},
        also={"factor": "operand"},
    ),
    "bridge_study": Door(roads.bridge_study, {"condition": "good"}, more=("seed",)),
    "classify": Door(roads.classify, {"G": 1e-6}),
    "from_iri": Door(roads.from_iri, {"iri": 2.0}, more=("seed", "band")),
    "from_table": Door(roads.from_table, {"table": {"kind": "smooth"}}, also={"table": "kind"}),
    "from_table(iso-8608)": Door(
        lambda **k: roads.from_table({"kind": "iso-8608", "class": "A", **k}),
        more=("kind", "class", "G", "band", "seed", "contact_patch"),
    ),
    "articulated_5_axle": Door(vehicles.articulated_5_axle),
    "flm4": Door(vehicles.flm4, {"lorry": 1}),
    "half_car": Door(vehicles.half_car),
    "quarter_car": Door(vehicles.quarter_car),
    "hs20": Door(vehicles.hs20),
    "hs20_44": Door(vehicles.hs20_44),
    "t44": Door(vehicles.t44),
    "Bridge.plot.influence_line": Door(B.plot.influence_line, {"quantity": "moment", "at": 9.0}),
    "Bridge.plot.modes": Door(B.plot.modes, {"count": 1}, also={"count": "modes"}),
    "Bridge.plot.model": Door(B.plot.model),
    "Ensemble.plot.envelope": Door(MANY.plot.envelope),
    "Ensemble.plot.impact_factors": Door(MANY.plot.impact_factors),
    "Road.plot.profile": Door(ROUGH.plot.profile, {"start": 0.0, "end": 10.0}),
    "Road.plot.psd": Door(ROUGH.plot.psd, {"start": 0.0, "end": 50.0}, also=ENDS),
    "Run.plot.envelope": Door(RUN.plot.envelope),
    "Run.plot.history": Door(RUN.plot.history),
    "Run.plot.impact_factors": Door(RUN.plot.impact_factors),
    "Run.plot.model": Door(RUN.plot.model),
    "Run.plot.model(time)": Door(RUN.plot.model, {"time": 0.1}),
    "Run.plot.vehicle": Door(RUN.plot.vehicle),
    "Vehicle.plot.model": Door(Q.plot.model),
    "compare_convergence": Door(
        plotting.compare_convergence, {"modes": [1, 2], "errors": {"moment": {"a": [1.0, 0.1]}}}
    ),
    "compare_impact_factors": Door(plotting.compare_impact_factors, {"runs": {"a": RUN}}),
}


def too_long(*_: object) -> None:
    raise TimeoutError


def fault_of(name: str, argument: str, value: object) -> str:
    """What is wrong with what a door does with an odd value, or nothing."""
    door = DOORS[name]
    start = time.process_time()
    before = signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, SOON)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            door.call(**{**door.given, argument: value})
    except TimeoutError:
        return "takes too long"
    except Exception as error:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        return fault_of_error(door, argument, error)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
    return "took too long" if time.process_time() - start > SOON else ""


def fault_of_error(door: Door, argument: str, error: Exception) -> str:
    """What is wrong with an error, or nothing."""
    said = f"{type(error).__name__}: {error}"
    allowed: tuple[type[Exception], ...] = (ValueError, TypeError, *door.raises)
    if not isinstance(error, allowed) or isinstance(error, UnicodeError):
        return f"raises {said[:SHORT]}"
    if isinstance(error, OSError):
        return ""
    names = (argument, *door.also.get(argument, "").split())
    whole_word = "|".join(rf"(?<![A-Za-z]){re.escape(each)}s?(?![A-Za-z])" for each in names)
    if not re.search(whole_word, str(error)):
        return f"names another: {said[:SHORT]}"
    return "" if len(said) <= SHORT else f"says too much, {len(said)} characters: {said[:SHORT]}"


def met(name: str) -> Iterator[tuple[str, str]]:
    """The arguments of a door, each with the odd values that it meets."""
    for k, argument in enumerate(DOORS[name].arguments):
        # Shifted from door to door and from argument to argument, so that every kind meets all.
        shift = 3 * k + 7 * [*DOORS].index(name)
        for odd in itertools.islice(ODD, shift % ONE_OF, None, ONE_OF):
            yield argument, odd


@pytest.mark.parametrize("name", DOORS)
def test_an_odd_value_works_or_is_refused_by_name(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = {
        f"{argument} = {odd}": fault
        for argument, odd in met(name)
        if (fault := fault_of(name, argument, ODD[odd]()))
    }
    assert not found


#: What is public and takes no arguments from users: results, warnings, types.
RESULTS: Final = {
    "CaseError",
    "Convergence",
    "Ensemble",
    "Envelope",
    "Extremes",
    "Failure",
    "ImpactFactors",
    "IriSegments",
    "IsoClass",
    "LiftOff",
    "Modes",
    "Preset",
    "Road",
    "Run",
    "Settlement",
}


def test_every_public_function_and_class_is_a_door() -> None:
    known = {name.split("(")[0].split(".")[0] for name in DOORS}
    for module in (sw, roads, vehicles, plotting):
        for name in module.__all__:
            each = getattr(module, name)
            plain = callable(each) and not (isinstance(each, type) and issubclass(each, Exception))
            if not plain or name in RESULTS or name.endswith("Plot") or not takes_any(each):
                continue
            assert name in known, f"{module.__name__}.{name} meets no odd values"


def takes_any(each: Callable[..., object]) -> bool:
    """Whether it takes arguments; a type alias takes none."""
    try:
        return len(inspect.signature(each).parameters) > 0
    except (TypeError, ValueError):
        return False


def forms(values: Any) -> dict[str, object]:
    """The same numbers as a list, a tuple and arrays of several kinds."""
    array = np.array(values, dtype=np.float64)
    wide = np.zeros((*array.shape[:-1], 2 * array.shape[-1]))
    wide[..., ::2] = array
    made: dict[str, object] = {
        "list": array.tolist(),
        "tuple": tuple(array.tolist()),
        "array": array,
        "Fortran order": np.asfortranarray(array),
        "strided": wide[..., ::2],
        "backwards": array[..., ::-1].copy()[..., ::-1],
        "float32": array.astype(np.float32),
        "read only": np.frombuffer(array.tobytes()).reshape(array.shape),
        "swapped": array.astype(">f8"),
        "objects": [np.float64(x) for x in values] if array.ndim == 1 else array.tolist(),
    }
    if (array == np.rint(array)).all() and abs(array).max() < 2**15:
        made |= {"ints": array.astype(int).tolist(), "int16": array.astype(np.int16)}
    return made


#: Arguments that take arrays, what they are given, and what they make, as plain arrays.
ARRAYS: Final[dict[str, tuple[Callable[[Any], object], list[Any]]]] = {
    "spans": (lambda v: sw.Bridge(spans=v, EI=1e9, mass=1e3).modes(3).omega, [18.0, 20.0]),
    "EI": (lambda v: sw.Bridge(spans=[18.0, 20.0], EI=v, mass=1e3).EI, [2.0**30, 2.0**31]),
    "point_masses": (
        lambda v: sw.Bridge(spans=[18.0], EI=1e9, mass=1e3, point_masses=v).masses,
        [[3.0, 1000.0], [4.5, 500.0]],
    ),
    "damping": (lambda v: sw.cross(B, Q, speed=20.0, modes=2, damping=v).moment, [0.125, 0.0625]),
    "damping matrix": (
        lambda v: sw.cross(B, Q, speed=20.0, modes=2, damping=v).moment,
        (8.0 * np.eye(6)).tolist(),
    ),
    "sections": (lambda v: sw.cross(B, Q, speed=20.0, damping=0.0, sections=v).moment, [4, 9, 20]),
    "loads": (lambda v: sw.ForceTrain(loads=v, spacings=[3.0]).static_loads(), [1e4, 2e4]),
    "elevation": (lambda v: ROUGH.elevation(v), [[0.0, 1.5, 3.0], [7.0, 9.0, 11.0]]),
    "profile": (
        lambda v: sw.Profile(v, [0.0, 2**-8, 2**-7, 0.0, 0.0]).elevation(1.5),
        [0.0, 1.0, 2.0, 3.0, 4.0],
    ),
    "speed": (
        lambda v: sw.ensemble(B, Q, samples=3, speed=v, damping=0.0).envelope("moment").max,
        [20.0, 21.0, 22.5],
    ),
    "kind": (
        lambda v: (
            sw.ensemble(
                B,
                [Q, vehicles.half_car()],
                samples=3,
                speed=20.0,
                damping=0.0,
                kind=np.asarray(v, int),
            )
            .envelope("moment")
            .max
        ),
        [1.0, 0.0, 1.0],
    ),
    "factors": (
        lambda v: (
            sw.ensemble(B, Q, samples=3, speed=20.0, damping=0.0, factors={"body_mass": v})
            .envelope("moment")
            .max
        ),
        [1.0, 0.5, 2.0],
    ),
    "influence line": (lambda v: B.influence_line("moment", 9.0, v), [[1.0, 2.5], [20.0, 3.0]]),
    "times": (lambda v: sw.Speeds(times=v, speeds=[4.0, 5.0]).times, [0.0, 2.0]),
}


@pytest.mark.parametrize("name", ARRAYS)
def test_the_form_of_an_array_does_not_matter(name: str) -> None:
    make, values = ARRAYS[name]
    expected = np.asarray(make(values))
    for form, each in forms(values).items():
        np.testing.assert_array_equal(np.asarray(make(each)), expected, form)
