"""The figures: each is drawn for every kind of bridge, and says its units."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import matplotlib.figure
import numpy as np
import pytest
from matplotlib.axes import Axes

import spanwise as sw
from spanwise.plotting import compare_convergence, compare_impact_factors
from spanwise.plotting.envelope import branches
from spanwise.plotting.style import LINES
from spanwise.quantities import RESPONSES


@dataclass(frozen=True)
class Scene:
    """A bridge, a vehicle and its run."""

    bridge: sw.Bridge
    vehicle: sw.Vehicle
    run: sw.Run


def truck(*positions: float) -> sw.Vehicle:
    return sw.Vehicle(
        mass=8000.0 * len(positions),
        pitch_inertia=60_000.0,
        cg_height=0.0 if len(positions) == 1 else 1.5,
        axles=[
            sw.Axle(
                position=x,
                tyre_stiffness=3e6,
                suspension_stiffness=1e6,
                friction_limit=np.inf if k == 0 else 5e3,
            )
            for k, x in enumerate(positions)
        ],
    )


def scene(name: str) -> Scene:
    if name == "two spans":
        bridge = sw.Bridge(spans=[18.0, 18.0], EI=2e9, mass=6000.0, stations_per_span=3)
        vehicle = sw.vehicles.kishan_1973()
    elif name == "cantilever":
        bridge = sw.Bridge(spans=[10.0], ends=("clamped", "free"), EI=2e9, mass=5000.0)
        vehicle = truck(0.0)
    else:
        bridge = sw.Bridge(
            spans=[4.0, 20.0, 3.0],
            ends=("free", "free"),
            EI=[1e9, 2e9, 1e9],
            mass=[4000.0, 5000.0, 4000.0],
            stations_per_span=4,
        )
        vehicle = truck(5.0, 2.0, -2.0, -3.2)
    run = sw.cross(bridge, vehicle, speed=20.0, drive="constant-traction", step=2e-3)
    return Scene(bridge, vehicle, run)


@pytest.fixture(scope="module", params=["two spans", "cantilever", "overhangs"])
def drawn(request: pytest.FixtureRequest) -> Scene:
    return scene(request.param)


@pytest.fixture(scope="module")
def two_spans() -> Scene:
    return scene("two spans")


def labels(figure: matplotlib.figure.Figure) -> str:
    """All axis labels, shared ones too."""
    found = [figure.get_supxlabel(), figure.get_supylabel()]
    for ax in figure.axes:
        found += [ax.get_xlabel(), ax.get_ylabel()]
        found += [child.get_xlabel() for child in ax.child_axes]
    return " ".join(found)


#: What the figures laid out so far are made of.
LAID_OUT: set[tuple[object, ...]] = set()


def check(figure: matplotlib.figure.Figure, *units: str) -> None:
    """It is a figure that can be laid out and drawn, and its labels give these units."""
    assert isinstance(figure, matplotlib.figure.Figure)
    written = labels(figure)
    for unit in units:
        assert f"[{unit}]" in written, written
    # Of those with axes alike one is laid out; models differ from scene to scene, and are drawn.
    diagram = figure.get_supylabel() or any(ax.get_ylabel() for ax in figure.axes)
    axes = {(ax.get_xlabel(), len(ax.child_axes)) for ax in figure.axes}
    alike = (bool(diagram), len(figure.subfigs), *sorted(axes))
    if alike in LAID_OUT:
        figure.set_layout_engine("none")
    if alike not in LAID_OUT or not diagram:
        # Without pixels, which the figures of the command line have.
        figure.draw_without_rendering()
    LAID_OUT.add(alike)


def only_axes(figure: matplotlib.figure.Figure) -> Axes:
    (ax,) = figure.axes
    return ax


def test_bridge_models(drawn: Scene) -> None:
    for figure in (drawn.bridge.plot.model(), drawn.bridge.plot.basic_bridge()):
        check(figure, "m")


def test_letters_name_the_supports(drawn: Scene) -> None:
    written = [text.get_text() for text in only_axes(drawn.bridge.plot.model()).texts]
    for letter in "ABC"[: len(drawn.bridge.supports)]:
        assert letter in written


def test_basic_bridge_keeps_what_it_takes_away_as_open_circles(two_spans: Scene) -> None:
    ax = only_axes(two_spans.bridge.plot.basic_bridge())
    (circles,) = [line for line in ax.lines if line.get_markerfacecolor() == "white"]
    np.testing.assert_array_equal(np.asarray(circles.get_xdata()), [18.0])
    assert "B" not in [text.get_text() for text in ax.texts]


def test_modes_pass_through_their_dots(drawn: Scene) -> None:
    figure = drawn.bridge.plot.modes(2)
    check(figure, "m", "$10^{-3}$ kg$^{-1/2}$")
    assert len(figure.axes) == 2
    for ax in figure.axes:
        curve = next(line for line in ax.lines if len(np.asarray(line.get_xdata())) > 100)
        dots = next(line for line in ax.lines if line.get_marker() == "o")
        x, y = np.asarray(dots.get_xdata()), np.asarray(dots.get_ydata())
        along = np.interp(x, np.asarray(curve.get_xdata()), np.asarray(curve.get_ydata()))
        # The curve has 400 pieces; a chord misses a cubic by far less than this.
        np.testing.assert_allclose(along, y, atol=2e-3 * np.abs(y).max())


def test_influence_lines(drawn: Scene) -> None:
    plot, middle = drawn.bridge.plot, 0.4 * drawn.bridge.length
    check(plot.influence_line("deflection", middle), "m", "mm")
    check(plot.influence_line("slope", middle), "m", "mrad")
    check(plot.influence_line("moment", middle, structure="basic"), "m", "kN m")
    check(plot.influence_line("shear-left", middle), "m", "kN")
    check(plot.influence_line("shear-right", middle), "m", "kN")
    check(plot.influence_line("reaction", drawn.bridge.supports[0][0]), "m", "kN")


def test_influence_line_of_shear_jumps_by_the_load(two_spans: Scene) -> None:
    ax = only_axes(two_spans.bridge.plot.influence_line("shear-right", 7.0))
    curve = max(ax.lines, key=lambda line: len(np.asarray(line.get_xdata())))
    assert np.diff(np.asarray(curve.get_ydata())).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("name", ["quarter-car", "articulated-5-axle", "hs20-44", "hs20"])
def test_models_of_the_catalogue(name: str) -> None:
    check(sw.vehicles.PRESETS[name]().plot.model(), "m")


def test_vehicle_model(drawn: Scene) -> None:
    check(drawn.vehicle.plot.model(), "m")


def test_run_model(drawn: Scene) -> None:
    check(drawn.run.plot.model(), "m")
    check(drawn.run.plot.model(front_axle=1.0), "m")


@pytest.mark.parametrize("quantity", RESPONSES)
def test_envelopes_and_histories(drawn: Scene, quantity: str) -> None:
    unit = RESPONSES[quantity].shown[0]
    clamped = any(kind == "clamped" for _, kind in drawn.bridge.supports)
    if quantity == "clamp_moments" and not clamped:
        with pytest.raises(ValueError, match="holds the rotation"):
            drawn.run.plot.envelope(quantity)
        with pytest.raises(ValueError, match="holds the rotation"):
            drawn.run.plot.history(quantity)
        return
    check(drawn.run.plot.envelope(quantity), unit)
    # A history does not depend on where the supports are.
    if clamped or len(drawn.bridge.supports) > 2:
        check(drawn.run.plot.history(quantity), unit, "s", "m")


def test_sagging_moments_are_drawn_down(two_spans: Scene) -> None:
    for quantity in ("deflection", "moment"):
        assert only_axes(two_spans.run.plot.envelope(quantity)).yaxis.get_inverted()
    assert not only_axes(two_spans.run.plot.envelope("shear")).yaxis.get_inverted()


def test_envelope_draws_the_extremes(two_spans: Scene) -> None:
    envelope = two_spans.run.envelope("moment")
    ax = only_axes(two_spans.run.plot.envelope("moment"))
    curves = [np.asarray(line.get_ydata()) for line in ax.lines]
    for extremes in (envelope.max, envelope.min, envelope.static_max, envelope.static_min):
        expected = 1e-3 * extremes.value
        assert any(len(c) == len(expected) and np.allclose(c, expected) for c in curves)


def test_history_of_a_named_section(two_spans: Scene) -> None:
    run = two_spans.run
    column = int(np.flatnonzero(run.sections == 9.0)[0])
    ax = only_axes(run.plot.history("moment", 9.0))
    drawn = [np.asarray(line.get_ydata()) for line in ax.lines]
    assert any(np.array_equal(each, 1e-3 * run.moment[:, column]) for each in drawn)
    assert any(np.array_equal(each, 1e-3 * run.static.moment[:, column]) for each in drawn)


def test_sides_of_a_shear_differ_at_a_support(two_spans: Scene) -> None:
    run = two_spans.run
    sides: tuple[Literal["left", "right"], ...] = ("left", "right")
    for side in sides:
        ax = only_axes(run.plot.history("shear", 18.0, side=side))
        column = int(np.flatnonzero(run.sections == 18.0)[0])
        expected = 1e-3 * getattr(run, f"shear_{side}")[:, column]
        assert any(np.array_equal(np.asarray(line.get_ydata()), expected) for line in ax.lines)


def test_history_elsewhere_is_refused_with_what_is_near(two_spans: Scene) -> None:
    with pytest.raises(ValueError, match=r"nearest is at 9\b.*sections"):
        two_spans.run.plot.history("moment", 9.1)
    with pytest.raises(ValueError, match=r"nearest is at 2$"):
        two_spans.run.plot.history("axle_loads", 3)
    with pytest.raises(ValueError, match="must be one of left, right"):
        two_spans.run.plot.history("shear", 9.0, side="right-hand")  # type: ignore[arg-type]


@pytest.mark.parametrize("draw", ["envelope", "history"])
def test_unknown_quantity_is_refused_with_those_known(two_spans: Scene, draw: str) -> None:
    with pytest.raises(ValueError, match="must be one of deflection, moment"):
        getattr(two_spans.run.plot, draw)("bending")


def test_impact_factors_leave_masked_stretches_blank(drawn: Scene) -> None:
    figure = drawn.run.plot.impact_factors()
    check(figure)
    written = labels(figure)
    assert "[-]" in written
    assert "blank where the static value is at most 5 %" in written
    curve = next(line for line in figure.axes[0].lines if len(np.asarray(line.get_xdata())) > 2)
    np.testing.assert_array_equal(
        np.asarray(curve.get_ydata()), drawn.run.impact_factors.deflection
    )


def test_vehicle_motion(drawn: Scene) -> None:
    units = ["mm", "kN", "m/s", "s", "m"]
    check(drawn.run.plot.vehicle(), *units, *(["mrad"] if len(drawn.vehicle.axles) > 1 else []))


@dataclass(frozen=True)
class Traffic:
    """What crosses in both directions on a bad road, one of them braking to a stop."""

    run: sw.Run


@pytest.fixture(scope="module")
def traffic() -> Traffic:
    bridge = sw.Bridge(spans=[20.0, 20.0], EI=5e9, mass=8e3, stations_per_span=4)
    passages = [
        sw.Passage(vehicle=sw.vehicles.hs20_44()),
        sw.Passage(vehicle=sw.vehicles.t44(), direction="left", entry=0.5),
        sw.Passage(
            vehicle=sw.vehicles.kishan_1973(),
            speed=12.0,
            drive=sw.Braking(deceleration=4.0, start=2.0),
            lane=7,
        ),
    ]
    run = sw.cross(bridge, passages, speed=25.0, road=sw.ISO8608("D", seed=1), approach=40.0)
    assert run.lift_offs
    assert run.vehicles[2].stopped is not None
    return Traffic(run)


def test_models_of_traffic_are_drawn_lane_by_lane(traffic: Traffic) -> None:
    plot = traffic.run.plot
    # The first reaches the bridge after 1.6 s, the second 0.5 s later, the third after 3.3 s.
    figure = plot.model(time=3.4)
    check(figure, "m")
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["lane 0", "lane 1", "lane 7"]
    ax = matplotlib.figure.Figure().subplots()
    assert plot.model(time=3.4, ax=ax).axes == [ax]
    check(plot.model(), "m")
    with pytest.raises(ValueError, match=r"front_axle = 3\.0: of several vehicles give the time"):
        plot.model(front_axle=3.0)


def test_motions_of_traffic(traffic: Traffic) -> None:
    plot, run = traffic.run.plot, traffic.run
    first, second, third = (plot.vehicle(number) for number in (1, 2, 3))
    check(first, "mm", "mrad", "kN", "m")
    check(second, "mm", "kN", "m")
    check(third, "mm", "mrad", "kN", "m/s", "m")
    assert "Heave" not in labels(second)
    for figure in (first, second, third):
        assert "Road under\naxle 1 [mm]" in labels(figure)
    assert "bands: the wheel is off the road" in labels(first)
    # Heave, pitch, loads of three axles, road.
    bands = [len(ax.patches) for ax in first.axes]
    assert bands == [0, 0, *run.contact_loss.count[:3], 0]
    for bad in (0, 4):
        with pytest.raises(ValueError, match=f"number = {bad}: must be 1 to 3"):
            plot.vehicle(bad)


def test_axle_positions_on_top_of_those_that_come_back_or_stand(traffic: Traffic) -> None:
    run = traffic.run
    for number, to in ((2, -1.0), (3, 1.0)):
        (top,) = run.plot.vehicle(number).axes[0].child_axes
        position, _ = top._functions  # type: ignore[attr-defined]
        front = run.vehicles[number - 1].axle_positions[:, 0]
        np.testing.assert_allclose(position(run.time), front, atol=1e-3)
        assert np.all(to * np.diff(position(np.linspace(-1.0, 20.0, 50))) >= 0.0)


def test_axle_loads_of_traffic(traffic: Traffic) -> None:
    ax = only_axes(traffic.run.plot.envelope("axle_loads"))
    names = [text.get_text() for text in ax.get_xticklabels()]
    assert names == [f"{v}.{k}" for v, k in traffic.run.axles]
    ax = only_axes(traffic.run.plot.history("axle_loads", 1))
    assert ax.get_title(loc="right") == "vehicle 1 axle 1"
    assert len(ax.patches) == traffic.run.contact_loss.count[0]


@pytest.mark.parametrize(
    "road",
    [
        sw.ISO8608("C", seed=1),
        sw.ISO8608("A") + sw.Pothole(20.0, 1.0, 0.03),
        sw.Bump(10.0, 2.0, 0.02),
        sw.Smooth(),
        sw.Profile(np.arange(0.0, 60.0), 0.01 * np.sin(np.arange(60.0))),
    ],
    ids=lambda road: type(road).__name__,
)
def test_roads(road: sw.roads.Road) -> None:
    figure = road.plot()
    check(figure, "m", "mm", "cycle/m", "m$^3$")
    _, spectrum = figure.axes
    letters = [text.get_text() for text in spectrum.texts]
    assert letters == list("ABCDEFGH")
    check(road.plot.profile(5.0, 30.0), "m", "mm")
    check(road.plot.psd(5.0, 55.0), "cycle/m")
    with pytest.raises(ValueError, match="end = 5 m: must be finite and greater than start, 30 m"):
        road.plot.profile(30.0, 5.0)


def test_the_spectrum_lies_between_the_limits_of_its_class() -> None:
    _, ax = sw.ISO8608("C", seed=1).plot().axes
    lines = [(np.asarray(each.get_xdata()), np.asarray(each.get_ydata())) for each in ax.lines]
    limits = sorted(float(y[0] * (x[0] / 0.1) ** 2) for x, y in lines if len(x) == 2)
    # Between B and C, and between C and D.
    assert any(np.isclose(limits, 128e-6))
    assert any(np.isclose(limits, 512e-6))
    n, density = max(lines, key=lambda line: len(line[0]))
    levels = density * (n / 0.1) ** 2
    assert 128e-6 < np.median(levels) < 512e-6


def test_axle_positions_on_top_go_on_beyond_the_axis(two_spans: Scene) -> None:
    ax = only_axes(two_spans.run.plot.history("deflection"))
    (top,) = ax.child_axes
    position, instant = top._functions  # type: ignore[attr-defined]
    for t in (-1.0, 0.3, two_spans.run.time[-1] + 1.0):
        assert instant(position(t)) == pytest.approx(t, abs=1e-9)
    assert position(-1.0) == pytest.approx(-20.0)


def test_comparisons(two_spans: Scene) -> None:
    runs = {"force summation": two_spans.run, "again": two_spans.run}
    for factor in ("deflection", "sagging", "hogging", "shear"):
        check(compare_impact_factors(runs, factor), "m", "-")
    with pytest.raises(ValueError, match="at least one run"):
        compare_impact_factors({})
    with pytest.raises(ValueError, match="must be one of deflection, sagging"):
        compare_impact_factors(runs, "bending")
    errors = {"moment": {"a": [1e-1, 1e-2], "b": [1e-2, 0.0]}}
    check(compare_convergence([1, 2], errors, reference="all modes"), "-")


def test_shear_meets_its_supports_from_both_sides() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    y = np.array([4.0, 1.0, 5.0, 4.0, 1.0])
    sides = np.column_stack([y, y])
    sides[2] = 0.5, 5.0
    cut_x, cut_y = branches(x, y, sides, np.array([0.0, 2.0, 4.0]))
    np.testing.assert_array_equal(cut_x, [0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 4.0])
    np.testing.assert_array_equal(cut_y, [4.0, 1.0, 0.5, np.nan, 5.0, 4.0, 1.0])


@pytest.fixture(scope="module")
def hinged() -> sw.Run:
    bridge = sw.Bridge(spans=[20.0, 30.0, 20.0], hinges=[28.0], EI=4e9, mass=8e3)
    return sw.cross(bridge, truck(2.0, -2.0), speed=20.0, road=sw.ISO8608("B"), step=2e-3)


def rings(ax: Axes) -> list[float]:
    """Where open circles are."""
    lines = [each for each in ax.lines if each.get_markerfacecolor() == "white"]
    return [float(x) for each in lines for x in np.asarray(each.get_xdata())]


def test_hinges_are_rings(hinged: sw.Run) -> None:
    bridge = hinged.bridge
    for figure in (
        bridge.plot.modes(2),
        bridge.plot.influence_line("moment", 35.0),
        hinged.plot.envelope("shear"),
        bridge.settlement({20.0: 0.02}).plot(),
    ):
        check(figure, "m")
        for ax in figure.axes:
            assert rings(ax) == [28.0]


def test_road_where_wheels_pass(hinged: sw.Run) -> None:
    figure = hinged.plot.road()
    check(figure, "m", "mm")
    left, right = figure.axes[0].get_xlim()
    positions = hinged.vehicles[0].axle_positions
    assert left == pytest.approx(positions.min())
    assert right == pytest.approx(positions.max())


def test_what_says_nothing_is_not_drawn() -> None:
    bridge = sw.Bridge(spans=[20.0], EI=4e9, mass=8e3, stations_per_span=4)
    run = sw.cross(bridge, truck(2.0, -2.0), speed=20.0, drive="constant-speed", step=2e-3)
    figure = run.plot.vehicle()
    assert "m/s" not in " ".join(ax.get_ylabel() for ax in figure.axes)
    assert figure.axes[-1].get_xlabel() == "Time [s]; at 20 m/s throughout"
    hogging = run.plot.impact_factors().axes[2]
    assert "blank everywhere" in [text.get_text() for text in hogging.texts]


Draw = Callable[[Scene, Any], matplotlib.figure.Figure]

INTO_AXES: dict[str, Draw] = {
    "bridge": lambda s, ax: s.bridge.plot.model(ax=ax),
    "basic bridge": lambda s, ax: s.bridge.plot.basic_bridge(ax=ax),
    "influence line": lambda s, ax: s.bridge.plot.influence_line("moment", 5.0, ax=ax),
    "vehicle": lambda s, ax: s.vehicle.plot.model(ax=ax),
    "run": lambda s, ax: s.run.plot.model(ax=ax),
    "envelope": lambda s, ax: s.run.plot.envelope("moment", ax=ax),
    "history": lambda s, ax: s.run.plot.history("moment", ax=ax),
    "comparison": lambda s, ax: compare_impact_factors({"one": s.run}, ax=ax),
}
INTO_FIGURE: dict[str, Draw] = {
    "modes": lambda s, figure: s.bridge.plot.modes(2, figure=figure),
    "impact factors": lambda s, figure: s.run.plot.impact_factors(figure=figure),
    "motion": lambda s, figure: s.run.plot.vehicle(figure=figure),
}


@pytest.mark.parametrize("name", INTO_AXES)
def test_draws_into_given_axes(two_spans: Scene, name: str) -> None:
    figure = matplotlib.figure.Figure(layout="constrained")
    _, ax = figure.subplots(2, 1)
    assert INTO_AXES[name](two_spans, ax) is figure
    assert ax.has_data()
    check(figure)


@pytest.mark.parametrize("name", INTO_FIGURE)
def test_draws_into_a_given_part_of_a_figure(two_spans: Scene, name: str) -> None:
    figure = matplotlib.figure.Figure(layout="constrained")
    _, part = figure.subfigures(1, 2, squeeze=False)[0]
    assert INTO_FIGURE[name](two_spans, part) is figure
    assert part.axes
    check(figure)


def test_lines_are_told_apart_without_colour() -> None:
    assert len({str(line["linestyle"]) for line in LINES}) == len(LINES)
    assert len({line["color"] for line in LINES}) == len(LINES)


def test_style_is_left_behind(two_spans: Scene) -> None:
    before = dict(matplotlib.rcParams)
    two_spans.run.plot.envelope()
    assert dict(matplotlib.rcParams) == before


def test_a_notebook_shows_the_figure_without_pyplot(two_spans: Scene) -> None:
    figure: Any = two_spans.bridge.plot.model()
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_plots_need_neither_pyplot_nor_matplotlib_until_drawn(start: Any) -> None:
    script = """
import sys
import spanwise as sw
plot = sw.Bridge(spans=[10.0], EI=1e9, mass=1e3).plot
assert "matplotlib" not in sys.modules, "imported before anything is drawn"
plot.model()
assert "matplotlib.pyplot" not in sys.modules, "pyplot is imported"
"""
    done = start(script).wait()
    assert (done.returncode, done.stderr) == (0, "")


class Refusing:
    """An import finder by which there is no matplotlib."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> None:
        if name.partition(".")[0] == "matplotlib":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


@pytest.mark.parametrize("draw", ["envelope", "history", "ensemble"])
def test_limits_are_drawn_in_the_unit_of_the_axis(two_spans: Scene, draw: str) -> None:
    many = sw.ensemble(two_spans.bridge, two_spans.vehicle, samples=3, speed=20.0, modes=2)
    drawing: Any = many.plot.envelope if draw == "ensemble" else getattr(two_spans.run.plot, draw)
    without = drawing("moment").axes[0]
    ax = drawing("moment", limit=[1.5e6, -2e5]).axes[0]
    drawn = [line for line in ax.lines if line.get_linestyle() == ":"]
    assert [line.get_ydata()[0] for line in drawn] == [1500.0, -200.0]
    assert len(ax.lines) == len(without.lines) + 2
    assert "limit" in [text.get_text() for text in ax.get_legend().get_texts()]
    assert drawing("moment", limit=1.5e6).axes[0].get_ylim()[0] >= 1500.0
    with pytest.raises(ValueError, match=r"limit = 'a': must be"):
        drawing("moment", limit="a")


@pytest.fixture
def without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr("sys.meta_path", [Refusing(), *sys.meta_path])


@pytest.mark.usefixtures("without_matplotlib")
def test_without_matplotlib_the_error_names_the_extra(two_spans: Scene) -> None:
    with pytest.raises(ImportError, match=r"spanwise\[plot\]"):
        two_spans.bridge.plot.model()
    with pytest.raises(ImportError, match=r"spanwise\[plot\]"):
        compare_impact_factors({"one": two_spans.run})


def test_axle_loads_of_an_ensemble_are_not_along_the_bridge() -> None:
    bridge = sw.Bridge(spans=[18.0], EI=2e9, mass=6000.0, stations_per_span=3)
    many = sw.ensemble(bridge, truck(0.0), samples=2, speed=20.0, modes=2)
    with pytest.raises(ValueError, match=r"not drawn along .*plot\.impact_factors\('axle_loads'\)"):
        many.plot.envelope("axle_loads")
