"""Engines are found by entry points; one that cannot be used is a line, and the others go on."""

import json
import sys
import textwrap

import pytest

from analytic import InputError, named_case
from compare.commands import pipeline
from compare.read.case import load_job
from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan
from compare.study.work.perform import perform
from engines import Found, find_engine, list_engines, sweep_apart
from engines.known import named_engines
from mujoco_models import Settings
from tests.compare.command import vibrissa

ODD = """
import os, time
from dataclasses import replace
from engines.mujoco import ENGINE as MUJOCO

class Odd:
    role, tuned, requires = "other model", "nothing", "numpy"
    def __init__(self, name, requires="numpy"):
        self.name, self.requires = name, requires
    def sweep(self, case, settings, advance=lambda: None):
        if self.name == "raises":
            raise RuntimeError("no\\nluck")
        if self.name == "hangs":
            time.sleep(1000)
        if self.name == "dies":
            os._exit(7)
        if self.name == "exits":
            raise SystemExit("enough")
        found = MUJOCO.sweep(case, settings, advance)
        if self.name == "not-a-number":
            return replace(found, table=found.table.assign(force_y=float("nan")))
        if self.name == "short":
            return replace(found, table=found.table.iloc[:5])
        return found.table

RAISES, HANGS, DIES, EXITS = Odd("raises"), Odd("hangs"), Odd("dies"), Odd("exits")
NAN, SHORT, TABLE = Odd("not-a-number"), Odd("short"), Odd("table")
MISSING, OLD = Odd("missing", "no-such-thing>=2"), Odd("old", "numpy<1")

class Bare:
    pass

class Short:
    def sweep(self, case): ...

class Hurried:
    def sweep(self, case, settings): ...

class Alone:
    def sweep(self, case, settings, advance=lambda: None):
        return MUJOCO.sweep(case, settings, advance)

BARE, SHORTER, HURRIED, ALONE, CLASS = Bare(), Short(), Hurried(), Alone(), Alone
VAGUE, LISTS, NEEDY = Odd("vague"), Odd("lists"), Odd("needy", 5)
VAGUE.role, LISTS.tuned = "rival", ["nothing"]
"""
POINTS = """
[vibrissa.engines]
raises = odd_engines:RAISES
hangs = odd_engines:HANGS
dies = odd_engines:DIES
exits = odd_engines:EXITS
not-a-number = odd_engines:NAN
short = odd_engines:SHORT
table = odd_engines:TABLE
missing = odd_engines:MISSING
bare = odd_engines:BARE
shorter = odd_engines:SHORTER
hurried = odd_engines:HURRIED
alone = odd_engines:ALONE
class = odd_engines:CLASS
vague = odd_engines:VAGUE
lists = odd_engines:LISTS
needy = odd_engines:NEEDY
old = odd_engines:OLD
broken = odd_engines:NOTHING
fails = failing_engine:ENGINE
mujoco = odd_engines:RAISES
"""


@pytest.fixture
def odd_engines(tmp_path, install):
    """A distribution that offers engines, as pip installs one."""
    (tmp_path / "odd_engines.py").write_text(textwrap.dedent(ODD))
    (tmp_path / "failing_engine.py").write_text("raise RuntimeError('no\\nluck')")
    install("odd-engines", "1.0", POINTS)
    yield tmp_path
    sys.modules.pop("odd_engines", None)


def test_the_shipped_engines_are_listed_first_and_cannot_be_replaced(odd_engines):
    found = {one.name: one for one in list_engines()}
    assert next(iter(found)) == "mujoco"
    assert found["mujoco"].trouble is None
    assert found["mujoco"].role == "subject"
    assert found["mujoco"].version != "1.0"  # of the distribution that offers another
    assert {"raises", "hangs", "broken"} < set(found)


def test_a_sweep_is_enough(odd_engines):
    (found,) = (one for one in list_engines() if one.name == "alone")
    assert found == Found("alone", found.engine, "1.0", None, "other model", "")
    assert find_engine("alone") is found.engine


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("missing", "no-such-thing is not installed: pip install 'no-such-thing>=2'"),
        ("old", "is not <1: pip install 'numpy<1'"),
        ("broken", "cannot be loaded"),
        ("fails", "cannot be loaded (RuntimeError: no luck)"),
        ("bare", "Bare has no method sweep(case, settings, advance)"),
        ("shorter", "sweep(case, settings) cannot be called: too many positional arguments"),
        ("hurried", "sweep(case, settings, advance) cannot be called: too many positional"),
        ("class", "an engine is an object, as Alone(), and no class"),
        ("lists", "tuned is ['nothing'], no text"),
        ("needy", "requires is 5, no requirement of pip's"),
        ("vague", "role is 'rival', not one of subject, twin, other model"),
        ("mujocco", "one of mujoco"),
    ],
)
def test_an_engine_that_cannot_be_used_is_a_line(odd_engines, name, says):
    with pytest.raises(InputError) as refused:
        find_engine(name)
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("names", ["", "mujoco,", "mujoco,mujoco", "mujoco;drake"])
def test_odd_lists_of_engines_are_refused(names):
    with pytest.raises(InputError, match="names between commas"):
        named_engines(names)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("raises", "RuntimeError: no luck"),
        ("hangs", "not finished after 5 s"),
        ("dies", "its process ended without a word, code 7"),
        ("exits", "SystemExit: enough"),
        ("not-a-number", "without a number in force_x, force_y, moment_z, but with status ok"),
        ("short", "stations = 5 from"),
        ("table", "readings = a DataFrame"),
        ("missing", "no-such-thing is not installed"),
    ],
)
def test_whatever_an_engine_does_there_is_an_outcome_in_time(odd_engines, name, says):
    case = named_case("tip-only")
    # Those that end have as long as a busy machine may need to load them.
    timeout = 5 if name == "hangs" else 300
    found = sweep_apart(name, case, Settings(segments=5), timeout=timeout)
    assert found.readings is None
    assert says in found.trouble
    assert "\n" not in found.trouble


@pytest.mark.slow
def test_one_that_fails_is_a_row_and_the_others_go_on(odd_engines, tmp_path):
    command = ("run", "tip-only", "--segments", 10, "--stations", 40, "--out", "out")
    done = vibrissa(*command, "--engine", "raises,mujoco", cwd=tmp_path)
    done.ended(1, "raises: RuntimeError: no luck")
    rows = json.loads((tmp_path / "out" / "engines.json").read_text())["engines"]
    named = [(row["name"], row["trouble"]) for row in rows]
    assert named == [("raises", "RuntimeError: no luck"), ("mujoco", None)]
    assert rows[0]["rms"] is None
    assert rows[1]["rms"]["force_y"] < 1e-2
    assert "RuntimeError: no luck" in (tmp_path / "out" / "engines.html").read_text()


@pytest.mark.slow
def test_where_none_gives_readings_there_is_one_line(odd_engines, tmp_path):
    command = ("run", "tip-only", "--engine", "raises", "--out", "out")
    vibrissa(*command, cwd=tmp_path).refused("RuntimeError: no luck")


@pytest.mark.slow
def test_an_interrupt_keeps_the_engines_that_are_done(odd_engines, tmp_path, monkeypatch):
    real = pipeline.sweep_apart

    def interrupted(name, *rest):
        if name == "hangs":
            raise KeyboardInterrupt
        return real(name, *rest)

    monkeypatch.setattr(pipeline, "sweep_apart", interrupted)
    command = ("run", "tip-only", "--segments", 5, "--stations", 20, "--out", "out")
    done = vibrissa(*command, "--engine", "mujoco,hangs", cwd=tmp_path)
    assert done.returncode != 0
    assert (tmp_path / "out" / "mujoco.parquet").exists()


def test_the_command_lists_them(odd_engines, tmp_path):
    done = vibrissa("list", "engines", cwd=tmp_path).ended(0, "no-such-thing is not installed")
    assert any(line.split()[:2] == ["mujoco", "subject"] for line in done.stdout.splitlines())


def test_a_case_file_names_its_engines(tmp_path):
    case = '[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\n[engine]\nname = "mujoco, drake"\n'
    (tmp_path / "case.toml").write_text(case + "timeout = 30\n")
    job = load_job(str(tmp_path / "case.toml"))
    assert job.engines == ("mujoco", "drake")
    assert job.timeout == 30
    (tmp_path / "case.toml").write_text(case.replace("drake", "drakke"))
    with pytest.raises(InputError, match=r"case.toml, line 6: .*drakke"):
        load_job(str(tmp_path / "case.toml"))


@pytest.mark.slow
def test_an_engine_is_an_axis_of_a_study(odd_engines, tmp_path):
    """In this process: the workers of a study would not know of a folder only tests know."""
    text = """
        [study]
        case = "tip-only"
        record = ["disagreement"]
        [axes]
        "engine.name" = ["mujoco", "raises", "not-a-number", "missing"]
        [sweep]
        stations = 40
        [mujoco]
        segments = 10
    """
    (tmp_path / "study.toml").write_text(textwrap.dedent(text))
    plan = Plan.of(load_study(str(tmp_path / "study.toml")))
    rows = [perform(plan.study.recipe, run).row for run in plan]
    assert [row["outcome"] for row in rows] == ["done", "failed", "bad-input", "bad-input"]
    assert rows[0]["disagreement_force_y_rms"] < 1e-2
    assert "no luck" in rows[1]["reason"]
    assert plan.versions["missing"] == "none"
