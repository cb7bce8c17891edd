"""When, by what command and with which versions a page was made."""

import platform
import shlex
import subprocess
import sys
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_PACKAGES = {"vibrissa-testbed": "", "numpy": "NumPy", "scipy": "SciPy", "mujoco": "MuJoCo"}
_PATIENCE = 5  # s; a repository on a slow disk is no reason to wait


def colophon() -> dict[str, str]:
    """What is known of the process that makes a page."""
    found = {
        "command": _command(),
        "date": datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"),
        "versions": ", ".join(_versions()),
        "commit": _commit(),
    }
    return {name: value for name, value in found.items() if value}


def _command() -> str:
    if not sys.argv[0] or sys.argv[0] == "-c":
        return ""
    return shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]])


def _versions() -> list[str]:
    found = [f"Python {platform.python_version()}"]
    for package, name in _PACKAGES.items():
        try:
            found.append(f"{name or package} {version(package)}")
        except PackageNotFoundError:
            continue
    return found


def _commit() -> str:
    root = Path(__file__).parents[2]
    if not (root / ".git").exists():
        return ""
    try:
        described = subprocess.run(
            ["git", "-C", root, "describe", "--always", "--dirty", "--abbrev=10", "--exclude=*"],
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return described.stdout.strip()
