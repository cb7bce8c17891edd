"""What noise of the six components hides: the stations at which no force stands out from it."""

from collections.abc import Mapping

import numpy as np

from analytic.from_clamp.contact import UNLOADED
from analytic.from_clamp.noise import checked_noise, scatter
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.space.problem.readings import FORCE, MOMENT, SpatialReadings

COMPONENTS = (*FORCE, *MOMENT)
_SIGMAS = 5.0  # noise alike in x, y and z makes more of no force once in 65,000 stations
_BOTH = np.sqrt(2.0)  # where nothing touches, noise of force and of moment make one product


def component_noise(
    readings: SpatialReadings, stated: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Standard deviation of each component's noise: what is stated, or seen if that is more.

    What jumps from station to station is seen, as in the plane. Stations that lie far apart seem to
    jump, too; but one force, wherever it acts and in whatever frame, has no moment along itself:
    what F . M jumps by is noise and nothing else, and if it is less than what was seen allows, what
    was seen is so much less noise.
    """
    given = {} if stated is None else checked_noise(stated, COMPONENTS)
    force, moment = readings.values(*FORCE), readings.values(*MOMENT)
    loaded = readings.trusted & force.any(axis=1)
    force, moment = force[loaded], moment[loaded]
    seen = np.array([scatter(values) for values in np.hstack([force, moment]).T])
    allowed = np.sqrt(moment**2 @ seen[:3] ** 2 + force**2 @ seen[3:] ** 2)
    product = (force * moment).sum(axis=1)
    share = min(1.0, _BOTH * scatter(product[allowed > 0] / allowed[allowed > 0]))
    return {
        name: max(float(given.get(name, 0.0)), share * float(size))
        for name, size in zip(COMPONENTS, seen, strict=True)
    }


def over_units(noise: Mapping[str, float], beam: Beam) -> Floats:
    """Those of the six components, dimensionless; nothing of what is not there."""
    units = np.repeat([beam.force_unit, beam.moment_unit], 3)
    return np.asarray([noise.get(name, 0.0) for name in COMPONENTS] / units)


def least_force(readings: SpatialReadings, noise: Mapping[str, float]) -> float:
    """The force below which a station is taken for free."""
    return max(_SIGMAS * max(noise[name] for name in FORCE), UNLOADED * readings.beam.force_unit)


def felt(readings: SpatialReadings, noise: Mapping[str, float]) -> Booleans:
    """Trusted stations with a force that noise does not make."""
    force = np.linalg.norm(readings.values(*FORCE), axis=1)
    return np.asarray(readings.trusted & (force > least_force(readings, noise)))
