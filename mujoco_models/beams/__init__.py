"""MuJoCo's models of a slender beam, and which of them the installed MuJoCo has."""

from collections.abc import Callable
from importlib.metadata import version

from analytic.problem.errors import InputError
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.rod import Rod
from mujoco_models.settings import Settings


def available_beams() -> dict[str, str | None]:
    """Each beam, with the reason why the installed MuJoCo does not have it, or None if it does.

    Judged by the installed version alone; MuJoCo is not imported.
    """
    major = int(version("mujoco").split(".")[0])
    return {
        "chain": None,
        "rod": None if major >= 4 else "the elastic one-dimensional flex came with MuJoCo 4",
        "cable": None if major < 4 else "the composite cable was removed in MuJoCo 4; 3.17 has it",
    }


def build(settings: Settings) -> Beam:
    """The beam that the settings ask for.

    Raises
    ------
    InputError
        If the installed MuJoCo lacks it; naming the version that has it.
    """
    beams = available_beams()
    if (reason := beams[settings.beam]) is not None:
        there = " or ".join(name for name, lack in beams.items() if lack is None)
        raise InputError(
            "mujoco.beam", settings.beam, f"{there} with MuJoCo {version('mujoco')}", reason
        )
    kinds: dict[str, Callable[[Settings], Beam]] = {"chain": Chain, "rod": Rod, "cable": Cable}
    return kinds[settings.beam](settings)
