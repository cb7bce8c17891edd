"""All faults of random models fixed but one: ``python -m tests.fuzz.left_out N [SEED]``.

What `inspect` still says of such a model is held against its sweep, beside that of the model with
all fixed, past the same object. A line a model says which fault was left, what is named, and how
far the sweeps differ; and as flags:

- ``also``: something is named beside what was left;
- ``false``: what is named moves no reading by half a per cent;
- ``sound``: nothing is named, and readings are moved by more than the expected interval.

Without a seed it takes a new one, from the clock. The exit code is 1 if there is a flag.
"""

import random
import sys
import tempfile
import time
from pathlib import Path

from rich.console import Console

from analytic import InputError, Readings
from compare import compare
from compare.read.case import load_case
from compare.simulate.expected import SPEED, expected
from compare.simulate.fixing import case_of
from compare.simulate.inspection import Inspection
from mujoco_models import inspect_model, simulate_model
from mujoco_models.fix.edit import Edit, Insert
from mujoco_models.fix.write import fixed
from mujoco_models.inspect.load import load
from tests.fuzz.models import Model, drawn
from tests.fuzz.ways import rewritten

_MATTERS = 0.005  # rms; half of the per cent that a fault is said to move
_ROUNDS = 4  # as of `--write`
_FEWEST = 2  # faults
# What comes with a fault: both sensors are on one site, a contact is as hard as the step lets it.
_TOGETHER = (
    {"force sensor", "torque sensor"},
    {"contact", "time step", "flags"},
    {"clamp", "uniformity"},
)


def without_faults(path: Path, out: Path, left: set[str]) -> Inspection:
    """Write a copy with what a number fixes, but for some subjects."""
    model, inspection = load(path), Inspection(inspect_model(path))
    done = list[Edit | Insert]()
    for _ in range(_ROUNDS):
        done += [
            edit
            for fault in inspection.faults
            for edit in fault.edits
            if fault.subject not in left and not (isinstance(edit, Insert) and edit in done)
        ]
        fixed(path, model, done, out)
        inspection = Inspection(inspect_model(out))
    return inspection


def swept(case: Path, file: Path) -> Readings:
    """A model past a case's object."""
    text = case.read_text()
    own = case.with_name(f"{file.stem}.toml")
    own.write_text(text.replace('file = "whole.xml"', f'file = "{file.name}"'))
    job = load_case(own)
    return simulate_model(job.case, job.model, job.motion, job.settings)


def moved_by(case: Path, file: Path, all_fixed: Readings) -> float:
    """How far its readings are from those of the fixed model; infinite if there are none."""
    try:
        parts = compare(all_fixed, swept(case, file)).disagreement
    except InputError:
        return float("inf")
    off = max(part.rms for part in parts.values())
    return off if off >= 0 else float("inf")  # NaN of a sweep that diverged


def trial(rng: random.Random, folder: Path) -> tuple[str, list[str]]:
    """What is said of a model with one fault left, and what is wrong with that."""
    model = Model()
    while len(model.planted) < _FEWEST or model.carrier == "weld" or "attached" in model.ways:
        model = drawn(rng)
    path = folder / "foreign.xml"
    path.write_text(rewritten(model.text(), model.ways, folder, rng))
    all_fixed = without_faults(path, folder / "whole.xml", set())
    faults = sorted({fault.subject for fault in Inspection(inspect_model(path)).faults})
    said = f"{model.planted} {faults}"
    if not all_fixed.sound:
        return f"{said}, not fixed: {[str(fault) for fault in all_fixed.faults]}", []
    one = rng.choice(faults)
    together = next((group for group in _TOGETHER if one in group), {one})
    found = without_faults(path, folder / "left.xml", {one})
    named = {fault.subject for fault in found.faults}
    case = folder / "case.toml"
    case.write_text(case_of(all_fixed.found, folder / "whole.xml", {}))
    by = moved_by(case, folder / "left.xml", swept(case, folder / "whole.xml"))
    flags = [f"also {sorted(named - together)}"] if named - together else []
    if named and not by > _MATTERS:
        flags.append("false")
    if not named and by > expected(all_fixed.found, SPEED).interval[1]:
        flags.append("sound")
    return f"{said}, left {one!r}: named {sorted(named)}, moves by {by:.1e}", flags


def main(count: int, seed: int) -> int:
    """Try some; 1 if something is wrong."""
    console = Console(highlight=False, soft_wrap=True)
    console.print(f"{count} models, seed {seed}")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for i in range(count):
            said, flags = trial(random.Random(f"{seed} {i}"), Path(folder))
            wrong += bool(flags)
            console.print(f"{i}: {said} {flags or ''}", markup=False)
    console.print(f"{wrong} wrong")
    return int(wrong > 0)


if __name__ == "__main__":
    words = [int(word) for word in sys.argv[1:]]
    sys.exit(main(words[0], words[1] if len(words) > 1 else time.time_ns() % 10**6))
