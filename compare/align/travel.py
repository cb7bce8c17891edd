"""How far along its path the foot is in space, and whether two sweeps are at the same stations."""

import numpy as np

from analytic import InputError
from analytic.problem.arrays import Floats
from analytic.space import SpatialReadings
from analytic.space.problem.readings import FOOT
from compare.align.stations import check_same_beam

_SAME_FOOT = 1e-6  # L
_SAME_TANGENT = 1e-6


def travel_of(readings: SpatialReadings) -> Floats:
    """How far along its path the foot is at the stations [length]."""
    return readings.running_values


def check_same_stations(reference: SpatialReadings, candidate: SpatialReadings) -> None:
    """Refuse sweeps of two vibrissae, of two clamps, or at other stations."""
    check_same_beam(reference, candidate)
    if np.abs(reference.clamp_tangent - candidate.clamp_tangent).max() > _SAME_TANGENT:
        raise InputError(
            f"tangent of {candidate.source}", candidate.clamp_tangent.tolist(),
            f"{reference.clamp_tangent.tolist()}, that of {reference.source}",
            "compare sweeps of one clamp",
        )  # fmt: skip
    feet = reference.values(*FOOT), candidate.values(*FOOT)
    length = reference.beam.length
    if feet[0].shape != feet[1].shape or np.abs(feet[0] - feet[1]).max() >= _SAME_FOOT * length:
        raise InputError(
            f"stations of {candidate.source}",
            f"{len(feet[1])}, not the {len(feet[0])} of {reference.source}",
            f"the same foot positions, to {_SAME_FOOT:g} L",
            "sweep both along one [path]",
        )
