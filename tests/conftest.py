"""What several files of tests need: to compare ensembles with crossings, and to start processes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TypeAlias

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import spanwise as sw
from spanwise.quantities import factors

Same: TypeAlias = Callable[[sw.Ensemble, int, sw.Run], None]


def last_on(run: sw.Run) -> int:
    """The instant by which the last axle has left; the last one where a vehicle stands there."""
    if run._core.reach("deflection") is None:
        return len(run.time) - 1
    ended = run.time[-1] - run.tail
    return int(np.searchsorted(run.time, ended - 1e-9))


def check_same(ensemble: sw.Ensemble, sample: int, run: sw.Run) -> None:
    """All that both give is equal to the bit, or differs by rounding where sums are made anew."""
    for name in (*ensemble.quantities, "axle_loads"):
        of_all, alone = ensemble.envelope(name), run.envelope(name)
        axles = len(alone.x)
        for side in ("max", "min"):
            extremes, at_rest = getattr(alone, side), getattr(alone, f"static_{side}")
            assert_array_equal(getattr(of_all, side)[sample, :axles], extremes.value, name)
            assert_array_equal(getattr(of_all, f"{side}_time")[sample, :axles], extremes.time, name)
            at = getattr(of_all, f"{side}_position")[sample, :axles]
            assert_array_equal(at, extremes.position, name)
            static = np.atleast_2d(getattr(of_all, f"static_{side}"))
            own = static[sample if len(static) > 1 else 0]
            assert_array_equal(own[:axles], at_rest.value, name)
            assert np.isnan(getattr(of_all, side)[sample, axles:]).all()
    for factor, (of, _) in factors().items():
        if of in ensemble.responses:
            expected = getattr(run.impact_factors, factor)
            found = ensemble.impact_factors[factor][sample, : len(expected)]
            assert_array_equal(found, expected, factor)
    axles = len(run.static_axle_loads)
    assert_array_equal(ensemble.contact_loss.count[sample, :axles], run.contact_loss.count)
    off = ensemble.contact_loss.total[sample, :axles]
    np.testing.assert_allclose(off, run.contact_loss.total, rtol=1e-9, atol=1e-12)
    accelerations = ensemble.body_accelerations.max[sample]
    bodies = [body for vehicle in run.vehicles for body in vehicle.bodies]
    until = slice(None, last_on(run) + 1)
    for found, body in zip(accelerations, bodies, strict=False):
        expected = np.abs(body.heave.acceleration[until]).max()
        np.testing.assert_allclose(found, expected, rtol=1e-9)
    # About the static loads: what is left of their differences by rounding is squared.
    deviations = run.axle_loads / run.static_axle_loads - 1.0
    axle, of_bodies = 0, []
    for vehicle in run.vehicles:
        x = vehicle.axle_positions
        on = ((x >= -1e-9) & (x <= run.bridge.length + 1e-9)).any(axis=1)
        first, last = np.flatnonzero(on)[[0, -1]]
        there, own = slice(first, last + 1), slice(axle, axle + x.shape[1])
        axle += x.shape[1]
        coefficients = np.sqrt((deviations[there, own] ** 2).mean(axis=0))
        found = run.dynamic_load_coefficients[own]
        np.testing.assert_allclose(found, coefficients, rtol=1e-9, atol=1e-12)
        for body in vehicle.bodies:
            of_bodies.append(np.sqrt((body.heave.acceleration[there] ** 2).mean()))
    assert_array_equal(
        ensemble.dynamic_load_coefficients[sample, :axles], run.dynamic_load_coefficients
    )
    rms = ensemble.body_accelerations.rms[sample, : len(of_bodies)]
    np.testing.assert_allclose(rms, of_bodies, rtol=1e-8, atol=1e-14)


@pytest.fixture
def same() -> Same:
    return check_same


@pytest.fixture
def case(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """The case of the file of tests, as a file."""
    path = tmp_path / "case.toml"
    path.write_text(request.module.CASE, encoding="utf-8")
    return path


#: Reads what is to be run, runs it in a copy of itself, and tells who that is and how it ended.
TEMPLATE = """
import json, os, signal, sys
import numpy
import spanwise.cli

for line in sys.stdin:
    child = os.fork()
    if child == 0:
        break
    print(child, flush=True)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
else:
    sys.exit()
program, environment, out, err = json.loads(line)
os.environ.update(environment)
for stream, path in enumerate((os.devnull, out, err)):
    os.dup2(os.open(path, os.O_RDWR), stream)
signal.alarm(600)
exec(compile(program, "<program>", "exec"), {"__name__": "__main__"})
"""


@dataclass
class Started:
    """A program under way in a process of its own."""

    template: IO[str]
    pid: int
    out: Path
    err: Path
    code: int | None = None

    def wait(self) -> subprocess.CompletedProcess[str]:
        if self.code is None:
            self.code = int(self.template.readline())
        out, err = (path.read_text(encoding="utf-8") for path in (self.out, self.err))
        return subprocess.CompletedProcess("", self.code, out, err)


Start: TypeAlias = Callable[..., Started]


@pytest.fixture(scope="session")
def template() -> Iterator[tuple[IO[str], IO[str]]]:
    """A process that has imported the package, to be copied: its two pipes."""
    process = subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", TEMPLATE],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )
    with process:
        assert process.stdin is not None
        assert process.stdout is not None
        yield process.stdin, process.stdout


@pytest.fixture
def start(
    template: tuple[IO[str], IO[str]], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Start]:
    """Runs a program in such a copy, which takes a twentieth of what a start with imports takes."""
    told, heard = template
    all_started = []

    def started(program: str, **environment: str) -> Started:
        folder = tmp_path_factory.mktemp("process")
        out, err = folder / "out", folder / "err"
        for path in (out, err):
            path.touch()
        job = (textwrap.dedent(program), environment, str(out), str(err))
        print(json.dumps(job), file=told, flush=True)
        all_started.append(Started(heard, int(heard.readline()), out, err))
        return all_started[-1]

    yield started
    for each in all_started:
        if each.code is None:
            os.kill(each.pid, signal.SIGKILL)
            each.wait()
