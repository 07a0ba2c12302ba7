"""An ensemble as a NumPy archive, and its main figures as plain values."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np

from spanwise._files import write_files
from spanwise._traffictable import is_alone, passage_table
from spanwise._values import plain
from spanwise._vehicletable import table_of
from spanwise.damping import in_words
from spanwise.population import FACTORS, Ensemble
from spanwise.roads import Road
from spanwise.traffic import plain_drive

#: Percentiles of the plain values.
PERCENTILES: Final = (1, 5, 25, 50, 75, 95, 99)


def arrays(ensemble: Ensemble) -> dict[str, Any]:
    """All extremes by name."""
    found: dict[str, Any] = {
        "sections": ensemble.sections,
        "supports": ensemble.supports,
        "frequencies": ensemble.frequencies,
        "numbers": ensemble.first + np.arange(ensemble.samples, dtype=np.uint64),
        "digests": ensemble.digests,
        "damping": np.array(in_words(ensemble.settings["damping"], ensemble.frequencies)),
        "hash": np.array(ensemble.hash),
        "failures": np.array([each.sample for each in ensemble.failures], dtype=np.uint64),
        "load_coefficients": ensemble.load_coefficients,
        "time_off_road": ensemble.time_off_road,
        "lift_offs": ensemble.lift_offs,
        "body_accelerations_max": ensemble.body_accelerations.max,
        "body_accelerations_rms": ensemble.body_accelerations.rms,
    }
    kinds = ["shear_left", "shear_right"] if "shear" in ensemble.quantities else []
    kinds += [each for each in ensemble.quantities if each != "shear"]
    for name in (*kinds, "axle_loads"):
        extremes = getattr(ensemble, name)
        for side in ("max", "min"):
            for suffix in ("", "_time", "_position"):
                found[f"{name}_{side}{suffix}"] = getattr(extremes, f"{side}{suffix}")
            found[f"{name}_static_{side}"] = getattr(extremes, f"static_{side}")
    found["settings"] = np.array(json.dumps(settings(ensemble), allow_nan=False))
    return found


def write_npz(ensemble: Ensemble, path: Path) -> None:
    """The archive, complete or not at all."""
    write_files([(path, npz_writer(ensemble))])


def npz_writer(ensemble: Ensemble) -> Callable[[BinaryIO], None]:
    """What writes the archive, array by array."""
    return lambda stream: np.savez(stream, **arrays(ensemble))


def settings(ensemble: Ensemble) -> dict[str, Any]:
    """What the ensemble was made of, in plain values, as a case file has it."""
    recipe = ensemble._recipe
    events = [
        {"vehicle": table_of(event[0].vehicle)}
        if is_alone(event)
        else [passage_table(each) for each in event]
        for event in recipe.events
    ]
    given = dict(ensemble.settings)
    road = given["road"]
    assert isinstance(road, Road)
    given["road"] = road.arguments
    given["drive"] = plain_drive(recipe.drive)
    table: dict[str, Any] = plain(
        {"bridge": recipe.bridge.arguments, "events": events, "ensemble": given}
    )
    return table


def as_dict(ensemble: Ensemble) -> dict[str, Any]:
    """Main figures as plain values: percentiles of impact factors and of extremes."""
    sound = ~np.isnan(ensemble.axle_loads.max).all(axis=1)
    found: dict[str, Any] = {
        "samples": ensemble.samples,
        "seed": ensemble.seed,
        "first": ensemble.first,
        "hash": ensemble.hash,
        "isa": ensemble.isa,
        "threads": ensemble.threads,
        "elapsed": ensemble.elapsed,
        "sections": ensemble.sections,
        "supports": ensemble.supports,
        "damping": in_words(ensemble.settings["damping"], ensemble.frequencies),
        "failures": [
            {"sample": each.sample, "step": each.step, "cause": each.cause}
            for each in ensemble.failures
        ],
        "percentiles": [*PERCENTILES],
        "extremes": {},
        "impact_factors": {},
        "settings": settings(ensemble),
    }
    if sound.any():
        for name in (*ensemble.quantities, "axle_loads"):
            extremes = getattr(ensemble, name)
            found["extremes"][name] = {
                side: _percentiles(getattr(extremes, side)) for side in ("max", "min")
            }
        for factor, (name, _) in FACTORS.items():
            if name in (*ensemble.quantities, "axle_loads"):
                found["impact_factors"][factor] = _percentiles(ensemble.impact_factors(factor))
    table: dict[str, Any] = plain(found)
    return table


def _percentiles(values: Any) -> Any:
    """By percentile and section, over the samples that have a value there."""
    there = ~np.isnan(values).all(axis=0)
    found = np.full((len(PERCENTILES), values.shape[1]), np.nan)
    if there.any():
        found[:, there] = np.nanpercentile(values[:, there], PERCENTILES, axis=0)
    return found
