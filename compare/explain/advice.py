"""The cheapest settings that reach a wanted tolerance, predicted from a budget."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from compare.explain.budget import Budget
from compare.explain.changes import COARSER
from compare.measure.disagreement import rms
from mujoco_models.settings import Settings

_SEGMENTS = np.unique(np.geomspace(5, 1000, 120).astype(int))
_POINTS = 100 * 2 ** np.arange(9)  # up to 25,600
_FRACTION = 0.9  # of the target that is planned for; the rest is for what a power law leaves out
_SOFTNESS = 0.3  # of the target that a contact may give way
_FACET_ORDERS = (0.5, 2.0)  # facets' normals fall with their number, their chords with its square


@dataclass(frozen=True)
class Advice:
    """Settings and what to expect of them."""

    settings: Settings  # the cheapest that should reach the target
    error: float  # the largest rms of the three readings, relative to each one's largest magnitude
    seconds_a_station: float  # on this machine


def advise(found: Budget, runs: Mapping[str, Readings], coarser: Readings, target: float) -> Advice:
    """Predict error and time at other settings, and choose the cheapest that reach `target`.

    Each part follows a power law, with the observed order of the segments and the observed fall
    of the facets' part; the parts add as squares. Time is a power of the segments, and for a mesh
    also linear in its points.
    """
    base = Settings(**runs["base"].provenance["settings"])
    smooth = runs["smooth"]
    parts = {
        name: np.array([found.parts[name][reading].rms for reading in CLAMP_READINGS])
        for name in found.parts
    }
    fewer = _facets(coarser, smooth)
    with np.errstate(divide="ignore", invalid="ignore"):
        fall = np.log(fewer / _facets(runs["calm"], smooth)) / np.log(COARSER)
    fall = np.clip(np.nan_to_num(fall, nan=1.0), *_FACET_ORDERS)
    stiffness = base.contact_stiffness
    soft = float(parts["softness"].max())
    if soft > _SOFTNESS * target:
        stiffness = min(stiffness * soft / (_SOFTNESS * target), 1e9)

    segments, points = (grid.astype(float) for grid in np.meshgrid(_SEGMENTS, _POINTS))
    squares = [
        (parts["discretisation"][i] * (base.segments / segments) ** found.order) ** 2
        + (parts["facets"][i] * (base.contour_points / points) ** fall[i]) ** 2
        + (parts["softness"][i] * base.contact_stiffness / stiffness) ** 2
        + parts["unexplained"][i] ** 2
        + parts.get("corner", np.zeros(len(CLAMP_READINGS)))[i] ** 2
        for i in range(len(CLAMP_READINGS))
    ]
    error = np.sqrt(np.max(squares, axis=0))
    time = _time(runs, coarser, segments, points)
    enough = error <= _FRACTION * target
    if not enough.any():
        raise InputError(
            "--target",
            target,
            f"at least {error.min() / _FRACTION:.1e} for this case",
            "ask for less",
        )
    best = np.unravel_index(np.argmin(np.where(enough, time, np.inf)), time.shape)
    chosen = replace(
        base,
        segments=int(segments[best]),
        contour_points=int(points[best]),
        contact_stiffness=stiffness,
    )
    return Advice(chosen, float(error[best]), float(time[best]))


def check_target(target: float) -> None:
    """Check that `target` can be an error relative to a reading's magnitude."""
    if not 0 < target < 1:
        raise InputError("--target", target, "between 0 and 1", "1e-3 is usual")


def _facets(mesh: Readings, smooth: Readings) -> np.ndarray:
    kept = mesh.trusted & smooth.trusted
    return np.array(
        [rms((mesh.values(name) - smooth.values(name))[kept]) for name in CLAMP_READINGS]
    )


def seconds_a_station(readings: Readings) -> float:
    """What the simulation of a sweep took a station."""
    return float(readings.provenance["seconds"]) / len(readings.table)


def _time(
    runs: Mapping[str, Readings], coarser: Readings, segments: np.ndarray, points: np.ndarray
) -> np.ndarray:
    """Seconds a station."""
    refined = [runs[name] for name in ("smooth", "two", "four")]
    n = [r.provenance["settings"]["segments"] for r in refined]
    power, level = np.polyfit(np.log(n), np.log([seconds_a_station(r) for r in refined]), 1)
    base = runs["base"].provenance["settings"]
    many, few = base["contour_points"], coarser.provenance["settings"]["contour_points"]
    a_point = max(
        (seconds_a_station(runs["base"]) - seconds_a_station(coarser)) / (many - few), 0.0
    )
    mesh = max(seconds_a_station(coarser) - seconds_a_station(runs["smooth"]) - a_point * few, 0.0)
    return np.asarray(np.exp(level) * segments**power + mesh + a_point * points)
