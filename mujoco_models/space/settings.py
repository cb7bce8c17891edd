"""The numerics of a MuJoCo sweep in space: everything that is not physics."""

from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias, TypeVar, get_args

from pydantic import BeforeValidator, ConfigDict, StrictFloat, StrictInt

from analytic.problem.errors import InputError
from mujoco_models.allowed import CONTACT_STIFFNESSES, ClampKind, check_number, check_word

SpatialBeamKind: TypeAlias = Literal["chain", "rod"]
JointKind: TypeAlias = Literal["ball", "universal"]
_WORDS = {
    "beam": get_args(SpatialBeamKind),
    "joints": get_args(JointKind),
    "clamp": get_args(ClampKind),
}
_Beam = TypeVar("_Beam")


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
class SpatialSettings:
    """How MuJoCo simulates a case in space.

    Stiffnesses and moments are in units of the case: EI/L^3 and EI/L.

    Parameters
    ----------
    beam : str
        Rigid links with springs, ``"chain"``, or MuJoCo 4's one-dimensional flex, ``"rod"``. MuJoCo
        3's composite cable is the chain in space: the same moments at the same turns of its balls.
    joints : str
        Of the links: a ``"ball"`` bends alike in all directions and twists, with GJ = EI; a
        ``"universal"`` joint, two hinges, does not twist. The rod has universal joints only.
    segments : int
        Number of segments N, at least 2.
    contact_stiffness : float
        Force over penetration of the contact [EI/L^3].
    clamp : str
        Where the beam first bends: half a cell from the clamp, ``"second-order"`` in 1/N, or a
        whole one, ``"naive"`` (first order; for comparison).
    contour_points : int
        Points of a prism's mesh along its contour, at equal steps of slope angle; about as many
        points has a body that is stated by its support function.
    tolerance : float
        A station has settled when no joint is out of balance by more than this [EI/L].

    Raises
    ------
    InputError
        If a word is unknown, or a number out of its range.
    """

    __pydantic_config__ = ConfigDict(extra="forbid")  # a misspelt key in a case file is an error

    beam: Annotated[SpatialBeamKind, BeforeValidator(_no_cable)] = "chain"
    joints: JointKind = "ball"
    segments: StrictInt = 40
    contact_stiffness: StrictFloat = 1e7
    clamp: ClampKind = "second-order"
    contour_points: StrictInt = 3200
    tolerance: StrictFloat = 1e-8

    def __post_init__(self) -> None:
        _no_cable(self.beam)
        for name, allowed in _WORDS.items():
            check_word(f"mujoco.{name}", getattr(self, name), allowed)
        if self.beam == "rod" and self.joints != "universal":
            raise InputError(
                "mujoco.joints",
                repr(self.joints),
                "'universal' for the rod",
                "a one-dimensional flex cannot resist twisting",
            )
        check_number("mujoco.segments", self.segments, 2, 400, "40 is usual", whole=True)
        points = self.contour_points
        check_number("mujoco.contour_points", points, 8, 20_000, "3200 is usual", whole=True)
        for name, low, high, remedy in (
            ("contact_stiffness", *CONTACT_STIFFNESSES, "1e7 is usual"),
            ("tolerance", 1e-10, 1e-2, "1e-8 is usual"),
        ):
            check_number(f"mujoco.{name}", getattr(self, name), low, high, remedy)
