"""How far readings lag behind the foot, from passes to either side of an object nobody knows.

A contour of some family is fitted to all passes, and the lag and the vibrissa's rigidity with it:
in a sweep to the left a lag moves all that is found to the left, in one to the right to the right.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.calibration.unknowns import LAG
from analytic.from_clamp.fitted import NoFamilyError
from analytic.from_clamp.noise import known_to, reading_noise
from analytic.from_clamp.object.fit_object import families_fitted, late_if_both_ways
from analytic.from_clamp.passes import as_passes
from analytic.problem.columns import CLAMP_READINGS, SENSED
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings

_FAMILIES = ("circle", "ellipse", "convex")  # the simplest one that explains the readings counts
_MEANS = 200  # of each direction: as many stations as an object needs


@dataclass(frozen=True)
class Lag:
    """How far the foot goes until a reading of its place is there."""

    way: Estimate  # [length]; negative if the readings come before the place
    rigidity: Estimate  # of the vibrissa, over the stated one
    family: str  # of the contour that explains both directions

    @property
    def shows(self) -> bool:
        return not self.way.lowest <= 0 <= self.way.highest


def lag_between(readings: Sequence[Readings]) -> Lag | None:
    """The lag that passes in both directions show.

    A play of the stage looks alike, and so may friction; an offset, which is to the same side in
    both directions, does not.

    Parameters
    ----------
    readings : sequence of Readings
        Passes of one rig past one object.

    Returns
    -------
    Lag or None
        None if they are all in one direction, or no contour explains them all.
    """
    passes = as_passes(readings)
    if not late_if_both_ways(passes):
        return None
    means = [
        _mean_of([one for one in passes if one.runs_right == right]) for right in (False, True)
    ]
    found = None
    with suppress(InputError):  # as of an object that one direction does not touch
        fit = families_fitted(means, _noise_of(means), ("flexural_rigidity", LAG))
        for family in _FAMILIES:
            with suppress(NoFamilyError):
                found = fit(family)
                if found.explains:
                    break
    if found is None or not found.explains:
        return None
    rigidity, size = found.found["flexural_rigidity"], passes[0].beam.base_rigidity
    shares = (x / size for x in (rigidity.value, rigidity.lowest, rigidity.highest))
    return Lag(found.found[LAG], Estimate(*shares), family)


def _noise_of(means: Sequence[Readings]) -> dict[str, float]:
    """Noise of the means, and what is left of zeros: of many rows that is more."""
    sizes = []
    for one in means:
        seen = np.array([*reading_noise(one).values()])
        known = [known_to(f"{what}_uncertainty", one) for what in ("zero", "bend")]
        sizes.append(np.linalg.norm([seen, *known], axis=0))
    return dict(zip(CLAMP_READINGS, np.max(sizes, axis=0).tolist(), strict=True))


def _mean_of(passes: Sequence[Readings]) -> Readings:
    """All passes in one direction as one, with means of its rows."""
    table = pd.concat([one.table.loc[one.trusted, list(SENSED)] for one in passes])
    table = table.sort_values("foot_x", kind="stable", ascending=passes[0].runs_right)
    part = np.arange(len(table)) * min(_MEANS, len(table)) // len(table)
    known = [x for one in passes if (x := one.provenance.get("zero_uncertainty"))]
    provenance = dict(passes[0].provenance)
    if known:  # means of several zeros are no worse known than each of them
        provenance["zero_uncertainty"] = {
            name: max(float(one[name]) for one in known) for name in CLAMP_READINGS
        }
    of_all = table.groupby(part).mean().reset_index(drop=True)
    return replace(passes[0], table=of_all, provenance=provenance)
