"""Made-up sweeps whose every number is known; no simulator is needed.

Values are of shape (3, stations), each reading relative to `SCALE`, its largest magnitude in the
reference. No length, force or moment is 1, so that no unit can be missed.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, SENSED, Beam, Case, Readings, Sweep, named_case, solve_sweep
from compare import Classification
from compare.explain.budget import controlled_changes
from compare.explain.motion import slower_and_finer
from compare.explain.variations import STEP
from mujoco_models import Motion, Settings

BEAM = Beam(length=2.0, flexural_rigidity=3.0, radius=0.01)
SCALE = np.array([0.5, 2.0, 1.25])
UNITS = np.array([BEAM.force_unit, BEAM.force_unit, BEAM.moment_unit])
FOOT_X = np.linspace(1.5, -1.5, 100)
PHASE = np.repeat(["free", "tip", "tangent", "free"], [6, 24, 60, 10])
TOUCHING, TANGENT = PHASE != "free", PHASE == "tangent"
CONTACT = 0.75 + 0.2 * np.cos(3 * FOOT_X)  # arc length over the beam's
SIZES = np.array([1.0, 2.0, 0.5])  # of a pattern in each reading: none is taken for another
PATTERNS = (
    *("discretisation", "facets", "corner", "unrest", "unexplained"),
    *("length", "radius", "friction", "foot_x"),
    *("rate", "damping", "time_step", "contact_model", "solver", "at_rest"),
)

wave = np.where(TOUCHING, 1.2 + np.cos(FOOT_X + np.arange(3.0)[:, None]), 0.0)
TRUTH = wave / wave.max(axis=1, keepdims=True)
SETTINGS = Settings(segments=40, contact_stiffness=1e5, corner_radius=1e-4, tolerance=1e-4)
MOTION = Motion(speed=0.08, timestep=0.02, damping_ratio=0.1, solref=(0.7, 1.0), solver="cg")


def pattern(name: str) -> np.ndarray:
    """A wave of each part's own; its rms over the stations in contact is `SIZES`."""
    if name == "softness":  # as if the contour lay deeper
        return -pattern("radius")
    wave = np.cos((2 + 0.7 * PATTERNS.index(name)) * FOOT_X + np.arange(3.0)[:, None])
    return SIZES[:, None] * wave / rms(wave)[:, None]


def rms(values: np.ndarray, here: np.ndarray = TOUCHING) -> np.ndarray:
    return np.sqrt(np.mean(values[:, here] ** 2, axis=1))


def sweep(values: np.ndarray, provenance: Mapping | None = None, **columns) -> Readings:
    readings = dict(zip(CLAMP_READINGS, SCALE[:, None] * values, strict=True))
    arc_length = BEAM.length * np.where(TOUCHING, CONTACT, np.nan)
    table = {"foot_x": FOOT_X, **readings, "phase": PHASE, "contact_arc_length": arc_length}
    frame = pd.DataFrame({**table, "status": "ok", **columns})
    return Readings(frame, BEAM, "made up", provenance or {})


EXACT = sweep(TRUTH)
VARIED = {
    name: sweep(TRUTH + STEP * pattern(name)) for name in ("length", "radius", "friction", "foot_x")
}


def changed(readings: Readings, rows: np.ndarray | slice = slice(None), **columns) -> Readings:
    """With other columns, and of those the rows."""
    return replace(readings, table=readings.table.assign(**columns).iloc[rows])


def added(readings: Readings, values: np.ndarray) -> Readings:
    """With these values on top, in whatever else it is."""
    more = SCALE[:, None] * values
    columns = {name: readings.values(name) + more[i] for i, name in enumerate(CLAMP_READINGS)}
    return changed(readings, **columns)


def at_rest(order: float = 2.0, swing: float = 0.0, **sizes: float) -> dict[str, Readings]:
    """The sweeps of a budget: each setting does what its part is, in the base by the part's size.

    A size by the name of a sweep is an error of its own, in the pattern of the discretisation. Of
    that there is always a little: without any, no order can be observed.
    """
    sizes = {"discretisation": 1e-7, **sizes}
    found = {}
    for name, s in controlled_changes(SETTINGS, corners="corner" in sizes).items():
        does = {
            "discretisation": (SETTINGS.segments / s.segments) ** order,
            "facets": s.obstacle == "mesh",
            "softness": SETTINGS.contact_stiffness / s.contact_stiffness,
            "corner": s.corner_radius / SETTINGS.corner_radius,
            "unrest": s.tolerance > 1e-8,
            "unexplained": 1,
        }
        errors = [sizes.get(part, 0.0) * by * pattern(part) for part, by in does.items()]
        discrepancy, extension = sizes.get("sensor", 0.0), sizes.get("extension", 0.0)
        errors += [sizes.get(name, 0.0) * pattern("discretisation"), extension * pattern("length")]
        errors += [discrepancy * (UNITS / SCALE)[:, None], swing * TANGENT * _turn(s.segments)]
        said = {"settings": {"segments": s.segments}}
        if swing:
            said["joints"] = _joints(s.segments).tolist()
        sunk = BEAM.radius * sizes.get("softness", 0.0) * does["softness"]
        engines = {"discrepancy": discrepancy, "extension": extension, "penetration": sunk}
        found[name] = sweep(TRUTH + sum(errors), said, **engines)
    return found


def _joints(segments: int) -> np.ndarray:
    return (np.arange(segments) + 0.5) / segments


def _turn(segments: int) -> np.ndarray:
    """By how much joints turn more than a smooth beam under a load of 1 at the contact."""
    behind = np.maximum(CONTACT - _joints(segments)[:, None], 0.0)
    return behind.sum(axis=0) / segments - CONTACT**2 / 2


def in_motion(of: Motion = MOTION, order: float = 1.0, **sizes: float) -> dict[str, Readings]:
    """The same of a budget in motion; a part of two words has a `_` between them."""

    def planted(m: Motion) -> Readings:
        speed = (m.speed / of.speed) ** order
        does = {
            "rate": speed,
            "damping": speed * m.damping_ratio / of.damping_ratio,
            "time_step": m.timestep / of.timestep,
            "contact_model": m.solref is not None,
            "solver": m.solver != "newton",
            "at_rest": 1,
            "unexplained": 1,
        }
        errors = [sizes.get(part, 0.0) * by * pattern(part) for part, by in does.items()]
        return sweep(TRUTH + sum(errors))

    found = {name: planted(motion) for name, motion in slower_and_finer(of).items()}
    return {**found, "rest": sweep(TRUTH + sizes.get("at_rest", 0.0) * pattern("at_rest"))}


def classified(readings: Readings) -> Classification:
    """By the phases that it says itself."""
    phase = np.where(readings.trusted, readings.table["phase"].to_numpy(dtype=str), "")
    short = 1 - readings.values("contact_arc_length") / readings.beam.length
    nothing = np.zeros(len(phase))
    return Classification(phase, nothing, nothing, short, nothing, readings)


def unread(sweep: Readings) -> Readings:
    """The sensor reads nothing, while the simulator recorded its contacts."""
    return changed(sweep, **dict.fromkeys(CLAMP_READINGS, 0.0))


def untrusted(sweep: Readings) -> Readings:
    """None of the stations in contact is to be trusted; the others are free."""
    return changed(sweep, status=np.where(sweep.table["phase"] == "free", "ok", "unsettled"))


def mute(sweep: Readings) -> Readings:
    """A file that has nothing but the readings, all of them zero."""
    return replace(sweep, table=unread(sweep).table[["foot_x", *CLAMP_READINGS]])


NOTHING = (unread, untrusted, mute)  # to compare with


STATIONS = Sweep(128, 2.125, 2.125 - 127 * 5 / 128)  # of the next


@cache
def solved() -> Readings:
    """A sweep in closed form, whose phases can be judged; steps of 5/128 have no round-off."""
    return solve_sweep(Case(BEAM, named_case("parabola").profile.scaled(BEAM.length), STATIONS))


def sensed(readings: Readings) -> Readings:
    """What a sensor gives, and nothing that a simulator knows."""
    return Readings(readings.table[list(SENSED)], readings.beam, "rig")


def scaled(readings: Readings, **gains: float) -> Readings:
    return changed(readings, **{name: readings.values(name) * g for name, g in gains.items()})
