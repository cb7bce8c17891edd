"""The report of each comparison that a run of tests made, and one table of them all."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from analytic.problem.files import write_whole
from compare.comparison import Comparison
from compare.show.report import write_report


def report(found: Comparison, folder: Path, name: str) -> dict[str, Any]:
    """Write the report of one comparison.

    Parameters
    ----------
    found : Comparison
        The comparison.
    folder : Path
        Where all reports of the run go.
    name : str
        Of this report's folder there.

    Returns
    -------
    dict
        Its row of the summary, fit for JSON.
    """
    write_report(found, folder / name)
    return {
        "name": name,
        "reference": found.reference.source,
        "candidate": found.candidate.source,
        "agrees": found.agrees,
        "rms": {reading: d.rms for reading, d in found.disagreement.items()},
        "failures": list(found.failures),
        "likely": found.likely,
    }


def write_summary(rows: Iterable[Mapping[str, Any]], folder: Path) -> None:
    """Write ``summary.json`` and ``summary.md`` into `folder`.

    Parameters
    ----------
    rows : iterable of mappings
        As `report` returns them, in any order.
    folder : Path
        Where the reports are.
    """
    ordered = sorted(rows, key=lambda row: str(row["name"]))
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "summary.json", json.dumps(ordered, indent=2))
    lines = [
        "| comparison | verdict | force_x | force_y | moment_z | likely |",
        "|---|---|---|---|---|---|",
    ]
    for row in ordered:
        rms = " | ".join(f"{x:.1e}" for x in row["rms"].values())
        lines.append(
            f"| [{row['candidate']} against {row['reference']}]({row['name']}/report.html) "
            f"| {'agrees' if row['agrees'] else 'disagrees'} | {rms} | {row['likely'] or ''} |"
        )
    lines += ["", "Numbers: rms over each reading's largest magnitude.", ""]
    write_whole(folder / "summary.md", "\n".join(lines))
