"""The pytest plugin as a user meets it: in a folder of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from engines import list_engines

pytest_plugins = ["pytester"]

EXAMPLES = Path(__file__).parents[2] / "examples"
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


def rows_in(folder: Path) -> list[dict]:
    return json.loads((folder / "summary.json").read_text())


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_the_example_passes_and_is_reported(pytester):
    for file in ("test_my_simulator.py", "rig.toml"):
        (pytester.path / file).write_text((EXAMPLES / file).read_text())
    result = pytester.runpytest("--vibrissa-report", "out", "--strict-markers", "-W", "error")
    result.assert_outcomes(passed=4)
    result.stdout.fnmatch_lines(["4 comparisons reported in out/summary.md"])
    rows = rows_in(pytester.path / "out")
    assert [row["agrees"] for row in rows] == [True] * 4
    for row in rows:
        assert (pytester.path / "out" / row["name"] / "report.html").exists()
        assert f"{row['name']}/report.html" in (pytester.path / "out" / "summary.md").read_text()


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
    for inside in ("def demand", "def agree"):
        result.stdout.no_fnmatch_line(f"*{inside}*")
    (row,) = rows_in(pytester.path / "out")
    assert not row["agrees"]
    assert row["likely"].startswith("flexural rigidity +2.00%")


@pytest.mark.slow
def test_reports_of_workers_are_gathered(pytester):
    pytester.makepyfile(BAD.replace('"parabola"', '"parabola", "tip-only"'))
    pytester.runpytest("--vibrissa-report", "out", "-n", "2").assert_outcomes(failed=2)
    assert len(rows_in(pytester.path / "out")) == 2


def test_which_cases_a_test_is_run_for(pytester):
    """All, or those of the option; the marker goes before it."""
    pytester.makepyfile(
        "import pytest\n"
        "@pytest.mark.vibrissa('tip-only')\n"
        "def test_marked(vibrissa_case): assert vibrissa_case.name == 'tip-only'\n"
        "def test_plain(vibrissa_case): print('case', vibrissa_case.name)\n"
    )
    pytester.runpytest().assert_outcomes(passed=6)
    result = pytester.runpytest("--vibrissa-case", "parabola", "-s")
    result.assert_outcomes(passed=2)
    result.stdout.fnmatch_lines(["*case parabola*"])


@pytest.mark.parametrize("marker", ["", "@pytest.mark.vibrissa('tip-only')"])
def test_a_case_that_is_none_is_an_error_in_any_run(pytester, marker):
    pytester.makepyfile(f"import pytest\n{marker}\ndef test_name(vibrissa_case): pass")
    result = pytester.runpytest("--vibrissa-case", "tip-onli")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["ERROR: --vibrissa-case: case = *did you mean tip-only?"])


def test_what_the_users_own_hook_chose_is_not_chosen_again(pytester):
    """Nor are their own parameters crossed with the named cases."""
    pytester.makeconftest(
        "def pytest_generate_tests(metafunc):\n"
        "    if 'case' in metafunc.fixturenames:\n"
        "        metafunc.parametrize('case', [1, 2])\n"
        "    if 'vibrissa_case' in metafunc.fixturenames:\n"
        "        metafunc.parametrize('vibrissa_case', ['tip-only'], indirect=True)\n"
    )
    pytester.makepyfile(
        "def test_own(case): assert case in (1, 2)\n"
        "def test_it(vibrissa_case): assert vibrissa_case.name == 'tip-only'\n"
    )
    pytester.runpytest("-W", "error").assert_outcomes(passed=3)


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


def test_two_given_sweeps_need_no_case_and_have_to_be_sweeps(pytester):
    pytester.makepyfile(
        "import analytic, pytest\n"
        "exact = analytic.solve_sweep(analytic.named_case('tip-only'))\n"
        "def test_two(vibrissa_agreement): vibrissa_agreement(exact, exact)\n"
        "def test_one(vibrissa_agreement): vibrissa_agreement(exact)\n"
        "@pytest.mark.parametrize('given', [None, exact.table, 'analytic.parquet'])\n"
        "def test_no_sweep(vibrissa_agreement, given): vibrissa_agreement(given, exact)\n"
    )
    result = pytester.runpytest("--tb=line")
    result.assert_outcomes(passed=1, failed=4)
    result.stdout.fnmatch_lines(
        [
            "*give a reference, or let the test use `vibrissa_case`*",
            *["*InputError: candidate = *: must be a Readings; *"] * 3,
        ]
    )


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
    said = f"*{hidden}.py hides the package `{hidden}` of vibrissa-testbed*"
    result = pytester.runpytest_subprocess()
    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines([said])
    result = pytester.runpytest_subprocess("--vibrissa-case", "tip-only")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([f"ERROR: --vibrissa-case: {said}"])


def test_who_does_not_use_it_waits_less_than_50_ms_and_for_nothing_heavy():
    code = (
        "import pytest, sys, time; begin = time.process_time(); import pytest_vibrissa; "
        "print(time.process_time() - begin, *sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    took, *loaded = said.stdout.split()
    assert float(took) < 0.05
    assert not {"numpy", "pandas", "scipy", "mujoco", "analytic", "compare"} & {*loaded}


@pytest.mark.slow
def test_a_check_runs_with_every_engine_that_is_installed(pytester):
    pytester.makepyfile("""
        import pytest

        @pytest.mark.vibrissa("tip-only")
        def test_agrees(vibrissa_engine_sweep, vibrissa_case, vibrissa_agreement):
            sweep = vibrissa_engine_sweep(segments=20, obstacle="primitive")
            assert vibrissa_engine_sweep(segments=20, obstacle="primitive") is sweep
            vibrissa_agreement(sweep)
    """)
    result = pytester.runpytest("--strict-markers", "-rs", "-v")
    there = [one.name for one in list_engines() if one.trouble is None]
    missing = [one for one in list_engines() if one.trouble is not None]
    result.assert_outcomes(passed=len(there), skipped=len(missing))
    for one in missing:
        result.stdout.fnmatch_lines([f"*SKIPPED*engine {one.name}:*pip install*"])


def test_which_engines_a_test_is_run_for(pytester):
    names = "def test_name(vibrissa_engine): print('engine', vibrissa_engine)\n"
    marked = "import pytest\n@pytest.mark.vibrissa_engine('{}')\n" + names
    pytester.makepyfile(names)
    result = pytester.runpytest("-s", "--vibrissa-engine", "mujoco")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*engine mujoco*"])
    result = pytester.runpytest("--vibrissa-engine", "drakke")
    result.stderr.fnmatch_lines(["*--vibrissa-engine: engine = 'drakke'*"])
    pytester.makepyfile(marked.format("mujoco"))
    pytester.runpytest("--strict-markers").assert_outcomes(passed=1)
    pytester.makepyfile(marked.format("drakke"))
    result = pytester.runpytest()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*'drakke' is none of mujoco*"])


def test_a_case_that_an_engine_refuses_is_skipped_with_what_it_says(pytester):
    pytester.makepyfile(
        "import pytest\n"
        "@pytest.mark.vibrissa('rubbing')\n"
        "@pytest.mark.vibrissa_engine('mujoco')\n"
        "def test_it(vibrissa_engine_sweep): vibrissa_engine_sweep()\n"
    )
    result = pytester.runpytest("-rs")
    result.assert_outcomes(skipped=1)
    result.stdout.fnmatch_lines(["*engine mujoco: friction*"])
