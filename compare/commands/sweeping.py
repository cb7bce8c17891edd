"""Sweeps: a job's simulated, those of files read, printed; in space the body found from them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, PHASES, Beam, Direction, InputError, Readings
from analytic.numerics.arrays import Floats
from analytic.space import (
    Body,
    SpatialReadings,
    misses,
    point_cloud,
    reconstruct_space,
    wrench_complaint,
    write_ply,
)
from analytic.space.problem.readings import FORCE, MOMENT
from compare.align.frames import Frame
from compare.commands import terminal
from compare.commands.output import waiting, warn
from compare.read.assumed import ASSUMED
from compare.read.job import AnyJob
from compare.read.rig import read_measured
from compare.read.units import OWN_UNITS
from compare.show.numbers import quantity
from compare.show.scene import SweepScene

AnyReadings: TypeAlias = Readings | SpatialReadings

_MEANINGS = {
    "touches again": ": another part of the vibrissa touches the object, or would lie in it",
    "touches another": ": the vibrissa touches more than the object, or the object more than it",
    "chattering": ": the contact was lost more than once, or for 5 % of a station's way; "
    "with friction, take cone elliptic and impratio 100",
    "creeping": ": MuJoCo's friction is less than its coefficient where a contact moves slowly; "
    "cone elliptic with impratio 100, a faster foot, or harder contacts in shorter steps",
    "lost": ": no contact, between stations with one",
    "sticks": ": the contact would slide back, which friction prevents as the foot moves on; the "
    "readings are those of one that slides on",
}
# What was done to rows of a rig's file.
_ROWS = {
    "out_of_order": "out of order were sorted by foot_x",
    "averaged": "averaged with the one before, at the same foot_x",
    "dropped": "filled with zeros amid contact were left out",
}


@dataclass(frozen=True)
class RigFiles:
    """How files that no engine wrote are to be read."""

    columns: Sequence[str]
    beam: Path | None
    direction: Direction | None
    frame: Frame

    def read(self, file: Path, otherwise: Beam | None = None) -> Readings:
        """A sweep in the plane, of that vibrissa if nothing else says."""
        return read_measured(file, self.beam, self.columns, otherwise, self.direction)

    def read_all(self, files: Sequence[Path], otherwise: Beam | None = None) -> list[Readings]:
        """The sweeps of some files, of passes those in the direction that is asked for."""
        found, way = [self.read(file, otherwise) for file in files], self.direction
        kept = [one for one in found if way in (None, one.provenance.get("direction", way))]
        if not kept:
            went = "they all go the other way: choose it, or leave --direction out"
            raise InputError("--direction", way, "that of a pass", went)
        return kept


def sweep_file(job: AnyJob) -> str:
    if job.model is not None:
        return "mujoco-own-model.parquet"
    return f"mujoco-{job.settings.beam}{'-in-motion' if job.motion else ''}.parquet"


def simulated(job: AnyJob, folder: Path) -> AnyReadings:
    """The sweep in MuJoCo, written; if it ends early, the stations that there are."""
    from compare.simulate.dispatch import simulate

    file = folder / sweep_file(job)

    def keep_part(part: AnyReadings) -> None:
        path = part.write(file.with_suffix(".partial.parquet"))
        warn(f"kept {len(part.table)} of {job.stations} stations in {path}")

    what = job.settings.beam if job.model is None else job.model.file.name
    with terminal.progress(f"MuJoCo {what}", job.stations) as advance:
        how = job.settings, job.motion, job.model
        swept = simulate(job.case, *how, advance=advance, keep=keep_part)
    swept.write(file)
    return swept


def printed(job: AnyJob, readings: AnyReadings, folder: Path, name: str | None = None) -> bool:
    """Print what a sweep found, and in space find the body from it; whether that could be."""
    print_sweep(readings)
    if name is not None:
        terminal.print_written(folder / name)
    if isinstance(readings, Readings):
        return True
    return find_body(readings, job.body, folder, 0.0, name is not None)


def find_body(
    readings: SpatialReadings, body: Body | None, folder: Path, noise: float, with_picture: bool
) -> bool:
    """Write the contacts found from the clamp; whether a vibrissa can have them.

    As a table, as a point cloud with normals and, if wanted, in a picture.
    """
    with waiting("reconstructing"):
        points = reconstruct_space(readings, deviations([readings], noise))
    complaint = wrench_complaint(points)
    if complaint is not None:
        if points["contact_x"].isna().all():
            raise InputError("readings", "without a contact", "of such a vibrissa", complaint)
        terminal.print_line(f"readings: {complaint}")
    cloud = point_cloud(points)
    said = f"{len(cloud.points)} contacts"
    if body is not None:
        found = misses(cloud, body, readings.beam.length)
        away, turned = found.distances / readings.beam.length, np.degrees(found.angles.max())
        said += (
            f"; from the true body {np.sqrt((away**2).mean()):.1e} L rms, {away.max():.1e} L at "
            f"most; normals {turned:.1e} degrees"
        )
    terminal.print_line(said)
    if friction := readings.provenance.get("friction", 0.0):
        leant = np.degrees(np.arctan(friction))
        terminal.print_line(f"friction tilts the normals found by up to {leant:.3g} degrees")
    terminal.keep(folder / "points.csv", points)
    terminal.print_written(write_ply(cloud, folder / "points.ply"))
    if with_picture:
        keep_scene(folder / "space.png", SweepScene.of(readings, body))
    diverged = "status" in readings.table and bool((readings.table["status"] == "diverged").any())
    return complaint is None and not diverged


def keep_scene(path: Path, scene: SweepScene, around: Floats | None = None) -> None:
    with waiting("drawing"):
        from compare.show.figures.space import sweep_in_space

        picture = sweep_in_space(scene, around)
    terminal.keep(path, picture)


def deviations(sweeps: list[SpatialReadings], share: float) -> dict[str, float] | None:
    """A share of each component's largest magnitude in any sweep."""
    if share == 0:
        return None
    return {
        name: share * max(float(np.nanmax(np.abs(one.values(name)))) for one in sweeps)
        for name in (*FORCE, *MOMENT)
    }


def print_sweep(readings: Readings | SpatialReadings) -> None:
    """Print what a sweep found, in a line: stations, phases, events, the worst residuals."""
    table = readings.table
    parts = [f"{int(readings.trusted.sum())} of {len(table)} stations ok"]
    parts += _untrusted(readings)
    if "phase" in table:
        parts.append(_phases(table["phase"].value_counts()))
    parts += _of_the_plane(readings) if isinstance(readings, Readings) else _of_space(readings)
    for name in ("residual", "residual_boundary", "residual_moment"):
        if name in table:
            worst = np.nanmax(table[name].to_numpy(dtype=float), initial=0.0)
            parts.append(f"{name.replace('_', ' ')} at most {worst:.1e}")
    deepest = np.nanmax(readings.values("penetration"), initial=0.0)
    if deepest > readings.beam.radius > 0:
        parts.append(
            f"the contact sinks by up to {deepest / readings.beam.radius:.2g} radii, past the "
            "vibrissa's axis: take harder ones in shorter steps"
        )
    terminal.print_line(f"{readings.source}: {'; '.join(parts)}")


def _phases(counts: pd.Series) -> str:
    return ", ".join(f"{counts[phase]} {phase}" for phase in PHASES if phase in counts)


def _of_the_plane(readings: Readings) -> list[str]:
    table = readings.table
    unsettled = readings.provenance.get("unsettled", {})
    parts = [f"{count} unsettled: {reason}" for reason, count in unsettled.items()]
    size, unit = readings.running_unit
    if (at := readings.snap_off) is None:
        parts.append("no snap-off")
    else:
        parts.append(f"snap-off at {readings.running} = {at / size:.4f} {unit}")
    if "kinetic_share" in table:
        touching = table.loc[table["phase"] != "free", "kinetic_share"].to_numpy(dtype=float)
        parts.append(f"kinetic share in contact at most {np.nanmax(touching, initial=0.0):.1e}")
        parts.append(f"{table['time'].max():.4g} T1")
    return parts + [f"{name} {value:g}" for name, value in readings.beyond_the_paper.items()]


def _of_space(readings: SpatialReadings) -> list[str]:
    parts, events = [], readings.provenance["events"]
    for event in events:
        x, _, z = (value / readings.beam.length for value in event["foot"])
        if event["kind"] in ("touch", "release", "slip-off"):
            parts.append(f"{event['kind']} at foot ({x:.4f}, {z:.4f}) L")
    hops = sum(event["kind"] == "hop" for event in events)
    return parts + [f"{hops} hops over edges"] * bool(hops)


def _untrusted(readings: Readings | SpatialReadings) -> list[str]:
    """How many stations have a status that nothing else is said of, where, and what it means."""
    if "status" not in readings.table:
        return []
    said = []
    for name, group in readings.table.groupby("status", sort=False):
        if name in ("ok", "unsettled"):
            continue
        size, unit = readings.running_unit
        ends = (group[readings.running].iloc[i] / size for i in (0, -1))
        where = " to ".join(f"{x:.4f}" for x in ends)
        meaning = _MEANINGS.get(str(name), "")
        none = "; no readings" if group[list(CLAMP_READINGS)].isna().all(axis=None) else ""
        said.append(f"{len(group)} {name} ({readings.running} {where} {unit}{meaning}{none})")
    return said


def note_rows(readings: Readings) -> None:
    """Say on standard error what was assumed of a rig's file or done to its rows, if anything."""
    rows = readings.provenance.get("rows", {})
    notes = []
    if ASSUMED in readings.provenance:
        notes.append("no vibrissa given, L = EI = 1 is assumed")
    if units := readings.provenance.get(OWN_UNITS):
        shown = ", ".join(f"{name} in {unit}" for name, unit in units.items())
        notes.append(f"units taken from the line below the names: {shown}")
    notes += [f"{count} rows {what}" for name, what in _ROWS.items() if (count := rows.get(name))]
    if notes:
        warn(f"{readings.source}: {'; '.join(notes)}")


def print_reconstruction(readings: Readings, found: pd.DataFrame, method: str) -> None:
    counts = found["phase"].value_counts()
    touching = int(np.isfinite(found["contact_x"].to_numpy(dtype=float)).sum())
    words = [f"{touching} contact points from {len(found)} stations", _phases(counts)]
    if "unexplained" in counts:
        words.append(f"{counts['unexplained']} with readings that no such vibrissa has")
    if unused := int((~readings.trusted).sum()):
        words.append(f"{unused} not used, their readings are not to be trusted")
    if touching:
        x, y = (found[name].to_numpy(dtype=float) for name in ("contact_x", "contact_y"))
        length = readings.beam.length
        words.append(
            f"x from {np.nanmin(x) / length:.4g} to {np.nanmax(x) / length:.4g} L, "
            f"y from {np.nanmin(y) / length:.4g} to {np.nanmax(y) / length:.4g} L"
            + (f" (L = {quantity(length, 'length', readings.beam)})" if readings.beam.si else "")
        )
    if unanswered := int((found["status"] == "no answer").sum()):
        words.append(f"{unanswered} to which the method has no answer")
    by = "" if method == "elastica" else f", {method}"
    terminal.print_line(f"{readings.source}{by}: {'; '.join(words)}")
