"""Bad input: a ValueError that names the key, the value and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import pytest

import spanwise as sw

nan, inf = float("nan"), float("inf")

AXLE: dict[str, Any] = {"position": 2.0, "tyre_stiffness": 2e6, "suspension_stiffness": 5e5}


def two_spans(**changes: Any) -> sw.Bridge:
    given = {"spans": [18.0, 18.0], "EI": 1.9e9, "mass": 6e3, "stations_per_span": 3}
    return sw.Bridge(**{**given, **changes})


def on_supports(**changes: Any) -> sw.Bridge:
    held = [(0.0, "pinned"), (20.0, "pinned")]
    return sw.Bridge(**{"length": 20.0, "supports": held, "EI": 1.9e9, "mass": 6e3, **changes})


def vehicle(**changes: Any) -> sw.Vehicle:
    axles = [sw.Axle(**AXLE), sw.Axle(**{**AXLE, "position": -2.0})]
    return sw.Vehicle(**{"mass": 20e3, "pitch_inertia": 6e4, "axles": axles, **changes})


def front_axle(**changes: Any) -> sw.Vehicle:
    axles = [sw.Axle(**{**AXLE, **changes}), sw.Axle(**{**AXLE, "position": -2.0})]
    return vehicle(axles=axles)


def cross(**changes: Any) -> sw.Run:
    return sw.cross(two_spans(), vehicle(), **{"speed": 20.0, "modes": 3, **changes})


def tractor(**changes: Any) -> sw.Vehicle:
    """A tractor whose trailer is changed."""
    axles = [sw.Axle(**AXLE), sw.Axle(**{**AXLE, "position": -2.0})]
    front = sw.Body(mass=6e3, pitch_inertia=9e3, axles=axles)
    given = {"mass": 20e3, "pitch_inertia": 9e4, "axles": [sw.Axle(**{**AXLE, "position": -3.0})]}
    hinge = sw.Hinge(to=0, at=-1.5, own=5.0)
    return sw.Vehicle(bodies=[front, sw.Body(**{**given, "hinge": hinge, **changes})])


def hinged(**changes: Any) -> sw.Vehicle:
    return tractor(hinge=sw.Hinge(**{"to": 0, "at": -1.5, "own": 5.0, **changes}))


def sprung(**changes: Any) -> sw.Vehicle:
    spring = sw.Spring(**{"to": 0, "at": -1.5, "own": 5.0, "stiffness": 1e6, **changes})
    return tractor(hinge=None, springs=[spring])


def train(**changes: Any) -> sw.ForceTrain:
    return sw.ForceTrain(**{"loads": [1e4, 2e4], **changes})


POSITIVE = "greater than 0"
NUMBER = "must be a number"
WHOLE = "must be a whole number"
PER_SPAN = "one for each of the 2 spans"
RATIO = "from 0 to below 1"
IN_SPAN = "must lie on the beam, 0 to 36 m"
ON_BEAM = "must lie on the beam, 0 to 20 m"

#: What is asked for, and what the message must contain: the key, the value, what is allowed.
BRIDGES: list[tuple[Callable[..., sw.Bridge], dict[str, Any], tuple[str, ...]]] = [
    *((two_spans, {"EI": bad}, ("EI", str(bad), POSITIVE)) for bad in (-1, 0, inf)),
    (two_spans, {"EI": nan}, ("EI", "NaN", POSITIVE)),
    (two_spans, {"EI": [1e9, nan]}, ("EI[1]", "NaN", POSITIVE)),
    (two_spans, {"EI": [1e9, 1e9, 1e9]}, ("EI", "3 values", PER_SPAN)),
    (two_spans, {"EI": []}, ("EI", "0 values", PER_SPAN)),
    (two_spans, {"mass": -1}, ("mass", "-1", "0 or more")),
    (two_spans, {"mass": nan}, ("mass", "NaN", "0 or more")),
    (two_spans, {"mass": inf}, ("mass", "inf", "finite")),
    (two_spans, {"mass": 0}, ("mass", "0", "must carry mass")),
    (two_spans, {"mass": [1e3, 1e3, 1e3]}, ("mass", "3 values", PER_SPAN)),
    (two_spans, {"spans": []}, ("spans", "[]", "at least one")),
    *(
        (two_spans, {"spans": [18.0, bad]}, ("spans[1]", str(bad), POSITIVE))
        for bad in (0, -1, inf)
    ),
    (two_spans, {"spans": [18.0, nan]}, ("spans[1]", "NaN", POSITIVE)),
    (two_spans, {"spans": [1e308, 1e308]}, ("spans", "inf", "finite")),
    (two_spans, {"spans": None}, ("spans", "length", "supports")),
    (two_spans, {"length": 36.0}, ("length", "not used with spans")),
    (two_spans, {"supports": [(0.0, "pinned")]}, ("supports", "not used with spans")),
    (two_spans, {"ends": ("roller", "pinned")}, ("ends[0]", "roller", "pinned, clamped or free")),
    (two_spans, {"ends": ("pinned",)}, ("ends", "('pinned',)", "pair")),
    (two_spans, {"ends": "pinned"}, ("ends", "'pinned'", "pair")),
    (two_spans, {"ends": ("free", "free")}, ("unstable", "pinned at 18 m", "two supports")),
    (two_spans, {"stations_per_span": 0}, ("stations_per_span", "0", "1 or more")),
    (two_spans, {"stations_per_span": -1}, ("stations_per_span", "-1", "not be negative")),
    (two_spans, {"stations_per_span": 2.5}, ("stations_per_span", "2.5", WHOLE)),
    (two_spans, {"stations_per_span": [3] * 3}, ("stations_per_span", "3 values", PER_SPAN)),
    (two_spans, {"stations_per_span": 10**7}, ("stations", "0000000", "at most 2000")),
    (two_spans, {"stations_per_span": 10**30}, ("stations_per_span", "1" + 30 * "0", "too large")),
    (two_spans, {"stations": [5.0, 25.0]}, ("stations", "stations_per_span", "one of the two")),
    (two_spans, {"point_masses": [(40.0, 1.0)]}, ("point_masses[0]", "40 m", IN_SPAN)),
    (two_spans, {"point_masses": [(4.0, -1.0)]}, ("point_masses[0] mass", "-1", POSITIVE)),
    (two_spans, {"point_masses": [(4.0, nan)]}, ("point_masses[0] mass", "NaN", POSITIVE)),
    (two_spans, {"point_masses": [4.0]}, ("point_masses[0]", "4.0", "pair")),
    (two_spans, {"point_masses": 4.0}, ("point_masses", "4.0", "list of pairs")),
    *((on_supports, {"length": bad}, ("length", str(bad), POSITIVE)) for bad in (0, -20, inf)),
    (on_supports, {"length": nan}, ("length", "NaN", POSITIVE)),
    (on_supports, {"ends": ("pinned", "free")}, ("ends", "spans only")),
    (on_supports, {"supports": []}, ("unstable", "fall", "two supports")),
    (on_supports, {"supports": [(0.0, "pinned")]}, ("unstable", "pinned at 0 m", "two supports")),
    (on_supports, {"supports": [(0.0, "pinned"), (21.0, "pinned")]}, ("[1]", "21 m", ON_BEAM)),
    (on_supports, {"supports": [(-1.0, "pinned"), (20.0, "pinned")]}, ("[0]", "-1 m", ON_BEAM)),
    (on_supports, {"supports": [(nan, "pinned"), (20.0, "pinned")]}, ("[0]", "NaN", ON_BEAM)),
    (on_supports, {"supports": [(5.0, "pinned"), (5.0, "pinned")]}, ("5 m and 5 m", "same")),
    *(
        (
            on_supports,
            {"supports": [(0.0, "pinned"), {"at": 9.0, key: bad}]},
            ("[1]", key, shown, "or"),
        )
        for key, bad, shown in (
            *(("vertical", bad, str(bad)) for bad in (0, -1000000, -inf)),
            *(("rotation", bad, str(bad)) for bad in (-1000000, -inf)),
            *((key, nan, "NaN") for key in ("vertical", "rotation")),
        )
    ),
    (on_supports, {"supports": [{"at": 9.0, "vertcal": 1e6}]}, ("supports[0]", "'vertical'")),
    (on_supports, {"supports": [{"vertical": 1e6}]}, ("supports[0]", "missing at")),
    (
        on_supports,
        {"supports": [sw.Support(at=9.0, vertical=1e6)]},
        ("unstable", "spring of", "rotate"),
    ),
    *(
        (on_supports, {"hinges": [bad]}, ("hinges[0]", str(bad), "inside the beam"))
        for bad in (0, 20, 25, -3, inf)
    ),
    (on_supports, {"hinges": [nan]}, ("hinges[0]", "NaN", "inside the beam")),
    (on_supports, {"hinges": [10.0]}, ("hinges[0]", "10 m", "mechanism")),
    (two_spans, {"hinges": [24.0, 30.0]}, ("hinges[1]", "30 m", "mechanism")),
    (two_spans, {"hinges": [9.0, 9.0]}, ("hinges", "9 m and 9 m", "same position")),
    (
        two_spans,
        {"ends": ("free", "clamped"), "hinges": [5.0]},
        ("hinges[0]", "5 m", "mechanism"),
    ),
    (
        on_supports,
        {"supports": [(0.0, "pinned"), (9.0, "clamped")], "hinges": [9.0]},
        ("hinges[0]", "9 m", "holds the rotation"),
    ),
    *(
        (on_supports, {key: {"at": at, "values": values}}, (f"{key} {what}", *said))
        for key in ("EI", "mass")
        for at, values, what, said in (
            ([0.0, 12.0, 8.0, 20.0], [1e9] * 3, "at[2]", ("8 m", "greater than", "12 m")),
            ([0.0, 8.0, 8.0, 20.0], [1e9] * 3, "at[2]", ("8 m", "greater than")),
            ([0.0, 8.0, 19.0], [1e9] * 2, "at[2]", ("19 m", "cover the beam")),
            ([1.0, 8.0, 20.0], [1e9] * 2, "at[0]", ("1 m", "cover the beam")),
            ([0.0, nan, 20.0], [1e9] * 2, "at[1]", ("NaN", "finite")),
            ([0.0], [1e9], "at", ("1 breakpoints", "2 to")),
            ([0.0, 8.0, 20.0], [1e9], "values", ("1 values", "2 values, constant", "or 3, linear")),
            ([0.0, 20.0], [1e9, -1.0], "values[1]", ("-1", "0")),
            ([0.0, 20.0], [1e9, nan], "values[1]", ("NaN", "finite")),
        )
    ),
    (
        on_supports,
        {"EI": {"at": [0.0, 20.0], "values": [1e9, 0.0]}},
        ("EI values[1]", "0", POSITIVE),
    ),
    *(
        (
            on_supports,
            {"EI": {"at": [0.0, 20.0], "values": [1e9, 2e9], "pieces": bad}},
            ("EI pieces", str(bad), "must"),
        )
        for bad in (0, -1, 5000, 1.5)
    ),
    (on_supports, {"EI": {"at": [0.0, 20.0], "value": [1e9]}}, ("EI", "'value'", "'values'")),
    (on_supports, {"supports": [(0.0, "fixed")]}, ("supports[0]", "fixed", "pinned or clamped")),
    (on_supports, {"supports": [0.0, 20.0]}, ("supports[0]", "0.0", "pair")),
    (on_supports, {"stations": []}, ("stations", "0 m to 20 m", "at least one station")),
    (on_supports, {"stations": [25.0]}, ("stations[0]", "25 m", ON_BEAM)),
    (on_supports, {"stations": [nan]}, ("stations[0]", "NaN", ON_BEAM)),
    (on_supports, {"stations": [15.0, 5.0]}, ("stations[1]", "5 m", "greater than", "15 m")),
    (on_supports, {"stations": [5.0, 5.0]}, ("stations[1]", "5 m", "greater than")),
]

LIMIT = "-1000 to 1000 N"
VEHICLES: list[tuple[Callable[..., object], dict[str, Any], tuple[str, ...]]] = [
    *((vehicle, {"mass": bad}, ("mass", str(bad), POSITIVE)) for bad in (0, -1, inf)),
    (vehicle, {"mass": nan}, ("mass", "NaN", POSITIVE)),
    *((vehicle, {"pitch_inertia": bad}, ("pitch_inertia", str(bad), POSITIVE)) for bad in (0, -1)),
    (vehicle, {"pitch_inertia": nan}, ("pitch_inertia", "NaN", POSITIVE)),
    (vehicle, {"cg_height": -1}, ("cg_height", "-1", "0 or more")),
    (vehicle, {"cg_height": nan}, ("cg_height", "NaN", "finite")),
    (vehicle, {"axles": []}, ("axles", "[]", "at least one axle")),
    (vehicle, {"axles": None}, ("axles", "None", "list of Axle")),
    (vehicle, {"axles": sw.Axle(**AXLE)}, ("axles", "Axle(position=2.0", "list of Axle")),
    (vehicle, {"axles": [AXLE]}, ("axles[0]", "'position': 2.0", "must be an Axle")),
    (vehicle, {"axles": [sw.Axle(**AXLE)]}, ("axles[0].position", "2 m", "must be 0")),
    *(
        (front_axle, {f"{part}_stiffness": bad}, (f"axles[0].{part}_stiffness", text, POSITIVE))
        for part in ("tyre", "suspension")
        for bad, text in ((0, "0"), (-1, "-1"), (inf, "inf"), (nan, "NaN"))
    ),
    (front_axle, {"friction_limit": -1}, ("axles[0].friction_limit", "-1", "0 or more")),
    (front_axle, {"friction_limit": nan}, ("axles[0].friction_limit", "NaN", "0 or more")),
    *(
        (
            front_axle,
            {"friction_limit": 1000, "initial_friction": bad},
            ("axles[0].initial_friction", f"{bad} N", LIMIT),
        )
        for bad in (1001, -1001)
    ),
    (front_axle, {"initial_friction": nan}, ("axles[0].initial_friction", "NaN", "finite")),
    (
        front_axle,
        {"friction_limit": inf, "initial_friction": inf},
        ("axles[0].initial_friction", "inf", "finite"),
    ),
    (front_axle, {"position": nan}, ("axles[0].position", "NaN", "finite")),
    *(
        (front_axle, {key: -1}, (f"axles[0].{key}", "-1", "0 or more"))
        for key in ("mass", "tyre_damping", "suspension_damping")
    ),
    *(
        (front_axle, {key: 0, "friction_limit": 9}, (f"axles[0].{key}", "0", POSITIVE))
        for key in ("stick_stiffness", "leaf_decay")
    ),
    (front_axle, {"stick_stiffness": 1, "leaf_decay": 1}, ("leaf_decay", "one of the two")),
    (front_axle, {"position": -3}, ("axles[1].position", "-2 m", "front to rear", "-3 m")),
    (front_axle, {"position": -2}, ("axles[1].position", "-2 m", "front to rear")),
    # Both axles are behind the centre of mass.
    (front_axle, {"position": -1}, ("axles[1].position", "-2 m", "centre of mass")),
    *(
        (front_axle, {key: bad}, (f"axles[0].{key}", text, "0 or more"))
        for key in ("mass", "tyre_damping", "suspension_damping")
        for bad, text in ((-1, "-1"), (nan, "NaN"), (inf, "inf"))
    ),
    (
        front_axle,
        {"mass": 700, "friction_limit": 1e3, "stick_stiffness": 1e7, "leaf_decay": 0.002},
        ("axles[0].stick_stiffness", "10000000", "leaf_decay = 0.002", "one of the two"),
    ),
    (
        front_axle,
        {"friction_limit": 1e3, "stick_stiffness": 1e7},
        ("axles[0].stick_stiffness", "10000000 N/m", "not for a massless axle"),
    ),
    *(
        (front_axle, {"mass": 700, "friction_limit": 1e3, key: bad}, (f"axles[0].{key}", POSITIVE))
        for key in ("stick_stiffness", "leaf_decay")
        for bad in (0, -1, nan, inf)
    ),
    (front_axle, {"friction_limit": inf, "leaf_decay": 0.01}, ("friction_limit", "inf", "finite")),
    (vehicle, {"bodies": 3}, ("bodies", "3", "list of Body")),
    (vehicle, {"bodies": [3]}, ("bodies[0]", "3", "must be a Body")),
    (vehicle, {"bodies": [sw.Body(mass=1, pitch_inertia=1)]}, ("mass", "20000", "not beside")),
    (sw.Vehicle, {}, ("missing mass, pitch_inertia, axles", "or bodies")),
    (sw.Vehicle, {"bodies": []}, ("missing mass, pitch_inertia, axles", "or bodies")),
    *((tractor, {"mass": bad}, ("bodies[1].mass", str(bad), POSITIVE)) for bad in (0, -1, inf)),
    (tractor, {"mass": "2"}, ("bodies[1].mass", "'2'", NUMBER)),
    (tractor, {"pitch_inertia": -1}, ("bodies[1].pitch_inertia", "-1", POSITIVE)),
    (tractor, {"axles": []}, ("bodies[1].axles", "0", "free to pitch")),
    (tractor, {"axles": AXLE}, ("axles", "list of Axle")),
    (tractor, {"hinge": 3}, ("hinge", "3", "must be a Hinge")),
    (tractor, {"springs": [3]}, ("springs[0]", "3", "must be a Spring")),
    (tractor, {"hinge": None}, ("bodies[1]", "uncoupled", "a hinge or springs")),
    (hinged, {"to": 1}, ("bodies[1].hinge.to", "1", "earlier body: 0")),
    (hinged, {"to": -1}, ("bodies[1].hinge.to", "-1", "not be negative")),
    (hinged, {"to": 0.5}, ("bodies[1].hinge.to", "0.5", WHOLE)),
    (hinged, {"own": nan}, ("bodies[1].hinge.own", "NaN", "finite")),
    (hinged, {"own": -5.0}, ("bodies[", "would carry no load")),
    (hinged, {"height": -1}, ("bodies[1].hinge.height", "-1", "0 or more")),
    (sprung, {"stiffness": 0}, ("bodies[1].springs[0].stiffness", "0", POSITIVE)),
    (sprung, {"damping": -1}, ("bodies[1].springs[0].damping", "-1", "0 or more")),
    (
        sprung,
        {"friction_limit": 1, "initial_friction": 2},
        ("bodies[1].springs[0].initial_friction", "2 N", "-1 to 1 N"),
    ),
    (train, {}, ("positions", "2 loads", "spacings")),
    (train, {"positions": [0.0]}, ("positions", "1 values", "each of the 2 loads")),
    (train, {"positions": [0.0, 1.0]}, ("positions[1]", "1 m", "front to rear", "0 m")),
    (train, {"positions": [1.0, 0.0], "spacings": [1.0]}, ("spacings", "not beside positions")),
    (train, {"spacings": [1.0, 2.0]}, ("spacings", "2 values", "one less than the 2 loads")),
    (train, {"spacings": [-1.0]}, ("spacings[0]", "-1 m", POSITIVE)),
    (train, {"spacings": [1.0], "loads": [1e4, -1.0]}, ("loads[1]", "-1", POSITIVE)),
    (train, {"loads": []}, ("loads", "[]", "at least one")),
]


def second_body(**changes: Any) -> sw.Vehicle:
    first = sw.Body(mass=4e3, pitch_inertia=4e3, axles=[sw.Axle(**AXLE), sw.Axle(**REAR)])
    given = {"mass": 4e3, "pitch_inertia": 4e3, "axles": [sw.Axle(**REAR)], **changes}
    return sw.Vehicle(bodies=[first, sw.Body(**given)])


REAR = {**AXLE, "position": -2.0}
HINGE = sw.Hinge(to=0, at=-3.0, own=3.0)
BODIES: list[tuple[Callable[..., sw.Vehicle], dict[str, Any], tuple[str, ...]]] = [
    (second_body, {}, ("bodies[1] = uncoupled", "needs a hinge or springs")),
    (second_body, {"hinge": 3}, ("hinge = 3", "must be a Hinge")),
    (second_body, {"hinge": sw.Hinge(to=1, at=0, own=0)}, ("bodies[1].hinge.to = 1", "earlier")),
    (second_body, {"hinge": HINGE, "mass": -1}, ("bodies[1].mass = -1", POSITIVE)),
    (
        second_body,
        {"springs": [sw.Spring(to=0, at=0, own=0, stiffness=-1)]},
        ("bodies[1].springs[0].stiffness = -1", POSITIVE),
    ),
]
TRAINS: list[tuple[Callable[..., object], dict[str, Any], tuple[str, ...]]] = [
    (sw.ForceTrain, {"loads": [1, -1], "spacings": [1]}, ("loads[1] = -1", POSITIVE)),
    (sw.ForceTrain, {"loads": [1, 1], "positions": [0, 1]}, ("positions[1] = 1 m", "less than 0")),
    (
        sw.ForceTrain,
        {"loads": [1, 1]},
        ("missing spacings", "one less than the 2 loads, or positions"),
    ),
    (sw.MovingMasses, {"masses": [1, 1], "spacings": [1, 1]}, ("spacings = 2 values", "one less")),
    (sw.MovingMasses, {"masses": [0]}, ("masses[0] = 0", POSITIVE)),
    (sw.vehicles.hs20, {"rear_spacing": 20}, ("rear_spacing = 20 m", "4.2672 to 9.144 m")),
    (sw.vehicles.flm4, {"lorry": 6}, ("lorry = 6", "1 to 5")),
]

STEADY = "constant-speed or constant-traction"
C = np.diag(np.full(6, 1e3))
CROSSINGS: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    *(({"speed": bad}, ("speed", str(bad), POSITIVE)) for bad in (0, -1, inf)),
    ({"speed": nan}, ("speed", "NaN", POSITIVE)),
    ({"speed": 1e-9}, ("speed", "1e-9 m/s", "at most 2000000")),
    ({"speed": 10**400}, ("speed", "too large")),
    ({"step": 1e-12}, ("step", "1e-12 s", "at most 2000000")),
    (
        {"tail": 1e9},
        (
            "tail = 1e9 s",
            "at most 2000000",
        ),
    ),
    (
        {"approach": 1e9},
        (
            "approach = 1e9 m",
            "at most 2000000",
        ),
    ),
    ({"modes": 0}, ("modes", "0", "1 to 6")),
    ({"modes": 7}, ("modes", "7", "1 to 6")),
    ({"modes": -1}, ("modes", "-1", "not be negative")),
    ({"modes": 10**30}, ("modes", "too large")),
    ({"drive": "constant_speed"}, ("drive", "constant_speed", STEADY)),
    ({"drive": "Constant-Speed"}, ("drive", "Constant-Speed", STEADY)),
    ({"drive": None}, ("drive", "None", STEADY)),
    ({"recovery": "force_summation"}, ("recovery", "force_summation", "or superposition")),
    ({"recovery": 3}, ("recovery", "3", "or superposition")),
    *(({"damping": bad}, ("damping", str(bad), RATIO)) for bad in (-0.1, 1, 1.5)),
    ({"damping": nan}, ("damping", "NaN", RATIO)),
    ({"damping": [0.01, -0.02, 0.01]}, ("damping", "-0.02", RATIO)),
    ({"damping": [0.01, 0.02]}, ("damping", "2 values", "each of the 3 modes")),
    ({"damping": []}, ("damping", "0 values", "each of the 3 modes")),
    ({"damping": C[:5, :5]}, ("damping", "5 x 5", "each of the 6 moving masses")),
    ({"damping": C[:, :5]}, ("damping", "6 x 5", "square")),
    ({"damping": C + np.eye(6, k=1)}, ("damping", "unsymmetric C", "must be symmetric")),
    ({"damping": -C}, ("damping", "-1.000e3", "no negative eigenvalue")),
    ({"damping": C * nan}, ("damping", "nan", "finite")),
    ({"damping": [[0.1, 0.2], [0.3]]}, ("damping", "[0.3]", "ratio", "matrix")),
    ({"damping": np.zeros((2, 2, 2))}, ("damping", "array", "ratio", "matrix")),
    *(({"beta": bad}, ("beta", str(bad), "from 1/12 to 1/2")) for bad in (0, 0.08, 0.51, -1)),
    ({"beta": nan}, ("beta", "NaN", "from 1/12 to 1/2")),
    *(({"step": bad}, ("step", str(bad), POSITIVE)) for bad in (0, -0.001, inf)),
    ({"step": nan}, ("step", "NaN", POSITIVE)),
    ({"approach": -1}, ("approach", "-1", "0 or more")),
    ({"approach": nan}, ("approach", "NaN", "0 or more")),
    ({"tail": -1}, ("tail", "-1", "0 or more")),
    ({"tail": inf}, ("tail", "inf", "finite")),
    ({"gravity": 0}, ("gravity", "0", POSITIVE)),
    ({"gravity": nan}, ("gravity", "NaN", POSITIVE)),
    *(({"mask": bad}, ("mask", str(bad), RATIO)) for bad in (-0.1, 1, nan)),
    ({"sections": []}, ("sections", "0 positions", "1 to 2000")),
    ({"sections": [40.0]}, ("sections[0]", "40 m", IN_SPAN)),
    ({"sections": [-1.0]}, ("sections[0]", "-1 m", IN_SPAN)),
    ({"sections": [nan]}, ("sections[0]", "NaN", IN_SPAN)),
    ({"sections": [9.0, 5.0]}, ("sections[1]", "5 m", "greater than", "9 m")),
    ({"sections": [9.0, 9.0]}, ("sections[1]", "9 m", "greater than")),
    ({"sections": np.linspace(0.0, 36.0, 2_001)}, ("sections", "2001", "1 to 2000")),
]

#: What is made, with what, and parts of the message.
Case: TypeAlias = tuple[Callable[..., object], dict[str, Any], tuple[str, ...]]

TABLES: dict[str, Sequence[Case]] = {
    "bridges": BRIDGES,
    "vehicles": VEHICLES,
    "bodies": BODIES,
    "trains": TRAINS,
    "crossings": [(cross, given, parts) for given, parts in CROSSINGS],
}


def refusal(make: Callable[..., object], *args: object, **given: object) -> str:
    """The message of the ValueError, or that there is none."""
    try:
        make(*args, **given)
    except ValueError as error:
        return str(error)
    return "is taken"


@pytest.mark.parametrize("table", TABLES)
def test_the_message_names_key_value_and_what_is_allowed(table: str) -> None:
    said = [(refusal(make, **given), given, parts) for make, given, parts in TABLES[table]]
    assert [case for case in said if not all(part in case[0] for part in case[2])] == []


#: What is no number. Text that could be read as one is no number either.
NO_NUMBERS = ["2.0", "abc", None, True, 1j, b"2", {"a": 1}, {2.0}, np.array([1j]), object()]


#: Where a number is asked for.
NUMBERS: list[tuple[Callable[..., object], str]] = [
    (two_spans, "EI"),
    (two_spans, "mass"),
    (vehicle, "mass"),
    (vehicle, "pitch_inertia"),
    (vehicle, "cg_height"),
    (front_axle, "position"),
    (front_axle, "tyre_stiffness"),
    (front_axle, "suspension_stiffness"),
    (front_axle, "friction_limit"),
    (front_axle, "initial_friction"),
    *((cross, key) for key in ("speed", "approach", "ramp", "tail", "beta", "gravity", "mask")),
    (cross, "damping"),
]


def test_numbers_must_be_numbers() -> None:
    defaults = ("approach", "ramp", "tail", "damping", "speed")
    for make, key in NUMBERS:
        for bad in NO_NUMBERS:
            if not (bad is None and key in defaults):
                said = refusal(make, **{key: bad})
                assert re.search(rf"{key}(\[0\])? = .*must be a number", said), (make, key, bad)
    said = refusal(cross, speed=None)
    assert "speed: missing; give it here or with every passage" in said


def test_lists_must_hold_numbers() -> None:
    lists = [(two_spans, "spans"), (on_supports, "stations"), (cross, "sections")]
    for make, key in lists:
        for bad in NO_NUMBERS:
            if bad is not None:
                said = refusal(make, **{key: bad})
                assert re.search(rf"{key}(\[0\])? = .*must be a number", said), (key, bad)
                said = refusal(make, **{key: [bad]})
                assert re.search(rf"{key}\[0\] = .*must be a number", said), (key, bad)


def test_numbers_of_modes_must_be_whole() -> None:
    for bad in ("3", True, 2.5, 1j, [3]):
        for said in (refusal(cross, modes=bad), refusal(two_spans().modes, bad)):
            assert re.search(r"modes = .*must be a whole number", said), bad


def test_long_values_are_cut_in_messages() -> None:
    with pytest.raises(ValueError, match="must be a number") as caught:
        cross(speed=list(range(10_000)))
    assert len(str(caught.value)) < 200


def test_numpy_is_welcome() -> None:
    bridge = sw.Bridge(
        spans=np.array([18.0, 18.0]),  # type: ignore[arg-type]
        EI=np.array([1.9e9, 1.9e9]),
        mass=np.array(6e3),
        stations_per_span=np.array([3, 3]),  # type: ignore[arg-type]
        point_masses=np.array([[4.0, 100.0]]),
    )
    given = {
        "speed": np.float32(20.0),
        "modes": np.int64(3),
        "damping": np.full(3, 0.01),
        "sections": np.array([4, 9]),
        "step": np.array(0.001),
    }
    run = sw.cross(bridge, vehicle(mass=np.int32(20_000)), **given)  # type: ignore[arg-type]
    same = sw.Bridge(
        spans=[18, 18], EI=1.9e9, mass=6e3, stations_per_span=3, point_masses=[(4, 100)]
    )
    plain = sw.cross(same, vehicle(), speed=20, modes=3, damping=0.01, sections=[4, 9], step=0.001)
    np.testing.assert_array_equal(
        run.envelope("moment").max.value, plain.envelope("moment").max.value
    )


def test_numbers_that_are_not_there() -> None:
    road = sw.ISO8608("A")
    with pytest.raises(ValueError, match=r"x = .*: must have no masked values"):
        road.elevation(np.ma.array([1.0, 2.0], mask=[True, False]))
    # Infinite where long doubles are doubles.
    with pytest.raises(ValueError, match=r"x\[1\] = .*: (is too large|must be finite)"):
        road.elevation(np.array(["1.0", "1e4000"], dtype=np.longdouble))


def test_wrong_objects() -> None:
    with pytest.raises(TypeError, match=r"path = 1\.5: must be a path"):
        sw.Ensemble.read(1.5)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="bridge = 1: must be a Bridge"):
        sw.cross(1, vehicle(), speed=20.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"vehicle = None: must be a Vehicle"):
        sw.cross(two_spans(), None, speed=20.0)  # type: ignore[arg-type]
    # As all that is not allowed, it knows its name, what it is and what is allowed.
    with pytest.raises(sw.InputError, match=r"road = 'C': must be a Road, such as") as caught:
        cross(road="C")
    assert (caught.value.key, caught.value.value) == ("road", "'C'")
    assert caught.value.allowed.startswith("must be a Road")


@pytest.mark.parametrize("forces", [(1.0,), (1.0, 2.0, 3.0), ()])
def test_initial_friction_needs_a_force_for_each_axle(forces: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"initial_friction = \(.*each of the 2 axles"):
        vehicle().with_initial_friction(*forces)


def test_influence_lines() -> None:
    cases: list[tuple[Any, Any, Any, tuple[str, ...]]] = [
        ("torque", 5.0, 1.0, ("quantity", "torque", "moment, shear-left")),
        (None, 5.0, 1.0, ("quantity", "None", "moment, shear-left")),
        ("moment", 40.0, 1.0, ("at", "40 m", IN_SPAN)),
        ("moment", nan, 1.0, ("at", "NaN", IN_SPAN)),
        ("moment", "5", 1.0, ("at", "'5'", NUMBER)),
        ("reaction", 5.0, 1.0, ("at", "5 m", "position of a support")),
        ("moment", 5.0, [1.0, nan], ("x", "nan", "finite")),
        ("moment", 5.0, "1", ("x", "'1'", NUMBER)),
        ("moment", 5.0, None, ("x", "None", NUMBER)),
        ("moment", 5.0, 1j, ("x", "1j", NUMBER)),
    ]
    for quantity, at, x, parts in cases:
        said = refusal(two_spans().influence_line, quantity, at, x)
        assert all(part in said for part in parts), (quantity, at, x, said)


def test_results_that_do_not_exist() -> None:
    run = cross()
    with pytest.raises(ValueError, match="quantity = 'momentum': must be one of deflection"):
        run.envelope("momentum")
    with pytest.raises(ValueError, match="ratio = 'max': must be one of extremes"):
        run.ratios("max")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="mask = 2: must be a fraction"):
        run.ratios(mask=2.0)
    with pytest.raises(ValueError, match="mask = '2': must be a number"):
        run.ratios(mask="2")  # type: ignore[arg-type]


# Limits


@pytest.mark.parametrize("beta", [1.0 / 12.0, 1.0 / 6.0, 0.2])
def test_the_step_may_go_up_to_the_stability_limit_that_the_message_tells(beta: float) -> None:
    with pytest.raises(ValueError, match="stable only for steps up to") as caught:
        cross(step=1.0, beta=beta)
    assert "step = 1 s" in str(caught.value)
    told = re.search(r"up to (\S+) s", str(caught.value))
    assert told is not None
    limit = float(told[1])
    # Newmark with gamma = 1/2 is stable up to omega h = (1/4 - beta)^(-1/2); omega is at least the
    # highest frequency of the bridge alone, and of the vehicle alone.
    fastest = max(*two_spans().modes(3).omega, *(2 * np.pi * vehicle().frequencies(locked=True)))
    assert limit <= 1.0 / (fastest * np.sqrt(0.25 - beta))
    run = cross(step=0.999 * limit, beta=beta)
    assert run.settings["step"] <= limit  # type: ignore[operator]
    # Below the limit the step is coarse, but nothing grows.
    assert np.abs(run.moment).max() < 10.0 * np.abs(run.static.moment).max()
    with pytest.raises(ValueError, match="stable only for steps up to"):
        cross(step=1.001 * limit, beta=beta)


def test_average_acceleration_has_no_stability_limit() -> None:
    run = cross(step=1.0, beta=0.25)
    assert np.isfinite(run.moment).all()


def test_histories_that_would_not_fit_are_refused() -> None:
    # Moments in 700 sections at 200 001 instants, dynamic and static, are 2.24 GB.
    run = cross(sections=np.linspace(0.0, 36.0, 700), step=1e-5, modes=1, tail=0.0)
    with pytest.raises(ValueError, match=r"sections = 700 positions at 200001 .*2\.2 GB") as caught:
        _ = run.moment
    assert "use fewer sections or a longer step" in str(caught.value)
    assert run.reactions.shape[1] == 3


#: Not typed, as users may be.
loose: Any = sw

#: Calls with a keyword misspelt, and what is meant.
MISSPELT: list[tuple[Callable[[], object], str, str]] = [
    (lambda: loose.cross(None, None, dampin=0.02), "dampin", "damping"),
    (lambda: loose.ensemble(None, None, sample=3), "sample", "samples"),
    (lambda: loose.Bridge(span=[20.0]), "span", "spans"),
    (lambda: loose.Bridge.from_modes(frequency=[1.0]), "frequency", "frequencies"),
    (lambda: loose.Axle(tire_stiffness=1e6), "tire_stiffness", "tyre_stiffness"),
    (lambda: loose.Vehicle(pitch_intertia=1e6), "pitch_intertia", "pitch_inertia"),
    (lambda: loose.ForceTrain(load=[1e5]), "load", "loads"),
    (lambda: loose.ISO8608("A", sed=3), "sed", "seed"),
    (lambda: loose.Profile.read("p.csv", column=1), "column", "columns"),
    (lambda: loose.Braking(decceleration=1.0), "decceleration", "deceleration"),
]


@pytest.mark.parametrize(("call", "given", "meant"), MISSPELT)
def test_a_keyword_misspelt_is_suggested(
    call: Callable[[], object], given: str, meant: str
) -> None:
    says = (
        rf"^[\w.]+\(\) got an unexpected keyword argument '{given}' \(did you mean '{meant}'\?\)$"
    )
    with pytest.raises(TypeError, match=says):
        call()


def test_what_goes_by_name_is_not_given_by_position() -> None:
    said = r"^cross\(\) takes bridge and vehicle by position and the rest by name: write speed=20$"
    with pytest.raises(TypeError, match=said):
        loose.cross(two_spans(), vehicle(), 20)
    with pytest.raises(TypeError, match=r"^Bridge\(\) takes all arguments by name: write spans=\["):
        loose.Bridge([18.0, 18.0], 2e9, 6e3)


def test_a_ratio_in_percent_is_written_as_a_ratio() -> None:
    for damping in (2, [0.01, 2.0, 0.02]):
        with pytest.raises(ValueError, match=r"damping = 2: .* below 1; for 2 % write 0\.02$"):
            cross(damping=damping)


def test_a_keyword_like_none_is_refused_as_it_is() -> None:
    with pytest.raises(TypeError, match=r"^cross\(\) got an unexpected keyword argument 'xyz'$"):
        loose.cross(None, None, xyz=1)
    with pytest.raises(TypeError, match="missing 2 required keyword-only arguments: 'EI' and 'm"):
        loose.Bridge(spans=[20.0])
