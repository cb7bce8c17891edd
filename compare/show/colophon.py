"""When, by what command and with which versions a page was made."""

import platform
import shlex
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_PACKAGES = {"vibrissa-testbed": "vibrissa-testbed", "numpy": "NumPy", "scipy": "SciPy",
             "mujoco": "MuJoCo"}  # fmt: skip
_PATIENCE = 5  # s; a repository on a slow disk is no reason to wait


def colophon() -> dict[str, str]:
    """What is known of the process that makes a page."""
    program, *words = sys.argv
    found = {
        "command": "" if program in ("", "-c") else shlex.join([Path(program).name, *words]),
        "date": datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"),
        "versions": ", ".join(_versions()),
        "commit": _commit(),
    }
    return {name: value for name, value in found.items() if value}


def _versions() -> Iterator[str]:
    yield f"Python {platform.python_version()}"
    for package, name in _PACKAGES.items():
        with suppress(PackageNotFoundError):
            yield f"{name} {version(package)}"


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
