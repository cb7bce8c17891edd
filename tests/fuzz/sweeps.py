"""Random MuJoCo sweeps against the closed form: ``python -m tests.fuzz.sweeps N [SEED [KIND]]``.

What is to be found are silent errors: stations that are "ok" and wrong. A line a sweep says how far
off the stations are that are "ok", how many are not, what a station costs, and, as flags:

- ``silent``: the stations that are "ok" disagree by more than ten times what segments, facets,
  beads and softness explain;
- ``lost``: a station is "ok" and free where the closed form touches, well before its snap-off;
- ``unsettled``: more than one station in a hundred is not "ok";
- ``slow``: more than 100 ms of CPU a station;
- ``snap-off``: both snap off, more than ten times that error apart, or only one does.

Without a seed it takes a new one, from the clock. The exit code is 1 if a sweep failed, or more
than one in 200 is silently wrong.
"""

import re
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh
from rich.console import Console
from rich.table import Table

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Contour,
    InputError,
    Readings,
    Sweep,
    catenary,
    circle,
    ellipse,
    mesh_section,
    parabola,
    polygon,
    solve_sweep,
)
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.beams.layout import OF_CURVATURE, bead_spacing
from mujoco_models.obstacles.kinds import place
from tests.fuzz.contours import from_support, log_uniform

USUAL = ("round", "needle", "small", "smooth", "polygon", "mesh")
KINDS = (*USUAL, "mixed")
CORNERED = ("polygon", "mixed", "mesh")
_TIMES = 10.0  # an error that is more times what is expected is silent
_SLOW = 100.0  # ms a station
_EDGE = 0.02  # L; so near to a snap-off, phases may differ
_BESIDE = 1e-3  # L; so near to a jump from facet to facet, a sweep may be before or after it
_JUMP = 0.05  # rad


@dataclass(frozen=True)
class Trial:
    """One random sweep."""

    kind: str
    case: Case
    settings: Settings

    @property
    def label(self) -> str:
        s = self.settings
        return (
            f"{self.case.profile.label}; r {self.case.beam.radius:.3g}, {s.beam} {s.segments}, "
            f"{s.contour_points} points, k {s.contact_stiffness:.1e}, "
            f"{self.case.sweep.stations} stations"
        )


@dataclass(frozen=True)
class Outcome:
    """What came of it."""

    rms: float
    expected: float
    ok: float
    milliseconds: float
    flags: tuple[str, ...]


def trial(
    seed: int, folder: Path, kind: str | None = None, wide: bool = False, skip: int = 0
) -> Trial:
    """The trial of this seed; a mesh's file is put into `folder`.

    A wide one may have three stations, five segments and an object next to the clamp. So many
    numbers of the seed are skipped.
    """
    draw = np.random.default_rng(seed)
    draw.bit_generator.advance(skip)
    while True:
        chosen = kind or str(draw.choice(KINDS if wide else USUAL))
        try:
            return _drawn(chosen, draw, folder / f"{seed}.stl", wide)
        except (InputError, ValueError):  # out of reach, under the foot, nothing cut
            continue


def _drawn(kind: str, draw: np.random.Generator, file: Path, wide: bool) -> Trial:
    height = float(draw.uniform(0.03 if wide else 0.15, 0.85))
    profile = {
        "round": _round, "needle": _needle, "small": _small,
        "smooth": _smooth, "polygon": _polygon, "mixed": _mixed,
        "mesh": lambda d, h: _mesh(d, h, file),
    }[kind](draw, height)  # fmt: skip
    beam = Beam(radius=log_uniform(draw, 0.001, 0.012))
    settings = Settings(
        beam=str(draw.choice(available_beams())),  # type: ignore[arg-type]
        segments=int(log_uniform(draw, 5, 120)) if wide else int(draw.integers(10, 121)),
        contour_points=int(log_uniform(draw, 100, 5000)),
        contact_stiffness=log_uniform(draw, 1e4, 5e7),
    )
    stations = int(log_uniform(draw, 3, 200)) if wide else int(draw.choice([12, 30, 60, 120]))
    return Trial(kind, Case(beam=beam, profile=profile, sweep=Sweep(stations)), settings)


def _round(draw: np.random.Generator, height: float) -> Contour:
    across, upward = np.exp(draw.uniform(np.log(0.1), np.log(3), size=2))
    return ellipse((float(across), float(upward)), (0.0, height))


def _needle(draw: np.random.Generator, height: float) -> Contour:
    thin, long = float(draw.uniform(0.05, 0.3)), float(draw.uniform(3, 13))
    return ellipse((thin, long) if draw.random() < 0.7 else (long, thin), (0.0, height))


def _small(draw: np.random.Generator, height: float) -> Contour:
    return circle(log_uniform(draw, 0.002, 0.1), (0.0, height))


def _smooth(draw: np.random.Generator, height: float) -> Contour:
    kind, a = int(draw.integers(3)), log_uniform(draw, 0.2, 3)
    if kind == 0:
        return catenary(a, height - 1)
    if kind == 1:
        return parabola(a, height)
    # Support function p = 1 + e cos(n (alpha - f)), convex while e < 1/(n^2 - 1).
    n, f, size = int(draw.integers(2, 6)), float(draw.uniform(0, 6.28)), float(draw.uniform(0.1, 1))
    e = 0.8 * float(draw.random()) / (n**2 - 1)

    return from_support(
        lambda alpha: size * (1 + e * np.cos(n * (alpha - f))),
        lambda alpha: -size * e * n * np.sin(n * (alpha - f)),
        None,
        (-np.pi / 2, np.pi / 2),
        f"support n={n} e={e:.3g}",
    )(height)


def _polygon(draw: np.random.Generator, height: float) -> Contour:
    corners = round(log_uniform(draw, 3, 200))
    angles = np.sort(draw.uniform(0, 2 * np.pi, corners)) if draw.random() < 0.5 else (
        2 * np.pi * np.arange(corners) / corners + draw.uniform(0, 6.28)
    )  # fmt: skip
    size = np.exp(draw.uniform(np.log(0.1), np.log(1.5), size=2))
    points = size * np.column_stack([np.cos(angles), np.sin(angles)])
    points[:, 1] += height - points[:, 1].min()
    return polygon(points, f"{corners}-gon")


def _mixed(draw: np.random.Generator, height: float) -> Contour:
    """Sharp corners, and between them sides that are straight or bowed, a little or more."""
    corners, size = int(draw.integers(3, 7)), np.exp(draw.uniform(np.log(0.2), np.log(2), size=2))
    angles = 2 * np.pi * (np.arange(corners) + 0.4 * draw.random(corners)) / corners
    ends = size * np.column_stack([np.cos(angles), np.sin(angles)])
    sides = []
    for here, there in zip(ends, np.roll(ends, -1, axis=0), strict=True):
        along = np.sort(draw.random(int(draw.integers(0, 12))))[:, None]
        bow = 0.0 if draw.random() < 0.3 else log_uniform(draw, 1e-7, 0.1)
        outward = np.array([there[1] - here[1], here[0] - there[0]])
        sides.append(here + along * (there - here) + bow * along * (1 - along) * outward)
    points = np.concatenate([x for pair in zip(ends[:, None], sides, strict=True) for x in pair])
    turn = draw.uniform(0, 6.28)
    points = points @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    points[:, 1] += height - points[:, 1].min()
    return polygon(points, f"mixed {len(points)}-gon")


def _mesh(draw: np.random.Generator, height: float, file: Path) -> Contour:
    size = log_uniform(draw, 0.15, 1.2)
    kind = int(draw.integers(5))
    body = (
        trimesh.creation.box(extents=[size, size, 1]),
        trimesh.creation.cylinder(radius=size, height=1, sections=int(draw.integers(6, 500))),
        trimesh.creation.icosphere(subdivisions=int(draw.integers(1, 5)), radius=size),
        trimesh.convex.convex_hull(size * draw.normal(size=(int(draw.integers(8, 300)), 3))),
        trimesh.creation.cone(radius=size, height=1.0, sections=64),
    )[kind]
    if draw.random() < 0.4:
        turn = trimesh.transformations.rotation_matrix(draw.uniform(0, 0.8), draw.normal(size=3))
        body.apply_transform(turn)
    body.export(file)
    section = body.section(plane_origin=[0, 0, 0.05], plane_normal=[0, 0, 1])
    if section is None:
        raise ValueError("nothing cut")
    return mesh_section(
        file, offset=(0.0, height - float(section.vertices[:, 1].min())), height=0.05
    )


def judge(made: Trial, reference: Readings, found: Readings, seconds: float) -> Outcome:
    """Compare station by station, where both say "ok"."""
    table, exact = found.table, reference.table
    ok = (table["status"] == "ok").to_numpy()
    both = ok & (exact["status"] == "ok").to_numpy()
    x, snap = found.values("foot_x"), (reference.snap_off, found.snap_off)
    away = np.ones(len(x), dtype=bool)
    for where in snap:
        if where is not None:
            away &= np.abs(x - where) > _EDGE
    if made.kind in CORNERED:
        away &= ~beside_a_jump(made.case, x)
    beam, angle = explained(made, found.provenance["obstacle"], exact["force_y"].abs().max())
    force = float(np.hypot(exact["force_x"], exact["force_y"]).max())
    rms, expected = 0.0, beam + angle
    for name in CLAMP_READINGS:
        scale = np.abs(exact[name]).max()
        error = (table[name] - exact[name]).to_numpy()[both & away]
        if scale > 0 and error.size:
            off = float(np.sqrt(np.mean(error**2)) / scale)
            due = beam + angle * max(1.0, force / scale)  # one component may be next to nothing
            if off / due > rms / expected:
                rms, expected = off, due
    touches = (exact["phase"] != "free").to_numpy()
    free = (table["phase"] == "free").to_numpy()
    flags = []
    if rms > _TIMES * expected:
        flags.append("silent")
    if (both & away & touches & free).any():
        flags.append("lost")
    if (~ok).mean() > 0.01:
        flags.append("unsettled")
    if 1e3 * seconds / len(table) > _SLOW:
        flags.append("slow")
    passed = [where is not None for where in snap]
    if passed[0] != passed[1] or (
        all(passed) and abs(snap[0] - snap[1]) > max(_TIMES * expected, 1e-3)
    ):
        flags.append("snap-off")
    return Outcome(rms, expected, float(ok.mean()), 1e3 * seconds / len(table), tuple(flags))


def beside_a_jump(case: Case, x: np.ndarray) -> np.ndarray:
    """At which of the stations the contact of the exact sweep jumps to another facet."""
    angles = []
    for shift in (-_BESIDE, _BESIDE):
        shifted = Sweep(len(x), float(x[0]) + shift, float(x[-1]) + shift)
        angles.append(solve_sweep(replace(case, sweep=shifted)).values("contact_angle"))
    return np.abs(angles[1] - angles[0]) > _JUMP


def explained(made: Trial, obstacle: str, force: float) -> tuple[float, float]:
    """What the numerics explain, roughly: of a reading, and of the force's direction [rad].

    Segments and softness; facets, and beads that are a little beside the point of tangency.
    """
    settings, case = made.settings, made.case
    beam = 3 / settings.segments**2 + force / settings.contact_stiffness / case.beam.radius / 10
    if made.kind in CORNERED:  # where a joint's sphere still holds a corner a little
        return beam, 1e-3
    normal, chord = (
        float(found[1]) if (found := re.search(f"{name} error ([^ ]+) ", obstacle)) else 0.0
        for name in ("normal", "chord")
    )
    height = float(case.profile.at(case.profile.parameter(np.array([0.0]))).eta[0])
    curvature = place(case, settings).largest_curvature
    spacing = bead_spacing(settings.segments, case.radius, curvature)
    lean = min(curvature / (1 + curvature * case.radius) * spacing, OF_CURVATURE) / 2
    return beam + 3 * chord / height, normal + lean


def main(count: int, seed: int, kind: str | None = None) -> list[tuple[Trial, Outcome | str]]:
    """Run that many trials; prints a line for each that is not as it should be, and a summary."""
    console, results = Console(width=190), []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(seed, seed + count):
            made = trial(number, Path(folder), kind, wide=True)
            begun = time.process_time()
            outcome: Outcome | str
            try:
                found = simulate_sweep(made.case, made.settings)
                seconds = time.process_time() - begun
                outcome = judge(made, solve_sweep(made.case), found, seconds)
                said = (
                    f"rms {outcome.rms:.1e} ({outcome.expected:.1e}), ok {outcome.ok:5.1%}, "
                    f"{outcome.milliseconds:6.1f} ms, {' '.join(outcome.flags)}"
                )
            except InputError as error:
                outcome = said = f"refused: {error}"
            except Exception as error:  # whatever it is, it is what is looked for
                outcome = said = f"FAILED: {type(error).__name__}: {error}"
            results.append((made, outcome))
            if isinstance(outcome, str) or outcome.flags:
                line = f"{number} {made.kind}: {said}  [{made.label}]"
                console.print(line, markup=False, highlight=False)
    _summary(console, results)
    return results


def _summary(console: Console, results: list[tuple[Trial, Outcome | str]]) -> None:
    table = Table("", "count", title=f"{len(results)} sweeps")
    done = [o for _, o in results if isinstance(o, Outcome)]
    for flag in ("silent", "lost", "unsettled", "slow", "snap-off"):
        table.add_row(flag, str(sum(flag in o.flags for o in done)))
    said = [o for _, o in results if isinstance(o, str)]
    table.add_row("refused", str(sum(s.startswith("refused") for s in said)))
    table.add_row("failed", str(sum(s.startswith("FAILED") for s in said)))
    if done:
        shares = [o.rms / o.expected for o in done]
        table.add_row("median rms / explained", f"{np.median(shares):.2f}")
        table.add_row("largest rms / explained", f"{max(shares):.2f}")
        table.add_row("stations ok", f"{np.mean([o.ok for o in done]):.2%}")
        table.add_row("median ms a station", f"{np.median([o.milliseconds for o in done]):.1f}")
    console.print(table)


def bad(results: list[tuple[Trial, Outcome | str]]) -> bool:
    """Whether a sweep failed, or more than one in 200 is silently wrong."""
    silent = sum(isinstance(o, Outcome) and "silent" in o.flags for _, o in results)
    return silent > len(results) / 200 or any(str(o).startswith("FAILED") for _, o in results)


if __name__ == "__main__":
    chosen = int(sys.argv[2]) if len(sys.argv) > 2 else int(time.time())
    print(f"seeds from {chosen}")
    sys.exit(bad(main(int(sys.argv[1]), chosen, *sys.argv[3:4])))
