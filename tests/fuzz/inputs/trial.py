"""One trial: a command in an empty folder of its own, and what is wrong with how it ended."""

import contextlib
import faulthandler
import io
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from compare.commands.main import main

CPU_SECONDS = 60
STUCK_SECONDS = 900  # of the clock; then the campaign itself is ended, and says where it was
MEGABYTES = 2000
ALONE = 300  # MB, of the command and its libraries before it does anything
ADDRESSES = 8_000_000_000  # bytes; more is refused before the machine suffers
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


class OutOfTime(BaseException):
    """A command has used up its CPU time."""


def perform(trial: Trial, own_process: bool = False) -> Outcome:
    """Do a trial in an empty folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "here"
        place.mkdir()
        for name, content in trial.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)
        before = set(place.rglob("*"))
        outcome = (_in_own_process if own_process else _in_this_process)(trial, place)
        outcome.faults += _left_behind(place, before)
        outcome.faults += [f"removed {path.name}" for path in before if not _there(path, before)]
        if {path.name for path in Path(folder).iterdir()} != {"here"}:
            outcome.faults.append("wrote outside its folder")
        return outcome


def _in_this_process(trial: Trial, place: Path) -> Outcome:
    out, error = io.StringIO(), io.StringIO()
    here, words, code = Path.cwd(), sys.argv, None
    begin = time.process_time()
    _forget_peak()
    others = _peak() - ALONE  # what trials before this one have left in this process
    try:
        os.chdir(place)
        sys.argv = ["vibrissa", *trial.words]
        with _limits(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            try:
                main()
            except SystemExit as ended:
                code = ended.code
    except OutOfTime:
        code = f"more than {CPU_SECONDS} s"
    except BaseException as crash:
        code = f"{type(crash).__name__}: {crash}"
    finally:
        sys.argv = words
        os.chdir(here)
    return _judged(code, error.getvalue(), time.process_time() - begin, _peak() - others)


def _in_own_process(trial: Trial, place: Path) -> Outcome:
    command = "from compare.commands.main import main; main()"
    path = os.pathsep.join([str(Path(__file__).parents[3]), os.environ.get("PYTHONPATH", "")])
    words = [word.encode(errors="surrogateescape").replace(b"\0", b"?") for word in trial.words]
    with tempfile.TemporaryFile() as error:
        done = subprocess.Popen(
            [sys.executable, "-c", command, *words],
            cwd=place,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=error,
            env={**os.environ, "PYTHONPATH": path},
            preexec_fn=_limit_own_process,
        )
        _, status, used = os.wait4(done.pid, 0)
        done.returncode = os.waitstatus_to_exitcode(status)
        error.seek(0)
        said = error.read().decode(errors="replace")
    return _judged(done.returncode, said, used.ru_utime + used.ru_stime, used.ru_maxrss // 1024)


def _limit_own_process() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


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


def _there(path: Path, before: set[Path]) -> bool:
    """Whether a file is still there, if only under the name of one that was set aside."""
    if path.exists():
        return True
    aside = path.with_name(f".damaged-{path.name.lstrip('.')}")
    tidied = path.name.startswith((".journal-", "part-")) and path.parent.is_dir()
    return aside.exists() or tidied


@contextlib.contextmanager
def _limits() -> Iterator[None]:
    """Bounds on CPU time and memory of what is done in this process."""

    def end(number, frame) -> None:
        raise OutOfTime

    before = signal.signal(signal.SIGVTALRM, end)
    signal.setitimer(signal.ITIMER_VIRTUAL, CPU_SECONDS)
    addresses = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, addresses[1]))
    faulthandler.dump_traceback_later(STUCK_SECONDS, exit=True, file=sys.__stderr__)
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()
        resource.setrlimit(resource.RLIMIT_AS, addresses)
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def _forget_peak() -> None:
    """The largest memory so far is that of other trials; Linux can forget it."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def _peak() -> int:
    """Largest memory of this trial [MB]; that of all trials where the system does not say."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) // 1024
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
