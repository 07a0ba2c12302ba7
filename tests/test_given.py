"""Bridges given by their flexibility or their modes: fed with what a bridge reports, the same."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import spanwise as sw

Array = NDArray[np.float64]

#: The same crossing by two routes, relative to the largest value of its kind.
SAME = 1e-10

QUANTITIES = ("deflection", "moment", "shear_left", "shear_right", "reactions", "clamp_moments")


def crossing(bridge: sw.Bridge, sections: list[float], **changes: Any) -> sw.Run:
    settings = {"speed": 23.0, "modes": 3, "damping": 0.02, "step": 5e-3, "tail": 0.2}
    vehicle = sw.vehicles.kishan_1973()
    return sw.cross(bridge, vehicle, **{**settings, "sections": sections, **changes})


def apart(one: sw.Run, other: sw.Run, quantities: tuple[str, ...] = QUANTITIES) -> float:
    """Largest difference of two runs, relative to the largest value of its kind."""
    worst = 0.0
    for quantity in quantities:
        for a, b in ((one, other), (one.static, other.static)):
            ours, theirs = getattr(a, quantity), getattr(b, quantity)
            assert ours.shape == theirs.shape, quantity
            if ours.size:
                worst = max(worst, np.abs(ours - theirs).max() / np.abs(ours).max())
    return worst


BUILT = {
    "two spans": lambda: sw.Bridge(
        spans=[18.0, 22.0], EI=[1.9e9, 2.6e9], mass=6e3, stations_per_span=4
    ),
    "clamped, overhang": lambda: sw.Bridge(
        length=26.0,
        supports=[(0.0, "clamped"), (14.0, "pinned"), (22.0, "pinned")],
        EI=1.9e9,
        mass=6e3,
        stations_per_span=3,
    ),
    "springs, hinges, EI that varies": lambda: sw.Bridge(
        length=46.0,
        supports=[
            sw.Support(at=0.0, rotation=5e8),
            sw.Support(at=15.0, vertical=3e8, rotation=4e8),
            (32.0, "pinned"),
            sw.Support(at=46.0, vertical=2e8),
        ],
        hinges=[24.0],
        EI={"at": [0.0, 15.0, 30.0, 46.0], "values": [2e9, 4e9, 2e9, 1e9], "pieces": 3},
        mass={"at": [0.0, 15.0, 46.0], "values": [6e3, 9e3, 5e3]},
        stations_per_span=3,
    ),
}


def as_modes(bridge: sw.Bridge, sections: list[float], path: Array, *, by: str) -> sw.Bridge:
    """What the bridge reports, given again; the modal responses by masses or by shapes."""
    count = 4

    def both(read: Any) -> Array:
        return np.stack([read(side="left"), read(side="right")], axis=-1)

    places: dict[Any, list[float]] = dict.fromkeys(
        ("deflection", "moment", "shear-left", "shear-right"), sections
    )
    places["reaction"] = [x for x, _ in bridge.supports]
    if len(bridge.clamps):
        places["clamp-moment"] = bridge.clamps.tolist()

    def lines(quantity: Any, derivative: bool) -> Array:
        return np.stack(
            [
                both(
                    lambda side, at=at: bridge.influence_line(
                        quantity, at, path, derivative=derivative, side=side
                    )
                )
                for at in places[quantity]
            ]
        )

    masses = np.zeros(len(path))
    masses[[int(np.argmin(np.abs(path - x))) for x in bridge.stations]] = bridge.masses
    modes = bridge.modes(count)
    modal = None
    if by == "modal":
        momentum = bridge.masses[:, None] * modes.shapes * modes.omega**2
        modal = {}
        for quantity, at in places.items():
            # A mass on the section of a shear stands to the right of its left side.
            side: Any = "left" if quantity == "shear-right" else "right"
            read = [bridge.influence_line(quantity, x, bridge.stations, side=side) for x in at]
            modal[quantity] = np.array(read) @ momentum
    return sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=modes.frequencies.tolist(),
        shapes=both(lambda side: bridge.mode_shapes(count, path, side=side)),
        slopes=both(lambda side: bridge.mode_shapes(count, path, derivative=True, side=side)),
        sections=sections,
        supports=bridge.springs,
        influence={q: lines(q, False) for q in places},
        influence_slopes={q: lines(q, True) for q in places},
        modal=modal,
        masses=masses.tolist() if by == "masses" else None,
    )


@pytest.mark.parametrize("name", BUILT)
@pytest.mark.parametrize("by", ["masses", "modal"])
@pytest.mark.parametrize("recovery", ["force-summation", "force-summation-by-rates"])
def test_given_by_its_modes(name: str, by: str, recovery: str) -> None:
    bridge = BUILT[name]()
    sections = bridge.default_sections().tolist()
    path = np.unique(np.concatenate([bridge.nodes, sections]))
    path = path[np.append(True, np.diff(path) > 1e-9)]
    sections = [float(path[np.argmin(np.abs(path - x))]) for x in sections]
    given = as_modes(bridge, sections, path, by=by)
    one = crossing(bridge, sections, recovery=recovery)
    other = crossing(given, sections, recovery=recovery)
    found = apart(one, other)
    print(f"{name}: {found:.1e}")
    assert found <= SAME
    for quantity in ("deflection", "moment", "shear"):
        for each in ("max", "min"):
            a, b = (getattr(run.envelope(quantity), each).value for run in (one, other))
            assert_allclose(a, b, atol=SAME * np.abs(a).max())


def test_splines_in_place_of_slopes() -> None:
    """EI is constant: less its own kink or jump, every line is a natural spline."""
    bridge = sw.Bridge(spans=[18.0, 22.0], EI=1.9e9, mass=6e3, stations_per_span=4)
    path = np.union1d(np.linspace(0.0, 18.0, 41), np.linspace(18.0, 40.0, 41))
    sections = [0.0, 9.0, 18.0, float(path[60]), 40.0]
    of_sections = ("deflection", "moment", "shear-left", "shear-right")
    places: dict[Any, list[float]] = dict.fromkeys(of_sections, sections)
    places["reaction"] = [0.0, 18.0, 40.0]
    modes = bridge.modes(3)
    influence = {
        q: np.array([bridge.influence_line(q, at, path) for at in places[q]]) for q in places
    }
    momentum = bridge.masses[:, None] * modes.shapes * modes.omega**2
    modal = {
        q: np.array([bridge.influence_line(q, at, bridge.stations) for at in places[q]]) @ momentum
        for q in places
    }
    given = sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=modes.frequencies.tolist(),
        shapes=bridge.mode_shapes(3, path),
        sections=sections,
        supports=bridge.supports,
        influence=influence,
        modal=modal,
    )
    found = apart(crossing(bridge, sections), crossing(given, sections))
    print(f"by splines: {found:.1e}")
    assert found <= SAME


#: Supports of the basic bridge, redundants, and the bridge as a whole.
BASIC: dict[str, tuple[list[Any], list[Any], dict[str, Any]]] = {
    "two spans": ([(0.0, "pinned"), (40.0, "pinned")], [18.0], {}),
    "overhangs": ([(4.0, "pinned"), (35.0, "pinned")], [12.0, 22.0], {}),
    "cantilever, propped": ([(0.0, "clamped")], [20.0, 40.0], {}),
    "cantilever from the right": ([(40.0, "clamped")], [], {}),
    "on springs": (
        [sw.Support(at=0.0, vertical=2e8), (40.0, "pinned")],
        [sw.Support(at=18.0, vertical=3e8)],
        {"EI": sw.Along([0.0, 10.0, 40.0], [1.5e9, 3e9])},
    ),
}


@pytest.mark.parametrize("name", BASIC)
def test_given_by_its_flexibility(name: str) -> None:
    outer, redundants, changes = BASIC[name]
    layout = {"length": 40.0, "EI": 1.9e9, **changes}
    at = [each.at if isinstance(each, sw.Support) else each for each in redundants]
    held = [*outer, *(r if isinstance(r, sw.Support) else (r, "pinned") for r in redundants)]
    bridge = sw.Bridge(supports=held, mass=6e3, stations_per_span=3, **layout)
    basic = sw.Bridge(supports=outer, mass=6e3, stations_per_span=3, **layout)
    sections = bridge.default_sections()
    masses = dict(zip(bridge.stations, bridge.masses, strict=True))
    stations = sections.tolist()
    path = np.union1d(stations, basic.nodes)
    path = path[np.append(True, np.diff(path) > 1e-9)]
    stations = [float(path[np.argmin(np.abs(path - x))]) for x in stations]
    given = sw.Bridge.from_flexibility(
        length=40.0,
        supports=outer,
        stations=stations,
        masses=[sum(m for y, m in masses.items() if abs(x - y) < 1e-6) for x in stations],
        flexibility=basic.deflections(path, stations),
        slopes=basic.deflections(path, stations, derivative=True),
        path=path.tolist(),
        redundants=redundants,
    )
    assert (
        [x for x, _ in given.supports]
        == [x for x, _ in bridge.supports]
        == sorted([*at, *(each.at if isinstance(each, sw.Support) else each[0] for each in outer)])
    )
    assert_allclose(given.modes(3).frequencies, bridge.modes(3).frequencies, rtol=SAME)
    c = np.diag(50.0 + bridge.masses)
    for damping in (0.02, sw.Rayleigh(0.4, 1e-4), c):
        one, other = (crossing(each, stations, damping=damping) for each in (bridge, given))
        found = apart(one, other)
        print(f"{name}: {found:.1e}")
        assert found <= SAME


def test_the_paper_s_flexibility_needs_no_slopes() -> None:
    """Constant EI on end supports: the natural spline through stations and supports is exact."""
    bridge = sw.Bridge(spans=[18.288] * 2, EI=1.9415e9, mass=6037.6, stations_per_span=3)
    x, f = bridge.flexibility("basic")
    masses = np.zeros(len(x))
    masses[[0, 1, 2, 4, 5, 6]] = bridge.masses
    given = sw.Bridge.from_flexibility(
        length=bridge.length,
        supports=[(0.0, "pinned"), (bridge.length, "pinned")],
        stations=x.tolist(),
        masses=masses.tolist(),
        flexibility=f,
        redundants=[18.288],
    )
    sections = given.default_sections().tolist()
    assert_allclose(sections, [0.0, *x, bridge.length])
    found = apart(crossing(bridge, sections), crossing(given, sections))
    print(f"by splines: {found:.1e}")
    assert found <= SAME
    # Slopes at the stations alone do as well: the ends follow from the supports.
    basic = sw.Bridge(spans=[2 * 18.288], EI=1.9415e9, mass=1.0)
    again = sw.Bridge.from_flexibility(
        **{
            **given.arguments["from_flexibility"],
            "slopes": basic.deflections(x, x.tolist(), derivative=True),
        }
    )
    assert apart(crossing(bridge, sections), crossing(again, sections)) <= SAME


def test_what_it_was_given_without() -> None:
    bridge = BUILT["two spans"]()
    path = bridge.nodes
    given = sw.Bridge.from_modes(
        path=path.tolist(),
        frequencies=bridge.modes(2).frequencies.tolist(),
        shapes=bridge.mode_shapes(2, path),
        sections=[float(path[3])],
        influence={"deflection": bridge.deflections(path, [float(path[3])]).T},
    )
    assert given.missing == ["moment", "shear-left", "shear-right", "reaction", "slope"]
    run = crossing(given, [float(path[3])], modes=2)
    assert np.isfinite(run.deflection).all()
    assert np.isnan(run.envelope("moment").max.value).all()
    with pytest.raises(ValueError, match=r"moment.*without influence lines"):
        _ = run.moment
    with pytest.raises(ValueError, match=r"moment.*given with deflection only"):
        given.influence_line("moment", float(path[3]), path)
    with pytest.raises(ValueError, match=r"sections\[0\] = 1 m.*given at the sections"):
        crossing(given, [1.0], modes=2)
    with pytest.raises(ValueError, match=r"EI = unknown.*given by its"):
        _ = given.EI
    with pytest.raises(ValueError, match="settlement = unknown"):
        given.settlement([])
    with pytest.raises(ValueError, match=r"modes = 3.*the number of modes given"):
        given.modes(3)
    with pytest.raises(ValueError, match=r"damping = a matrix C.*ratios only"):
        crossing(given, [float(path[3])], modes=2, damping=np.eye(2))
    assert "2 modes given" in repr(given)
    assert run.to_dict()["settings"]["bridge"]["from_modes"]["sections"] == [float(path[3])]


def test_copies_are_the_same() -> None:
    bridge = BUILT["two spans"]()
    path = bridge.nodes
    given = as_modes(bridge, path.tolist(), path, by="masses")
    one = crossing(given, path.tolist())
    for again in (pickle.loads(pickle.dumps(given)), copy.deepcopy(given)):
        assert apart(one, crossing(again, path.tolist())) == 0.0
    again = sw.Bridge.from_modes(**one.to_dict()["settings"]["bridge"]["from_modes"])
    assert apart(one, crossing(again, path.tolist())) == 0.0


def by_flexibility(**changes: Any) -> sw.Bridge:
    x, f = sw.Bridge(spans=[20.0], EI=2e9, mass=6e3, stations_per_span=3).flexibility()
    given = {"length": 20.0, "supports": [(0, "pinned"), (20, "pinned")], "stations": x.tolist()}
    return sw.Bridge.from_flexibility(**{**given, "masses": [4e4] * 3, "flexibility": f, **changes})


def by_modes(**changes: Any) -> sw.Bridge:
    bridge = sw.Bridge(spans=[20.0], EI=2e9, mass=6e3, stations_per_span=3)
    path = bridge.nodes
    given = {
        "path": path.tolist(),
        "frequencies": bridge.modes(2).frequencies.tolist(),
        "shapes": bridge.mode_shapes(2, path),
        "sections": [10.0],
        "influence": {"moment": [bridge.influence_line("moment", 10.0, path)]},
        "masses": [0.0, 4e4, 4e4, 4e4, 0.0],
    }
    return sw.Bridge.from_modes(**{**given, **changes})


def test_the_examples_of_bad_input_are_good() -> None:
    by_flexibility()
    by_modes()


F = np.array([[3.0, 2.0, 1.0], [2.0, 4.0, 2.0], [1.0, 2.0, 3.0]]) * 1e-8


@pytest.mark.parametrize(
    ("make", "changes", "words"),
    [
        (by_flexibility, {"flexibility": F + np.triu(F)}, ("flexibility", "symmetric")),
        (by_flexibility, {"flexibility": F[:2]}, ("flexibility", "2 x 3", "3 x 3")),
        (by_flexibility, {"flexibility": F * np.nan}, ("flexibility", "finite")),
        (by_flexibility, {"flexibility": -F}, ("flexibility", "lift")),
        (by_flexibility, {"flexibility": F[0]}, ("flexibility", "2 dimensions")),
        (by_flexibility, {"slopes": F[:2]}, ("slopes", "2 x 3", "3 x 3")),
        (by_flexibility, {"masses": [1.0]}, ("masses", "1 values", "3 stations")),
        (by_flexibility, {"masses": [1.0, -1.0, 1.0]}, ("masses[1]", "-1", "0 or more")),
        (by_flexibility, {"masses": [0.0] * 3}, ("masses", "at least one station")),
        (by_flexibility, {"stations": [1.0, 3.0, 2.0]}, ("stations[2]", "2 m", "greater")),
        (by_flexibility, {"path": [1.0, 2.0, 3.0]}, ("stations[0]", "point of the path")),
        (by_flexibility, {"redundants": [5.0]}, ("redundants[0]", "5 m", "one of the stations")),
        (
            by_flexibility,
            {"redundants": [sw.Support(at=10.0, vertical=-1.0)]},
            ("redundants[0] vertical", "-1", "greater than 0"),
        ),
        (
            by_flexibility,
            {"redundants": [sw.Support(at=10.0, rotation=1e6)]},
            ("redundants[0] rotation", "must be 0"),
        ),
        (by_flexibility, {"supports": [(0.0, "clamped"), (20.0, "pinned")]}, ("determinate",)),
        (by_flexibility, {"supports": [(0.0, "pinned")]}, ("unstable", "rotate")),
        (
            by_flexibility,
            {"supports": [(0.0, "pinned"), sw.Support(at=20.0, vertical=1e8)]},
            ("path", "supports[1]", "spring"),
        ),
        (
            by_flexibility,
            {"supports": [(0.0, "pinned"), (18.0, "pinned")], "slopes": F},
            ("path", "18 m", "supports[1]", "slopes"),
        ),
        (by_modes, {"frequencies": [2.0, 1.0]}, ("frequencies[1]", "1 Hz", "2 Hz")),
        (by_modes, {"frequencies": [2.0, -1.0]}, ("frequencies[1]", "-1", "greater than 0")),
        (by_modes, {"frequencies": [2.0]}, ("shapes", "5 x 2", "5 x 1")),
        (by_modes, {"path": [0.0, 5.0, 20.0]}, ("shapes", "5 x 2", "3 x 2")),
        (by_modes, {"path": [1.0, 5.0, 8.0, 10.0, 20.0]}, ("path[0]", "begin at 0")),
        (by_modes, {"sections": [7.0]}, ("sections[0]", "7 m", "point of the path")),
        (by_modes, {"masses": [0.0, 8e4, 8e4, 8e4, 0.0]}, ("masses", "2.0", "unit modal mass")),
        (by_modes, {"masses": [1.0]}, ("masses", "1 values", "5 points")),
        (by_modes, {"masses": None}, ("modal moment", "response of each mode")),
        (by_modes, {"influence": {}}, ("influence", "one response or more")),
        (by_modes, {"influence": {"momment": [[0.0]]}}, ("influence", "'moment'")),
        (by_modes, {"influence": {"moment": [[0.0]]}}, ("influence moment", "1 x 1", "1 x 5")),
        (
            by_modes,
            {"influence": {"shear-left": np.zeros((1, 5))}},
            ("shear", "both shear-left and shear-right"),
        ),
        (by_modes, {"modal": {"deflection": [[1.0]]}}, ("modal", "'deflection'", "influence")),
        (by_modes, {"modal": {"moment": [[1.0]]}}, ("modal moment", "1 x 1", "1 x 2")),
        (by_modes, {"shapes": np.zeros((5, 2))}, ("shapes", "zero")),
        (by_modes, {"shapes": np.zeros((5, 2, 2)) + 1e-3}, ("shapes", "both sides", "slopes")),
    ],
)
def test_refusals(make: Any, changes: dict[str, Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ValueError, match=r".") as raised:
        make(**changes)
    for each in words:
        assert each in str(raised.value), f"{each!r} not in {raised.value}"


def imported(**changes: Any) -> sw.Bridge:
    """A simple span with lines of deflection, by a third of its modes."""
    bridge = sw.Bridge(spans=[20.0], EI=2e9, mass=6e3, stations_per_span=9)
    path = np.unique(np.append(bridge.nodes, 10.0))
    path = path[np.append(True, np.diff(path) > 1e-9)]
    given = {
        "path": path.tolist(),
        "frequencies": bridge.modes(3).frequencies,
        "shapes": bridge.mode_shapes(3, path),
        "sections": path.tolist(),
        "influence": {"deflection": bridge.deflections(path, path.tolist()).T},
    }
    for key, change in changes.items():
        given[key] = change(given[key])
    return sw.Bridge.from_modes(**given)


def test_modes_and_lines_of_deflection_are_of_one_bridge() -> None:
    imported()
    # What two digits do.
    imported(frequencies=lambda f: np.round(f, 1), shapes=lambda shapes: np.round(shapes, 4))
    with pytest.raises(ValueError, match=r"influence deflection = -.*positive down: change"):
        imported(influence=lambda lines: {"deflection": -lines["deflection"]})
    # Largest ordinate 1; unit modal mass in tonnes.
    for scale in (lambda shapes: shapes / shapes.max(axis=0), lambda shapes: 31.6 * shapes):
        with pytest.raises(ValueError, match=r"shapes: the modes alone.*not scaled to unit modal"):
            imported(shapes=scale)
    with pytest.raises(ValueError, match=r"shapes: .*frequencies are too low"):
        imported(frequencies=lambda f: f / (2.0 * np.pi))
    with pytest.warns(UserWarning, match=r"frequencies: the modes explain at most 2.5 %.*rad/s"):
        imported(frequencies=lambda f: 2.0 * np.pi * f)
