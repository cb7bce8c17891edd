"""One trial: a command in an empty folder of its own, and what is wrong with how it ended.

It is done in a process that shares what is imported here, so that its limits, its memory and its
end are its own.
"""

import os
import resource
import signal
import sys
import tempfile
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import NoReturn

import compare
from compare.commands.main import main

for module in walk_packages(compare.__path__, "compare."):  # once, not in each trial
    import_module(module.name)

CPU_SECONDS = 60
STUCK_SECONDS = 900  # of the clock
MEGABYTES = 2000
ADDRESSES = 8_000_000_000  # bytes; more is refused before the machine suffers
CRASHED = 70
USELESS = ("None:", "; see ...", "out of memory", "internal error", "Traceback", " = : must be")


@dataclass
class Trial:
    """A command line, and the files that it finds in its folder."""

    kind: str
    words: list[str]
    files: dict[str, bytes] = field(default_factory=dict)

    def __str__(self) -> str:
        return " ".join(ascii(word)[1:-1][:60] for word in self.words)


@dataclass
class Outcome:
    """How a command ended, and what is wrong with that."""

    code: object
    error: str
    seconds: float
    faults: list[str]


def perform(trial: Trial) -> Outcome:
    """Do a trial in an empty folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "here"
        place.mkdir()
        for name, content in trial.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)
        before = set(place.rglob("*"))
        outcome = _done(trial, place)
        outcome.faults += _left_behind(place, before)
        outcome.faults += [f"removed {path.name}" for path in before if not _there(path)]
        if {path.name for path in Path(folder).iterdir()} != {"here"}:
            outcome.faults.append("wrote outside its folder")
        return outcome


def _done(trial: Trial, place: Path) -> Outcome:
    with tempfile.TemporaryFile() as error:
        process = os.fork()
        if process == 0:
            _be_the_command(trial.words, place, error.fileno())
        _, status, used = os.wait4(process, 0)
        error.seek(0)
        said = error.read().decode(errors="replace")
    code, seconds = os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime
    return _judged(code, said, seconds, used.ru_maxrss // 1024)


def _be_the_command(words: list[str], place: Path, error: int) -> NoReturn:
    code: object = CRASHED
    try:
        os.chdir(place)
        for wanted, stream in ((os.open(os.devnull, os.O_RDWR), (0, 1)), (error, (2,))):
            for one in stream:
                os.dup2(wanted, one)
        sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w", errors="backslashreplace")
        sys.argv = ["vibrissa", *words]
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
        signal.alarm(STUCK_SECONDS)
        main()
    except SystemExit as ended:
        code = ended.code or 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stderr.flush()
        os._exit(code if isinstance(code, int) else CRASHED)


def _judged(code: object, error: str, seconds: float, megabytes: int) -> Outcome:
    faults = []
    if code not in (0, 1, 2):
        faults.append(f"ended with {str(code)[:200]}")
    faults += [f"said {nonsense!r}" for nonsense in USELESS if nonsense in error]
    if code == 2 and len(error.strip("\n").splitlines()) != 1:
        faults.append(f"{len(error.splitlines())} lines of error")
    if code in (0, 1) and not all(line.startswith("vibrissa: ") for line in error.splitlines()):
        faults.append("a stray line")
    if "Warning" in error:
        faults.append("a warning")
    if code == 2 and len(error) > 1500:
        faults.append(f"a line of {len(error)} characters")
    if megabytes > MEGABYTES:
        faults.append(f"{megabytes} MB")
    return Outcome(code, error, seconds, faults)


def _left_behind(place: Path, before: set[Path]) -> Iterator[str]:
    for path in set(place.rglob("*")) - before:
        if path.name.endswith(".partial"):
            yield f"left {path.name}"
        if path.is_dir() and not any(path.iterdir()):
            yield f"left the empty folder {path.name}"


def _there(path: Path) -> bool:
    """Whether a file is still there, if only under the name of one that was set aside."""
    return path.exists() or path.with_name(f".damaged-{path.name.lstrip('.')}").exists()
