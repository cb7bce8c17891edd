"""Models as people write them, which come with this package."""

from importlib.resources import files
from pathlib import Path

from analytic.problem.errors import unknown
from analytic.problem.files import as_path


def find_model(name: str | Path) -> Path:
    """The file of that name, or the shipped model."""
    path, shipped = as_path(name, "model"), shipped_models()
    if path.is_file():
        return path
    if not path.suffix and str(name) not in shipped:
        raise unknown("model", str(name), shipped, more=", or a file")
    return shipped.get(str(name), path)


def shipped_models() -> dict[str, Path]:
    """Models as people write them, which come with this package.

    Returns
    -------
    dict of Path
        Their files by name; each begins with what it is.
    """
    folder = Path(str(files("mujoco_models") / "models"))
    return {path.stem: path for path in sorted(folder.glob("*.xml"))}
