"""What the disagreement of a sweep in space is made of, by changing one thing at a time."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic.space import SpatialReadings
from compare.explain.budget import STIFFER
from compare.explain.parts import Account, Parted, Shared
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.settings import SpatialSettings

_ORDER = 2.0  # of the chain in 1/N
_MOST = 400  # segments


def changes_in_space(settings: SpatialSettings) -> dict[str, SpatialSettings]:
    """The settings of all sweeps by name; ``base`` is the one that the budget is of."""
    segments, stiffness = 2 * settings.segments, STIFFER * settings.contact_stiffness
    if segments > _MOST:  # half as many show the same
        segments = settings.segments // 2
    if stiffness > CONTACT_STIFFNESSES[1]:
        stiffness = settings.contact_stiffness / STIFFER
    return {
        "base": settings,
        "segments": replace(settings, segments=segments),
        "stiffness": replace(settings, contact_stiffness=stiffness),
    }


def budget_in_space(
    exact: SpatialReadings,
    runs: Mapping[str, SpatialReadings],
    changes: Mapping[str, SpatialSettings],
) -> Parted:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts.

    Each of the six components is relative to the largest of its kind, force or moment.
    """
    shared = np.logical_and.reduce([one.touching for one in (exact, *runs.values())])
    account = Account(Shared(exact, shared), runs)
    base, run = changes["base"], account.run
    finer = (changes["segments"].segments / base.segments) ** _ORDER
    harder = changes["stiffness"].contact_stiffness / base.contact_stiffness
    account.add_extrapolated("discretisation", run["base"], run["segments"], finer)
    account.add_extrapolated("softness", run["base"], run["stiffness"], harder)
    account.settle()
    return Parted(**account.common(), **account.closing(), order=_ORDER, blame=account.blame())
