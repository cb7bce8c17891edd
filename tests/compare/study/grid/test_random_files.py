"""Study files made at random: a plan, or one line."""

import random

import pytest

from analytic import InputError
from compare.study.grid.plan import Plan
from compare.study.work.perform import columns
from tests.compare.study.studies import planned

FITTING = {
    "beam.radius": ["0.002", "[0.001, 0.002]", "{ from = 1e-3, to = 1e-2, count = 3 }"],
    "profile.a": ["0.4", "[0.3, 0.5]", "{ from = 0.2, to = 0.8 }"],
    "mujoco.segments": ["20", "[10, 20]", "{ from = 10, to = 80, count = 4, spacing = 'log' }"],
    "mujoco.planar": ["[true, false]", "true"],
    "mujoco.clamp": ["['naive', 'second-order']"],
    "noise.seed": ["[1, 2, 3]", "{ from = 1, to = 20, count = 20 }"],
    "sweep.stations": ["[20, 40]", "30"],
}
STRANGE = [
    "true", "-1", "0", "2.5", "1e308", "1e-320", "nan", "inf", "9" * 30, "''", "'50 mm'", "'1 kg'",
    "'9**9**9 m'", "'../../x'", "[]", "{}", "[true]", "[[]]", "[{}]", "[nan]", "[1e9]", "[1, 2]",
    "{ from = 1 }", "{ count = 3 }", "{ form = 1, to = 3 }", "{ from = true, to = 2, count = 3 }",
    "{ from = 1, to = 2 }", "{ from = 1, to = 2, count = 1000000000 }", "1979-05-27",
    "{ from = 1e-308, to = 1e308, count = 3, spacing = 'log' }", "{ x = { y = [1] } }",
    "{ from = 'naive', to = 'second-order', count = 3 }", "[['beam.radius', 'profile.a']]",
]  # fmt: skip
KEYS = [
    "study.name", "study.case", "study.beams", "study.record", "study.timeout", "study.zip",
    "sample", "sample.count", "noise.relative", "axes", "axes.beam", "axes.beam.radius.x",
    "axes.profile.kind", "axes.profile.points", "axes.mujoco.beam", "axes.sweep.start", "nois.x",
    "axes.'beam.radius'", "axes.''", "profile.file", "mujoco", "sweep.stations",
]  # fmt: skip


def random_file(chance):
    lines = {"study.case": '"catenary"', "study.beams": chance.choice(["[]", '["chain"]'])}
    for key in chance.sample(list(FITTING), chance.randrange(1, 4)):
        strange = chance.random() < 0.15
        value = chance.choice(STRANGE if strange else FITTING[key])
        lines[f"axes.{key}" if value[0] in "[{" else key] = value
    if chance.random() < 0.4:
        lines[chance.choice(KEYS)] = chance.choice(STRANGE)
    if chance.random() < 0.4:
        lines["sample.count"] = "5"
    return "\n".join(f"{key} = {value}" for key, value in lines.items())


@pytest.mark.parametrize(
    "trials",
    [
        15,
        pytest.param(100, marks=pytest.mark.slow),
        pytest.param(3000, marks=pytest.mark.trial),
    ],
)
def test_a_random_file_is_a_plan_or_one_line(tmp_path, trials):
    chance = random.Random("study files")
    plans = 0
    for _ in range(trials):
        text = random_file(chance)
        try:
            plan = planned(tmp_path, text)
        except InputError as error:
            assert "\n" not in str(error), text
            assert len(str(error)) < 1000, text
            continue
        plans += 1
        assert set(plan[len(plan) - 1].parameters) <= set(columns(plan.study)), text
        assert Plan.from_json(plan.to_json())[0] == plan[0], text
    assert 0.1 < plans / trials < 0.9
