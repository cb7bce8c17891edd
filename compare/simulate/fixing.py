"""A model's faults fixed in a copy of its file, and the case that the copy is a model of."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from analytic import Beam, Case, InputError, circle, solve_sweep
from compare.judge.rate import Rate
from compare.simulate.course import curvature
from compare.simulate.expected import SPEED, expected, hurry
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import (
    as_intended,
    clamp_stiffness,
    is_cone,
    radii,
    smooth_rigidity,
    tapers,
)
from mujoco_models import inspect_model
from mujoco_models.fix.edit import Edit, Insert
from mujoco_models.fix.write import fixed
from mujoco_models.inspect.ahead import HEIGHT
from mujoco_models.inspect.load import load
from mujoco_models.inspect.measured import MeasuredBeam

CASE_MARK = "# Written by `vibrissa inspect --write`: the vibrissa"
"""The first line of a case file that is not a user's own."""
_ROUNDS = 5  # EI; a contact as hard as the step lets it; its inertia goes with the step
_UNTIL = ", until it would leave its plane"
_CIRCLE = 0.8  # L; its radius
_STATIONS = 21  # of a varying EI
_WAY = 1.5  # L; of the foot while the side of the vibrissa touches that circle


@dataclass(frozen=True)
class Fixed:
    files: tuple[Path, ...]
    edits: tuple[Edit | Insert, ...]
    followed: tuple[Edit | Insert, ...]  # those of them that the model asks for with the others set
    inspection: Inspection  # of the fixed model

    def lines(self) -> Iterator[str]:
        names = " and ".join(str(file) for file in self.files)
        yield f"wrote {names}: {len(self.edits)} edits"
        for edit in filter(str, self.followed):
            yield f"  then set {edit}"
        left = self.inspection.faults
        if left:
            faults = f"{len(left)} faults are" if len(left) > 1 else "1 fault is"
            yield f"  {faults} left, to fix by hand; how far it is off can then be said:"
        for fault in left:
            yield f"  {'; '.join(filter(None, (f'{fault.subject}: {fault.text}', fault.remedy)))}"
        if self.inspection.sound:
            until = "" if stop_of(self.inspection.found) is None else _UNTIL
            found = expected(self.inspection.found, SPEED)
            yield f"  expected at {SPEED} L/T1{until}: {found}"


def fix(path: Path, names: dict[str, str | None], inspection: Inspection, out: Path) -> Fixed:
    """Write a copy without the faults that a number fixes."""
    model, done, asked = load(path), list[Edit | Insert](), 0
    now = model
    files: tuple[Path, ...] = ()
    for _ in range(_ROUNDS):
        faults = inspection.faults
        # What a contact and a step are to be goes with EI, by orders where its unit was another.
        first = [] if done else [one for one in faults if one.subject == "EI" and one.edits]
        edits = (edit for fault in first or faults for edit in fault.edits)
        wanted = dict.fromkeys(edit.with_free_names(model) for edit in edits)
        each = (
            edit.of(model, now) if isinstance(edit, Edit) else edit
            for edit in wanted
            if isinstance(edit, Edit) or edit not in done
        )
        # What was put in has no number in the model as it was: what is left of it, is said.
        new = [one for one in each if isinstance(one, Insert) or one.numbers or one.of_all]
        if files and not {*new}.difference(done):
            break
        done += new
        asked = asked or len(done)
        files = fixed(path, model, done, out)
        now = load(out)
        try:
            inspection = Inspection(inspect_model(out, **names), inspection.stated)
        except InputError as error:
            for file in files:
                file.unlink()
            raise InputError("--write", out, "a model that can be inspected",
                             f"fix by hand what is said of it ({error})") from error  # fmt: skip
    return Fixed(files, tuple(done), tuple(done[asked:]), inspection)


@cache
def stop_of(found: MeasuredBeam) -> float | None:
    """Where the foot is as the vibrissa would leave the plane of the sweep; None if it cannot.

    That is where the object recedes (`analytic/out-of-plane.md`), unless friction holds it.
    """
    if found.planar or _friction(found):
        return None
    length, rigidity = found.length, as_intended(found)
    s = np.linspace(0, length, _STATIONS)
    pairs = list(zip(s.tolist(), smooth_rigidity(found, s).tolist(), strict=True))
    case = Case(
        Beam(
            length=length,
            flexural_rigidity=pairs if tapers(found) else rigidity,
            radius=radii(found)[0],
            natural_curvature=curvature(found, _STATIONS),
        ),
        circle(_CIRCLE * length, (0.0, HEIGHT * length)),
        clamp_stiffness=clamp_stiffness(found) * rigidity / length,
    )
    exact = solve_sweep(case)
    recedes = np.flatnonzero(exact.values("contact_angle") < 0)
    return float(exact.values("foot_x")[recedes[0] - 1]) if recedes.size else None


def _friction(found: MeasuredBeam) -> float:
    meeting = [geom for geom in found.geoms if geom.meets] or found.geoms
    return max(geom.friction for geom in meeting)


def case_of(found: MeasuredBeam, file: Path, names: dict[str, str | None]) -> str:
    """A case file: the vibrissa that the model is, past a circle."""
    length, rigidity = found.length, as_intended(found)
    radius, tip = radii(found)
    along = f"{smooth_rigidity(found, np.zeros(1))[0] if tip != radius else rigidity:.6g}"
    if not is_cone(found):
        s = np.linspace(0, length, _STATIONS)
        along = _written(zip(s.tolist(), smooth_rigidity(found, s).tolist(), strict=True))
    lines = [f"{CASE_MARK} of {file.name}", "[beam]", f"length = {length:.6g}",
             f"flexural_rigidity = {along}", f"radius = {radius:.6g}"]  # fmt: skip
    if tip != radius:
        lines.append(f"tip_radius = {tip:.6g}")
    if curved := curvature(found, _STATIONS):
        lines.append(f"natural_curvature = {_written(curved)}")
    stiffness = clamp_stiffness(found)
    if np.isfinite(stiffness):
        lines += ["[support]", f"rotational_stiffness = {stiffness * rigidity / length:.6g}"]
    friction, stop = _friction(found), stop_of(found)
    if friction:
        lines += ["[contact]", f"friction = {friction:g}"]
    lines += ["[profile]", 'kind = "circle"', f"radius = {_CIRCLE * length:.6g}",
              f"lowest = [0.0, {HEIGHT * length:.6g}]", "[sweep]", "stations = 60",
              *([] if stop is None else [f"stop = {stop:.6g}  # then it would leave its plane"]),
              "[model]", f'file = "{file.name}"']  # fmt: skip
    lines += [f'{name} = "{value}"' for name, value in names.items() if value is not None]
    lines += ["[motion]", f"speed = {SPEED}"]
    lines += ["[tolerances]", *_tolerances(found)]
    return "\n".join(lines) + "\n"


def _written(values: float | Iterable[tuple[float, float]]) -> str:
    """A number, or pairs along the vibrissa, as a case file has them."""
    if isinstance(values, float):
        return f"{values:.6g}"
    return f"[{', '.join(f'[{at:.6g}, {value:.6g}]' for at, value in values)}]"


def _tolerances(found: MeasuredBeam) -> Iterator[str]:
    most, ends = expected(found, SPEED).interval[1], [joint.s for joint in found.joints]
    links = np.diff(ends, prepend=0.0, append=found.length) / found.length
    late = Rate(SPEED * hurry(found), found.damping_ratio).lateness
    for name, limit, reason in (
        ("rms", most, "the most that inspect expects of this model"),
        ("transition", links.max() / 2, "half a link"),
        ("snap_off", _WAY * most, "rms times the way of its side on the object"),
        ("lateness", late, f"at {SPEED} L/T1 it takes time to let go, by inertia and dampers"),
    ):
        yield f'{name} = {{ limit = {limit:.2g}, reason = "{reason}" }}'
