"""From settings to a beam."""

from collections.abc import Callable

from mujoco_models.beams.available import require
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.rod import Rod
from mujoco_models.settings import Settings

_KINDS: dict[str, Callable[[Settings, float], Beam]] = {"chain": Chain, "rod": Rod, "cable": Cable}


def build(settings: Settings, spacing: float) -> Beam:
    """The beam that the settings ask for, with beads at most `spacing` apart [L].

    Raises
    ------
    InputError
        If the installed MuJoCo lacks it.
    """
    require(settings.beam)
    return _KINDS[settings.beam](settings, spacing)
