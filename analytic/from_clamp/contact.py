"""The contact of the elastica that has one station's clamp readings, in closed form.

A pose of the clamp is a motion of a rigid body: turned back by its angle, each station of a clamp
that turns is one of an upright clamp past a turned object.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd

from analytic.from_clamp.clamp_end import ClampEnd
from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Pose
from analytic.problem.columns import SENSED, units
from analytic.problem.readings import Readings
from analytic.problem.support import is_plain
from analytic.problem.table import mirrored_table
from analytic.solver.elastica import frame, span_of_moment
from analytic.solver.general.states import Vibrissa

Reconstruct = Callable[[Readings, "Mapping[str, float] | None"], pd.DataFrame]

UNLOADED = 1e-9  # force that has no direction to speak of, over EI/L^2
LONGEST = 1.1  # longest arc length of a contact, over L; one at the tip may seem so through noise


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


class LocatedContact(NamedTuple):
    """Contact points of the centreline, dimensionless; arrays of one shape."""

    alpha: Floats
    arc_length: Floats
    xi: Floats
    eta: Floats

    def surface(self, radius: Floats | float) -> tuple[Floats, Floats]:
        return self.xi - radius * np.sin(self.alpha), self.eta + radius * np.cos(self.alpha)


def dimensionless(readings: Readings) -> Floats:
    """The sensed columns over L, EI/L^2 and EI/L, the forces without what holds the weight."""
    beam = readings.beam
    found = np.array(
        [readings.values(n) / u for n, u in zip(SENSED, units(beam, SENSED), strict=True)]
    )
    for row, weight in zip(found[1:3], readings.support.weight, strict=True):
        row += weight * beam.length / beam.force_unit
    return found


def sides(sensed: Floats) -> Floats:
    """To which side the vibrissa bends, by the sign of its moment."""
    side = np.where(sensed[3] < 0, -1.0, 1.0)
    return np.stack([side, side, np.ones_like(side), side])


class SweptVibrissa(NamedTuple):
    """What the readings of a sweep are of, as the clamp's readings need it."""

    # its numbers in a sweep to the left; the mirror image's, if the foot moves to the right.
    vibrissa: Vibrissa
    plain: bool  # whether it is the paper's: straight at rest, rigidly clamped, without friction
    way: float  # -1 if the foot moves to the right, else 1; it determines the sense of friction

    @classmethod
    def of(cls, readings: Readings) -> "SweptVibrissa":
        foot_x = readings.values("foot_x")
        rightward = foot_x[-1] > foot_x[0]
        beam = readings.beam.mirrored() if rightward else readings.beam
        held = readings.support.mirrored() if rightward else readings.support
        return cls(Vibrissa.of(beam, held), is_plain(beam, held), -1.0 if rightward else 1.0)

    def clamp_end(self, sensed: Floats) -> ClampEnd:
        way = self.way
        return ClampEnd.of(way * sensed[1], sensed[2], way * sensed[3], self.vibrissa)

    def surface(self, contact: LocatedContact) -> tuple[Floats, Floats]:
        return contact.surface(self.vibrissa.radius_at(contact.arc_length))

    def contact(self, sensed: Floats) -> LocatedContact:
        """Contacts of stations; the paper's vibrissa is bent to its own side at each."""
        if self.plain:
            turned = sides(sensed)
            found = contact_bent_right(turned * sensed)
            side = turned[0]
            return LocatedContact(side * found.alpha, found.arc_length, side * found.xi, found.eta)
        end = self.clamp_end(sensed)
        place = end.place(end.contact_arc_length())
        xi = sensed[0] + self.way * place.x
        return LocatedContact(self.way * place.alpha, place.arc_length, xi, place.y)

    def arc_length_and_criterion(self, sensed: Floats) -> tuple[Floats, Floats]:
        """Where stations touch, and what vanishes in Phase B and is positive in Phase A."""
        if self.plain:
            _, force_x, force_y, moment = sensed
            criterion = (2 * force_y - moment**2) / (2 * np.hypot(force_x, force_y))
            return self.contact(sensed).arc_length, np.asarray(criterion)
        end = self.clamp_end(sensed)
        length = end.contact_arc_length()
        parallel = end.parallel(end.march(length).theta)
        return length, np.asarray(end.sine_at_contact(length) - np.sin(parallel))


def located(readings: Readings) -> LocatedContact:
    """Contacts of a sweep, station by station, on the vibrissa."""
    sensed = dimensionless(readings)
    felt = np.hypot(sensed[1], sensed[2]) > UNLOADED
    found = SweptVibrissa.of(readings).contact(np.where(felt, sensed, np.nan))
    there = (found.arc_length >= 0) & (found.arc_length <= LONGEST)
    return LocatedContact(*(np.where(there, values, np.nan) for values in found))


def contact_bent_right(sensed: Floats) -> LocatedContact:
    """Slope angle, arc length and position of the contact, for moments from 0 up.

    The force's direction is the contour's normal, so tan(alpha) = -F_x/F_y; force and moment fix
    the modulus, k^2 = (1 + (M^2 - 2 F_y)/(2 f))/2, and with it the whole elastica up to where its
    curvature vanishes, which is the contact.
    """
    foot_x, force_x, force_y, moment = sensed
    root_f = np.sqrt(np.hypot(force_x, force_y))
    alpha = np.arctan2(-force_x, force_y)
    loaded = span_of_moment(moment / root_f, alpha)
    up, across = frame(loaded, alpha)
    return LocatedContact(alpha, loaded.q / root_f, foot_x + across / root_f, up / root_f)
