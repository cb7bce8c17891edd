"""The frames that six components are given in: the world's, and that of the clamp."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np

from analytic import InputError
from analytic.numerics.arrays import Floats

if TYPE_CHECKING:  # limits are checked before pandas is needed
    from analytic.space import SpatialReadings

Frame: TypeAlias = Literal["world", "clamp"]
COMPONENTS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
_OVERTURNED = 1e-9  # of 1 + cos: a clamp that points straight down


def clamp_axes(tangent: Floats) -> Floats:
    """The world's axes by the shortest rotation that takes y to the clamp's tangent."""
    x, y, z = tangent
    if 1 + y < _OVERTURNED:
        return np.diag([1.0, -1.0, -1.0])
    skew = np.array([[0.0, x, 0.0], [-x, 0.0, -z], [0.0, z, 0.0]])
    return np.asarray((np.eye(3) + skew + skew @ skew / (1 + y)).T)  # y cross tangent is its axis


def components(readings: SpatialReadings, frame: Frame = "world") -> dict[str, Floats]:
    return _turned(readings, _axes(readings, frame))


def from_frame(readings: SpatialReadings, frame: Frame) -> SpatialReadings:
    """Readings whose components are in a frame, in that of the world."""
    axes = _axes(readings, frame)
    if frame == "world":
        return readings
    return replace(readings, table=readings.table.assign(**_turned(readings, axes.T)))


def _turned(readings: SpatialReadings, axes: Floats) -> dict[str, Floats]:
    return {
        name: column
        for names in (COMPONENTS[:3], COMPONENTS[3:])
        for name, column in zip(names, (readings.values(*names) @ axes.T).T, strict=True)
    }


def _axes(readings: SpatialReadings, frame: Frame) -> Floats:
    if frame not in get_args(Frame):
        raise InputError("frame", repr(frame), "'world' or 'clamp'", "choose one")
    return np.eye(3) if frame == "world" else clamp_axes(readings.clamp_tangent)
