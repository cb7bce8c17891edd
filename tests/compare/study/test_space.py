"""Studies of sweeps in space: their axes, their numbers, their mistakes, and their report."""

import re

import numpy as np
import pytest
import trimesh

from analytic import Beam, InputError
from analytic.space import FootPath, SpatialCase, reconstruct_space, solve_space, sphere
from compare import compare
from compare.study.grid.file import load_study
from compare.study.grid.plan import PLAN, Plan
from compare.study.work.perform import perform, perform_all
from mujoco_models import SpatialSettings, simulate_space
from tests.compare.case_files import BALL, BALL_OF_50_MM, WIRE
from tests.compare.study.studies import SIMULATED_IN_SPACE

LEANING = f"""
[study]
beams = []
record = ["events", "reconstruction"]
[axes]
path.tangent.x = [0.0, 0.2]
path.height = [0.0, 0.05]
path.turn = [0, 20]
body.centre.y = {{ from = 1.35, to = 1.45, count = 2 }}
{BALL}[path]
points = [[1.6, 0.3], [-1.6, 0.3]]
stations = 16
"""


def case_of(tangent_x, height=0.0, turn=0.0, y=1.4, points=((1.6, 0.3), (-1.6, 0.3)), n=16):
    cos, sin = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    turned = [(cos * x + sin * z, cos * z - sin * x) for x, z in points]
    path = FootPath(turned, height, (tangent_x, 1, 0), n)
    return SpatialCase(Beam(), body=sphere(1.0, (0, y, 0)), path=path)


@pytest.mark.slow
def test_a_row_of_the_closed_form_is_what_the_library_finds(plan_of):
    plan = plan_of(LEANING)
    assert len(plan) == 16
    recipe = plan.study.recipe
    rows = [result.row for result in perform_all(recipe, list(plan)[4:7])]
    for run, row in zip(list(plan)[4:7], rows, strict=True):
        at = run.parameters
        assert row["outcome"] == "done", row["reason"]
        exact = solve_space(
            case_of(at["path.tangent.x"], at["path.height"], at["path.turn"], at["body.centre.y"])
        )
        events = {event["kind"]: event["travel"] for event in exact.provenance["events"]}
        for name, word in (("touch",) * 2, ("release",) * 2, ("slip_off", "slip-off")):
            assert row[f"event_{name}"] == events.get(word)
        assert row["stations_touching"] == exact.touching.sum()
        assert row["reconstruction_rms"] < 1e-12
    assert len({row["event_touch"] for row in rows}) == 3
    back = PLAN.validate_json(PLAN.dump_json(plan))
    assert [run.id for run in back] == [run.id for run in plan]


@pytest.mark.slow
def test_a_row_of_mujoco_is_what_the_library_finds(plan_of):
    plan = plan_of(SIMULATED_IN_SPACE)
    run = list(plan)[1]
    row = perform(plan.study.recipe, run).row
    assert row["outcome"] == "done", row["reason"]
    case = case_of(run.parameters["path.tangent.x"], points=((1.1, 0.3), (-0.3, 0.3)), n=12)
    segments = run.parameters["mujoco.segments"]
    candidate = simulate_space(case, SpatialSettings(segments=segments))
    found = compare(solve_space(case), candidate)
    for name, one in found.disagreement.items():
        assert row[f"disagreement_{name}_rms"] == one.rms
    assert row["contact_rms"] == found.contact.rms
    assert row["touch_difference"] == found.events["touch"].difference
    contact = candidate.values("contact_x", "contact_y", "contact_z")
    far = np.linalg.norm(
        reconstruct_space(candidate)[["contact_x", "contact_y", "contact_z"]] - contact, axis=1
    )
    assert row["reconstruction_max"] == np.nanmax(far)


@pytest.mark.slow
def test_noise_is_that_of_six_components(plan_of):
    text = LEANING.replace("[body]", "[noise]\nrelative = 0.01\n[body]", 1)
    text = text.replace('["events", "reconstruction"]', '["disagreement"]')
    plan = plan_of(text)
    row = perform(plan.study.recipe, plan[0]).row
    found = [
        row[f"disagreement_{kind}_{axis}_rms"] for kind in ("force", "moment") for axis in "xyz"
    ]
    assert all(0.004 < size < 0.02 for size in found)


@pytest.mark.slow
def test_a_mesh_is_known_by_its_content(plan_of, tmp_path):
    text = LEANING.replace(
        'kind = "sphere"\nradius = 1\ncentre = [0, 1.4, 0]', 'kind = "mesh"\nfile = "ball.stl"'
    ).replace("body.centre.y = { from = 1.35, to = 1.45, count = 2 }\n", "")

    def id_of(name, subdivisions):
        ball = trimesh.creation.icosphere(subdivisions, 1.0)
        ball.apply_translation([0, 1.4, 0])
        ball.export(tmp_path / name)
        return plan_of(text.replace("ball.stl", name))[0].id

    assert id_of("ball.stl", 1) == id_of("same.stl", 1) != id_of("other.stl", 2)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("path.tangent.x", "path.tangent.w", r"axes\.path\.tangent\.?w?"),
        ("path.height = [0.0", "path.height = [3.0", "within reach"),
        ("path.turn = [0, 20]", "sweep.stations = [10, 20]", "sweep"),
        ("radius = 1", "radius = -1", "positive"),
    ],
)
def test_a_mistake_is_one_line_that_names_its_line(tmp_path, old, new, says):
    path = tmp_path / "grid.toml"
    assert old in LEANING
    path.write_text(LEANING.replace(old, new))
    with pytest.raises(InputError, match=says) as refused:
        load_study(str(path))
    assert "\n" not in str(refused.value)
    assert re.search(r"line \d+", str(refused.value))


def test_units_hold_for_components_too(tmp_path):
    path = tmp_path / "grid.toml"
    path.write_text(f"""
[study]
beams = []
[axes]
body.centre.y = ["68 mm", "70 mm"]
{WIRE}{BALL_OF_50_MM}[path]
points = [["65 mm", "15 mm"], ["-75 mm", "10 mm"]]
stations = 10
""")
    study = load_study(str(path))
    (axis,) = study.axes
    assert axis.points == ((0.068,), (0.07,))
    row = perform(study.recipe, Plan.of(study)[0]).row
    assert row["outcome"] == "done", row["reason"]
