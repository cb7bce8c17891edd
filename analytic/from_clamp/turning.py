"""Readings of a clamp that turns, station by station as those of an upright one.

A pose of the clamp is a motion of a rigid body: turned back by its angle, each station is one of an
upright clamp past a turned object.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from analytic.problem.arrays import Floats
from analytic.problem.clamp_path import Pose
from analytic.problem.readings import Readings
from analytic.problem.table import mirrored_table

Reconstruct = Callable[[Readings, "Mapping[str, float] | None"], pd.DataFrame]


def reconstruct_turning(
    readings: Readings, noise: Mapping[str, float] | None, reconstruct: Reconstruct
) -> pd.DataFrame:
    """What the way of an upright clamp finds, in the world; noise is the larger of both forces'."""
    if readings.runs_right:
        return mirrored_table(reconstruct_turning(readings.mirrored(), noise, reconstruct))
    if noise is not None:
        larger = max(noise.get(name, 0.0) for name in ("force_x", "force_y"))
        noise = {**noise, "force_x": larger, "force_y": larger}
    found = reconstruct(as_upright(readings), noise)
    x, y = _poses(readings).place(*found[["contact_x", "contact_y"]].to_numpy().T)
    angle = found["contact_angle"] + readings.clamp_angle
    return found.assign(contact_x=x, contact_y=y, contact_angle=angle)


def shapes_turning(
    readings: Readings, shapes: Callable[[Readings], tuple[Floats, Floats]]
) -> tuple[Floats, Floats]:
    """Centrelines in the world, shape (stations, points)."""
    if readings.runs_right:
        x, y = shapes_turning(readings.mirrored(), shapes)
        return -x, y
    return Pose(*(values[:, None] for values in _poses(readings))).place(
        *shapes(as_upright(readings))
    )


def as_upright(readings: Readings) -> Readings:
    """The same readings as a clamp has them that stands upright at the origin."""
    pose = _poses(readings)
    none = np.zeros_like(pose.angle)
    force = Pose(none, none, pose.angle)
    x, y = force.seen(readings.values("force_x"), readings.values("force_y"))
    ways = ["clamp_angle", "foot_y", "travel"]
    table = readings.table.drop(columns=[name for name in ways if name in readings.table])
    if "second_contact_angle" in table:
        table = table.assign(second_contact_angle=table["second_contact_angle"] - pose.angle)
    return replace(readings, table=table.assign(foot_x=0.0, force_x=x, force_y=y))


def _poses(readings: Readings) -> Pose:
    return Pose(readings.values("foot_x"), readings.foot_y, readings.clamp_angle)
