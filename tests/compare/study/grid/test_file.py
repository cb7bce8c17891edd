"""Study files: what they expand to, and what is said about those that are wrong."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CASE_NAMES, InputError, named_case
from compare.study.grid.file import load_study, shipped_studies
from compare.study.grid.plan import PLAN, Plan
from compare.study.grid.study import run_of
from tests.compare.study.studies import EVENTS_ONLY


def parameters(plan):
    return [run.parameters for run in plan]


def test_axes_are_crossed_in_the_order_of_the_file(plan_of):
    plan = plan_of(EVENTS_ONLY)
    runs = parameters(plan)
    assert len(plan) == len(runs) == 40
    assert runs[0] == {"profile.a": 0.3, "beam.radius": 0.001}
    assert runs[1] == {"profile.a": 0.3, "beam.radius": 0.002}
    assert len({run.id for run in plan}) == 40


def test_a_log_range_has_equal_ratios_and_whole_numbers_where_they_must_be(plan_of):
    plan = plan_of("""
        study.case = "catenary"
        axes.mujoco.segments = { from = 10, to = 80, count = 4, spacing = "log" }
        axes.noise.relative = { from = 1e-4, to = 1e-2, count = 3, spacing = "log" }
    """)
    values = [(run["mujoco.segments"], run["noise.relative"]) for run in parameters(plan)]
    assert {n for n, _ in values} == {10, 20, 40, 80}
    assert {x for _, x in values} == {1e-4, 1e-3, 1e-2}
    assert all(run["mujoco.beam"] == "chain" for run in parameters(plan))


def test_zipped_axes_advance_together(plan_of):
    plan = plan_of("""
        study.case = "catenary"
        study.zip = [["mujoco.segments", "mujoco.contour_points"]]
        axes.mujoco.segments = [10, 20, 40]
        axes.sweep.stations = [30, 60]
        axes.mujoco.contour_points = { from = 100, to = 1600, count = 3, spacing = "log" }
    """)
    runs = parameters(plan)
    assert len(runs) == 6
    assert {(r["mujoco.segments"], r["mujoco.contour_points"]) for r in runs} == {
        (10, 100), (20, 400), (40, 1600),
    }  # fmt: skip


@pytest.mark.parametrize("method", ["latin-hypercube", "random"])
def test_samples_repeat_with_their_seed(plan_of, method):
    text = """
        study.case = "catenary"
        study.beams = []
        sample = {{ count = 50, seed = {seed}, method = "{method}" }}
        axes.profile.a = {{ from = 0.2, to = 0.8 }}
        axes.beam.radius = {{ from = 1e-4, to = 1e-2, spacing = "log" }}
    """
    one, same, other = (list(plan_of(text.format(seed=seed, method=method))) for seed in (1, 1, 2))
    assert one == same
    assert one != other
    drawn = np.array([run.parameters["profile.a"] for run in one])
    assert ((drawn > 0.2) & (drawn < 0.8)).all()
    if method == "latin-hypercube":  # one point in each of 50 equal strata
        assert len(set(np.floor((drawn - 0.2) / 0.6 * 50).astype(int))) == 50


def test_what_varies_need_not_stand_in_the_case(plan_of):
    """It was refused: "profile.radius = missing"."""
    plan = plan_of(
        "[profile]\nkind = 'circle'\nlowest = [0, 0.4]\n[axes]\nprofile.radius = [0.5, 1.0]\n"
    )
    assert [run.parameters["profile.radius"] for run in plan] == [0.5, 1.0]


def test_units_are_read_as_in_a_case_file(plan_of):
    plan = plan_of("""
        study.beams = []
        beam = { length = "50 mm", flexural_rigidity = "2e-6 N m^2" }
        profile = { kind = "catenary", a = 0.5, c = -0.8, scale = "5 cm" }
        axes.beam.radius = { from = "0.1 mm", to = "0.3 mm", count = 3 }
    """)
    assert [run["beam.radius"] for run in parameters(plan)] == [1e-4, 2e-4, 3e-4]


def test_named_cases_are_those_of_the_command_line(tmp_path):
    for name in CASE_NAMES:
        path = tmp_path / "named.toml"
        path.write_text(f'study.case = "{name}"\nstudy.beams = []')
        run = run_of(load_study(str(path)).base)
        assert run.case(tmp_path, name).digest == named_case(name).digest


def test_a_run_keeps_its_id_wherever_its_numbers_stand(plan_of):
    (fixed,) = plan_of('study = { case = "catenary", beams = [] }\nbeam.radius = 0.002')
    (varied,) = plan_of('study = { case = "catenary", beams = [] }\naxes.beam.radius = [0.002]')
    (changed,) = plan_of('study = { case = "catenary", beams = [] }\naxes.beam.radius = [0.003]')
    assert fixed.id == varied.id != changed.id


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("[axes]\nbeam.radis = [1]\n", ["line 3", "axes.beam.radis", "did you mean radius"]),
        ("[axes]\nbeam.radius = [\n  0.01,\n  -1,\n]\n", ["line 3", "axes.beam.radius", "-1"]),
        ("[axes]\nbeam.radius = { from = 0.0, to = 1e-2, count = 3, spacing = 'log' }\n",
         ["line 3", "both positive"]),
        ("[axes]\nbeam.radius = { from = 0.0, too = 1e-2 }\n", ["line 3", "did you mean to"]),
        ("[axes]\nbeam.radius = { from = 0.0, to = 1e-2 }\n", ["line 3", "[sample]"]),
        ("[axes]\nbeam.radius = [1e-3, 1e-3]\n", ["line 3", "different"]),
        ("[axes]\nbeam.radius = 0.1\n", ["line 3", "a list of different values, or a range"]),
        ("[model]\nfile = 'sound-chain'\n", ["line 2", "a study sweeps our models"]),
        ("[axes]\ncontact.friction = [0.1, -0.1]\n", ["line 3", "axes.contact.friction", "-0.1"]),
        ("[axes]\nsupport.rotational_stiffness = [1, 1e-3]\n", ["line 3", "0.001", "hundredth"]),
        ("[axes]\nbeam.radius = ['1 kg']\n", ["line 3", "unit"]),
        ("[axes]\nmujoco.beam = ['chain']\n", ["line 3", "study.beams"]),
        ("[sample]\ncount = 5\n", ["line 2", "[sample]"]),
        ("axes = {}\n", ["line 2", "axes = {}: must be not empty"]),
        ("[axes]\nbeam.radius.x = [1]\n", ["line 3", "beam.radius"]),
        ("[axes]\n'beam.radius' = [1e-3]\nbeam.radius = [2e-3]\n", ["given once"]),
        ("[axes]\nbeam.radius = [true]\n", ["line 3", "True"]),
        ("[axes]\nmujoco.clamp = { from = 'naive', to = 'second-order', count = 2 }\n",
         ["line 3", "two different numbers"]),
        ("[axes]\nprofile.a = { from = 1e-300, to = 1e300, count = 3, spacing = 'log' }\n",
         ["line 3"]),
        ("[axes]\nnoise.seed = [99999999999999999999]\n", ["line 3", "less than"]),
        ("[axes]\nbeam.radius = { from = 0, to = 1e-3, count = 1000000000 }\n",
         ["line 3", "1000000"]),
        ("[sweep]\nstations = 1000000000\n", ["line 3", "1000000000"]),
        ("[axes]\nreconstruction.method = ['kanecko']\n", ["line 3", "kanecko", "kaneko"]),
        ("[noise]\nrelative = nan\n", ["line 3", "nan"]),
        ("[axes]\nengine.name = ['mujoco', 'drak']\n", ["line 3", "drak", "mujoco, drake"]),
        ("[engine]\nname = 'mujoco,drake'\n", ["line 3", "engine.name", "as an axis"]),
        ('[study]\ncase = "catenry"\n', ["line 2", "catenry"]),
        ('[study]\ncase = "catenary"\nbeams = ["rope"]\n', ["line 3", "rope"]),
        ('[study]\ncase = "catenary"\nzip = [["beam.radius", "profile.a"]]\n',
         ["line 3", "axes"]),
        (f"[axes]\nbeam.radius = {[1e-3 + 1e-7 * i for i in range(10_001)]}\n",
         ["line 3", "10001 values"]),
    ],
)  # fmt: skip
def test_errors_point_at_the_line(tmp_path, text, stated):
    path = tmp_path / "grid.toml"
    path.write_text(("" if "[study]" in text else 'study = { case = "catenary" }\n') + text)
    with pytest.raises(InputError) as caught:
        load_study(str(path))
    assert "\n" not in str(caught.value)
    for words in stated:
        assert words in str(caught.value)


def test_true_and_false_are_an_axis_where_they_mean_something(plan_of):
    plan = plan_of("""
        study.case = "catenary"
        axes.mujoco.planar = [true, false]
    """)
    assert [run["mujoco.planar"] for run in parameters(plan)] == [True, False]
    assert list(PLAN.validate_json(PLAN.dump_json(plan))) == list(plan)


def test_a_plan_is_reached_anywhere_at_once(plan_of):
    plan = plan_of(EVENTS_ONLY)
    assert [plan[index] for index in range(len(plan))] == list(plan)
    with pytest.raises(IndexError):
        plan[len(plan)]


def test_edited_sources_are_other_runs(plan_of):
    plan = plan_of(EVENTS_ONLY)
    edited = replace(plan, versions=plan.versions | {"sources": "0" * 12})
    assert not {run.id for run in plan} & {run.id for run in edited}


def test_shipped_studies_are_valid():
    assert len(shipped_studies()) == 10
    for name in shipped_studies():
        assert len(Plan.of(load_study(name))) > 10


def test_a_motion_varies_in_natural_units(plan_of):
    study = """
        study.case = "catenary"
        study.beams = ["chain"]
        axes.motion.speed = [0.1, 0.2]
    """
    runs = parameters(plan_of(study))
    assert [run["motion.speed"] for run in runs] == [0.1, 0.2]
    plan = plan_of(study + "motion.timestep = 0.01")
    assert plan.study.base["motion.timestep"] == 0.01
    steel = """
        beam = { length = "100 mm", flexural_rigidity = "6.4e-4 N m^2", radius = "0.25 mm" }
        profile = { kind = "circle", radius = "80 mm", lowest = ["0 mm", "40 mm"] }
        motion = { period = "28 ms" }
        study.beams = ["chain"]
    """
    plan = plan_of(steel + 'axes.motion.speed = ["1 m/s", "2 m/s"]')
    assert [run["motion.speed"] for run in parameters(plan)] == pytest.approx([0.28, 0.56])
    with pytest.raises(InputError, match="in natural units"):
        plan_of(steel + 'axes.motion.period = ["28 ms", "30 ms"]')


def test_a_part_of_a_place_varies_in_the_plane(plan_of):
    text = """
        study.beams = []
        beam = { length = "100 mm", flexural_rigidity = "6.4e-4 N m^2" }
        profile = { kind = "ellipse", semi_axes = ["40 mm", "20 mm"], lowest = ["0 mm", "50 mm"] }
        axes.profile.semi_axes.x = ["30 mm", "50 mm"]
        axes.profile.lowest.y = { from = "40 mm", to = "60 mm", count = 3 }
    """
    plan = plan_of(text)
    assert parameters(plan)[-1] == pytest.approx(
        {"profile.semi_axes.x": 0.05, "profile.lowest.y": 0.06}
    )
    assert run_of(plan.study.base | parameters(plan)[-1]).profile.semi_axes == (0.05, 0.02)
    with pytest.raises(InputError, match=r"line 5.*semi_axes whole, or its x, y"):
        plan_of(text.replace("semi_axes.x", "semi_axes.z"))
    with pytest.raises(InputError, match=r"vary profile.semi_axes.x"):
        plan_of(text.replace("semi_axes.x =", "semi_axes ="))
