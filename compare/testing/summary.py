"""The report of each comparison that a run of tests made, and one table of them all."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from analytic.problem.files import write_whole
from analytic.space import Body
from compare.comparison import Comparison, SpatialComparison
from compare.show.report import write_report


def report(
    found: Comparison | SpatialComparison, folder: Path, name: str, body: Body | None = None
) -> dict[str, Any]:
    write_report(found, folder / name, body=body)
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
    ordered = sorted(rows, key=lambda row: str(row["name"]))
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "summary.json", json.dumps(ordered, indent=2))
    readings = list(dict.fromkeys(name for row in ordered for name in row["rms"]))
    lines = [
        f"| comparison | verdict | {' | '.join(readings)} | likely |",
        f"|---|---|{'---|' * len(readings)}---|",
    ]
    for row in ordered:
        rms = " | ".join(f"{row['rms'][x]:.1e}" if x in row["rms"] else "" for x in readings)
        lines.append(
            f"| [{row['name']}]({row['name']}/report.html): "
            f"{row['candidate']} against {row['reference']} "
            f"| {'agrees' if row['agrees'] else 'disagrees'} | {rms} | {row['likely'] or ''} |"
        )
    lines += ["", "Numbers: rms over each reading's largest magnitude.", ""]
    write_whole(folder / "summary.md", "\n".join(lines))
