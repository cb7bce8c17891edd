"""Models as people write them, which come with this package."""

from importlib.resources import files
from pathlib import Path


def find_model(name: str | Path) -> Path:
    """The file of that name, or the shipped model."""
    return Path(name) if Path(name).exists() else shipped_models().get(str(name), Path(name))


def shipped_models() -> dict[str, Path]:
    """Models as people write them, which come with this package.

    Returns
    -------
    dict of Path
        Their files by name; each begins with what it is.
    """
    folder = Path(str(files("mujoco_models") / "models"))
    return {path.stem: path for path in sorted(folder.glob("*.xml"))}
