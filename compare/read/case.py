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
    """A case, how MuJoCo is to simulate it, how far models may disagree, what is uncertain."""

    case: Case  # the problem
    settings: Settings  # the numerics
    tolerances: Tolerances = field(default_factory=Tolerances)  # the limits
    # How the foot moves; None if MuJoCo's beam is at rest at every station.
    motion: "Motion | None" = None
    # What is uncertain about the case; None if nothing is stated.
    uncertainties: "Uncertainties | None" = None
    # The user's own model, if that is to be swept; it is always in motion.
    model: "OwnModel | None" = None
    engines: tuple[str, ...] = ("mujoco",)  # which engines sweep the case at rest
    timeout: float = 600.0  # the longest that each of them may take [s]


def load_job(name_or_path: str) -> Job:
    """The case of that name, or from that TOML file."""
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
