"""Options that several commands share, and the job that they describe."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from analytic.problem.errors import InputError
from mujoco_models.allowed import BeamKind, ObstacleKind

if TYPE_CHECKING:
    from compare.read.case import Job
    from mujoco_models.motion import Motion

AGREES, DISAGREES = 0, 1

CaseName = Annotated[
    str, typer.Argument(metavar="CASE", help="A named case (see `vibrissa cases`) or a TOML file.")
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Folder for what is written.",
        show_default="results/CASE, with the options that change the case",
    ),
]


def out_folder(default: str) -> Any:  # noqa: ANN401  # typer's
    """The option ``--out`` of a command on files."""
    return typer.Option(
        "--out", metavar="DIR", help="Folder for what is written.", show_default=default
    )


Stations = Annotated[
    int | None,
    typer.Option(metavar="N", help="Stations of the sweep.", show_default="the case's, or 200"),
]
Segments = Annotated[
    int | None,
    typer.Option(metavar="N", help="Segments of MuJoCo's beam.", show_default="the case's, or 40"),
]
Beam = Annotated[
    BeamKind | None, typer.Option(help="MuJoCo's beam.", show_default="the case's, or chain")
]
Obstacle = Annotated[
    ObstacleKind | None,
    typer.Option(help="MuJoCo's obstacle.", show_default="the case's, or mesh"),
]
Spatial = Annotated[
    bool, typer.Option("--spatial", help="Let MuJoCo's beam leave the plane of the sweep.")
]
InMotion = Annotated[
    bool, typer.Option("--motion", help="Let the foot move as [motion] says, or at 0.01 L/T1.")
]
Speed = Annotated[
    float | None,
    typer.Option(metavar="V", help="Of the foot in motion [L/T1].", show_default="the case's"),
]
Timestep = Annotated[
    float | None,
    typer.Option(metavar="DT", help="MuJoCo's, in motion [T1].", show_default="the case's"),
]
Engines = Annotated[
    str | None,
    typer.Option(
        "--engine",
        metavar="A,B,...",
        help="Engines that sweep the case at rest; `vibrissa engines` lists them.",
        show_default="the case's, or mujoco",
    ),
]
BeamFile = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="TOML file whose [beam] table describes the vibrissa of measured data.",
    ),
]
Columns = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=COLUMN[:UNIT]", help="A column of a rig's file; repeat the option for each."
    ),
]
InFrame = Annotated[
    Literal["world", "clamp"],
    typer.Option("--frame", help="Of the six components in space."),
]
Way = Annotated[
    Literal["left", "right"] | None,
    typer.Option(help="Which sweep of a rig's file with one in each direction."),
]


@dataclass(frozen=True)
class Changes:
    """What the command line changes of a case and of its simulation; None leaves it as it is."""

    stations: int | None = None
    segments: int | None = None
    beam: BeamKind | None = None
    obstacle: ObstacleKind | None = None
    spatial: bool = False
    motion: bool = False
    speed: float | None = None
    timestep: float | None = None
    engines: str | None = None

    def job(self, name: str) -> "Job":
        """The job of that name or TOML file, with these changes."""
        from compare.read.case import load_job

        job = load_job(name)
        if job.model is not None:
            self._check_model()
        case = job.case
        if self.stations is not None:
            case = replace(case, sweep=replace(case.sweep, stations=self.stations))
        named: dict[str, Any] = {
            "segments": self.segments,
            "beam": self.beam,
            "obstacle": self.obstacle,
            "planar": False if self.spatial else None,
        }
        given = {key: value for key, value in named.items() if value is not None}
        if self.engines is not None:
            from engines.known import named_engines

            job = replace(job, engines=tuple(named_engines(self.engines)))
        return replace(
            job, case=case, settings=replace(job.settings, **given), motion=self._moved(job.motion)
        )

    def job_at_rest(self, name: str, command: str) -> "Job":
        """The job, as `job` makes it, for what knows sweeps at rest only."""
        job = self.job(name)
        if job.motion is not None:
            raise InputError(
                command,
                "of a sweep in motion",
                "of a sweep at rest",
                "take [motion] and [model] out of the case",
            )
        return job

    def _check_model(self) -> None:
        """Refuse what a model of the user's own says itself."""
        for option, value in (
            ("--segments", self.segments),
            ("--beam", self.beam),
            ("--obstacle", self.obstacle),
            ("--spatial", self.spatial or None),
            ("--timestep", self.timestep),
        ):
            if value is not None:
                raise InputError(option, value, "left out", "the case has a [model] of its own")

    def _moved(self, motion: "Motion | None") -> "Motion | None":
        named: dict[str, Any] = {"speed": self.speed, "timestep": self.timestep}
        given = {key: value for key, value in named.items() if value is not None}
        if motion is None and not (self.motion or given):
            return None
        from mujoco_models.motion import Motion

        return replace(motion or Motion(), **given)

    def folder(self, out: Path | None, case: str) -> Path:
        """Where the results go by default: runs that differ do not overwrite each other."""
        words = [
            case,
            *(word for word in (self.beam, self.obstacle) if word),
            *([f"{self.segments}-segments"] if self.segments is not None else []),
            *([f"{self.stations}-stations"] if self.stations is not None else []),
            *(["spatial"] if self.spatial else []),
            *(["in-motion"] if self.motion else []),
            *([f"speed-{self.speed:g}"] if self.speed is not None else []),
            *([f"timestep-{self.timestep:g}"] if self.timestep is not None else []),
            *(self.engines.replace(" ", "").split(",") if self.engines is not None else []),
        ]
        return out or Path("results") / "-".join(words)


def number_or_auto(option: str, text: str) -> float | Literal["auto"]:
    """The value of an option that takes a number or the word auto."""
    if text == "auto":
        return "auto"
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(option, repr(text), "a number or auto", "write it with a decimal point")
    return number
