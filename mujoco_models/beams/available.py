"""Which beams the installed MuJoCo has."""

from importlib.metadata import version

from analytic.problem.errors import InputError


def available_beams() -> dict[str, str | None]:
    """Each beam with None, or with the reason why the installed MuJoCo does not have it.

    Judged by MuJoCo's version alone, without importing it.
    """
    old = int(version("mujoco").split(".")[0]) < 4
    return {
        "chain": None,
        "rod": "the elastic one-dimensional flex came with MuJoCo 4: install mujoco>=4,<5"
        if old
        else None,
        "cable": None
        if old
        else "the composite cable went with MuJoCo 3: install mujoco==3.17.0 in an environment "
        "of its own",
    }


def require(beam: str) -> None:
    """Refuse a beam that the installed MuJoCo lacks.

    Raises
    ------
    InputError
        Naming the version that has it.
    """
    beams = available_beams()
    if (reason := beams[beam]) is not None:
        there = " or ".join(name for name, lack in beams.items() if lack is None)
        raise InputError(
            "mujoco.beam", beam, f"{there} with the installed MuJoCo {version('mujoco')}", reason
        )
