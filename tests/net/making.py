"""Does the items of the net, and stores each as one JSON file."""

import json
import os
import platform
import sys
import tempfile
import time
import zlib
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from fnmatch import fnmatch
from importlib.metadata import version
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .commands import CHECKOUT
from .rooms import ITEMS

VOLATILE = ("seconds*", "version*", "engine", "python", "system", "host", "run", "file")
"""Keys and columns that say when, where and by which version; they are not stored."""


def make_all(out: Path, only: str, jobs: int) -> int:
    """Do the items of a room, or all; what the index knows of others stays."""
    wanted = [key for key in ITEMS if fnmatch(key, only) or key.startswith(f"{only}/")]
    if not wanted:
        sys.exit(f"--only {only}: must be one of {', '.join({k.split('/')[0] for k in ITEMS})}")
    index = out / "index.json"
    seconds = json.loads(index.read_text())["seconds"] if index.exists() else {}
    with ProcessPoolExecutor(jobs, mp_context=get_context("fork")) as pool:
        for done in as_completed([pool.submit(_make, key, out) for key in wanted]):
            key, seconds[key], error = done.result()
            print(f"{seconds[key]:6.1f} s  {key}  {error}", flush=True)
    versions = {name: version(name) for name in ("mujoco", "numpy", "scipy", "pandas", "trimesh")}
    found = {"checkout": str(CHECKOUT), "python": platform.python_version(), "seconds": seconds}
    index.write_text(json.dumps(found | {"versions": versions}, indent=1, sort_keys=True))
    print(f"{len(wanted)} items of {CHECKOUT} in {out}")
    return 0


def _make(key: str, out: Path) -> tuple[str, float, str]:
    """Do an item in a folder of its own, with random numbers of its own."""
    start, error = time.perf_counter(), ""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            found = plain(ITEMS[key](np.random.default_rng(zlib.crc32(key.encode()))))
        except Exception as raised:  # it is what this item comes to
            error = f"{type(raised).__name__}: {raised}"
            found = {"error": plain(error)}
        os.chdir(CHECKOUT)
    target = out / f"{key}.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(found))
    return key, round(time.perf_counter() - start, 2), error.partition("\n")[0]


def plain(value: Any) -> Any:
    """What JSON can hold of it; rows of the same keys become columns."""
    if hasattr(value, "provenance") and hasattr(value, "table"):
        return plain({name: getattr(value, name) for name in ("table", "source", "provenance")})
    if isinstance(value, pd.DataFrame):
        return plain(value.to_dict("list"))
    if isinstance(value, Mapping):
        kept = (k for k in value if not any(fnmatch(str(k), name) for name in VOLATILE))
        return {str(key): plain(value[key]) for key in kept}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        if len({tuple(row) if isinstance(row, Mapping) else None for row in value} - {None}) == 1:
            return plain(pd.DataFrame(value))
        return [plain(inner) for inner in value]
    if isinstance(value, str | Path):
        return str(value).replace(str(CHECKOUT), "").replace(str(Path.cwd()), "")
    if value is None or isinstance(value, bool | int | float):
        return value
    raise TypeError(f"a {type(value).__name__} cannot be stored")
