"""Sweeps as they are drawn."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic import CLAMP_READINGS, Readings, curvatures, deflected_shapes, reconstruct
from analytic.problem.arrays import Floats, Integers, Words
from compare.sense.phases import classify

_DOTS = 10  # of a dotted vibrissa, at equal steps of arc length


@dataclass(frozen=True)
class Motion:
    """One sweep as it is drawn: lengths in L, forces in EI/L^2, moments in EI/L."""

    readings: Readings  # the sweep
    foot_x: Floats  # shape (stations,); Foot positions
    x: Floats  # shape (stations, points); of the centreline, from clamp to tip
    y: Floats  # shape (stations, points); of the centreline, from clamp to tip
    curvature: Floats  # shape (stations, points); its magnitude there
    contact: Floats  # shape (stations, 2); Where the body is touched; NaN where it is not
    clamp: dict[str, Floats]  # shape (stations,); The clamp readings
    phase: Words  # shape (stations,); As judged from the clamp

    @property
    def force(self) -> Floats:
        """Magnitude of the contact force, zero where it is not known, shape (stations,)."""
        return np.nan_to_num(np.hypot(self.clamp["force_x"], self.clamp["force_y"]))

    @classmethod
    def of(cls, readings: Readings) -> "Motion":
        """The sweep that these readings show, in units of their beam."""
        beam = readings.beam
        x, y = deflected_shapes(readings)
        units = (beam.force_unit, beam.force_unit, beam.moment_unit)
        return cls(
            readings,
            readings.values("foot_x") / beam.length,
            x / beam.length,
            y / beam.length,
            np.abs(curvatures(readings, x, y)) * beam.length,
            reconstruct(readings)[["contact_x", "contact_y"]].to_numpy() / beam.length,
            {n: readings.values(n) / u for n, u in zip(CLAMP_READINGS, units, strict=True)},
            classify(readings).phase,
        )

    def beads(self, station: int) -> tuple[Floats, Floats]:
        """Points on the centreline at equal steps of arc length."""
        x, y = self.x[station], self.y[station]
        along = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
        at = np.linspace(0, along[-1], _DOTS + 1)[1:]
        return np.interp(at, along, x), np.interp(at, along, y)


@dataclass(frozen=True)
class Motions:
    """Both sweeps."""

    reference: Motion
    candidate: Motion

    @cached_property
    def nearest(self) -> Integers:
        """The candidate's station that is nearest to each of the reference, shape (stations,)."""
        apart = np.abs(self.reference.foot_x[:, None] - self.candidate.foot_x)
        return np.asarray(apart.argmin(axis=1))
