"""Cases by name or TOML file, and what is to be done with them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analytic import NAMED_TABLES, InputError, named_case
from analytic.problem.errors import unknown
from compare.read.job import Job, SpaceJob
from mujoco_models.settings import Settings


def load_case(name_or_path: str | Path) -> Job | SpaceJob:
    """The case of that name, or from that TOML file: in the plane or in space, as the file says.

    Parameters
    ----------
    name_or_path : str or Path
        One of `analytic.CASE_NAMES`, or a file named ``*.toml``.

    Returns
    -------
    Job or SpaceJob
        ``.case`` is an `analytic.Case`, or an `analytic.space.SpatialCase` if the file has a
        ``[body]``; ``.settings`` and ``.tolerances`` are what `simulate_sweep` or `simulate_space`
        and `compare` take. In the plane there are also ``.motion``, ``.model``,
        ``.uncertainties`` and ``.engines``, as the file states them.

    Raises
    ------
    InputError
        If there is neither, or anything in the file cannot be used; the line is named.
    """
    name = str(name_or_path)
    if name in NAMED_TABLES:
        return Job(named_case(name), Settings())
    if not name.endswith(".toml"):
        more, remedy = ", or the path of a .toml file", "`vibrissa list cases` lists them"
        raise unknown("case", name, NAMED_TABLES, more=more, remedy=remedy)
    from compare.read.toml import TomlFile  # named cases need none of the tables of a file

    file = TomlFile.read(Path(name), "case file")
    if "body" in file.tables:
        from compare.read.space import job_in_space

        return job_in_space(file)
    from compare.read.tables import job_in_the_plane

    return job_in_the_plane(file)


def case_tables(name_or_path: str | Path) -> tuple[Mapping[str, Any], Path]:
    """What the file of a case says, or would say of a named one; and its folder."""
    name = str(name_or_path)
    if name in NAMED_TABLES:
        return NAMED_TABLES[name], Path()
    from compare.read.toml import TomlFile

    return TomlFile.read(Path(name), "case file").tables, Path(name).parent


def load_job(name_or_path: str | Path) -> Job:
    """The case in the plane of that name, or from that TOML file."""
    job = load_case(name_or_path)
    if isinstance(job, Job):
        return job
    remedy = "`vibrissa run`, `compare`, `reconstruct` and the marker vibrissa_space take a body"
    raise InputError(f"{name_or_path}: [body]", "given", "a [profile], in the plane", remedy)


def load_space_job(path: str | Path) -> SpaceJob:
    job = load_case(path)
    if isinstance(job, SpaceJob):
        return job
    remedy = "`vibrissa run` and the marker vibrissa take the case"
    raise InputError(f"{path}: [body]", "missing", "given for a sweep in space", remedy)
