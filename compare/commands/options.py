"""Options that several commands share, for what they hold, and the job that they describe.

What is given is looked at before any work is done: an option that would be ignored is bad input.
"""

import math
import sys
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal, get_type_hints

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.read.case import load_case
from compare.read.job import AnyJob, Job, engines_beside_exact
from compare.read.kinds import MODEL, MOTION, PLANE, SPACE
from mujoco_models.allowed import BeamKind, ObstacleKind

IN_THE_PLANE = (PLANE, MOTION, MODEL)
ANY_CASE = (*IN_THE_PLANE, SPACE)
_LEFT_OUT = "left out but for "
A_RIG = "a file that no engine wrote"


@dataclass(frozen=True)
class For:
    """What an option holds for: any of these kinds, and beside all of what else is named."""

    kinds: tuple[str, ...]
    beside: tuple[str, ...] = ()

    def lacks(self, kind: str, others: Collection[str]) -> str | None:
        """What would be allowed, if the option would be ignored."""
        if kind not in self.kinds:
            return _LEFT_OUT + " or ".join(self.kinds)
        missing = [one for one in self.beside if one not in others]
        return f"beside {missing[0]}" if missing else None


def require_use(context: typer.Context, kind: str, *others: str) -> None:
    """Refuse options that would be ignored: of what kind it is, and what else is asked for."""
    hints = get_type_hints(context.command.callback, include_extras=True)
    given = {one.name: one for one in context.command.params if one.name and _given(context, one)}
    asked = {*others, *(one.opts[0] for one in given.values())}
    for name, parameter in given.items():
        uses = [use for use in getattr(hints[name], "__metadata__", ()) if isinstance(use, For)]
        lacks = [use.lacks(kind, asked) for use in uses]
        if lacks and all(lacks):
            is_option, value = parameter.param_type_name == "option", context.params[name]
            called = parameter.opts[0] if is_option else name.upper()
            shown = "given" if isinstance(value, bool) else str(value)
            allowed = str(lacks[-1])
            if parameter.required:  # and so cannot be left out
                allowed = allowed.removeprefix(_LEFT_OUT)
            raise InputError(called, shown, allowed, f"this is {kind}")


def _given(context: typer.Context, parameter: Any) -> bool:  # noqa: ANN401  # typer's own
    source = context.get_parameter_source(parameter.name)
    return source is not None and source.name == "COMMANDLINE"


def no_rigs(files: Iterable[Path]) -> bool:
    """Whether this project wrote all of these files of readings."""
    from analytic.problem.readings_file import is_ours

    return all(is_ours(file) for file in files)


def from_rigs(files: Collection[Path]) -> bool:
    """Whether a rig's file is among these, or passes of one: then a direction says something."""
    return not no_rigs(files) or are_passes(files)


def pass_files(files: Iterable[Path]) -> list[Path]:
    """The files of readings; of a folder that ``rig`` wrote those of its passes."""
    found = []
    for file in files:
        if not file.is_dir():
            found.append(file)
            continue
        if not (file / "passes.json").is_file():
            remedy = "make one: vibrissa rig FILE... --rig RIG.toml --out DIR"
            raise InputError("FILE", file, "a file, or a folder that `rig` wrote", remedy)
        from compare.read.run_folder import PassesRecord, read_stored

        record = read_stored(file / "passes.json", PassesRecord)
        found += [file / f"{one['name']}.parquet" for one in record.passes]
    for file in found:
        regular_file(file, "readings file", sys.maxsize)
    return found


def are_passes(files: Iterable[Path]) -> bool:
    from analytic import Readings

    return no_rigs(files) and all("pass" in Readings.read(file).provenance for file in files)


# What is done with a case, as options ask for it.
EXACT, SIMULATED = "the closed form", "an engine"
IN_MUJOCO, COMPARED = "MuJoCo", "a comparison"
WITH_MUJOCO = "a comparison with MuJoCo alone"
AT_REST = "a case at rest"


def option(text: str, metavar: str | None = None, default: str | bool = True, *names: str) -> Any:  # noqa: ANN401
    """An option of a command, by default named as its parameter."""
    return typer.Option(*names, metavar=metavar, help=text, show_default=default)


def flag(name: str, text: str) -> Any:  # noqa: ANN401
    return typer.Option(name, help=text, show_default=False)


def out_folder(default: str) -> Any:  # noqa: ANN401
    return option("Folder for what is written.", "DIR", default, "--out")


CaseName = Annotated[
    str,
    typer.Argument(metavar="CASE", help="A named case (see `vibrissa list cases`) or a TOML file."),
]
Out = Annotated[Path | None, out_folder("results/CASE, with the options that change the case")]
Stations = Annotated[int | None, option("Stations of the sweep.", "N", "the case's, or 200")]
Segments = Annotated[
    int | None,
    option("Segments of MuJoCo's beam.", "N", "the case's, or 40"),
    For((PLANE, MOTION, SPACE), (SIMULATED,)),
]
Beam = Annotated[
    BeamKind | None,
    option("MuJoCo's beam.", default="the case's, or chain"),
    For((PLANE, MOTION, SPACE), (IN_MUJOCO,)),
]
Obstacle = Annotated[
    ObstacleKind | None,
    option("MuJoCo's obstacle.", default="the case's, or mesh"),
    For((PLANE, MOTION), (IN_MUJOCO,)),
]
Spatial = Annotated[
    bool,
    flag("--spatial", "Let MuJoCo's beam leave the plane of the sweep."),
    For((PLANE,), (IN_MUJOCO,)),
]
InMotion = Annotated[
    bool, flag("--motion", "Let the foot move, at 0.01 L/T1."), For((MOTION,), (IN_MUJOCO, AT_REST))
]
Speed = Annotated[
    float | None,
    option("Of the foot in motion [L/T1].", "V", "the case's"),
    For((MOTION, MODEL), (IN_MUJOCO,)),
]
Timestep = Annotated[
    float | None,
    option("MuJoCo's, in motion [T1].", "DT", "the case's"),
    For((MOTION,), (IN_MUJOCO,)),
]
BeamFile = Annotated[
    Path | None, option("TOML file whose [beam] is the vibrissa of measured data.", "FILE")
]
Columns = Annotated[
    list[str] | None,
    option("A column of a rig's file; repeat the option for each.", "NAME=COLUMN[:UNIT]"),
]
InFrame = Annotated[Literal["world", "clamp"], option("Of the six components in space.")]
Way = Annotated[
    Literal["left", "right"] | None, option("Which sweep of a rig's file with one each way.")
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

    def load(self, name: str) -> AnyJob:
        """The case of that name or TOML file, with the engines that are to sweep it."""
        job = load_case(name)
        if self.engines is None:
            return job
        return replace(job, engines=engines_beside_exact(self.engines))

    def kind(self, job: AnyJob) -> str:
        moved = self.motion or self._given("speed", "timestep")
        return MOTION if moved and job.kind == PLANE else job.kind

    def made(self, job: AnyJob) -> AnyJob:
        given = self._given("segments", "beam", "obstacle")
        given |= {"planar": False} if self.spatial else {}
        made = job.changed(job.stations if self.stations is None else self.stations, given)
        faster = self._given("speed", "timestep")
        if isinstance(made, Job) and (made.motion or self.motion or faster):
            from mujoco_models.motion import Motion

            return replace(made, motion=replace(made.motion or Motion(), **faster))
        return made

    def _given(self, *names: str) -> dict[str, Any]:
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    def folder(self, out: Path | None, case: str) -> Path:
        """Where the results go by default: runs that differ do not overwrite each other."""
        parts = [
            case,
            *(word for word in (self.beam, self.obstacle) if word),
            *(f"{n}-{name}" for name, n in self._given("segments", "stations").items()),
            *["spatial"] * self.spatial,
            *["in-motion"] * self.motion,
            *(f"{name}-{x:g}" for name, x in self._given("speed", "timestep").items()),
            *(one for one in words(self.engines or "") if one not in ("", "exact")),
        ]
        return out or Path("results") / "-".join(parts)


def number_or_auto(option: str, text: str) -> float | Literal["auto"]:
    if text == "auto":
        return "auto"
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(option, repr(text), "a number or auto", "write it with a decimal point")
    return number


def require_fraction(option: str, value: float, usual: str) -> None:
    if not 0 < value < 1:
        raise InputError(option, value, "between 0 and 1", f"{usual} is usual")


def words(text: str) -> list[str]:
    return [word.strip() for word in text.split(",")]
