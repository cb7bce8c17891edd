"""A case, and what is to be done with it."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias

from analytic import Case
from compare.judge.tolerances import SpatialTolerances, Tolerances
from compare.read.kinds import MODEL, MOTION, PLANE, SPACE
from engines.known import named_engines
from mujoco_models.settings import Settings, SpatialSettings

if TYPE_CHECKING:
    from analytic.space import Body, SpatialCase
    from compare.validate.stated import Uncertainties
    from mujoco_models.motion import Motion
    from mujoco_models.user_model.names import OwnModel

EXACT = "exact"
"""What the closed form is called among the engines."""


@dataclass(frozen=True)
class _Stated:
    """A case and its numerics, of which the stations and the settings may be changed."""

    case: Any
    settings: Any
    _path: ClassVar[str]  # the field of the case that has its stations

    @property
    def stations(self) -> int:
        return int(getattr(self.case, self._path).stations)

    def changed(self, stations: int, numerics: dict[str, Any]) -> Self:
        """The same with so many stations, and with other settings of MuJoCo by name."""
        path = replace(getattr(self.case, self._path), stations=stations)
        case = replace(self.case, **{self._path: path})
        return replace(self, case=case, settings=replace(self.settings, **numerics))

    def solve(self, certified: bool = False) -> Any:  # noqa: ANN401  # as the case, readings
        """The closed form; certified, every station is proved to rest, and how exactly it does."""
        from analytic import solve_sweep
        from analytic.space import solve_space

        solver: Any = solve_sweep if isinstance(self.case, Case) else solve_space
        return solver(self.case, certified)


@dataclass(frozen=True)
class Job(_Stated):
    """A case in the plane, how it is to be simulated, how far models may disagree.

    Attributes
    ----------
    case : Case
        The problem.
    settings : Settings
        The numerics of MuJoCo.
    tolerances : Tolerances
        The limits of agreement.
    motion : Motion or None
        How the foot moves; None if MuJoCo's beam is at rest at every station.
    uncertainties : Uncertainties or None
        What is uncertain about the case; None if nothing is stated.
    model : OwnModel or None
        The user's own model, if that is to be swept; it is always in motion.
    engines : tuple of str
        Which engines sweep the case at rest; none: the closed form alone.
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
    body: ClassVar[None] = None
    _path = "sweep"

    @property
    def kind(self) -> str:
        if self.model is not None:
            return MODEL
        return PLANE if self.motion is None else MOTION


@dataclass(frozen=True)
class SpaceJob(_Stated):
    """A case in space, how it is to be simulated, how far models may disagree.

    Attributes
    ----------
    case : SpatialCase
        The problem.
    settings : SpatialSettings
        The numerics of MuJoCo.
    tolerances : SpatialTolerances
        The limits of agreement.
    engines : tuple of str
        Which engines sweep the case; none: the closed form alone.
    motion : Motion or None
        How the foot moves; None if MuJoCo's beam is at rest at every station.
    """

    case: "SpatialCase"
    settings: SpatialSettings = field(default_factory=SpatialSettings)
    tolerances: SpatialTolerances = field(default_factory=SpatialTolerances)
    engines: tuple[str, ...] = ("mujoco",)
    motion: "Motion | None" = None
    model: ClassVar[None] = None
    uncertainties: ClassVar[None] = None
    _path = "path"

    @property
    def kind(self) -> str:
        return SPACE

    @property
    def body(self) -> "Body":
        return self.case.body


AnyJob: TypeAlias = Job | SpaceJob
"""A case in the plane or in space: both can be solved, swept and compared alike."""


def engines_beside_exact(names: str) -> tuple[str, ...]:
    """The engines of a list beside the closed form, called ``exact``; none if that is alone."""
    listed = [name.strip() for name in names.split(",")]
    others = [name for name in listed if name != EXACT]
    return tuple(named_engines(",".join(others))) if others else ()
