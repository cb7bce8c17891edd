"""From settings to a beam."""

from collections.abc import Callable
from typing import TypeAlias

from mujoco_models.beams.available import require
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.rod import Rod
from mujoco_models.beams.spatial import SpatialChain, SpatialRod
from mujoco_models.settings import Settings

_Kinds: TypeAlias = dict[str, Callable[[Settings, float], Beam]]

_PLANAR: _Kinds = {"chain": Chain, "rod": Rod, "cable": Cable}
_SPATIAL: _Kinds = {"chain": SpatialChain, "rod": SpatialRod, "cable": Cable}


def build(settings: Settings, spacing: float) -> Beam:
    """The beam that the settings ask for, with beads at most `spacing` apart [L].

    Parameters
    ----------
    settings : Settings
        Which beam, of how many segments.
    spacing : float
        Of the beads [L].

    Returns
    -------
    Beam
        Not yet a model of MuJoCo's.

    Raises
    ------
    InputError
        If the installed MuJoCo lacks it.
    """
    require(settings.beam)
    kinds = _PLANAR if settings.planar else _SPATIAL
    return kinds[settings.beam](settings, spacing)
