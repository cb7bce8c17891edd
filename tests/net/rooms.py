"""The items of the net, by room: what is swept, and what is stored of it."""

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from typing import Any

import analytic as plane
import compare
import engines
import mujoco_models as mujoco
from analytic import space

from . import commands
from .problems import BODIES, CONTOURS, MESHES, VIBRISSAE, Draw, planar, spatial

METHODS = (
    *("binary", "kaneko", "kim-moeller", "birdwell", "birdwell-cone", "beam-column"),
    *("scholz-rahn", "clements-rahn", "quist-hartmann", "quist-hartmann-half-cell"),
    *("elastica", "decision"),
)
MODELS = ("cable", "mistakes", "rod", "sound-chain", "sound-rod", "tapered-whisker")
CHANGES: dict[str, Callable[[Any], Any]] = {
    "gain": lambda t: t.assign(force_y=1.04 * t["force_y"]),
    "zero": lambda t: t.assign(moment_z=t["moment_z"] + 0.2),
    "sign": lambda t: t.assign(force_x=-t["force_x"]),
    "swapped": lambda t: t.rename(columns={"force_x": "force_y", "force_y": "force_x"}),
    "displaced": lambda t: t.assign(foot_x=t["foot_x"] + 0.01),
    "reversed": lambda t: t.iloc[::-1],
    "missing": lambda t: t.drop(index=range(20, 30)),
    "dropouts": lambda t: t.assign(force_y=t["force_y"].where(t.index % 9 > 0, 0.0)),
    "clipped": lambda t: t.assign(moment_z=t["moment_z"].clip(-3, 3)),
}


def named(name: str, stations: int = 60) -> plane.Case:
    return replace(plane.named_case(name), sweep=plane.Sweep(stations))


def exact(case: plane.Case) -> dict[str, Any]:
    clamp = {"clamp_stiffness": case.clamp_stiffness, "friction": case.friction}
    events = vars(plane.find_events(case.profile, case.beam, **clamp))
    found = {name: event and asdict(event) for name, event in events.items()}
    return {"sweep": plane.solve_sweep(case), "events": found}


def many(shape: str, kinds: tuple[str, ...], draw: Draw) -> list[Any]:
    return [*plane.solve_sweeps([planar(shape, kind, 30, draw) for kind in kinds * 3])]


def exact_space(case: space.SpatialCase) -> dict[str, Any]:
    sweep = space.solve_space(case)
    found = space.reconstruct_space(sweep)
    return {"sweep": sweep, "contacts": found, "rod_residuals": space.rod_residuals(sweep)}


def rest(case: plane.Case, segments: int = 20, **settings: Any) -> plane.Readings:
    return mujoco.simulate_sweep(case, mujoco.Settings(segments=segments, **settings))


def rest_in_space(case: space.SpatialCase, segments: int = 10, **settings: Any) -> Any:
    return mujoco.simulate_space(case, mujoco.SpatialSettings(segments=segments, **settings))


def moved(case: plane.Case, beam: Any = "chain", obstacle: Any = "mesh", **motion: Any) -> Any:
    settings = mujoco.Settings(beam, segments=10, obstacle=obstacle)
    return mujoco.simulate_motion(case, mujoco.Motion(**({"speed": 0.2} | motion)), settings)


def there_and_back(case: plane.Case) -> Any:
    settings = mujoco.Settings(segments=10)
    return mujoco.simulate_there_and_back(case, mujoco.Motion(speed=0.3), settings)


def inspected(model: str) -> dict[str, Any]:
    return mujoco.inspect_model(mujoco.shipped_models()[model]).to_dict()


def own(model: str, contact: Any = "own") -> plane.Readings:
    beam = plane.Beam(0.1, 6.44e-4, 0.00025)
    case = plane.Case(beam, plane.circle(0.08, lowest=(0.0, 0.04)), plane.Sweep(30))
    given = mujoco.OwnModel(mujoco.shipped_models()[model], contact=contact)
    return mujoco.simulate_model(case, given, mujoco.Motion(speed=0.3))


def by_engine(name: str, case: plane.Case) -> plane.Readings:
    settings = mujoco.Settings(segments=10, obstacle="primitive")
    return engines.find_engine(name).sweep(case, settings)


def noisy(case: plane.Case, level: float, draw: Draw) -> plane.Readings:
    """What a rig reads, which knows neither phase nor contact."""
    clean = plane.solve_sweep(case)
    table = {
        name: clean.values(name) + size * draw.standard_normal(len(clean.table))
        for name, size in plane.relative_noise(clean, level).items()
    }
    return plane.Readings.of({"foot_x": clean.values("foot_x"), **table}, beam=clean.beam)


def calibrated(rig: plane.Readings, unknowns: str) -> dict[str, Any]:
    noise = plane.relative_noise(rig, 0.01)
    found = plane.calibrate(rig, named("catenary"), unknowns.split(), noise)
    estimates = {name: asdict(one) for name, one in found.found.items()}
    return {"found": estimates, "correlation": found.correlation, "misfit": found.misfit}


def by_rig(rig: plane.Readings, what: Callable[..., Any]) -> dict[str, Any]:
    return {k: v for k, v in vars(what(rig)).items() if k != "readings"}


def shapes(readings: plane.Readings) -> list[Any]:
    x, y = plane.deflected_shapes(readings)
    return [x, y, plane.curvatures(readings, x, y), plane.sideways_stiffness(readings)]


def compared(reference: Any, candidate: Any, **given: Any) -> dict[str, Any]:
    found: Any = compare.compare(reference, candidate, **given)
    return {"comparison": found.to_dict(), "worst": found.worst and found.worst.clause}


def compared_models(case: Any, **given: Any) -> dict[str, Any]:
    if isinstance(case, space.SpatialCase):
        return compared(space.solve_space(case), rest_in_space(case), **given)
    return compared(plane.solve_sweep(case), rest(case), **given)


def compared_table(case: plane.Case, rig: plane.Readings, change: str, **given: Any) -> Any:
    changed = replace(rig, table=CHANGES[change](rig.table.copy()), source="mine")
    return compared(plane.solve_sweep(case), changed, **given)


def compared_in_units(case: plane.Case) -> dict[str, Any]:
    """With a rig's file in millimetres and millinewtons."""
    clean = plane.solve_sweep(replace(case, beam=replace(case.beam, si=True)))
    units = {"foot_x": "mm", "force_x": "mN", "force_y": "mN", "moment_z": "mN m"}
    columns = [f"{name}={name}:{unit}" for name, unit in units.items()]
    return compared(clean, compare.read_measured(1e3 * clean.table[[*units]], clean.beam, columns))


def validated(case: plane.Case, rig: plane.Readings) -> dict[str, Any]:
    inputs = {"length": compare.Input(1e-3), "friction": compare.Input(0.01, "uniform")}
    stated = compare.Uncertainties(inputs, noise=plane.relative_noise(rig, 0.003))
    found = compare.compare(plane.solve_sweep(case), rig).validated(case, stated).validation
    return found.to_dict() if found else {}


class Items(dict[str, Callable[[Draw], Any]]):
    """By ``ROOM/NAME``; an argument that is a partial function is called with random numbers."""

    def put(self, key: str, what: Callable[..., Any], *given: Any, **named: Any) -> None:
        def do(draw: Draw) -> Any:
            return what(*(g(draw) if isinstance(g, partial) else g for g in given), **named)

        assert key not in self
        self[key] = do


ITEMS = Items()
put = ITEMS.put
for key, text, options in commands.BUDGETS:
    put(f"budget/{key}", commands.split, text, *options)
for key, text in commands.STUDIES:
    put(f"study/{key}", commands.study, text)

for name, n in zip(plane.CASE_NAMES, (40, 20, 80, 10, 40), strict=True):
    put(f"plane/{name}", exact, plane.named_case(name))
    put(f"plane/certified-{name}", plane.solve_sweep, named(name), certified=True)
    put(f"mujoco/{name}", rest, named(name, 100), n)
    put(f"mujoco/rod-{name}", rest, named(name, 30), 10, beam="rod")
    put(f"mujoco/primitive-{name}", rest, named(name, 30), obstacle="primitive")
    put(f"compare/{name}", compared_models, named(name))
for shape, count in {**dict.fromkeys((*CONTOURS, *MESHES), 2), "polygon": 8}.items():
    for k in range(count):
        put(f"plane/{shape}-{k}", exact, partial(planar, shape, "plain", 60))
    for k in range(count // 2):
        put(f"mujoco/{shape}-{k}", rest, partial(planar, shape, "in-units", 40), 10 * (k + 1))
for shape in ("circle", "polygon", "box"):
    put(f"plane/in-units-{shape}", exact, partial(planar, shape, "in-units", 60))
    put(f"motion/{shape}", moved, partial(planar, shape, "in-units", 30))
for shape in CONTOURS:
    put(f"plane/many-{shape}", list, partial(many, shape, ("plain", "in-units")))
put("plane/tilted", lambda: [plane.slip_off(named("parabola").profile, t) for t in (0.05, 0.2)])
put("plane/contacts", plane.solve_contact, named("catenary").profile, [-0.9, -0.2, 0.1, 0.7])

for name in plane.REAL_CASE_NAMES:
    put(f"general/{name}", exact, named(name))
    put(f"from-clamp/{name}", lambda name: plane.reconstruct(plane.solve_sweep(named(name))), name)
for kind in VIBRISSAE:
    for shape in ("circle", "catenary", "polygon"):
        put(f"general/{kind}-{shape}", exact, partial(planar, shape, kind, 40))
    put(f"mujoco/{kind}", rest, partial(planar, "parabola", kind, 40))
put("general/many", list, partial(many, "ellipse", VIBRISSAE[:4]))
put("general/back", plane.turn_back, named("rubbing"), turn_at=0.2)
put("general/stiction", plane.stiction_limits, named("rubbing"))

put("mujoco/by-spatial", rest, named("parabola", 30), 10, planar=False)
put("mujoco/by-naive", rest, named("parabola", 30), 10, clamp="naive")
put("mujoco/by-soft", rest, named("parabola", 30), 10, contact_stiffness=1e5)
put("mujoco/tip", lambda: [mujoco.load_tip(p, mujoco.Settings(segments=20)) for p in (0.1, 5.0)])

for kind in BODIES:
    put(f"mujoco-space/{kind}", rest_in_space, partial(spatial, kind, 30))
    for k in range(2):
        put(f"space/{kind}-{k}", exact_space, partial(spatial, kind, 40))
put("mujoco-space/universal", rest_in_space, partial(spatial, "box", 20), joints="universal")
rods = {"beam": "rod", "joints": "universal"}
put("mujoco-space/rod", rest_in_space, partial(spatial, "sphere", 20), **rods)
put("mujoco-space/40", rest_in_space, partial(spatial, "cylinder", 20), 40)

put("motion/plain", moved, named("catenary", 30))
put("motion/raw", moved, named("catenary", 30), average=0.0, cutoff=20.0, damping_ratio=0.2)
put("motion/explicit", moved, named("catenary", 30), integrator="implicitfast", armature=1.0)
put("motion/solref", moved, named("catenary", 20), solref=(0.1, 1.0), solver="cg")
slow = {"timestep": 0.002, "contact_stiffness": 1e3, "speed": 0.5}
put("motion/rubbing", moved, named("rubbing", 20), cone="elliptic", **slow)
put("motion/primitive", moved, named("parabola", 30), obstacle="primitive")
put("motion/rod", moved, named("parabola", 20), beam="rod")
put("motion/back", there_and_back, named("parabola", 20))

for name in (*MODELS, "tutorial-chain"):
    put(f"own/inspect-{name}", inspected, name)
    put(f"own/swept-{name}", own, name)
put("own/ours", own, "tutorial-chain", contact="ours")
for name in ("mujoco", "drake", "exudyn", "unknown"):
    for case in ("catenary", "tip-only"):
        put(f"engines/{name}-{case}", by_engine, name, named(case, 30))

for method in METHODS:
    for case, level in (("catenary", 0.0), ("parabola", 0.01)):
        rig = partial(noisy, named(case), level)
        put(f"from-clamp/{method}-{case}", plane.reconstruct, rig, method=method)
rig = partial(noisy, named("parabola"), 0.003)
stated = dict.fromkeys(plane.CLAMP_READINGS, 0.02)
put("from-clamp/uncertain", plane.reconstruct, rig, noise=stated, seed=3)
put("from-clamp/by-decision", plane.reconstruct_by_decision, partial(noisy, named("catenary"), 0.0))
put("from-clamp/shapes", lambda: shapes(plane.solve_sweep(named("catenary", 20))))
put("from-clamp/phases", by_rig, rig, compare.classify)
for name, unknowns in {
    "soft-support": "clamp_stiffness flexural_rigidity",
    "catenary": "offset flexural_rigidity",
    "rubbing": "friction",
    "pre-curved": "natural_curvature",
}.items():
    put(f"from-clamp/calibrate-{name}", calibrated, partial(noisy, named(name), 0.01), unknowns)
for level in (0.0, 0.01):
    rig = partial(noisy, named("rubbing", 100), level)
    put(f"from-clamp/friction-{level}", by_rig, rig, plane.estimate_friction)

clean = named("catenary", 100)
for change in CHANGES:
    rig = partial(noisy, clean, 0.01)
    put(f"compare/{change}", compared_table, clean, rig, change, noise="auto")
rig = partial(noisy, clean, 1e-3)
put("compare/offset", compared_table, clean, rig, "displaced", offset="auto", noise=1e-3)
put("compare/units", compared_in_units, partial(planar, "circle", "in-units", 80))
put("compare/motion", lambda: compared(plane.solve_sweep(clean), moved(named("catenary", 30))))
put("compare/validated", validated, clean, partial(noisy, clean, 0.003))
for kind in ("sphere", "prism", *MESHES):
    put(f"compare/space-{kind}", compared_models, partial(spatial, kind, 30))
put("compare/space-clamp", compared_models, partial(spatial, "ellipsoid", 30), frame="clamp")
put("compare/space-noise", compared_models, partial(spatial, "ellipsoid", 30), noise=0.01)
