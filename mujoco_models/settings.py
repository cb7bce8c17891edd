"""The numerics of a MuJoCo sweep: everything that is not physics."""

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal, TypeAlias, TypeVar, get_args

from pydantic import BeforeValidator, ConfigDict, StrictBool, StrictFloat, StrictInt

from analytic.problem.errors import InputError
from mujoco_models.allowed import (
    BEAMS,
    CLAMPS,
    CONTACT_STIFFNESSES,
    OBSTACLES,
    SPRINGS,
    BeamKind,
    ClampKind,
    Limits,
    ObstacleKind,
    SpringKind,
    check_numbers,
    check_word,
)

SpatialBeamKind: TypeAlias = Literal["chain", "rod"]
JointKind: TypeAlias = Literal["ball", "universal"]
Words: TypeAlias = dict[str, tuple[str, ...]]
_Beam = TypeVar("_Beam")


@dataclass(frozen=True)
class _Discretised:
    """What all models have."""

    __pydantic_config__ = ConfigDict(extra="forbid")  # a misspelt key in a case file is an error

    beam: BeamKind = "chain"
    segments: StrictInt = 40
    contour_points: StrictInt = 3200
    contact_stiffness: StrictFloat = 1e7
    clamp: ClampKind = "second-order"
    tolerance: StrictFloat = 1e-8
    _words: ClassVar[Words]
    _limits: ClassVar[Limits]

    def __post_init__(self) -> None:
        for name, allowed in self._words.items():
            check_word(f"mujoco.{name}", getattr(self, name), allowed)
        check_numbers("mujoco", self, self._limits)


def _limits(segments: int, contour_points: int, tolerance: float) -> Limits:
    return {
        "segments": (2, segments, "40 is usual"),
        "contour_points": (8, contour_points, "3200 is usual"),
        "contact_stiffness": (*CONTACT_STIFFNESSES, "1e7 is usual"),
        "tolerance": (tolerance, 1e-2, "1e-8 is usual"),
    }


@dataclass(frozen=True)
class Settings(_Discretised):
    """How MuJoCo simulates a case.

    Lengths and stiffnesses are in units of the case: L, EI/L^3 and EI/L.

    Parameters
    ----------
    beam : str
        Which of MuJoCo's models of a slender beam; see `available_beams`.
    segments : int
        Number of segments N, at least 2.
    contour_points : int
        Points of the obstacle's mesh along the contour, at equal steps of slope angle.
    contact_stiffness : float
        Force over penetration of a contact [EI/L^3].
    clamp : str
        Where the beam first bends: half a cell from the clamp, ``"second-order"`` in 1/N, or a
        whole one, ``"naive"`` (first order; for comparison).
    tolerance : float
        A station has settled when no joint is out of balance by more than this [EI/L].
    corner_radius : float
        Of the thin edges that stand for an object's sharp corners [L].
    obstacle : str
        The object as a ``"mesh"``, or, if its contour has no corners, as MuJoCo's smooth
        ``"primitive"``: a cylinder that osculates the contour where the vibrissa touches.
    planar : bool
        Whether the beam stays in the plane of the sweep, as in the theory, or may leave it.
    springs : str
        Of the planar chain: ``"linear"``, EI/h times a joint's turn, or ``"arc"``, EI times the
        curvature of the arc between its two links, with the first joint h/24 nearer the clamp: of
        second order, too, with less left where it bends much.

    Raises
    ------
    InputError
        If a number is out of its range.
    """

    corner_radius: StrictFloat = 1e-6
    obstacle: ObstacleKind = "mesh"
    planar: StrictBool = True
    springs: SpringKind = "linear"
    _words: ClassVar[Words] = {
        "beam": BEAMS,
        "clamp": CLAMPS,
        "obstacle": OBSTACLES,
        "springs": SPRINGS,
    }
    _limits: ClassVar[Limits] = {
        **_limits(1000, 50_000, 1e-11),
        "corner_radius": (1e-9, 1e-3, "1e-6 is usual"),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.planar, bool):
            raise InputError(
                "mujoco.planar",
                repr(self.planar),
                "true or false",
                "false lets the beam leave the plane",
            )
        if self.springs == "arc" and not (self.beam == "chain" and self.planar):
            raise InputError(
                "mujoco.springs", "'arc'", "'linear'", "only the chain in the plane has arcs"
            )

    @property
    def elsewhere(self) -> bool:
        """Whether other engines have its beam: the chain in the plane, on linear springs."""
        return self.beam == "chain" and self.planar and self.springs == "linear"


def _no_cable(beam: _Beam) -> _Beam:
    """MuJoCo has a beam of that name too, so that it takes a reason why it is none here."""
    if beam == "cable":
        raise InputError(
            "mujoco.beam",
            "'cable'",
            "'chain' or 'rod' in space",
            "the cable's joints are the chain's balls, whose moments are the same to 1e-14",
        )
    return beam


@dataclass(frozen=True)
class SpatialSettings(_Discretised):
    """How MuJoCo simulates a case in space.

    Stiffnesses and moments are in units of the case: EI/L^3 and EI/L.

    Parameters
    ----------
    beam : str
        Rigid links with springs, ``"chain"``, or MuJoCo 4's one-dimensional flex, ``"rod"``. MuJoCo
        3's composite cable is the chain in space: the same moments at the same turns of its balls.
    segments : int
        Number of segments N, at least 2.
    contour_points : int
        Points of a prism's mesh along its contour, at equal steps of slope angle; about as many
        points has a body that is stated by its support function.
    contact_stiffness : float
        Force over penetration of the contact [EI/L^3].
    clamp : str
        Where the beam first bends: half a cell from the clamp, ``"second-order"`` in 1/N, or a
        whole one, ``"naive"`` (first order; for comparison).
    tolerance : float
        A station has settled when no joint is out of balance by more than this [EI/L].
    joints : str
        Of the links: a ``"ball"`` bends alike in all directions and twists, with GJ = EI; a
        ``"universal"`` joint, two hinges, does not twist. The rod has universal joints only.

    Raises
    ------
    InputError
        If a word is unknown, or a number out of its range.
    """

    beam: Annotated[SpatialBeamKind, BeforeValidator(_no_cable)] = "chain"
    joints: JointKind = "ball"
    _words: ClassVar[Words] = {
        "beam": get_args(SpatialBeamKind),
        "joints": get_args(JointKind),
        "clamp": CLAMPS,
    }
    _limits: ClassVar[Limits] = _limits(400, 20_000, 1e-10)

    def __post_init__(self) -> None:
        _no_cable(self.beam)
        super().__post_init__()
        if self.beam == "rod" and self.joints != "universal":
            raise InputError(
                "mujoco.joints",
                repr(self.joints),
                "'universal' for the rod",
                "a one-dimensional flex cannot resist twisting",
            )
