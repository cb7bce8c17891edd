"""What one sweep has: its events, doubts, contacts."""

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, PHASES, Readings
from analytic.space import SpatialReadings
from compare.commands.output import warn
from compare.commands.terminal import print_line
from compare.read.assumed import ASSUMED
from compare.read.units import OWN_UNITS
from compare.show.numbers import quantity

_MEANINGS = {
    "touches again": ": another part of the vibrissa touches the object, or would lie in it",
    "chattering": ": the contact was lost more than once, or for 5 % of a station's way",
    "creeping": ": MuJoCo's friction is less than its coefficient where a contact moves slowly; "
    "impratio 100, a faster foot, or harder contacts in shorter steps",
    "lost": ": no contact, between stations with one",
    "sticks": ": the contact would slide back, which friction prevents as the foot moves on; the "
    "readings are those of one that slides on",
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
    print_line(f"{readings.source}: {'; '.join(parts)}")


def _phases(counts: pd.Series) -> str:
    return ", ".join(f"{counts[phase]} {phase}" for phase in PHASES if phase in counts)


def _of_the_plane(readings: Readings) -> list[str]:
    """Its snap-off, its motion, and what is beyond the paper."""
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
    """Where the vibrissa touches and leaves the body."""
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
    notes += [
        f"{count} rows {what}"
        for name, what in (
            ("out_of_order", "out of order were sorted by foot_x"),
            ("averaged", "averaged with the one before, at the same foot_x"),
            ("dropped", "filled with zeros amid contact were left out"),
        )
        if (count := rows.get(name))
    ]
    if notes:
        warn(f"{readings.source}: {'; '.join(notes)}")


def print_reconstruction(readings: Readings, found: pd.DataFrame, method: str) -> None:
    counts = found["phase"].value_counts()
    touching = int(np.isfinite(found["contact_x"].to_numpy(dtype=float)).sum())
    words = [
        f"{touching} contact points from {len(found)} stations",
        _phases(counts),
    ]
    if "unexplained" in counts:
        words.append(f"{counts['unexplained']} with readings that no such vibrissa has")
    unused = int((~readings.trusted).sum())
    if unused:
        words.append(f"{unused} not used, their readings are not to be trusted")
    if touching:
        x, y = (found[name].to_numpy(dtype=float) for name in ("contact_x", "contact_y"))
        length = readings.beam.length
        words.append(
            f"x from {np.nanmin(x) / length:.4g} to {np.nanmax(x) / length:.4g} L, "
            f"y from {np.nanmin(y) / length:.4g} to {np.nanmax(y) / length:.4g} L"
            + (f" (L = {quantity(length, 'length', readings.beam)})" if readings.beam.si else "")
        )
    unanswered = int((found["status"] == "no answer").sum())
    if unanswered:
        words.append(f"{unanswered} to which the method has no answer")
    by = "" if method == "elastica" else f", {method}"
    print_line(f"{readings.source}{by}: {'; '.join(words)}")
