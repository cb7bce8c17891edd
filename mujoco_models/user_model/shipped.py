"""Models as people write them, which come with this package."""

from importlib.resources import files
from pathlib import Path


def shipped_models() -> dict[str, Path]:
    """Models as people write them, which come with this package.

    Returns
    -------
    dict of Path
        Their files by name; each begins with what it is.
    """
    folder = Path(str(files("mujoco_models") / "models"))
    return {path.stem: path for path in sorted(folder.glob("*.xml"))}
