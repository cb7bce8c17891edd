"""A digest of the installed sources: edited code does its runs again."""

import hashlib
from functools import cache
from importlib.resources import files
from pathlib import Path

# What reads, shows or stores results does not change them.
_WITHOUT_EFFECT = ("commands", "show", "testing", "simulate", "study/keep", "study/show")


@cache
def sources_digest(*packages: str) -> str:
    """Digest of the modules whose code a run's numbers depend on."""
    digest = hashlib.sha256()
    for package in packages:
        root = Path(str(files(package)))
        for path in sorted(root.rglob("*.py")):
            name = path.relative_to(root).as_posix()
            if package != "compare" or not name.startswith(_WITHOUT_EFFECT):
                digest.update(f"{package}/{name}\n".encode() + path.read_bytes())
    return digest.hexdigest()[:12]
