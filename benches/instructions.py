"""Fails when a crossing takes more instructions than recorded: a measure that noise cannot blur.

Each case runs twice under callgrind, for some blocks of crossings and for twice as many: the
difference is what the crossings take, without what comes before and after them.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT = Path(__file__).resolve().parent.parent
BASELINE = ROOT / "benches" / "instructions.toml"

# As the benchmark's source has it.
ABSENT = 3

# How far a count may be off before the gate says so. Compiler and C library move it by less.
TOLERANCE = 0.03


@dataclass(frozen=True)
class Case:
    """What to run: the name the program knows it by, how many blocks, and whether by stages too."""

    id: str
    argument: str
    blocks: int
    stages: bool = False


# The stages of a crossing side by side with others, by the functions that take them.
STAGES: Final = {
    "draw_roads": "roads",
    "step_ahead": "approach",
    "step_on_bridge": "bridge",
    "take_in": "ends",
    "survey": "survey",
}
ROOM: Final = "spanwise::ensemble::group::"

CASES: Final = (
    Case("ensemble/kishan_1973/modes=3/baseline", "baseline", 2, stages=True),
    Case("ensemble/kishan_1973/modes=3/avx2", "avx2", 2, stages=True),
    Case("crossing/kishan_1973/modes=3", "crossing", 4),
    Case("ensemble/kinds of one sample", "kinds", 8),
    Case("crossing/the same trucks", "loop", 8),
)

# What may take no more than what.
NO_MORE = [("ensemble/kinds of one sample", "crossing/the same trucks")]


class Unusable(Exception):
    """What keeps the gate from counting."""


def program() -> Path:
    """Builds what is counted, as the other benchmarks are built."""
    command = [
        os.environ.get("CARGO", "cargo"),
        "bench",
        "--locked",
        "--bench",
        "instructions",
        "--no-run",
    ]
    built = subprocess.run(
        [*command, "--message-format=json"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True
    )
    for line in built.stdout.splitlines():
        message = json.loads(line)
        if message["reason"] == "compiler-artifact" and message["target"]["name"] == "instructions":
            return Path(message["executable"])
    raise Unusable("cargo built no program")


def compiler() -> str:
    """Version of the compiler, 1.95.0 or the like."""
    said = subprocess.run(["rustc", "--version"], cwd=ROOT, capture_output=True, text=True)
    return said.stdout.split()[1]


def by_stage(written: str) -> dict[str, int]:
    """Instructions of each stage, with all that it calls, from what callgrind wrote.

    A function begins with ``fn=`` and its name. Lines of a place and a number are its own
    instructions; such a line after ``calls=`` is what that call took in all.
    """
    counts = dict.fromkeys(STAGES.values(), 0)
    stage = None
    for line in written.splitlines():
        if line.startswith("fn="):
            _, own, name = line.partition(ROOM)
            stage = STAGES.get(re.split(r"\W", name)[0]) if own else None
        elif stage is not None and re.match(r"[\d+*-]", line):
            counts[stage] += int(line.split()[-1])
    return counts


def collected(binary: Path, case: Case, blocks: int) -> tuple[dict[str, int], int] | None:
    """Instructions of a whole run, by stage and in all, and its crossings.

    None if the processor cannot.
    """
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        raise Unusable("valgrind is not there: install it (apt-get install valgrind)")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "callgrind.out"
        run = subprocess.run(
            [
                valgrind,
                "--tool=callgrind",
                f"--callgrind-out-file={out}",
                "--compress-strings=no",
                str(binary),
                case.argument,
                str(blocks),
            ],
            capture_output=True,
            text=True,
        )
        if run.returncode == ABSENT:
            return None
        if run.returncode != 0:
            raise Unusable(f"{case.id} ended with {run.returncode}:\n{run.stderr[-2000:]}")
        written = out.read_text()
    total = re.search(r"^(?:summary|totals):\s*(\d+)", written, re.MULTILINE)
    if total is None:
        raise Unusable(f"{case.id}: callgrind wrote no total")
    counts = {case.id: int(total[1])}
    if case.stages:
        counts |= {f"{case.id}/{stage}": count for stage, count in by_stage(written).items()}
        if 0 in counts.values():
            raise Unusable(f"{case.id}: a stage is not among the functions of {ROOM}")
    return counts, int(run.stdout)


def measure() -> dict[str, int | None]:
    """Instructions per crossing by case; None where the processor cannot."""
    binary = program()
    counts: dict[str, int | None] = {}
    for case in CASES:
        runs = [collected(binary, case, blocks) for blocks in (case.blocks, 2 * case.blocks)]
        if runs[0] is None or runs[1] is None:
            stages = STAGES.values() if case.stages else ()
            counts |= dict.fromkeys([case.id, *(f"{case.id}/{stage}" for stage in stages)])
            continue
        (less, few), (more, many) = runs[0], runs[1]
        counts |= {name: round((more[name] - less[name]) / (many - few)) for name in more}
    return counts


def record(counts: dict[str, int | None]) -> None:
    """Writes the baseline; what this processor cannot count stays as it was."""
    old = tomllib.loads(BASELINE.read_text())["instructions"] if BASELINE.exists() else {}
    lines = [
        "# Instructions of the processor per crossing, recorded by `make instructions-record`.",
        "# A commit that raises a number says why.",
        "",
        f'rustc = "{compiler()}"',
        "",
        "[instructions]",
    ]
    for name, count in counts.items():
        kept = old.get(name) if count is None else count
        if kept is not None:
            lines.append(f'"{name}" = {kept:_}')
    BASELINE.write_text("\n".join(lines) + "\n")


def compare(counts: dict[str, int | None]) -> bool:
    """Prints every case beside its baseline; whether none takes too much."""
    baseline = tomllib.loads(BASELINE.read_text())
    recorded: dict[str, int] = baseline["instructions"]
    held = True
    for name, count in counts.items():
        if count is None:
            print(f"{name}: skipped, this processor does not have the instruction set")
            continue
        if name not in recorded:
            print(f"{name}: {count:_} instructions per crossing, but no baseline")
            held = False
            continue
        change = count / recorded[name] - 1.0
        line = f"{name}: {count:_} instructions per crossing, baseline {recorded[name]:_}"
        print(f"{line}, {100 * change:+.2f} %")
        if change > TOLERANCE:
            print(f"  FAILED: more than {100 * TOLERANCE:.0f} % above the baseline")
            held = False
        elif change < -TOLERANCE:
            print("  better: lower the baseline with `make instructions-record`")
    if not held:
        print(
            "If what it buys is worth it: `make instructions-record` makes today's numbers the\n"
            "baseline, and the commit that does so says why."
        )
        if baseline["rustc"] != compiler():
            print(f"The baseline is of rustc {baseline['rustc']}, this is {compiler()}.")
    for name, other in NO_MORE:
        mine, others = counts[name], counts[other]
        if mine is not None and others is not None and mine > others:
            print(f"{name}: {mine / others:.3f} times the instructions of {other}\n  FAILED: more")
            held = False
    return held


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--record", action="store_true", help="make the counts the baseline")
    arguments = parser.parse_args()
    try:
        counts = measure()
    except (Unusable, subprocess.CalledProcessError) as reason:
        print(f"instructions cannot be counted: {reason}", file=sys.stderr)
        return 1
    if arguments.record:
        record(counts)
    return 0 if compare(counts) else 1


if __name__ == "__main__":
    sys.exit(main())
