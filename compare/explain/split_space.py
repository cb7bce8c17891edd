"""What the disagreement of a sweep in space is made of, by changing one thing at a time."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from compare.measure.disagreement import rms
from compare.sense.touching import component_scales
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.settings import SpatialSettings

_ORDER = 2  # of the chain in 1/N
_MOST = 400  # segments
_STIFFER = 10.0


class Parts(NamedTuple):
    """The parts of a disagreement; each a root mean square over the stations that all sweeps share.

    Relative to the largest component of force and of moment; of the two the larger one.
    """

    whole: float
    """Of the disagreement itself."""
    discretisation: float
    """What the limit of many segments does not have, by another number and order two."""
    softness: float
    """What a rigid contact does not have, by another stiffness."""
    unexplained: float
    """What is left when these are subtracted, station by station."""
    stations: int
    """How many all sweeps share."""

    def to_dict(self) -> dict[str, Any]:
        """What ``budget.json`` holds."""
        return self._asdict()


def split_space(
    exact: SpatialReadings,
    base: SpatialReadings,
    settings: SpatialSettings,
    sweep: Callable[[SpatialSettings], SpatialReadings],
) -> Parts:
    """Split the disagreement of a sweep in MuJoCo, by two more with one other setting each."""
    other = 2 * settings.segments  # where there cannot be so many, half as many show the same
    if other > _MOST:
        other = settings.segments // 2
    finer = sweep(replace(settings, segments=other))
    stiffness = _STIFFER * settings.contact_stiffness
    if stiffness > CONTACT_STIFFNESSES[1]:
        stiffness = settings.contact_stiffness / _STIFFER
    stiffer = sweep(replace(settings, contact_stiffness=stiffness))
    shared = np.logical_and.reduce([r.touching for r in (exact, base, finer, stiffer)])
    values = {
        name: _scaled(exact, readings, shared)
        for name, readings in (("exact", exact), ("base", base), ("n", finer), ("k", stiffer))
    }
    whole = values["base"] - values["exact"]
    coarse = (values["base"] - values["n"]) / (1 - (settings.segments / other) ** _ORDER)
    soft = (values["base"] - values["k"]) / (1 - settings.contact_stiffness / stiffness)
    rest = whole - coarse - soft
    return Parts(_worst(whole), _worst(coarse), _worst(soft), _worst(rest), int(shared.sum()))


def _scaled(exact: SpatialReadings, readings: SpatialReadings, shared: Booleans) -> Floats:
    """All components over the largest of their kind, shape (6, stations)."""
    scales = component_scales(exact)
    return np.stack([readings.values(name)[shared] / (scales[name] or 1.0) for name in scales])


def _worst(signal: Floats) -> float:
    return float(rms(signal).max())
