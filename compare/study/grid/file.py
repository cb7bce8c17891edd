"""Study files: a case file with tables that say what varies and what is recorded."""

import difflib
from importlib.resources import files
from pathlib import Path

from pydantic import ValidationError

from analytic import InputError
from compare.read.complaints import complaint
from compare.read.toml import TomlFile
from compare.study.grid.base import Base
from compare.study.grid.expand import expand
from compare.study.grid.schema import StudyFile
from compare.study.grid.study import BEAM, RECORDS, Study


def shipped_studies() -> dict[str, Path]:
    """Find the studies that come with the package."""
    folder = Path(str(files("compare.study") / "shipped"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_study(name_or_path: str) -> Study:
    """Read a study.

    Parameters
    ----------
    name_or_path : str
        A shipped study, or the path of a TOML file.

    Returns
    -------
    Study
        It is checked: every listed value and both ends of every range are tried on the base case.
        Combinations are not.

    Raises
    ------
    InputError
        If there is neither, or anything in the file cannot be used; the line is named.
    """
    shipped = shipped_studies()
    path = shipped.get(name_or_path, Path(name_or_path))
    if path.suffix != ".toml":
        near = difflib.get_close_matches(name_or_path, shipped, n=1)
        raise InputError(
            "study",
            repr(name_or_path),
            f"one of {', '.join(shipped)}, or the path of a .toml file",
            f"did you mean {near[0]}?" if near else "name one of them",
        )
    return _checked(TomlFile.read(path, "study file"))


def _checked(file: TomlFile) -> Study:
    # Without a name of its own the study is called like its file, under the same rules.
    tables = {"study": {}, **file.tables}
    if isinstance(tables["study"], dict):
        tables["study"] = {"name": file.path.stem, **tables["study"]}
    try:
        content = StudyFile.model_validate(tables)
    except ValidationError as error:
        raise complaint(error, file.place) from error
    base = Base(file, content)
    table = content.study
    beams = [base.values[BEAM]] if table.beams is None else table.beams
    beams = [str(base.tried(BEAM, beam, ["study", "beams"])) for beam in beams]
    return Study(
        name=str(table.name),
        base=base.values,
        axes=expand(file, content, base),
        beams=tuple(dict.fromkeys(beams)),
        record=tuple(table.record or (RECORDS if beams else ("events",))),
        keep_readings=table.keep_readings,
        timeout=table.timeout,
        case=table.case or file.path.stem,
    )
