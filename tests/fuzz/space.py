"""Random meshes passed obliquely, MuJoCo against the closed form.

``python -m tests.fuzz.space N SEED [KIND]``: bodies are written to STL, OBJ and PLY in turn, and
read again. What is to be found are silent errors: stations that are "ok" and on another branch. A
line a sweep has the rms of the worst component over the largest one of force or moment, the events
of both, what a station costs, and, as flags:

- ``silent``: a station that both call "ok" is more than 1e-2 off, not beside an event, and off by
  that from the closed form a little before and behind, too: a tip that passes an edge turns its
  force by some 1e-2 while the foot moves by what two models may be apart;
- ``lost``: such a station touches in one and is free in the other;
- ``rms``: that of all such stations exceeds 3e-3;
- ``slip-off``: more than 5e-3 L apart, or only one slips off;
- ``unsettled``: a station of MuJoCo's is "unsettled";
- ``slow``: more than 10 ms of CPU a station.
"""

import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh

from analytic import InputError
from analytic.space import FootPath, SpatialCase, SpatialReadings, convex_mesh, solve_space
from analytic.space.problem.readings import FORCE, MOMENT
from mujoco_models import SpatialSettings, simulate_space

KINDS = ("ball", "egg", "hull", "capsule", "box")
FLAGS = ("silent", "lost", "rms", "slip-off", "unsettled", "slow")
_SUFFIXES = ("stl", "obj", "ply")
_OFF = 1e-2  # of the largest component: segments, softness and single facets explain a few 1e-4
_RMS = 3e-3
_SLIPPED = 5e-3  # L
_BESIDE = 2e-3  # L of the way; so near to an event the two may be on either side of it
_PASSING = 1e-4  # L of the way, that both models may be apart in passing an edge (observed: 6e-5)
_SLOW = 10.0  # ms a station


@dataclass(frozen=True)
class Outcome:
    """What came of a sweep."""

    rms: float
    milliseconds: float
    flags: tuple[str, ...]
    statuses: dict[str, int]
    wrong: int
    """Stations that both call "ok" and that are far apart."""


def body(kind: str, draw: np.random.Generator) -> trimesh.Trimesh:
    """A body about the origin, turned at random, of a size next to that of the vibrissa."""
    size = float(draw.uniform(0.3, 1.0))
    if kind == "ball":
        mesh = trimesh.creation.icosphere(3, size)
    elif kind == "egg":
        mesh = trimesh.creation.icosphere(3, size)
        mesh.apply_scale([1, 0.7, 1.6])
    elif kind == "hull":
        points = draw.normal(size=(int(draw.integers(20, 200)), 3))
        far = size * draw.uniform(0.8, 1.0, (len(points), 1))
        points *= far / np.linalg.norm(points, axis=1, keepdims=True)
        mesh = trimesh.convex.convex_hull(points)
    elif kind == "capsule":
        mesh = trimesh.creation.capsule(height=size, radius=0.4 * size, count=[16, 16])
        mesh.apply_translation([0, 0, -size / 2])
    else:
        mesh = trimesh.creation.box(extents=size * draw.uniform(0.5, 1.5, 3))
    turn, _ = np.linalg.qr(draw.normal(size=(3, 3)))
    transform = np.eye(4)
    transform[:3, :3] = turn * np.sign(np.linalg.det(turn))
    mesh.apply_transform(transform)
    return mesh


def oblique(draw: np.random.Generator, wide: float, stations: int) -> FootPath:
    """A way under a body in any direction, beside its middle, of a clamp that leans."""
    angle, aside = draw.uniform(0, 2 * np.pi), draw.uniform(-0.6, 0.6) * wide
    along = np.array([np.cos(angle), np.sin(angle)])
    middle = aside * np.array([-along[1], along[0]])
    points = [middle - (wide + 0.4) * along, middle + (wide + 0.6) * along]
    lean = draw.uniform(-0.2, 0.2, 2)
    return FootPath(points, tangent=(lean[0], 1.0, lean[1]), stations=stations)


def trial(seed: int, folder: Path, kind: str | None = None, stations: int = 60) -> SpatialCase:
    """The case of this seed; its mesh is written into `folder`."""
    draw = np.random.default_rng(seed)
    kind = kind or KINDS[seed % len(KINDS)]
    while True:
        mesh = body(kind, draw)
        low, high = mesh.bounds
        mesh.apply_translation([0, float(draw.uniform(0.3, 0.8)) - low[1], 0])
        wide = float(max(-low[0], high[0], -low[2], high[2]))
        path = oblique(draw, wide, stations)
        file = folder / f"{kind}-{seed}.{_SUFFIXES[seed % 3]}"
        mesh.export(file)
        try:
            return SpatialCase(body=convex_mesh(file), path=path, name=file.stem)
        except InputError:  # out of reach, or in the way of the clamp
            continue


def events(readings: SpatialReadings, *kinds: str) -> np.ndarray:
    """Where along the way they happen."""
    found = [e["travel"] for e in readings.provenance["events"] if not kinds or e["kind"] in kinds]
    return np.array(found, dtype=float)


def judge(
    case: SpatialCase, exact: SpatialReadings, found: SpatialReadings, seconds: float
) -> Outcome:
    """Compare station by station, where both say "ok"."""
    travel = exact.values("travel")
    near = np.concatenate([events(exact), events(found)])
    clear = np.ones(len(travel), dtype=bool)
    if near.size:
        clear = np.abs(travel[:, None] - near).min(axis=1) > _BESIDE
    both = exact.trusted & found.trusted & clear
    off = np.zeros(len(travel))
    rms = 0.0
    touching = both & (exact.touching | found.touching)
    for names in (FORCE, MOMENT):
        one, other = exact.values(*names), found.values(*names)
        scale = np.nanmax(np.abs(one)) or 1.0  # a way may pass beside the body
        error = np.abs(other - one) / scale
        off = np.fmax(off, np.where(both, error.max(axis=1), 0.0))
        if touching.any():
            rms = max(rms, float(np.sqrt((error[touching] ** 2).mean(axis=0)).max()))
    wrong = off > _OFF
    if wrong.any():
        wrong &= _beyond(case, exact, found) > _OFF
    lost = both & (exact.touching != found.touching)
    slips = [events(r, "slip-off") for r in (exact, found)]
    apart = len(slips[0]) != len(slips[1]) or bool(
        (np.abs(np.sort(slips[0]) - np.sort(slips[1])) > _SLIPPED).any()
    )
    statuses = dict(Counter(found.table["status"]))
    milliseconds = 1e3 * seconds / len(travel)
    raised = (
        (wrong & ~lost).any(),
        lost.any(),
        rms > _RMS,
        apart,
        "unsettled" in statuses,
        milliseconds > _SLOW,
    )
    flags = tuple(name for name, up in zip(FLAGS, raised, strict=True) if up)
    return Outcome(rms, milliseconds, flags, statuses, int(wrong.sum()))


def _beyond(case: SpatialCase, exact: SpatialReadings, found: SpatialReadings) -> np.ndarray:
    """How far found ones are off all that the closed form has next to each station."""
    along = np.diff(case.path.points, axis=0)[0]
    step = _PASSING * case.beam.length * along / np.linalg.norm(along)
    shifted = [case.path.points + sign * step for sign in (-1, 1)]
    paths = [replace(case.path, points=points) for points in shifted]
    every = [exact, *(solve_space(replace(case, path=path)) for path in paths)]
    off = np.zeros(len(exact.table))
    for names in (FORCE, MOMENT):
        near, other = np.array([one.values(*names) for one in every]), found.values(*names)
        error = np.fmax(other - near.max(axis=0), near.min(axis=0) - other)
        off = np.fmax(off, error.max(axis=1) / np.nanmax(np.abs(near)))
    return off


def main(count: int, seed: int, kind: str | None = None, segments: int = 40) -> list[Outcome]:
    """Run that many sweeps; prints a line each."""
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(seed, seed + count):
            case = trial(number, Path(folder), kind)
            exact = solve_space(case)
            begun = time.process_time()
            found = simulate_space(case, SpatialSettings(segments=segments))
            outcome = judge(case, exact, found, time.process_time() - begun)
            outcomes.append(outcome)
            print(
                f"{case.name}: rms {outcome.rms:.1e}, {outcome.milliseconds:5.1f} ms, "
                f"{_said(exact)} | {_said(found)}; {outcome.statuses} {' '.join(outcome.flags)}",
                flush=True,
            )
    print({flag: sum(flag in o.flags for o in outcomes) for flag in FLAGS}, "of", len(outcomes))
    print(f"wrong and ok: {sum(o.wrong for o in outcomes)} stations")
    print(f"largest rms {max(o.rms for o in outcomes):.1e}")
    print(f"median {np.median([o.milliseconds for o in outcomes]):.1f} ms a station")
    print(dict(sum((Counter(o.statuses) for o in outcomes), Counter())))
    return outcomes


def _said(readings: SpatialReadings) -> str:
    """Its events but those that are on every way."""
    left = (f"{x} {at:.4f}" for x in ("slip-off", "release") for at in events(readings, x))
    return f"{len(events(readings, 'hop'))} hops {' '.join(left)}"


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *sys.argv[3:4])
