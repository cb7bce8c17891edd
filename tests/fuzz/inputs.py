"""Bad input of all kinds to all commands: ``python -m tests.fuzz.inputs N SEED``.

Whatever comes, a command ends with 0, 1 or 2, without a traceback; 2 comes with one line on
standard error; nothing unfinished is left behind; and time and memory stay bounded. Trial i of a
seed is the same every time: ``--only i`` repeats it, and prints what it was.
"""

import argparse
import contextlib
import gc
import io
import os
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from typer.main import get_command

from analytic import Sweep, named_case, solve_sweep
from analytic.problem.case import Case
from compare import compare
from compare.commands.main import app, main
from compare.show.report import write_report
from compare.study import Plan, load_study
from compare.study.keep.store import Store
from compare.study.work.perform import Recipe
from compare.study.work.perform import perform as perform_run

CPU_SECONDS = 60
MEGABYTES = 2000


@dataclass
class Trial:
    """A command line, and the files that it finds in its folder."""

    kind: str
    words: list[str]
    files: dict[str, bytes] = field(default_factory=dict)


@dataclass
class Outcome:
    """How a command ended, and what is wrong with that."""

    code: object
    error: str
    seconds: float
    faults: list[str]


class OutOfTime(BaseException):
    """A command has used up its CPU time."""


# ---- what people, and mishaps, write

NUMBERS = (
    "0", "-0.0", "1", "-1", "2.5", "1e-320", "1e308", "-1e308", "1e999", "nan", "inf", "-inf",
    "99999999999999999999", "9" * 5000, "0x" + "f" * 5000, "1_000", "0.5", "1e-9", "3", "true",
    "false", "[]", "{}", "[1, 2]", "[[1, 2], [3]]", '""', "1979-05-27T07:32:00Z",
)  # fmt: skip
QUANTITIES = (
    '"1 m"', '"50 mm"', '"1 parsnip"', '"1 kg"', '"0 m"', '"m"', '"-1 m"', '"1e400 m"',
    '"9**9**9 m"', '"m**9**9"', '"((((1 m"', '"1 m)"', "'\"\"\"'", '"1 m/0"', '"1 m^-1"',
    '"' + "(" * 3000 + '"', '"' + "m*" * 3000 + 'm"', '"1 degC"', '"1 __import__(\'os\')"',
    '"5 5 m"', '"1 m\\n2 m"', '"\\u0000"', '"1 km*"', '"1e5"', '"½ m"', '"1 µm"',
)  # fmt: skip
WORDS = (
    "", "catenary", "x", "-", "--", ".", "..", "/", "../../../x", "a/b", "a\\b", "nul\x01", "é",
    "[bold]", "[/b]", "$$", "%s", "{0}", "<script>", "name with blanks", "x" * 300, "\n", "\udcff",
    "chain", "rod", "cable", "mesh", "primitive", "auto", "1", "0.5", "-1", "nan", "1e400",
)  # fmt: skip
KEYS = {
    "beam": ("length", "flexural_rigidity", "radius", "radis"),
    "profile": ("kind", "a", "c", "radius", "lowest", "semi_axes", "points", "scale", "file",
                "right_radius", "left_radius", "height", "axes", "offset"),
    "sweep": ("stations", "start", "stop", "direction"),
    "mujoco": ("beam", "segments", "contour_points", "contact_stiffness", "clamp", "obstacle",
               "tolerance", "planar"),
    "tolerances": ("rms", "max", "snap_off", "force_x", "nonsense"),
}  # fmt: skip
LINES = (
    "# a comment", "", "ERR,ERR,ERR,ERR", "1,2", "date;time", '"', "true,false,true,true",
    "1e999,1,1,1", "\x00", "0.5;0.5;0.5;0.5", "NaN,NaN,NaN,NaN", ",,,", "1,2,3,4,5",
)  # fmt: skip
PROFILES = (
    'kind = "catenary"\na = 0.5\nc = -0.8',
    'kind = "parabola"\na = 0.5\nc = 0.5',
    'kind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]',
    'kind = "ellipse"\nsemi_axes = [2.0, 0.5]\nlowest = [0.0, 0.4]',
    'kind = "two-circles"',
    'kind = "polygon"\npoints = [[-1, 1.2], [0, 0.4], [1, 1.2]]',
    'kind = "points"\npoints = [[-1, 1.2], [-0.5, 0.5], [0, 0.4], [1, 1.2]]',
    'kind = "mesh"\nfile = "body.stl"\noffset = [0.0, 1.3]',
)


class Maker:
    """Trials of one seed."""

    def __init__(self, seed: int, number: int) -> None:
        self.rng = np.random.default_rng([seed, number])

    def pick(self, *choices):
        return choices[self.rng.integers(len(choices))]

    def some(self, choices, most: int) -> list:
        count = self.rng.integers(0, min(most, len(choices)) + 1)
        return [choices[i] for i in self.rng.choice(len(choices), count, replace=False)]

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def trial(self) -> Trial:
        kinds = (self.options, self.case, self.study, self.data, self.mesh, self.outputs, self.toml)
        weights = np.array([4, 5, 4, 4, 2, 2, 1])
        return kinds[self.rng.choice(len(kinds), p=weights / weights.sum())]()

    # -- classes of trials --

    def options(self) -> Trial:
        """Commands with arguments and options that are nonsense, or extreme."""
        known = get_command(app).commands
        name = self.pick(*known, *known, "fly", "--help", "--version", "")
        words = [name] if name else []
        files = {"file": b"", "good.csv": good_csv(), "short.csv": good_csv()[:300]}
        usual = ("catenary", "parabola", "good.csv", "short.csv", "file", ".", "resolution",
                 "nowhere.toml", "/dev/zero", "good.csv/")  # fmt: skip
        extreme = (*(n for n in NUMBERS if len(n) < 30), "9" * 5000, "/proc/x/y", "/dev/full")
        if name in known:
            for parameter in known[name].params:
                option = parameter.opts[0]
                if not option.startswith("-"):
                    words += [self.pick(*usual, *usual, self.pick(*WORDS))] * self.pick(
                        1, 1, 1, 0, 2
                    )
                elif self.chance(0.3):
                    valued = not getattr(parameter, "is_flag", False)
                    value = self.pick("out", *usual, self.pick(*WORDS), self.pick(*extreme))
                    words += [option, value] if valued else [option]
        if self.chance(0.1):
            words.append(self.pick("--help", "--version", "--nonsense", *WORDS))
        # What would be right, and take long, must have one thing wrong at least.
        if name in ("run", "simulate", "animate", "budget"):
            words += ["--stations", self.pick("1", "-5", "1e3", "99999999999999999999", "x")]
        if name == "study":
            words.append("--dry-run")
        return Trial("options", words, files)

    def case(self) -> Trial:
        """Case files whose tables hold what they should not."""
        tables = self._tables()
        for _ in range(self.rng.integers(0, 4)):
            self._spoil(tables)
        text = self._written(tables).encode(errors="surrogateescape")
        command = self.pick("analytic", "analytic", "analytic", "simulate")
        words = [command, "case.toml", "--out", "out", "--stations", "4"]
        if command == "simulate":
            words += ["--segments", "8"]
        return Trial("case", words, {"case.toml": text, "body.stl": ball()})

    def toml(self) -> Trial:
        """Files that are hardly TOML: deep, large, cut off, in another encoding."""
        whole = self._written(self._tables())
        deep = int(self.pick(10, 100, 1000, 100_000))
        text = self.pick(
            whole + "\nx = " + "[" * deep + "]" * deep,
            whole + "\nx = " + "{a=" * deep + "1" + "}" * deep,
            ".".join(["a"] * deep) + " = 1\n" + whole,
            "[" + ".".join(["a"] * deep) + "]\n",
            whole + "\n[tolerances." + ".".join(["a"] * deep) + "]\nx = 1\n",
            whole.replace("\n", "\r"),
            whole.replace("\n", "\r\n"),
            whole + "\nx = " + "9" * 5000,
            whole + '\nx = """open',
            "".join(f"k{i} = 1\n" for i in range(deep)) + whole,
            whole + "\n[profile]\n" + "".join(f"k{i} = {{ a = 1 }}\n" for i in range(deep)),
            '[profile]\nkind = "points"\npoints = [\n'
            + "".join(f"[{x}, {x * x + 0.4}],\n" for x in np.linspace(-1, 1, min(deep, 3000)))
            + "]\n[beam]\nradis = 1\n",
        )
        content = text.encode()
        if self.chance(0.2):
            content = text.encode(self.pick("utf-16", "utf-8-sig", "utf-32"))
        if self.chance(0.3):
            content = self._damaged(content)
        command = self.pick(["analytic", "case.toml", "--stations", "4"],
                            ["study", "case.toml", "--dry-run"],
                            ["compare", "good.csv", "good.csv", "--tolerances", "case.toml"],
                            ["reconstruct", "good.csv", "--beam", "case.toml"])  # fmt: skip
        return Trial("toml", command, {"case.toml": content, "good.csv": good_csv()})

    def study(self) -> Trial:
        """Study files, planned only."""
        case = self.pick("catenary", "catenary", "parabola", *WORDS[:8])
        tables = {"study": {"case": f'"{case}"', "beams": self.pick("[]", '["chain"]')}}
        for key in self.some(("name", "beams", "record", "keep_readings", "timeout", "zip"), 2):
            tables["study"][key] = self._value()
        axes = [f"{table}.{key}" for table, keys in KEYS.items() for key in keys]
        usual = ["profile.a", "beam.radius", "sweep.stations", "mujoco.segments"]
        wanted = self.some([*usual, *usual, *axes, "noise.relative", "noise.seed", "x", "a.b.c"], 4)
        tables["axes"] = {key: self._axis() for key in wanted}
        for name in self.some(("sample", "noise", "beam", "sweep", "mujoco", "nonsense"), 2):
            key = self.pick("count", "seed", "relative", "length", "stations", "segments")
            tables[name] = {key: self._value()}
        text = self._written(tables).encode(errors="surrogateescape")
        return Trial("study", ["study", "grid.toml", "--dry-run"], {"grid.toml": text})

    def data(self) -> Trial:
        """Files of readings as rigs, and accidents, write them."""
        content = self._table()
        if self.chance(0.3):
            content = self._damaged(content)
        name = self.pick("rig.csv", "rig.csv", "rig.txt", "rig.dat", "rig.parquet", "rig.xls")
        files = {name: content, "good.csv": good_csv(), "beam.toml": b"[beam]\nlength = 1.0\n"}
        words = self.pick(
            ["reconstruct", name],
            ["compare", "good.csv", name],
            ["compare", name, "good.csv"],
            ["side-by-side", "good.csv", name],
        )
        if words[0] != "side-by-side":
            for spec in self.some(("foot_x=stage:mm", "force_x=1", "foot_x=a:b:c", "x=y",
                                   "moment_z=Mz:N m", "force_y=Fy:0 N", "foot_x=foot_x:parsec",
                                   "=", "foot_x="), 2):  # fmt: skip
                words += ["--column", spec]
            if self.chance(0.3):
                words += ["--beam", self.pick("beam.toml", "good.csv", "nowhere.toml")]
            words += self.some(("--direction=left", "--direction=right", "--noise=0.01"), 1)
        return Trial("data", [*words, "--out", "out"], files)

    def mesh(self) -> Trial:
        """Meshes that are damaged, lie about their size, or are no meshes."""
        content = self._damaged(ball()) if self.chance(0.7) else self.pick(
            b"", b"solid\nendsolid", b"PK\x03\x04" + bytes(100),
            b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n",
            bytes(80) + struct.pack("<I", 4_000_000_000) + bytes(500),
            b"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n",
            b"v 0 0 0\nv 1 0 0\nv 0 1e38 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n",
            b"v 0 0 0\nf 1 2 99\n", b"{}", bytes(self.rng.integers(0, 256, 500, dtype=np.uint8)),
        )  # fmt: skip
        suffix = self.pick("stl", "stl", "obj", "ply", "3mf", "off", "glb", "gltf", "dae", "xaml",
                           "zip", "step", "txt", "STL", "")  # fmt: skip
        name = f"body.{suffix}"
        text = f'[profile]\nkind = "mesh"\nfile = "{name}"\noffset = [0, 1.3]\n'
        if self.chance(0.3):
            text += f"{self.pick('height', 'scale', 'axes')} = {self._value()}\n"
        words = ["analytic", "case.toml", "--stations", "4", "--out", "out"]
        return Trial("mesh", words, {"case.toml": text.encode(), name: content})

    def outputs(self) -> Trial:
        """What the commands themselves have written, damaged since."""
        files = dict(outputs())
        for name in self.some(sorted(files), 2) or [sorted(files)[0]]:
            files[name] = self._damaged(files[name])
        words = self.pick(["findings", "runs"], ["findings", "runs", "--out", "page"],
                          ["study-report", "small"], ["study", "small/study.toml", "--dry-run"],
                          ["compare", "runs/one/analytic.parquet", "runs/one/mujoco.parquet"],
                          ["reconstruct", "runs/one/mujoco.parquet"],
                          ["side-by-side", "catenary", "runs/one/mujoco.parquet"])  # fmt: skip
        return Trial("outputs", words, files)

    # -- their parts --

    def _tables(self) -> dict[str, dict[str, str]]:
        """A sound case file: its tables, their keys and values as they are written."""
        profile = dict(line.split(" = ", 1) for line in self.pick(*PROFILES).splitlines())
        beam = {"length": "1.0"}
        return {"": {}, "profile": profile, "beam": beam, "mujoco": {"segments": "8"}}

    def _spoil(self, tables: dict[str, dict[str, str]]) -> None:
        """Change a value, or add or remove a key or a table."""
        name = self.pick(*tables)
        other = self.pick(*KEYS)
        match self.rng.integers(7):
            case 0 | 1 | 2:
                if tables[name]:
                    tables[name][self.pick(*tables[name])] = self._value()
            case 3:
                if tables[name]:
                    del tables[name][self.pick(*tables[name])]
            case 4:
                tables[""]["name"] = self._text()
            case 5:
                tables.setdefault(other, {})[self.pick(*KEYS[other])] = self._value()
            case 6:
                tables[name][self.pick(*KEYS[other])] = self._value()

    def _written(self, tables: dict[str, dict[str, str]]) -> str:
        lines = []
        for name, table in tables.items():
            lines += [f"[{name}]"] if name else []
            lines += [f"{key} = {value}" for key, value in table.items()]
        if self.chance(0.05):
            lines.insert(int(self.rng.integers(len(lines))), self.pick(*lines))
        return "\n".join(lines)

    def _text(self) -> str:
        word = self.pick(*WORDS)
        written = word.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{written}"'.replace("\x01", "\\u0001")

    def _value(self) -> str:
        number = self.rng.standard_normal() * 10.0 ** self.rng.integers(-12, 12)
        return self.pick(self.pick(*NUMBERS), self.pick(*QUANTITIES), self._text(), f"{number:g}")

    def _axis(self) -> str:
        few = ", ".join(self._value() for _ in range(self.rng.integers(0, 3)))
        ends = f"from = {self._value()}, to = {self._value()}"
        return self.pick(self._value(), f"[{few}]", f"{{ {ends}, count = {self._value()} }}",
                         "{ from = 0.2, to = 0.4, count = 1000000000 }",
                         "{ from = 0.2, to = 0.4, count = 3 }", f"{{ {ends} }}",
                         "[0.001, 0.002]", '{ from = 1, to = 2, spacing = "log" }')  # fmt: skip

    def _table(self) -> bytes:
        """A sweep as text: some dialect, some accident."""
        table = sweep_table().copy()
        match self.rng.integers(9):
            case 0:
                table = table.sample(frac=1, random_state=int(self.rng.integers(1000)))
            case 1:
                table = table.iloc[np.r_[0 : len(table), len(table) - 1 : -1 : -1]]
            case 2:
                table = table.iloc[np.repeat(np.arange(len(table)), 3)]
            case 3:
                table["foot_x"] = table["foot_x"].round().astype(int)
            case 4:
                table = table * 10.0 ** self.rng.integers(-300, 300)
            case 5:
                table = table.head(int(self.rng.integers(0, 4)))
            case 6:
                table.iloc[:, int(self.rng.integers(4))] = self.pick(np.nan, np.inf, 0.0, 1.0)
        mark, decimal = self.pick((",", "."), (";", ","), (";", "."), ("\t", ","), (" ", "."),
                                  (",", ","), ("|", "."))  # fmt: skip
        text = table.to_csv(sep=mark, decimal=decimal, index=False, header=self.chance(0.9))
        lines = text.splitlines()
        for _ in range(self.rng.integers(0, 3)):
            at = int(self.rng.integers(len(lines))) if lines else 0
            lines.insert(at, self.pick(*LINES))
        text = self.pick("\n", "\n", "\r\n", "\r").join(lines)
        encoding = self.pick("utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1")
        return text.encode(encoding, "replace")

    def _damaged(self, content: bytes) -> bytes:
        """Cut off, with flipped bytes, with a piece twice, or with junk in it."""
        if not content:
            return content
        at = int(self.rng.integers(len(content)))
        match self.rng.integers(6):
            case 0:
                return content[:at]
            case 1:
                changed = bytearray(content)
                for i in self.rng.integers(0, len(content), self.rng.integers(1, 20)):
                    changed[i] = self.rng.integers(256)
                return bytes(changed)
            case 2:
                return content[:at] + content[max(0, at - 100) :]
            case 3:
                return content[:at] + bytes(200) + content[at:]
            case 4:
                junk = self.pick(
                    b"null", b"[]", b'{"a": [', b"NaN", b"\xff\xfe", b'"', b"-1", b"{}"
                )
                return content[:at] + junk + content[at + len(junk) :]
        return self.pick(b"", b"{}", b"[]", b"null", b"0", content[at:])


# ---- files that are right, to be spoilt


@cache
def sweep_table():
    case = named_case("parabola")
    table = solve_sweep(Case(case.beam, case.profile, Sweep(stations=40))).table
    return table[["foot_x", "force_x", "force_y", "moment_z"]]


@cache
def good_csv() -> bytes:
    return sweep_table().to_csv(index=False).encode()


@cache
def ball() -> bytes:
    import trimesh

    return bytes(trimesh.creation.icosphere(subdivisions=2).export(file_type="stl"))


@cache
def outputs() -> tuple[tuple[str, bytes], ...]:
    """A run and a small study, as the commands write them."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "small").mkdir()
        (place / "small/study.toml").write_text(
            'study = { name = "small", case = "catenary", beams = [] }\n'
            "axes.beam.radius = [0.001, 0.002, 0.003]\n"
        )
        sweep = solve_sweep(Case(sweep=Sweep(stations=40)))
        (place / "runs/one").mkdir(parents=True)
        for name in ("analytic", "mujoco"):
            sweep.write(place / f"runs/one/{name}.parquet")
        write_report(compare(sweep, sweep), place / "runs/one")
        plan = Plan.of(load_study(str(place / "small/study.toml")))
        with Store(place / "small", plan, print) as store:
            for run in plan:
                store.add(perform_run(Recipe.of(plan.study), run))
        return tuple(
            (str(path.relative_to(place)), path.read_bytes())
            for path in sorted(place.rglob("*"))
            if path.is_file() and path.suffix not in (".png", ".html")
        )


# ---- a trial, and what is wrong with how it ended


def perform(trial: Trial, own_process: bool = False) -> Outcome:
    """Do a trial in an empty folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "here"
        for name, content in trial.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_bytes(content)
        place.mkdir(exist_ok=True)
        before = set(place.rglob("*"))
        outcome = (_in_own_process if own_process else _in_process)(trial, place)
        outcome.faults += _left_behind(place, before)
        if {path.name for path in Path(folder).iterdir()} != {"here"}:
            outcome.faults.append("wrote outside its folder")
        return outcome


def _in_process(trial: Trial, place: Path) -> Outcome:
    out, error = io.StringIO(), io.StringIO()
    here, words, code = Path.cwd(), sys.argv, None
    begin = time.process_time()
    try:
        os.chdir(place)
        sys.argv = ["vibrissa", *trial.words]
        with _cpu_time(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
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
    return _judged(code, error.getvalue(), time.process_time() - begin)


def _in_own_process(trial: Trial, place: Path) -> Outcome:
    command = "from compare.commands.main import main; main()"
    begin = time.perf_counter()
    path = os.pathsep.join([str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    words = [word.encode(errors="surrogateescape") for word in trial.words]
    done = subprocess.run(
        [sys.executable, "-c", command, *words],
        cwd=place,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        env={**os.environ, "PYTHONPATH": path},
        preexec_fn=_limit_own_process,
    )
    return _judged(done.returncode, done.stderr, time.perf_counter() - begin)


def _limit_own_process() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))


def _judged(code: object, error: str, seconds: float) -> Outcome:
    faults = []
    if code not in (0, 1, 2):
        faults.append(f"ended with {str(code)[:200]}")
    if "Traceback" in error or "internal error" in error:
        faults.append("traceback")
    if code == 2 and len(error.strip("\n").splitlines()) != 1:
        faults.append(f"{len(error.splitlines())} lines of error")
    if code in (0, 1) and "Warning" in error:
        faults.append("a warning")
    if any(nonsense in error for nonsense in ("None:", "; see ...", "out of memory")):
        faults.append("a useless line")
    if resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > MEGABYTES * 1024:
        faults.append(f"more than {MEGABYTES} MB")
    return Outcome(code, error, seconds, faults)


def _left_behind(place: Path, before: set[Path]) -> Iterator[str]:
    for path in set(place.rglob("*")) - before:
        if path.name.endswith(".partial"):
            yield f"left {path.name}"
        if path.is_dir() and not any(path.iterdir()):
            yield f"left the empty folder {path.name}"


@contextlib.contextmanager
def _cpu_time() -> Iterator[None]:
    def end(number, frame) -> None:
        raise OutOfTime

    before = signal.signal(signal.SIGVTALRM, end)
    signal.setitimer(signal.ITIMER_VIRTUAL, CPU_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def campaign(
    numbers: range | list[int],
    seed: int,
    own_process: bool = False,
    show: bool = False,
) -> tuple[Counter, list[str]]:
    """Do trials; counts by class and exit code, and a line for each that ended badly."""
    counts: Counter = Counter()
    bad = []
    for number in numbers:
        trial = Maker(seed, number).trial()
        outcome = perform(trial, own_process)
        counts[trial.kind, str(outcome.code)[:20]] += 1
        if outcome.faults:
            words = " ".join(ascii(word)[1:-1] for word in trial.words)
            bad.append(f"{number} {trial.kind}: {'; '.join(outcome.faults)}: {words}"[:400])
        if outcome.faults or show:
            words = " ".join(ascii(word)[1:-1][:60] for word in trial.words)
            print(number, trial.kind, outcome.code, f"{outcome.seconds:.1f} s", words)
            print(f"    {outcome.error[-300:]!a}", *outcome.faults, sep="; ", flush=True)
        if number % 50 == 0:
            import matplotlib.pyplot as plt

            plt.close("all")
            gc.collect()
    return counts, bad


def _main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?", default=1000)
    parser.add_argument("seed", type=int, nargs="?", default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first trial")
    parser.add_argument("--only", type=int, help="repeat this trial, and print it")
    parser.add_argument("--show", action="store_true", help="a line for each trial")
    parser.add_argument("--processes", action="store_true", help="a process for each trial")
    given = parser.parse_args()
    if given.only is not None:
        trial = Maker(given.seed, given.only).trial()
        for name, content in trial.files.items():
            print(f"--- {name}\n{content[:2000]!r}")
        print("vibrissa", *(ascii(word) for word in trial.words))
        outcome = perform(trial, given.processes)
        print(outcome.code, outcome.faults, f"{outcome.seconds:.1f} s", outcome.error, sep="\n")
        return 0
    numbers = range(given.first, given.first + given.count)
    counts, bad = campaign(numbers, given.seed, given.processes, given.show)
    for (kind, code), count in sorted(counts.items()):
        print(f"{kind:10}{code:>22}{count:8}")
    print(f"{given.count} trials, {len(bad)} of them ended badly")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(_main())
