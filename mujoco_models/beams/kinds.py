"""From settings to a beam."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from analytic.problem.errors import InputError
from mujoco_models.beams.available import require
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.protocol import Beam, SpatialBeam
from mujoco_models.beams.rod import Rod
from mujoco_models.beams.spatial import SpatialChain, SpatialRod, UniversalChain
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings, SpatialSettings

_Kinds: TypeAlias = dict[str, Callable[[Settings, float, Vibrissa], Beam]]

_PLANAR: _Kinds = {"chain": Chain, "rod": Rod, "cable": Cable}
_SPATIAL: _Kinds = {"chain": SpatialChain, "rod": SpatialRod, "cable": Cable}


def build(settings: Settings, spacing: float, vibrissa: Vibrissa | None = None) -> Beam:
    """The beam that the settings ask for, with beads at most `spacing` apart [L]."""
    require(settings.beam)
    vibrissa = vibrissa or Vibrissa()
    if not (settings.planar or vibrissa.is_plain):
        raise InputError(
            "mujoco.planar",
            False,
            "true for a vibrissa that is curved at rest, varies, or whose clamp turns",
            "sideways it would twist, and no theory of it is here",
        )
    kinds = _PLANAR if settings.planar else _SPATIAL
    return kinds[settings.beam](settings, spacing, vibrissa)


def build_spatial(settings: SpatialSettings) -> SpatialBeam:
    """The beam that the settings of a sweep in space ask for, without beads of its own."""
    require(settings.beam)
    planar = Settings(beam=settings.beam, segments=settings.segments, clamp=settings.clamp)
    if settings.beam == "rod":
        return SpatialRod(planar, np.inf)
    kind = SpatialChain if settings.joints == "ball" else UniversalChain
    return kind(planar, np.inf)
