"""The passes of a rig as a document: what was kept, what was dropped, how far they repeat."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from compare.measure.repeats import Repeat
from compare.read.passes import Pass


def passes_document(
    passes: Sequence[Pass], repeats: Mapping[tuple[str, str], Repeat]
) -> dict[str, Any]:
    """What ``passes.json`` holds."""
    return {
        "passes": [
            {
                "name": one.name,
                "direction": one.direction,
                "rows": one.rows,
                "kept": one.kept,
                "dropped": one.dropped,
                "sorted": one.sorted,
                "gaps": one.record.gaps,
                "widest_step": one.record.widest,
                "zero": one.zero,
                "drift": one.drift,
            }
            for one in passes
        ],
        "repeats": [
            {"first": first, "second": second, **asdict(found)}
            for (first, second), found in repeats.items()
        ],
    }
