"""The fixtures for sweeps in space, in a folder of the user's own."""

import json

import pytest

from tests.compare.case_files import BALL

pytest_plugins = ["pytester"]

CASE = f"""
{BALL}[path]
points = [[1.1, 0.3], [0.2, 0.3]]
tangent = [0.1, 1, 0]
stations = 12
[mujoco]
segments = 10
[tolerances]
rms = {{ limit = 0.01, reason = "ten segments" }}
contact = {{ limit = 0.01, reason = "ten segments" }}
"""
TESTS = """
from dataclasses import replace

def test_mujoco(vibrissa_space_case, vibrissa_space_sweep, vibrissa_agreement):
    found = vibrissa_agreement(vibrissa_space_sweep("chain"), frame="clamp")
    assert found.frame == "clamp"
    assert found.tolerances.rms == 0.01
    assert found.candidate.provenance["settings"]["segments"] == 10

def test_wrong(vibrissa_space_case, vibrissa_space_sweep, vibrissa_agreement):
    exact = vibrissa_space_sweep()
    table = exact.table.assign(force_z=-exact.table["force_z"])
    vibrissa_agreement(replace(exact, table=table, source="mine"))
"""


@pytest.fixture
def own_folder(pytester):
    pytester.makefile(".toml", ball=CASE)
    pytester.makepyfile(TESTS)
    return pytester


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_what_agrees_passes_and_what_does_not_says_why(own_folder):
    result = own_folder.runpytest(
        "--vibrissa-space", "ball.toml", "--vibrissa-report", "out", "--strict-markers"
    )
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(
        ["*mine disagrees with analytic:*", "*force_z: rms *; allowed 1.00e-02 (ten segments)*"]
    )
    rows = json.loads((own_folder.path / "out" / "summary.json").read_text())
    assert [row["agrees"] for row in rows] == [True, False]
    assert len(rows[0]["rms"]) == 6
    summary = (own_folder.path / "out" / "summary.md").read_text()
    assert "moment_x" in summary
    for row in rows:
        page = (own_folder.path / "out" / row["name"] / "report.html").read_text()
        assert "scene-canvas" in page


def test_cases_have_to_be_named(own_folder):
    result = own_folder.runpytest("-k", "mujoco")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*vibrissa_space_case: no case is chosen*"])
    own_folder.makepyfile(
        "import pytest\n"
        "@pytest.mark.vibrissa_space('ball.toml')\n"
        "def test_name(vibrissa_space_case): assert vibrissa_space_case.name == 'ball'\n"
    )
    own_folder.runpytest("--strict-markers").assert_outcomes(passed=1)


@pytest.mark.parametrize("marker", ["vibrissa_space", "vibrissa"])
def test_a_marker_that_names_no_file_fails_in_a_line(pytester, marker):
    pytester.makepyfile(
        f"import pytest\n@pytest.mark.{marker}('nowhere.toml')\ndef test_it({marker}_case): pass\n"
    )
    result = pytester.runpytest()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["case file = nowhere.toml: must be a file that is there*"])
    result.stdout.no_fnmatch_line("*load*job*")
