"""Meshes in space: time a station on oblique ways past three bodies from files."""

import tempfile
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from mujoco_models import SpatialSettings, simulate_space
from tests.mujoco_models.space.files import FILES, oblique


def main(quick: bool) -> None:
    settings = SpatialSettings(segments=10 if quick else 40)
    table = Table(
        "file", "median", "most", "unsettled",
        title=f"Oblique ways, {settings.segments} segments; CPU ms a station, with the model",
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        for file in FILES:
            took, unsettled = [], 0
            for seed in range(1 if quick else 10):
                case = oblique(file, seed, Path(folder))
                begin = time.process_time()
                found = simulate_space(case, settings)
                took.append(1e3 * (time.process_time() - begin) / len(found.table))
                unsettled += int((found.table["status"] == "unsettled").sum())
            table.add_row(file, f"{np.median(took):.1f}", f"{max(took):.1f}", str(unsettled))
    Console().print(table)
