"""A hash of a problem's physics."""

import hashlib
import json
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.clamp_path import Sweep

if TYPE_CHECKING:
    from analytic.problem.case import Case

_PLACES = 67  # of a contour


def digest_of(case: "Case") -> str:
    """Equal for equal problems, whatever the case is called."""
    xi, eta = case.centreline.place(np.linspace(*case.reach, _PLACES))
    beam, foot_x = case.beam, case.foot_x
    sizes = beam.length, beam.base_rigidity, beam.radius
    if isinstance(case.sweep, Sweep):
        ends = [foot_x[0], foot_x[-1], len(foot_x)]
    else:
        ends = [value for values in case.stations for value in values.tolist()]
    numbers = np.array([*sizes, *ends, *xi, *eta])
    if not case.is_plain:
        base_curvature = float(beam.curvature_at(0.0))
        beyond = base_curvature, case.clamp_stiffness, case.friction
        numbers = np.append(numbers, beyond)
    if case.clamp_angle or any(case.weight):
        numbers = np.append(numbers, case.clamp_angle)
    if any(case.weight):
        numbers = np.append(numbers, case.weight)
    for other in case.alone:
        places = other.centreline.place(np.linspace(*other.reach, _PLACES))
        numbers = np.append(numbers, places)
    text = " ".join(["%.12e"] * numbers.size) % tuple(numbers.tolist())
    if beam.varies:
        given = asdict(beam)
        names = "flexural_rigidity", "tip_radius", "natural_curvature"
        text += json.dumps([given[name] for name in names])
    return hashlib.sha256(text.encode()).hexdigest()[:16]
