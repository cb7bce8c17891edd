"""The command ``reconstruct``: the object from the clamp, and how well methods find it."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from compare.commands.given import A_RIG, no_rigs, require_readings
from compare.commands.kinds import For, require_use
from compare.commands.options import (
    AGREES,
    DISAGREES,
    BeamFile,
    Columns,
    InFrame,
    Way,
    flag,
    number_or_auto,
    option,
    out_folder,
    shares,
    words,
)
from compare.commands.output import distinct_name, distinct_names, output_folder
from compare.commands.waiting import waiting
from compare.read.kinds import SPACE, TABLES

if TYPE_CHECKING:
    from analytic import Readings
    from compare.read.job import Job, SpaceJob

SWEEP, ERRORS = "readings in the plane", "contacts that are known"
_CASE, _STORED = "a case", "a file"
_LEVELS = "0,0.001,0.01"  # of noise


def reconstruct(
    context: typer.Context,
    files: Annotated[
        list[str],
        typer.Argument(metavar="FILE...", help="Readings; or a case, for how well methods do."),
    ],
    out: Annotated[Path | None, out_folder("results/FILE-reconstructed, or CASE-methods")] = None,
    beam: Annotated[BeamFile, For((SWEEP, SPACE))] = None,
    column: Annotated[Columns, For((SWEEP, SPACE))] = None,
    direction: Annotated[Way, For((SWEEP,), (A_RIG,))] = None,
    noise: Annotated[
        str | None,
        option(
            "Of the clamp readings over their largest magnitude, as 0.01; beside contacts that "
            "are known up to three, as 0,0.001,0.01.",
            "NUMBER",
        ),
    ] = None,
    offset: Annotated[
        float,
        option(
            "By how much foot_x is too large, as `compare --offset auto` finds it; in the "
            "vibrissa's unit of length, metres beside units.",
            "NUMBER",
        ),
        For((SWEEP,)),
    ] = 0.0,
    friction: Annotated[
        str | None,
        option(
            "Friction coefficient of the sweep; auto: estimate it from Phase B.",
            "NUMBER|auto",
            "the file's, or that of --beam",
        ),
        For((SWEEP,)),
    ] = None,
    method: Annotated[
        str | None,
        option(
            "Which methods; `vibrissa list methods` has all.",
            "A,B,...",
            "elastica; all beside contacts that are known",
        ),
        For((SWEEP, ERRORS)),
    ] = None,
    errors: Annotated[
        bool,
        flag("--errors", "How well methods find the contacts that a model's file holds."),
        For((ERRORS,), (_STORED,)),
    ] = False,
    on: Annotated[
        str,
        option(
            "Readings of what, while methods take it for a straight vibrissa in a rigid clamp "
            "without friction: exact, curved, tapered, soft-clamp, friction, mujoco; or all.",
            "A,B,...",
        ),
        For((ERRORS,), (_CASE,)),
    ] = "exact",
    frame: Annotated[InFrame, For((SPACE,), (A_RIG,))] = "world",
) -> int:
    """Find the object from the clamp readings alone.

    Of a case, and with --errors, how well every method finds contacts that are known. In space
    --beam takes a case file, too: its vibrissa, its clamp, and the true body to compare with.
    """
    known = None if beam is None else _in_space(beam)
    several = distinct_names([Path(file) for file in files])
    code = AGREES
    for name, path in several.items():
        source: Job | Path = _source(str(path))
        kind = _kind(source, errors, known)
        ours = not column and isinstance(source, Path) and no_rigs([source])
        is_file = isinstance(source, Path)
        require_use(
            context, kind, _STORED if is_file else _CASE, *([] if ours or not is_file else [A_RIG])
        )
        place = out if out is None or len(several) == 1 else out / name
        if errors or not isinstance(source, Path):
            from compare.commands.methods import compare_methods

            levels = shares("--noise", _LEVELS if noise is None else noise, 3)
            chosen = None if method is None else words(method)
            compare_methods(source, place, chosen, levels, words(on))
            continue
        share = None if noise is None else shares("--noise", noise, 1)[0]
        folder = place or Path("results") / f"{distinct_name(path)}-reconstructed"
        if kind == SPACE:
            from compare.commands.space import find_body
            from compare.read.space_readings import read_space

            body = None if known is None else known.body
            held = None if known is None else known.case.beam
            tangent = None if known is None else known.case.path.tangent
            found = read_space(path, held, tangent, column or (), frame)
            with output_folder(folder):
                if not find_body(found, body, folder, share or 0.0, True):
                    code = DISAGREES
        else:
            readings = _readings(path, beam, column or [], direction, offset)
            _in_the_plane(readings, folder, share, friction, words(method or "elastica"))
    return code


def _source(name: str) -> "Job | Path":
    """The readings, or the case in the plane, of that name."""
    path = Path(name)
    if path.suffix.lower() in TABLES:
        require_readings([path])
        return path
    from compare.read.case import load_job

    return load_job(name)


def _in_space(beam: Path) -> "SpaceJob | None":
    """The case in space that the vibrissa's file is, if it is one."""
    from compare.read.toml import TomlFile

    if "body" not in TomlFile.read(beam, "beam file").tables:
        return None
    from compare.read.case import load_space_job

    return load_space_job(beam)


def _kind(source: "Job | Path", errors: bool, known: "SpaceJob | None") -> str:
    if errors or not isinstance(source, Path):
        return ERRORS
    from compare.read.space_readings import is_spatial

    return SPACE if known is not None or is_spatial(source) else SWEEP


def _readings(
    file: Path, beam: Path | None, column: list[str], direction: Way, offset: float
) -> "Readings":
    """A sweep without dropouts and offset, NaN where a station is not to be trusted."""
    import numpy as np

    from analytic import CLAMP_READINGS
    from compare.align.offset import checked_offset, without_offset
    from compare.read.rig import read_measured
    from compare.sense.record import without_dropouts

    readings = without_dropouts(read_measured(file, beam, column, direction=direction))
    if offset:
        readings = without_offset(readings, checked_offset(offset))
    known = {
        name: np.where(readings.trusted, readings.values(name), np.nan) for name in CLAMP_READINGS
    }
    return replace(readings, table=readings.table.assign(**known))


def _in_the_plane(
    readings: "Readings",
    place: Path,
    noise: float | None,
    friction: str | None,
    methods: list[str],
) -> None:
    from analytic import reconstruct as reconstruct_contour
    from analytic import relative_noise, require_beam
    from analytic.from_clamp.reconstruct import doubt
    from compare.commands import terminal

    level = None if noise is None else relative_noise(readings, noise)
    if friction is not None:
        readings = _rubbing(readings, number_or_auto("--friction", friction), level)
    contacts = {name: reconstruct_contour(readings, level, method=name) for name in methods}
    if "elastica" in contacts:
        require_beam(contacts["elastica"], readings)
    with output_folder(place) as folder:
        from compare.commands.keep import keep
        from compare.show.figures.geometry import reconstruction

        terminal.note_rows(readings)
        for name, found in contacts.items():
            points = found.assign(foot_x=readings.values("foot_x"))
            end = "" if name == "elastica" else f"-{name}"
            terminal.print_reconstruction(readings, found, name)
            if name == "elastica" and (why := doubt(found, readings)) is not None:
                terminal.print_line(why)
            keep(folder / f"points{end}.csv", points)
            with waiting("drawing"):
                picture = reconstruction(readings, found)
            keep(folder / f"reconstruction{end}.png", picture)


def _rubbing(
    readings: "Readings", friction: float | Literal["auto"], noise: Mapping[str, float] | None
) -> "Readings":
    from analytic import estimate_friction
    from analytic.problem.support import check_support
    from compare.commands import terminal

    if friction == "auto":
        found = estimate_friction(readings, noise)
        terminal.print_line(
            f"friction coefficient {found.coefficient:.4f} +- {found.uncertainty:.1g}, "
            f"from {found.stations} stations of Phase B"
        )
        friction = found.coefficient
    check_support(readings.support[0], friction, readings.beam, signed=True)
    return readings.with_friction(friction)
