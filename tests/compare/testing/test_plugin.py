"""The pytest plugin as a user meets it: in a folder of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

# What a run inside this process imports first is forgotten after it, and not all modules bear that.
import compare.read.case
import compare.show.report  # noqa: F401
import mujoco_models  # noqa: F401

pytest_plugins = ["pytester"]

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.slow
def test_the_example_passes_and_is_reported(pytester):
    for file in ("test_my_simulator.py", "rig.toml"):
        (pytester.path / file).write_text((EXAMPLES / file).read_text())
    result = pytester.runpytest("--vibrissa-report", "out", "--strict-markers", "-W", "error")
    result.assert_outcomes(passed=4)
    result.stdout.fnmatch_lines(["4 comparisons reported in out/summary.md"])
    rows = json.loads((pytester.path / "out" / "summary.json").read_text())
    assert [row["agrees"] for row in rows] == [True] * 4
    for row in rows:
        assert (pytester.path / "out" / row["name"] / "report.html").exists()
        assert f"{row['name']}/report.html" in (pytester.path / "out" / "summary.md").read_text()


BAD = """
from dataclasses import replace
import pytest
from analytic import Beam, Sweep, solve_sweep

@pytest.mark.vibrissa("parabola")
def test_stiff(case, agreement):
    sweep = Sweep(200, float(case.foot_x[0]), float(case.foot_x[-1]))
    stiff = replace(case, beam=Beam(flexural_rigidity=1.02), sweep=sweep)
    agreement(replace(solve_sweep(stiff), beam=case.beam, source="mine"))
"""


@pytest.mark.slow
def test_a_failure_says_what_where_how_much_and_why(pytester):
    pytester.makepyfile(BAD)
    result = pytester.runpytest("--vibrissa-report", "out")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "*mine disagrees with analytic:*",
            "*force_x: rms * most in phase *; allowed 2.00e-03 (a chain of 40 segments*",
            "*likely: flexural rigidity +2.00% off*",
        ]
    )
    (row,) = json.loads((pytester.path / "out" / "summary.json").read_text())
    assert not row["agrees"]
    assert row["likely"].startswith("flexural rigidity +2.00%")


@pytest.mark.slow
def test_reports_of_workers_are_gathered(pytester):
    pytester.makepyfile(BAD.replace('"parabola"', '"parabola", "tip-only"'))
    result = pytester.runpytest("--vibrissa-report", "out", "-n", "2")
    result.assert_outcomes(failed=2)
    assert len(json.loads((pytester.path / "out" / "summary.json").read_text())) == 2


def test_which_cases_a_test_is_run_for(pytester):
    pytester.makepyfile("def test_name(case): print('case', case.name)")
    pytester.runpytest().assert_outcomes(passed=5)
    result = pytester.runpytest("--vibrissa-case", "tip-only", "-s")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*case tip-only*"])
    result = pytester.runpytest("--vibrissa-case", "tip-onli")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*did you mean tip-only?*"])


def test_the_users_own_case_goes_first(pytester):
    pytester.makeconftest(
        "import pytest, analytic\n"
        "@pytest.fixture\n"
        "def case(): return analytic.named_case('tip-only')\n"
    )
    pytester.makepyfile("def test_it(case, sweep, agreement): agreement(sweep())")
    pytester.runpytest().assert_outcomes(passed=1)


def test_each_sweep_is_made_once(pytester):
    pytester.makepyfile(
        "import pytest\n"
        "seen = []\n"
        "@pytest.mark.vibrissa('tip-only')\n"
        "@pytest.mark.parametrize('again', range(2))\n"
        "def test_it(sweep, again):\n"
        "    seen.append(sweep())\n"
        "    assert seen[0] is seen[-1]\n"
    )
    pytester.runpytest().assert_outcomes(passed=2)


def test_two_given_sweeps_need_no_case(pytester):
    pytester.makepyfile(
        "import analytic\n"
        "exact = analytic.solve_sweep(analytic.named_case('tip-only'))\n"
        "def test_two(agreement): agreement(exact, exact)\n"
        "def test_one(agreement): agreement(exact)\n"
    )
    result = pytester.runpytest()
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*give a reference, or let the test use `case`*"])


@pytest.mark.parametrize("module", ["numpy", "pandas", "scipy", "mujoco", "analytic"])
def test_who_does_not_use_it_does_not_wait_for_it(module):
    code = f"import sys, compare.testing.plugin; sys.exit({module!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
