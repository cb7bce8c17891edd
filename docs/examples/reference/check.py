"""python check.py tables/contact.csv mine.csv [tolerance]: exit 0 if mine agrees; else says how."""

import csv
import hashlib
import math
import sys
from pathlib import Path
from statistics import median


def number(text: str | None) -> float | None:
    """A cell's number, if it is one."""
    try:
        return float(text or "")
    except ValueError:
        return None


def rows(path: Path) -> list[dict[str, str]]:
    """The lines of a file by their columns."""
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def check(table: Path, mine: Path, tolerance: float = 1e-6) -> list[str]:
    """Complaints about `mine`, a file with the columns and rows of the reference `table`."""
    sums = {line["file"]: line["sha256"] for line in rows(table.with_name("MANIFEST.csv"))}
    if hashlib.sha256(table.read_bytes()).hexdigest() != sums.get(table.name):
        return [f"{table.name}: stale, not the file that MANIFEST.csv states"]
    ours, theirs = rows(table), rows(mine)
    words = [name for name in ours[0] if any(number(row[name]) is None for row in ours)]
    if [[r.get(w) for w in words] for r in ours] != [[r.get(w) for w in words] for r in theirs]:
        return [f"{mine.name}: stale, other rows than {table.name} has ({', '.join(words)})"]
    found = []
    for name in (name for name in ours[0] if name not in words):
        pairs = [(number(a[name]), number(b.get(name))) for a, b in zip(ours, theirs, strict=True)]
        if any(a == a and (b is None or b != b) for a, b in pairs):
            found.append(f"{name}: missing")
            continue
        pairs = [(a, b) for a, b in pairs if a == a]  # nan: there is no such number
        size = max((abs(a) for a, _ in pairs), default=0.0) or 1.0
        worst = max((abs(a - b) for a, b in pairs), default=0.0)
        if worst > tolerance * size:
            factor = median(b / a for a, b in pairs if abs(a) > 1e-3 * size)
            near = max(tolerance, 1e-3)
            alike = all(abs(factor * a - b) <= near * size * abs(factor) for a, b in pairs)
            wrong = "wrong sign" if math.isclose(factor, -1, rel_tol=near) else "wrong unit"
            found.append(f"{name}: {wrong if alike else 'off'}, {factor:g} times, {worst:.1e}")
    return found


if __name__ == "__main__":
    complaints = check(Path(sys.argv[1]), Path(sys.argv[2]), *map(float, sys.argv[3:]))
    print("\n".join(complaints) or "agrees")
    sys.exit(bool(complaints))
