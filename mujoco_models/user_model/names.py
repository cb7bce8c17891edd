"""Which model of a user's is swept, and what of it is what."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, get_args

from analytic.problem.numbers import within
from mujoco_models.allowed import check_word
from mujoco_models.user_model.shipped import find_model

ContactKind: TypeAlias = Literal["own", "ours"]


@dataclass(frozen=True)
class OwnModel:
    """A model file, and the names of what is the vibrissa in it.

    Attributes
    ----------
    file : str or Path
        MJCF or URDF, in the units of the case, or the name of a shipped model.
    foot, force, torque, geoms, site : str or None
        As `mujoco_models.inspect_model` takes them; what is None is looked for.
    contact : str
        Whether contacts have the model's ``"own"`` parameters, or ``"ours"``: frictionless, and as
        stiff as `mujoco_models.Motion` says.
    timestep, damping, stiffness : float
        What the model's time step, the vibrissa's dampers and the stiffness of our contacts are
        multiplied by, in memory.
    solver : str
        The model's ``"own"``, or ``"newton"`` with iterations and tolerance that leave nothing.
    """

    file: Path
    foot: str | None = None
    force: str | None = None
    torque: str | None = None
    geoms: str | None = None
    site: str | None = None
    contact: ContactKind = "own"
    timestep: float = 1.0
    damping: float = 1.0
    stiffness: float = 1.0
    solver: Literal["own", "newton"] = "own"

    def __post_init__(self) -> None:
        """A name will do for a file."""
        object.__setattr__(self, "file", find_model(self.file))
        check_word("model.contact", self.contact, get_args(ContactKind))
        check_word("model.solver", self.solver, ("own", "newton"))
        for name in ("timestep", "damping", "stiffness"):
            within(f"model.{name}", getattr(self, name), 0.0)
