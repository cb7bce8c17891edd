"""A sweep in space that the reader of a report turns, comes closer to and steps through."""

import numpy as np

from analytic.problem.arrays import Floats
from compare.show.scene import SweepScene, corners_and_faces, normals
from compare.show.style import PHASE_NAMES

_STATIONS = 200  # that a slider has
_GHOSTS = 24  # shapes that are always there
_DIGITS = 4  # of a length in L: a tenth of a pixel
_LIGHT = np.array([0.3, 0.2, 0.9]) / np.linalg.norm([0.3, 0.2, 0.9])
_DARKEST = 0.62
_COLOURS = {"free": "faint", "tip": "blue", "tangent": "orange"}  # of the page, light or dark


def turning(scene: SweepScene) -> dict[str, object]:
    """What ``turning.js`` draws, as JSON holds it."""
    shown = np.unique(np.linspace(0, len(scene.foot) - 1, _STATIONS).round().astype(int))
    touching = [n for n, i in enumerate(shown) if np.isfinite(scene.contact[i]).all()]
    corners, where = corners_and_faces(scene.faces)
    lit = _DARKEST + (1 - _DARKEST) * (1 + normals(scene.faces) @ _LIGHT) / 2
    lights = zip(lit.round(2).tolist(), where.tolist(), strict=True)
    return {
        "low": _rounded(scene.low),
        "high": _rounded(scene.high),
        "corners": _rounded(corners),
        "faces": [[light, *face] for light, face in lights],
        "every": max(1, len(shown) // _GHOSTS),
        "first": touching[len(touching) // 2] if touching else 0,
        "colours": _COLOURS,
        "stations": [
            {
                "foot": _rounded(scene.foot[i]),
                "line": _rounded(scene.lines[i]),
                "contact": _rounded(scene.contact[i]),
                "phase": scene.phase[i],
                "said": _said(scene, int(i)),
            }
            for i in shown
        ],
    }


def _said(scene: SweepScene, station: int) -> str:
    x, _, z = scene.foot[station]
    table = scene.readings.table
    status = str(table["status"].iloc[station]) if "status" in table else "ok"
    phase = PHASE_NAMES[scene.phase[station]] if status == "ok" else status
    count = len(scene.foot)
    return f"station {station + 1} of {count}, foot at ({x:.3f}, {z:.3f}) L, {phase}"


def _rounded(values: Floats) -> list[object] | None:
    if not np.isfinite(values).all():
        return None
    found: list[object] = values.round(_DIGITS).tolist()
    return found
