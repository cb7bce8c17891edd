"""A user's check runs with every engine, and says why where it does not."""

import pytest

from engines import list_engines

pytest_plugins = ["pytester"]

CHECK = """
import pytest
from compare import Tolerances

@pytest.mark.vibrissa("tip-only")
def test_agrees(vibrissa_engine_sweep, vibrissa_case, vibrissa_agreement):
    sweep = vibrissa_engine_sweep(segments=20, obstacle="primitive")
    assert vibrissa_engine_sweep(segments=20, obstacle="primitive") is sweep
    vibrissa_agreement(sweep)
"""
NAMES = """
def test_name(vibrissa_engine): print('engine', vibrissa_engine)
"""


@pytest.mark.slow
def test_a_check_runs_with_every_engine_that_is_installed(pytester):
    pytester.makepyfile(CHECK)
    result = pytester.runpytest("--strict-markers", "-rs", "-v")
    there = [one.name for one in list_engines() if one.trouble is None]
    missing = [one for one in list_engines() if one.trouble is not None]
    result.assert_outcomes(passed=len(there), skipped=len(missing))
    for one in missing:
        result.stdout.fnmatch_lines([f"*SKIPPED*engine {one.name}:*pip install*"])


def test_which_engines_a_test_is_run_for(pytester):
    pytester.makepyfile(NAMES)
    result = pytester.runpytest("-s", "--vibrissa-engine", "mujoco")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*engine mujoco*"])
    pytester.makepyfile("import pytest\n@pytest.mark.vibrissa_engine('mujoco')" + NAMES)
    pytester.runpytest("--strict-markers").assert_outcomes(passed=1)


def test_an_engine_that_there_is_not_is_an_error(pytester):
    pytester.makepyfile(NAMES)
    result = pytester.runpytest("--vibrissa-engine", "drakke")
    result.stderr.fnmatch_lines(["*--vibrissa-engine: engine = 'drakke'*"])
    pytester.makepyfile("import pytest\n@pytest.mark.vibrissa_engine('drakke')" + NAMES)
    result = pytester.runpytest()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*'drakke' is none of mujoco*"])


def test_a_case_that_an_engine_refuses_is_skipped_with_what_it_says(pytester):
    pytester.makepyfile(
        """
        import pytest
        @pytest.mark.vibrissa("rubbing")
        @pytest.mark.vibrissa_engine("mujoco")
        def test_it(vibrissa_engine_sweep):
            vibrissa_engine_sweep()
        """
    )
    result = pytester.runpytest("-rs")
    result.assert_outcomes(skipped=1)
    result.stdout.fnmatch_lines(["*engine mujoco: friction*"])
