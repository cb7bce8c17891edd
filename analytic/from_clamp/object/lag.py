"""How far readings lag behind the foot, from passes to either side of an object nobody knows.

A contour of some family is fitted to all passes, and the lag and the vibrissa's rigidity with it:
in a sweep to the left a lag moves all that is found to the left, in one to the right to the right.
A vibrissa that is longer than stated, or a moment about a point off the clamp, explains nearly the
same: each is fitted in the lag's place, and the likeliest counts.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd

from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.calibration.unknowns import LAG, LOOK_LIKE_LAG, UNKNOWNS, Unknown
from analytic.from_clamp.fitted import NoFamilyError, likeliest
from analytic.from_clamp.noise import known_to, reading_noise
from analytic.from_clamp.object.fit_object import (
    FittedObject,
    families_fitted,
    late_if_both_ways,
)
from analytic.from_clamp.passes import as_passes
from analytic.problem.columns import CLAMP_READINGS, SENSED
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings

_FAMILIES = ("circle", "ellipse", "convex")  # the simplest one that explains the readings counts
_MEANS = 200  # of each direction: as many stations as an object needs


@dataclass(frozen=True)
class Lag:
    """How far the foot goes until a reading of its place is there, or what explains that better."""

    way: Estimate | None  # [length]; negative if the readings come before the place
    rigidity: Estimate  # of the vibrissa, over the stated one
    family: str  # of the contour that explains both directions
    # What else explains them as well, or alone if there is no `way`: the vibrissa's ``length``, and
    # the ``lever`` along it from the clamp to where the moment is taken, both over L.
    otherwise: dict[str, Estimate] = field(default_factory=dict)

    @property
    def shows(self) -> bool:
        return self.way is None or not _may_be_zero(self.way)


def _may_be_zero(way: Estimate) -> bool:
    return way.lowest <= 0 <= way.highest


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
    noise = _noise_of(means)
    late = _explaining(means, noise, UNKNOWNS[LAG], _FAMILIES)
    fits = {} if late is None else {LAG: late}
    if late is None or not _may_be_zero(late.found[LAG]):
        simple = _FAMILIES.index(late.family) + 1 if late else -1  # more has an object by chance
        for name, unknown in LOOK_LIKE_LAG.items():
            other = _explaining(means, noise, unknown, _FAMILIES[:simple])
            fits |= {} if other is None else {name: other}
    if not fits:
        return None
    named = {name: replace(fit, family=name) for name, fit in fits.items()}
    best = likeliest("auto", [*named], named.__getitem__, "")
    possible = [best.family, *best.others]
    rigidity, size = best.found["flexural_rigidity"], passes[0].beam.base_rigidity
    return Lag(
        fits[LAG].found[LAG] if LAG in possible else None,
        _over(rigidity, size),
        fits[best.family].family,
        {x: _over(fits[x].found[x], passes[0].beam.length) for x in possible if x != LAG},
    )


def _explaining(
    means: Sequence[Readings],
    noise: Mapping[str, float],
    unknown: Unknown,
    families: Sequence[str],
) -> FittedObject | None:
    """The simplest object that explains all beside an unknown and the vibrissa's rigidity."""
    with suppress(InputError):  # as of an object that one direction does not touch
        fit = families_fitted(means, noise, [UNKNOWNS["flexural_rigidity"], unknown])
        for family in families:
            with suppress(NoFamilyError):
                found = fit(family)
                if found.explains:
                    return found
    return None


def _over(found: Estimate, size: float) -> Estimate:
    return Estimate(found.value / size, found.lowest / size, found.highest / size)


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
