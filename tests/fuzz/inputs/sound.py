"""Files that are right, to be spoilt."""

import tempfile
from functools import cache
from pathlib import Path

from analytic import Sweep, named_case, solve_sweep
from analytic.problem.case import Case
from compare import compare
from compare.show.report import write_report
from compare.study import Plan, load_study
from compare.study.keep.store import Store
from compare.study.work.perform import perform

STATIONS = 40
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
SUFFIXES = ("stl", "obj", "ply", "off", "glb")


@cache
def sweep_table():
    case = named_case("parabola")
    table = solve_sweep(Case(case.beam, case.profile, Sweep(stations=STATIONS))).table
    return table[["foot_x", "force_x", "force_y", "moment_z"]]


@cache
def good_csv() -> bytes:
    return sweep_table().to_csv(index=False).encode()


@cache
def body(shape: str = "ball", suffix: str = "stl") -> bytes:
    """A solid as a file of that kind."""
    from trimesh import creation

    made = {
        "ball": lambda: creation.icosphere(subdivisions=2),
        "block": lambda: creation.box((1, 2, 3)),
        "cylinder": lambda: creation.cylinder(radius=0.7, height=2, sections=24),
        "ring": lambda: creation.torus(1, 0.3, major_sections=12, minor_sections=8),
        "spot": lambda: creation.icosphere(subdivisions=1, radius=1e-12),
    }[shape]()
    if shape == "cylinder":
        made.faces = made.faces[:-3]  # open
    content = made.export(file_type=suffix)
    return content.encode() if isinstance(content, str) else bytes(content)


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
        sweep = solve_sweep(Case(sweep=Sweep(stations=STATIONS)))
        (place / "runs/one").mkdir(parents=True)
        for name in ("analytic", "mujoco-chain"):
            sweep.write(place / f"runs/one/{name}.parquet")
        sweep.write(place / "runs/one/written.csv")
        write_report(compare(sweep, sweep), place / "runs/one")
        plan = Plan.of(load_study(str(place / "small/study.toml")))
        with Store(place / "small", plan, print) as store:
            for run in plan:
                store.add(perform(plan.study.recipe, run))
        return tuple(
            (str(path.relative_to(place)), path.read_bytes())
            for path in sorted(place.rglob("*"))
            if path.is_file() and path.suffix not in (".png", ".html")
        )
