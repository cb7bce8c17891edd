"""Cases by name or TOML file, and what is to be done with them."""

import difflib
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from analytic import NAMED_TABLES, Case, InputError, named_case
from compare.judge.tolerances import Tolerances
from mujoco_models.settings import Settings

if TYPE_CHECKING:
    from compare.validate.stated import Uncertainties
    from mujoco_models.motion import Motion
    from mujoco_models.own.names import OwnModel


@dataclass(frozen=True)
class Job:
    """A case, how MuJoCo is to simulate it, how far models may disagree, what is uncertain.

    Attributes
    ----------
    case : Case
        The problem.
    settings : Settings
        The numerics.
    tolerances : Tolerances
        The limits.
    motion : Motion or None
        How the foot moves; None if MuJoCo's beam is at rest at every station.
    uncertainties : Uncertainties or None
        What is uncertain about the case; None if nothing is stated.
    model : OwnModel or None
        The user's own model, if that is to be swept; it is always in motion.
    engines : tuple of str
        Which engines sweep the case at rest.
    timeout : float
        The longest that each of them may take [s].
    """

    case: Case
    settings: Settings
    tolerances: Tolerances = field(default_factory=Tolerances)
    motion: "Motion | None" = None
    uncertainties: "Uncertainties | None" = None
    model: "OwnModel | None" = None
    engines: tuple[str, ...] = ("mujoco",)
    timeout: float = 600.0


def load_job(name_or_path: str) -> Job:
    """The case of that name, or from that TOML file.

    Parameters
    ----------
    name_or_path : str
        A named case, or the path of a ``.toml`` file.

    Returns
    -------
    Job
        With defaults for what the file leaves out.

    Raises
    ------
    InputError
        If there is neither, or the file has unknown keys, wrong types, unknown units, numbers with
        and without units mixed, or states no solvable problem.
    """
    if name_or_path in NAMED_TABLES:
        return Job(named_case(name_or_path), Settings())
    if not name_or_path.endswith(".toml"):
        near = difflib.get_close_matches(name_or_path, NAMED_TABLES, n=1)
        raise InputError(
            "case",
            repr(name_or_path),
            f"one of {', '.join(NAMED_TABLES)}, or the path of a .toml file",
            f"did you mean {near[0]}?" if near else "`vibrissa cases` lists them",
        )
    from compare.read.case_file import read_job  # named cases need none of the tables of a file

    return read_job(Path(name_or_path))
