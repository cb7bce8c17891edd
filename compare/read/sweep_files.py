"""Where the two sweeps of a run are, in its folder."""

from pathlib import Path

from analytic.problem.errors import InputError


def sweep_files(folder: Path) -> tuple[Path, Path]:
    """The files of the two sweeps that a run has left."""
    found = [*folder.glob("mujoco-*.parquet")]
    sweeps = [path for path in found if not path.name.endswith(".partial.parquet")]
    if not (folder / "analytic.parquet").is_file() or len(sweeps) != 1:
        there = ", ".join(sorted(path.name for path in folder.glob("*.parquet"))) or "no sweep"
        raise InputError(
            "DIR",
            f"{folder} ({there[:200]})",
            "the folder of one run, with analytic.parquet and one mujoco-BEAM.parquet",
            "make one: vibrissa run CASE --out DIR",
        )
    return folder / "analytic.parquet", sweeps[0]
