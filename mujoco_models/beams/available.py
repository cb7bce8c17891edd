"""Which beams the installed MuJoCo has; apart from them, so that asking does not load MuJoCo."""

from functools import cache
from importlib.metadata import version

from analytic.problem.errors import InputError
from mujoco_models.allowed import BeamKind


class Beams(tuple[BeamKind, ...]):
    """The beams that there are; ``missing`` gives for each other one the reason why it is not."""

    missing: dict[str, str]  # reason by name


@cache  # the metadata are a long file
def available_beams() -> Beams:
    """The beams that the installed MuJoCo has, and why not the others.

    Judged by MuJoCo's version alone, without importing it.

    Returns
    -------
    Beams
        Their names.
    """
    old = int(version("mujoco").split(".")[0]) < 4
    found = Beams(("chain", "cable") if old else ("chain", "rod"))
    found.missing = (
        {"rod": "the elastic one-dimensional flex came with MuJoCo 4: install mujoco>=4,<5"}
        if old
        else {"cable": "the composite cable went with MuJoCo 3: install mujoco==3.17.*"}
    )
    return found


def require(beam: str) -> None:
    """Refuse a beam that the installed MuJoCo lacks."""
    beams = available_beams()
    if beam in beams.missing:
        raise InputError(
            "mujoco.beam",
            beam,
            f"{' or '.join(beams)} with the installed MuJoCo {version('mujoco')}",
            beams.missing[beam],
        )
