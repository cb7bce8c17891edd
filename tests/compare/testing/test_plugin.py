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


CASES = """
@pytest.mark.vibrissa('tip-only')
def test_marked(vibrissa_case): assert vibrissa_case.name == 'tip-only'
def test_plain(vibrissa_case): print('case', vibrissa_case.name)
"""
TWICE = """
seen = []
@pytest.mark.vibrissa('tip-only')
@pytest.mark.parametrize('again', range(2))
def test_it(vibrissa_sweep, again):
    seen.append(vibrissa_sweep())
    assert seen[0] is seen[-1]
"""
WORDS = """
@pytest.mark.vibrissa('tip-only')
def test_it(vibrissa_sweep): assert vibrissa_sweep(segments=2).source == 'mujoco chain'
"""
GIVEN = """
import analytic
exact = analytic.solve_sweep(analytic.named_case('tip-only'))
def test_two(vibrissa_agreement): vibrissa_agreement(exact, exact)
def test_one(vibrissa_agreement): vibrissa_agreement(exact)
@pytest.mark.parametrize('given', [None, exact.table, 'analytic.parquet'])
def test_no_sweep(vibrissa_agreement, given): vibrissa_agreement(given, exact)
"""
ENGINE = "def test_name(vibrissa_engine): print('engine', vibrissa_engine)"
OF_ENGINE = "@pytest.mark.vibrissa_engine('{}')\n" + ENGINE
REFUSED = """
@pytest.mark.vibrissa('rubbing')
@pytest.mark.vibrissa_engine('mujoco')
def test_it(vibrissa_engine_sweep): vibrissa_engine_sweep()
"""


@pytest.mark.parametrize(
    ("text", "options", "outcomes", "said"),
    [
        # All cases, or those of the option; the marker goes before it.
        (CASES, (), {"passed": 6}, ()),
        (CASES, ("--vibrissa-case", "parabola", "-s"), {"passed": 2}, ("*case parabola*",)),
        (TWICE, (), {"passed": 2}, ()),  # each sweep is made once
        (WORDS, (), {"passed": 1}, ()),
        (GIVEN, ("--tb=line",), {"passed": 1, "failed": 4},
         ("*give a reference, or let the test use `vibrissa_case`*",
          *["*InputError: candidate = *: must be a Readings; *"] * 3)),
        (ENGINE, ("-s", "--vibrissa-engine", "mujoco"), {"passed": 1}, ("*engine mujoco*",)),
        (OF_ENGINE.format("mujoco"), ("--strict-markers",), {"passed": 1}, ()),
        (OF_ENGINE.format("drakke"), (), {"errors": 1}, ("*'drakke' is none of mujoco*",)),
        (REFUSED, ("-rs",), {"skipped": 1}, ("*engine mujoco: friction*",)),
    ],
)  # fmt: skip
def test_what_a_test_is_run_for(pytester, text, options, outcomes, said):
    pytester.makepyfile("import pytest\n" + text)
    result = pytester.runpytest(*options)
    result.assert_outcomes(**outcomes)
    result.stdout.fnmatch_lines([*said])


@pytest.mark.parametrize(
    ("text", "options", "said"),
    [
        *((f"{marker}\ndef test_name(vibrissa_case): pass", ("--vibrissa-case", "tip-onli"),
           "--vibrissa-case: case = *did you mean tip-only?")
          for marker in ("", "@pytest.mark.vibrissa('tip-only')")),
        (ENGINE, ("--vibrissa-engine", "drakke"), "--vibrissa-engine: engine = 'drakke'*"),
        ("", ("--vibrissa-space", "bell.toml"), "--vibrissa-space: *bell.toml*"),
    ],
)  # fmt: skip
def test_an_option_that_names_nothing_is_an_error_in_any_run(pytester, text, options, said):
    pytester.makepyfile("import pytest\n" + text)
    result = pytester.runpytest(*options)
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([f"ERROR: {said}"])


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


@pytest.mark.slow
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


def test_a_file_that_a_marker_names_is_beside_its_test(pytester):
    folder = pytester.mkdir("checks")
    (folder / "own.toml").write_text(
        '[profile]\nkind = "circle"\nradius = 0.5\nlowest = [0.0, 0.6]\n'
    )
    (folder / "test_own.py").write_text(
        "import pytest\n@pytest.mark.vibrissa('own.toml')\ndef test_own(vibrissa_case): pass\n"
    )
    pytester.runpytest().assert_outcomes(passed=1)


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
