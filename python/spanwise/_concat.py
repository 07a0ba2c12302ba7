"""Several ensembles as one: parts computed at different times, or on different machines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spanwise._checks import is_list, items, of_kind, shown
from spanwise._events import Speeds
from spanwise._plan import Plan
from spanwise._rows import Rows
from spanwise._value import same
from spanwise._variation import Factors
from spanwise.ensembles import Ensemble
from spanwise.errors import InputError, wrong_kind

Array: TypeAlias = NDArray[np.float64]

#: Settings that each part has for its own samples.
BY_SAMPLE = ("samples", "first", "speed", "kind", "factors")


def concat(ensembles: Iterable[Ensemble]) -> Ensemble:
    """The ensemble of which these are parts, in the order of their numbers.

    The result is that of one call for all samples, to the bit, `Ensemble.hash` included. Samples
    that failed stay among the failures. So there are no gaps: samples that are missing, as of a
    lost part, can be computed alone, with `first`; tables of parts with gaps go together by
    ``pandas.concat``, for `Ensemble.to_pandas` names rows by the numbers of samples.

    Parameters
    ----------
    ensembles : iterable of Ensemble
        The parts, in any order: consecutive samples of one seed, of the same bridge, vehicles,
        road and settings. Speeds, kinds and factors may differ from sample to sample.

    Returns
    -------
    Ensemble

    Raises
    ------
    ValueError
        If parts overlap, samples between them are missing, or they were not asked the same.

    Examples
    --------
    >>> import spanwise as sw
    >>> whole = sw.concat(map(sw.Ensemble.read, folder.glob("part*.npz")))  # doctest: +SKIP
    """
    if not is_list(ensembles):
        raise wrong_kind("ensembles", ensembles, "must be a list of Ensemble")
    given = items("ensembles", ensembles, "a list of Ensemble")
    for i, each in enumerate(given):
        of_kind(f"ensembles[{i}]", each, Ensemble, "an Ensemble")
    if not given:
        raise InputError("ensembles", "[]", "must be one or more")
    order = sorted(range(len(given)), key=lambda i: given[i].first)
    for before, i in pairwise(order):
        _check_alike(given[order[0]], order[0], given[i], i)
        _check_next(given[before], before, given[i], i)
    parts: list[Ensemble] = [given[i] for i in order]
    if len(parts) == 1:
        return parts[0]
    plan = _joined([each._plan for each in parts])
    return Ensemble(plan, Rows.joined([each._rows for each in parts]))


def _check_next(before: Ensemble, number: int, part: Ensemble, i: int) -> None:
    """Refuses samples that are there twice, or not at all."""
    end = before.first + before.samples
    if part.first < end:
        last = min(end, part.first + part.samples) - 1
        raise InputError(
            f"ensembles[{i}]",
            None,
            f"samples {part.first} to {last} are in ensembles[{number}] too",
        )
    if part.first > end:
        raise InputError(
            f"ensembles[{i}]",
            f"samples from {part.first}",
            f"samples {end} to {part.first - 1} are missing before it; compute them with "
            f"first={end}, samples={part.first - end}, or put the tables of parts with gaps "
            "together, pandas.concat of their to_pandas()",
        )


def _check_alike(one: Ensemble, number: int, part: Ensemble, i: int) -> None:
    """Refuses a part that was asked something else, naming what."""
    mine, others = one._plan, part._plan
    for name, what in (("bridge", "bridge"), ("events", "vehicles"), ("quantities", "quantities")):
        if not same(getattr(mine, name), getattr(others, name)):
            raise InputError(f"ensembles[{i}]", None, f"{what}: must be as in ensembles[{number}]")
    ours, theirs = mine.settings, others.settings
    for key in dict.fromkeys((*ours, *theirs)):
        if key not in BY_SAMPLE and not same(ours.get(key), theirs.get(key)):
            raise InputError(
                f"ensembles[{i}]",
                None,
                f"{key} = {shown(theirs.get(key))}: must be as in "
                f"ensembles[{number}], {shown(ours.get(key))}",
            )
    widths = [{each.name: each.values.shape[1] for each in plan.factors} for plan in (mine, others)]
    if widths[0] != widths[1]:
        names = ", ".join(f"{name} ({width})" for name, width in widths[1].items()) or "none"
        raise InputError(
            f"ensembles[{i}]",
            None,
            f"factors = {names}: must be the same with as many parts as in ensembles[{number}]",
        )
    if [*one._rows.columns.items()] != [*part._rows.columns.items()]:
        raise InputError(f"ensembles[{i}]", None, f"is of another version than ensembles[{number}]")


def _joined(plans: Sequence[Plan]) -> Plan:
    """What one call for all samples would have been told."""
    first = plans[0]
    counts = [each.samples for each in plans]
    speeds = _speeds([each.speeds for each in plans], counts)
    kinds = np.concatenate([each.kinds for each in plans])
    factors = [
        Factors(each.name, _column([plan.factors[k].values for plan in plans], counts))
        for k, each in enumerate(first.factors)
    ]
    samples = sum(counts)
    by_sample: dict[str, Any] = {
        "samples": samples,
        "first": first.first,
        "speed": speeds.given,
        "kind": kinds,
        "factors": {each.name: each.plain for each in factors},
    }
    return replace(
        first,
        samples=samples,
        kinds=kinds,
        speeds=speeds,
        factors=factors,
        settings={key: by_sample.get(key, value) for key, value in first.settings.items()},
    )


def _speeds(parts: Sequence[Speeds], counts: Sequence[int]) -> Speeds:
    """Those of all samples; one number where it is the same for all."""
    first = parts[0].given
    if not isinstance(first, np.ndarray) and all(same(each.given, first) for each in parts):
        return parts[0]
    rows = [each.rows(n) for each, n in zip(parts, counts, strict=True)]
    column = _column(rows, counts)
    given = column[:, 0] if column.shape[1] == 1 else column
    return Speeds(given, np.ascontiguousarray(column).ravel())


def _column(parts: Sequence[Array], counts: Sequence[int]) -> Array:
    """Rows of all samples; one row where it is the same for all."""
    if all(len(each) == 1 and same(each, parts[0]) for each in parts):
        return parts[0]
    width = max(each.shape[1] for each in parts)
    rows = [np.broadcast_to(each, (n, width)) for each, n in zip(parts, counts, strict=True)]
    return np.concatenate(rows)
