"""Keeps the figures of benchmark runs in benches/history.csv, and draws them commit by commit.

Times and rates are criterion's medians of the run just made, as `make bench-record` makes one;
shares of the peak come from the benchmark of the ensemble, instructions from their gate.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import os
import platform
import statistics
import subprocess
import sys
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import instructions
from matplotlib import colormaps
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parent.parent
HISTORY = ROOT / "benches" / "history.csv"
CRITERION = ROOT / "target" / "criterion"
SHARES = ROOT / "target" / "tmp" / "share.json"

INSTRUCTION_SETS = ("baseline", "avx2", "avx512")

COLUMNS = 4


@dataclass(frozen=True)
class Figured:
    """One figure of one run: a row of the file."""

    date: str
    commit: str
    processor: str
    instruction_set: str
    benchmark: str
    median: float
    unit: str


def git(*arguments: str) -> str:
    return subprocess.run(
        ["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.strip()


def commit() -> str:
    """The commit in short, with a plus if the tree is not as committed."""
    changed = git("status", "--porcelain", "-uno", "--", ".", f":!{HISTORY.relative_to(ROOT)}")
    return git("rev-parse", "--short=9", "HEAD") + ("+" if changed else "")


def processor() -> str:
    """What the machine says of its processor."""
    described = Path("/proc/cpuinfo")
    if described.exists():
        keys = ("model name", "cpu family", "model")
        said: dict[str, str] = {}
        for line in described.read_text().splitlines():
            key, _, value = line.partition(":")
            said.setdefault(key.strip(), value.strip())
        if "model name" in said:
            name, family, model = (said.get(key, "?") for key in keys)
            # Clouds hide the name; family and model tell generations apart.
            return f"{name} (family {family}, model {model})"
    return platform.processor() or platform.machine()


def measured(since: float) -> dict[str, tuple[float, str]]:
    """What criterion measured since a moment: median and unit by benchmark id."""
    found = {}
    for path in CRITERION.rglob("new/estimates.json"):
        if path.stat().st_mtime < since:
            continue
        described = json.loads((path.parent / "benchmark.json").read_text())
        nanoseconds = json.loads(path.read_text())["median"]["point_estimate"]
        name = described["full_id"]
        match described["throughput"]:
            case {"Elements": elements}:
                unit = "flop/s" if name.startswith("peak/") else "1/s"
                found[name] = (1e9 * elements / nanoseconds, unit)
            case _:
                found[name] = (1e-9 * nanoseconds, "s")
    return found


def busy() -> bool:
    """Whether the machine had more to do than the benchmarks, which fill all cores at most."""
    return os.getloadavg()[1] > (os.cpu_count() or 1) + 0.5


def run(since: float, *, anyway: bool) -> list[Figured]:
    """All figures of the run just made; without times and rates if the machine was busy."""
    figures: dict[str, tuple[float, str]] = {}
    if busy() and not anyway:
        print(
            f"The machine was busy with other work (load {os.getloadavg()[1]:.1f}):"
            " instructions are recorded, times are not (--anyway takes them too).",
            file=sys.stderr,
        )
    else:
        figures = measured(since)
        if not figures:
            sys.exit("nothing was measured since the last commit: `make bench-record` does it")
        if SHARES.exists() and SHARES.stat().st_mtime >= since:
            for name, share in json.loads(SHARES.read_text()).items():
                figures[f"share-of-peak/ensemble/kishan_1973/modes=3/{name}"] = (share, "%")
    for name, count in instructions.measure().items():
        if count is not None:
            figures[f"instructions/{name}"] = (float(count), "1")
    when = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
    what = (commit(), processor())
    rows = []
    for name, (median, unit) in sorted(figures.items()):
        sets = [part for part in name.split("/") if part in INSTRUCTION_SETS]
        rows.append(Figured(when, *what, sets[0] if sets else "", name, median, unit))
    return rows


def append(rows: list[Figured]) -> None:
    new = not HISTORY.exists()
    with HISTORY.open("a", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if new:
            writer.writerow(field.name for field in fields(Figured))
        for row in rows:
            writer.writerow(f"{v:.8g}" if isinstance(v, float) else v for v in astuple(row))


def read() -> list[Figured]:
    with HISTORY.open(newline="") as file:
        return [
            Figured(**{**row, "median": float(row["median"])})  # type: ignore[arg-type]
            for row in csv.DictReader(file)
        ]


def draw(rows: list[Figured], path: Path) -> None:
    """One panel for each benchmark, one line for each processor."""
    commits = list(dict.fromkeys(row.commit for row in sorted(rows, key=lambda row: row.date)))
    processors = list(dict.fromkeys(row.processor for row in rows))
    benchmarks = sorted({row.benchmark for row in rows})
    lines = -(-len(benchmarks) // COLUMNS)
    figure = Figure(figsize=(3.4 * COLUMNS, 1.9 * lines + 0.6), layout="constrained")
    panels = figure.subplots(lines, COLUMNS, squeeze=False, sharex=True).flat
    for index, (panel, name) in enumerate(zip(panels, benchmarks, strict=False)):
        own = [row for row in rows if row.benchmark == name]
        for number, kind in enumerate(processors):
            color = colormaps["tab10"](number % 10)
            by_commit = {
                place: [r.median for r in own if r.processor == kind and r.commit == commit]
                for place, commit in enumerate(commits)
            }
            points = [(place, value) for place, all_ in by_commit.items() for value in all_]
            middle = [(place, statistics.median(all_)) for place, all_ in by_commit.items() if all_]
            if points:
                panel.plot(*zip(*points, strict=True), ".", color=color, alpha=0.5)
                panel.plot(*zip(*middle, strict=True), "-", color=color, lw=1, label=kind)
        scale, prefix = scaled(max(row.median for row in own), own[0].unit)
        panel.yaxis.set_major_formatter(lambda value, _, scale=scale: f"{value / scale:.4g}")
        panel.set_ylim(0.0, 1.15 * max(row.median for row in own))
        panel.set_ylabel(prefix, fontsize=7)
        panel.set_title(wrapped(name), fontsize=7)
        panel.set_xlim(-0.5, len(commits) - 0.5)
        panel.set_xticks(range(len(commits)), commits, rotation=90, fontsize=6)
        panel.tick_params(axis="y", labelsize=7)
        panel.tick_params(axis="x", labelbottom=index + COLUMNS >= len(benchmarks))
        panel.grid(alpha=0.3)
    for panel in list(figure.axes)[len(benchmarks) :]:
        panel.remove()
    handles = {
        label: handle
        for panel in figure.axes
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)
    }
    figure.legend(
        handles.values(), handles.keys(), loc="outside lower center", fontsize=7, frameon=False
    )
    figure.savefig(path, dpi=110)


def scaled(value: float, unit: str) -> tuple[float, str]:
    """A power of a thousand that suits a value, and the unit with it."""
    if unit == "%":
        return 1.0, "%"
    name = {"1": "instructions", "1/s": "per second"}.get(unit, unit)
    for scale, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ")):
        if value >= scale:
            gap = " " if len(name) > 6 and prefix else ""
            return scale, prefix + gap + name
    return 1e-9, "n" + name


def wrapped(name: str) -> str:
    """An id over two lines, broken after a slash."""
    if len(name) < 42:
        return name
    cut = name.index("/", len(name) // 3) + 1
    return f"{name[:cut]}\n{name[cut:]}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--append", action="store_true", help="take in the run just made")
    parser.add_argument("--anyway", action="store_true", help="times of a busy machine too")
    parser.add_argument("--plot", type=Path, metavar="PNG", help="draw all runs")
    arguments = parser.parse_args()
    if arguments.append:
        # What criterion measured before the commit was not measured of it.
        since = float(git("log", "-1", "--format=%ct"))
        append(run(since, anyway=arguments.anyway))
    if arguments.plot:
        draw(read(), arguments.plot)


if __name__ == "__main__":
    main()
