"""One crossing of a bridge by a vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypeAlias, get_args

from spanwise import _core
from spanwise._checks import count, number, numbers, word
from spanwise.bridge import Bridge
from spanwise.damping import Damping, resolved
from spanwise.run import Run
from spanwise.vehicles import GRAVITY, Vehicle

Drive: TypeAlias = Literal["constant-speed", "constant-traction"]
Recovery: TypeAlias = Literal["force-summation", "force-summation-by-rates", "superposition"]


def cross(
    bridge: Bridge,
    vehicle: Vehicle,
    *,
    speed: float,
    modes: int | None = None,
    drive: Drive = "constant-speed",
    damping: Damping = 0.0,
    approach: float = 0.0,
    tail: float = 0.0,
    sections: Sequence[float] | None = None,
    recovery: Recovery = "force-summation",
    step: float | None = None,
    beta: float = 1.0 / 6.0,
    gravity: float = GRAVITY,
    mask: float = 0.05,
) -> Run:
    """Drive a vehicle over a bridge once.

    The vehicle starts in static equilibrium with its front axle at the start of the approach; the
    bridge is at rest. The crossing ends when the last axle has left and the tail is over. The
    results are those of the vehicle alone, without the dead load of the bridge.

    Parameters
    ----------
    bridge : Bridge
        The bridge.
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed at the start [m/s].
    modes : int, optional
        Number of natural modes included. By default two for each span, at least three, at most as
        many as there are masses.
    drive : {"constant-speed", "constant-traction"}, optional
        Keep the speed, or keep traction and resistance in balance, so that the speed follows the
        slope of the deflected bridge.
    damping : float, array_like or Rayleigh, optional
        Ratio to critical damping, one for all modes or one for each; `Rayleigh`, or a table with
        the key ``rayleigh`` and the values alpha and beta; or the damping matrix C at the moving
        masses [N s/m], shape (stations, stations).
    approach : float, optional
        Length of the rigid approach [m].
    tail : float, optional
        Free vibration kept after the last axle has left [s]. The maxima can lie in it.
    sections : sequence of float, optional
        Where to look [m], ascending. By default mass stations, supports and tenth points.
    recovery : {"force-summation", "force-summation-by-rates", "superposition"}, optional
        How responses follow from the included modes: by force summation with the inertia and
        damping forces from the coordinates (Eq. 11 of [1]_) or from their rates (Eq. 6), or by
        plain superposition of the modes (Eq. 2).
    step : float, optional
        Longest time step [s]. By default a twentieth of the shortest coupled period or the time in
        which the vehicle passes a hundredth of the narrowest panel, whichever is less.
    beta : float, optional
        Newmark's beta: 1/6 for linear, 1/4 for constant average acceleration.
    gravity : float, optional
        Gravity [m/s2].
    mask : float, optional
        Impact factors are not given where the static value is at most this fraction of the largest
        among the sections.

    Returns
    -------
    Run
        Responses, static and dynamic, their extremes and impact factors.

    Raises
    ------
    ValueError
        If a value is not allowed, naming it and what is; if the step is beyond the stability limit,
        naming the limit.
    RuntimeError
        If the numerics fail, or under constant traction the vehicle comes to rest.

    Notes
    -----
    An axle that drives on to a *free* end of the bridge loads it suddenly with all it carries, and
    its wheel drops off the deflected end as it leaves. The bridge rings from that at any speed, so
    there impact factors do not tend to one as the speed goes down.

    References
    ----------
    .. [1] H. Kishan and R. W. Traill-Nash, IABSE Publications 33 (1973).
    """
    if not isinstance(bridge, Bridge):
        raise TypeError(f"bridge = {bridge!r}: must be a Bridge")
    if not isinstance(vehicle, Vehicle):
        raise TypeError(f"vehicle = {vehicle!r}: must be a Vehicle")
    if modes is None:
        modes = bridge.default_modes()
    modes = count("modes", modes)
    ratios, matrix = resolved(damping, lambda: bridge.modes(modes).frequencies)
    speed, beta, gravity = number("speed", speed), number("beta", beta), number("gravity", gravity)
    approach, tail, mask = number("approach", approach), number("tail", tail), number("mask", mask)
    drive_word = word("drive", drive, *get_args(Drive))
    recovery_word = word("recovery", recovery, *get_args(Recovery))
    if not 0.0 <= mask < 1.0:
        raise ValueError(
            f"mask = {mask:g}: must be a fraction of the largest static value, from 0 to below 1"
        )
    core = _core.cross(
        bridge._core,
        vehicle._core,
        speed=speed,
        drive=drive_word,
        modes=modes,
        damping=ratios,
        damping_matrix=matrix,
        beta=beta,
        step=None if step is None else number("step", step),
        approach=approach,
        tail=tail,
        gravity=gravity,
        sections=None if sections is None else numbers("sections", sections),
        recovery=recovery_word,
    )
    settings: dict[str, object] = {
        "speed": speed,
        "modes": modes,
        "drive": drive_word,
        "damping": matrix.tolist() if matrix is not None else ratios,
        "approach": approach,
        "tail": tail,
        "recovery": recovery_word,
        "beta": beta,
        "gravity": gravity,
        "mask": mask,
        "step": core.step,
    }
    if matrix is None and len(ratios) == 1:
        settings["damping"] = ratios[0]
    return Run(bridge, vehicle, settings, core)
