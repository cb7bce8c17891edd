"""The pytest plugin as a user meets it: in a folder of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
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
def test_stiff(vibrissa_case, vibrissa_agreement):
    case = vibrissa_case
    sweep = Sweep(200, float(case.foot_x[0]), float(case.foot_x[-1]))
    stiff = replace(case, beam=Beam(flexural_rigidity=1.02), sweep=sweep)
    vibrissa_agreement(replace(solve_sweep(stiff), beam=case.beam, source="mine"))
"""


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_a_failure_says_what_where_how_much_and_why(pytester):
    pytester.makepyfile(BAD)
    result = pytester.runpytest("--vibrissa-report", "out")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "*mine disagrees with analytic:*",
            "*likely: flexural rigidity +2.00% off*",
            "*force_x: rms * most in phase *; allowed 2.00e-03 (the default)",
            "*convention for this source*",
        ]
    )
    said = result.stdout.str()
    assert "def demand" not in said
    assert "def agree" not in said
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
    pytester.makepyfile("def test_name(vibrissa_case): print('case', vibrissa_case.name)")
    pytester.runpytest().assert_outcomes(passed=5)
    result = pytester.runpytest("--vibrissa-case", "tip-only", "-s")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*case tip-only*"])


@pytest.mark.parametrize("marker", ["", "@pytest.mark.vibrissa('tip-only')"])
def test_a_case_that_is_none_is_an_error_in_any_run(pytester, marker):
    pytester.makepyfile(f"import pytest\n{marker}\ndef test_name(vibrissa_case): pass")
    result = pytester.runpytest("--vibrissa-case", "tip-onli")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["ERROR: --vibrissa-case: case = *did you mean tip-only?"])


def test_the_marker_goes_before_the_option(pytester):
    pytester.makepyfile(
        "import pytest\n"
        "@pytest.mark.vibrissa('tip-only')\n"
        "def test_marked(vibrissa_case): assert vibrissa_case.name == 'tip-only'\n"
        "def test_plain(vibrissa_case): assert vibrissa_case.name == 'parabola'\n"
    )
    pytester.runpytest("--vibrissa-case", "parabola").assert_outcomes(passed=2)


def test_the_users_own_parameters_are_not_crossed_with_the_named_cases(pytester):
    pytester.makeconftest(
        "def pytest_generate_tests(metafunc):\n"
        "    if 'case' in metafunc.fixturenames:\n"
        "        metafunc.parametrize('case', [1, 2])\n"
    )
    pytester.makepyfile("def test_it(case): assert case in (1, 2)")
    pytester.runpytest("-W", "error").assert_outcomes(passed=2)


def test_what_the_users_own_hook_chose_is_not_chosen_again(pytester):
    pytester.makeconftest(
        "def pytest_generate_tests(metafunc):\n"
        "    metafunc.parametrize('vibrissa_case', ['tip-only'], indirect=True)\n"
    )
    pytester.makepyfile("def test_it(vibrissa_case): assert vibrissa_case.name == 'tip-only'")
    pytester.runpytest("-W", "error").assert_outcomes(passed=1)


def test_each_sweep_is_made_once(pytester):
    pytester.makepyfile(
        "import pytest\n"
        "seen = []\n"
        "@pytest.mark.vibrissa('tip-only')\n"
        "@pytest.mark.parametrize('again', range(2))\n"
        "def test_it(vibrissa_sweep, again):\n"
        "    seen.append(vibrissa_sweep())\n"
        "    assert seen[0] is seen[-1]\n"
    )
    pytester.runpytest().assert_outcomes(passed=2)


def test_two_given_sweeps_need_no_case(pytester):
    pytester.makepyfile(
        "import analytic\n"
        "exact = analytic.solve_sweep(analytic.named_case('tip-only'))\n"
        "def test_two(vibrissa_agreement): vibrissa_agreement(exact, exact)\n"
        "def test_one(vibrissa_agreement): vibrissa_agreement(exact)\n"
    )
    result = pytester.runpytest()
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*give a reference, or let the test use `vibrissa_case`*"])


@pytest.mark.parametrize("given", ["None", "exact.table", "'analytic.parquet'"])
def test_what_is_no_sweep_is_said_in_a_line(pytester, given):
    pytester.makepyfile(
        "import analytic\n"
        "exact = analytic.solve_sweep(analytic.named_case('tip-only'))\n"
        f"def test_it(vibrissa_agreement): vibrissa_agreement({given}, exact)\n"
    )
    result = pytester.runpytest("--tb=line")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*InputError: candidate = *: must be a Readings; *"])


@pytest.mark.parametrize("hidden", ["compare", "analytic", "mujoco_models"])
def test_a_file_of_the_users_that_hides_a_package(pytester, hidden):
    """Who does not use the plugin does not notice it; who does learns which file it is."""
    pytester.makepyfile(**{hidden: "x = 1"})
    pytester.makepyfile(
        test_own=f"import {hidden}\ndef test_own(): assert {hidden}.x == 1",
        test_ours="import pytest\n"
        "@pytest.mark.vibrissa('tip-only')\n"
        "def test_ours(vibrissa_case): pass",
    )
    result = pytester.runpytest_subprocess()
    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines([f"*{hidden}.py hides the package `{hidden}` of vibrissa-testbed*"])


def test_a_hidden_package_and_a_case_on_the_command_line(pytester):
    pytester.makepyfile(compare="")
    result = pytester.runpytest_subprocess("--vibrissa-case", "tip-only")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["ERROR: --vibrissa-case: *compare.py hides the package*"])


def test_who_does_not_use_it_waits_less_than_50_ms_and_for_nothing_heavy():
    code = (
        "import pytest, sys, time; begin = time.process_time(); import pytest_vibrissa; "
        "print(time.process_time() - begin, *sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    took, *loaded = said.stdout.split()
    assert float(took) < 0.05
    assert not {"numpy", "pandas", "scipy", "mujoco", "analytic", "compare"} & {*loaded}
