"""From settings to a beam."""

from collections.abc import Callable
from typing import TypeAlias

from analytic.problem.errors import InputError
from mujoco_models.beams.available import require
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.rod import Rod
from mujoco_models.beams.spatial import SpatialChain, SpatialRod
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings

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
