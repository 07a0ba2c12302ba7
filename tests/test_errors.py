"""An error about a value knows what it is about, wherever it comes from."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import pytest

import spanwise as sw
from spanwise import _core
from spanwise._build import within
from spanwise.case import CaseError

CASE = """
[bridge]
spans = [25.0]
EI = 9e9
mass = 9e3
[vehicle]
preset = "kishan-1973"
[crossing]
speed = 22.0
damping = 0.01
modes = 3
"""


def unstable() -> object:
    return sw.Bridge(length=10.0, supports=[(2.0, "pinned")], EI=1e9, mass=1e3)


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (
            lambda: sw.Rayleigh(alpha="a", beta=1.0),  # type: ignore[arg-type]
            ("Rayleigh alpha", "'a'", "must be a number"),
        ),
        (lambda: _core.Road.step(0.0, 0.01, -1.0), ("contact_patch", "-1", None)),
        (unstable, ("supports", "[pinned at 2 m]", None)),
        (lambda: sw.ensemble(None, None, samples=0), ("samples", "0", None)),  # type: ignore[arg-type]
    ],
)
def test_it_has_key_value_and_what_is_allowed(
    make: Callable[[], object], parts: tuple[str, str, str | None]
) -> None:
    with pytest.raises(sw.InputError) as caught:
        make()
    error = caught.value
    key, value, allowed = parts
    assert (error.key, error.value) == (key, value)
    assert error.allowed == (allowed or error.allowed)
    assert str(error) == f"{key} = {value}: {error.allowed}"


def test_it_travels_and_is_a_value_error() -> None:
    error = sw.InputError("speed", -1.0, "must be positive")
    for made in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert (made.key, made.value, made.allowed) == ("speed", "-1.0", "must be positive")
        assert str(made) == "speed = -1.0: must be positive"
    assert isinstance(error, ValueError)


def test_its_place_goes_in_front() -> None:
    assert str(sw.InputError("a", 1, "is none").within("case")) == "case: a = 1: is none"
    assert str(sw.InputError("a", None, "is missing").within("case")) == "case: a: is missing"
    assert str(sw.InputError("", None, "missing a").within("case")) == "case: missing a"
    assert str(sw.InputError("a", 1, "is none").within("")) == "a = 1: is none"
    with pytest.raises(CaseError) as caught, within("case", CaseError):
        raise ValueError("of another kind")
    assert caught.value.key == "case"
    assert str(caught.value) == "case: of another kind"


def test_a_case_names_the_table_that_gives_what_is_refused() -> None:
    both = f'{CASE}[ensemble]\nsamples = 2\nquantities = ["clamp_moment"]\nstep = -1.0\n'
    case = sw.Case.parse(both)
    with pytest.raises(sw.CaseError, match=r"^case, \[ensemble\]: quantities\[0\] = 'clamp"):
        case.ensemble()
    with pytest.raises(sw.CaseError, match=r"^case, \[ensemble\]: step = -1: must be finite"):
        case.ensemble(quantities=["moment"])
    with pytest.raises(sw.CaseError, match=r"^case: step = 0: must be finite"):
        case.ensemble(quantities=["moment"], step=0.0)
    alone = sw.Case.parse(CASE.replace("modes = 3", "modes = 99"))
    for compute in (alone.run, lambda: alone.ensemble(samples=2)):
        with pytest.raises(sw.CaseError, match=r"^case, \[crossing\]: modes = 99: "):
            compute()
