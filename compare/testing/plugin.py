"""Fixtures for users' own tests of a simulator: ``case``, ``sweep``, ``agreement``.

Registered as a pytest plugin by the package; nothing but pytest is imported until a fixture is
used.

``--vibrissa-case NAME|FILE`` (repeat it) or the marker ``@pytest.mark.vibrissa(NAME, ...)`` say
which cases a test is run for, by default all named ones; ``--vibrissa-report DIR`` writes the
report of every comparison that `agreement` makes, and ``DIR/summary.md``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pytest

if TYPE_CHECKING:
    from analytic import Case, Readings
    from compare.comparison import Comparison
    from compare.explain.budget import Budget
    from compare.judge.tolerances import Tolerances
    from compare.read.case import Job
    from mujoco_models import Settings
    from mujoco_models.settings import BeamKind

_RECORD = "vibrissa"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The plugin's options."""
    group = parser.getgroup("vibrissa", "sweeps of a vibrissa")
    group.addoption(
        "--vibrissa-case",
        action="append",
        metavar="NAME|FILE",
        help="case of the `case` fixture, named or a TOML file; repeat it (default: all named)",
    )
    group.addoption(
        "--vibrissa-report",
        type=Path,
        metavar="DIR",
        help="write a report of every comparison of the `agreement` fixture, and a summary",
    )


def pytest_configure(config: pytest.Config) -> None:
    """The plugin's marker, and its summary where it is asked for."""
    config.addinivalue_line(
        "markers", "vibrissa(case, ...): the cases, named or TOML files, of the `case` fixture"
    )
    folder = config.getoption("--vibrissa-report")
    if folder is not None and not hasattr(config, "workerinput"):  # xdist's workers have that
        config.pluginmanager.register(_Summary(folder))


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test a case; not where the `case` fixture is the user's own."""
    if "vibrissa_job" not in metafunc.fixturenames:
        return
    marker = metafunc.definition.get_closest_marker("vibrissa")
    names = marker.args if marker else metafunc.config.getoption("--vibrissa-case")
    if not names:
        from analytic import CASE_NAMES

        names = CASE_NAMES
    metafunc.parametrize("vibrissa_job", names, ids=[Path(n).stem for n in names], indirect=True)


@pytest.fixture
def vibrissa_job(request: pytest.FixtureRequest) -> Job:
    """The case, MuJoCo's settings and the tolerances that the name or file of a case states."""
    from compare.read.case import load_job

    return load_job(request.param)


@pytest.fixture
def case(vibrissa_job: Job) -> Case:
    """The problem: a `Case`, one test for each that marker or option names."""
    return vibrissa_job.case


@pytest.fixture(scope="session")
def vibrissa_sweeps() -> dict[tuple[str, Settings | None], Readings]:
    """The sweeps of this session, by case and by MuJoCo's settings (None: the closed form)."""
    return {}


@pytest.fixture
def sweep(
    case: Case, vibrissa_sweeps: dict[tuple[str, Settings | None], Readings]
) -> Callable[..., Readings]:
    """``sweep()`` is the closed form's sweep of `case`, ``sweep("chain", segments=80)`` MuJoCo's.

    Further words are those of `mujoco_models.Settings`. Each sweep is made once a session.
    """

    def made(beam: BeamKind | None = None, **settings: Any) -> Readings:  # noqa: ANN401
        from analytic import solve_sweep
        from mujoco_models import Settings, simulate_sweep

        numerics = None if beam is None else Settings(beam=beam, **settings)
        key = case.digest, numerics
        if key not in vibrissa_sweeps:
            vibrissa_sweeps[key] = (
                solve_sweep(case) if numerics is None else simulate_sweep(case, numerics)
            )
        return vibrissa_sweeps[key]

    return made


@pytest.fixture
def agreement(
    request: pytest.FixtureRequest, record_property: Callable[[str, object], None]
) -> Callable[..., Comparison]:
    """``agreement(candidate)`` fails the test unless the candidate agrees with the closed form.

    ``agreement(candidate, reference, tolerances, offset=, noise=, budget=)``, as
    `compare.assert_agreement` takes them. Without a reference it is the closed form's sweep of
    ``case``, which the test then has to use; without tolerances those of the case's file hold. The
    comparison is reported either way.
    """
    reported = 0

    def agree(
        candidate: Readings,
        reference: Readings | None = None,
        tolerances: Tolerances | None = None,
        *,
        offset: float | Literal["auto"] = 0.0,
        noise: float | Literal["auto"] = 0.0,
        budget: Budget | None = None,
    ) -> Comparison:
        from compare.comparison import compare
        from compare.testing.gates import demand

        nonlocal reported
        if reference is None:
            if "case" not in request.fixturenames:
                raise TypeError("agreement: give a reference, or let the test use `case`")
            reference = request.getfixturevalue("sweep")()
        if tolerances is None and "vibrissa_job" in request.fixturenames:
            tolerances = request.getfixturevalue("vibrissa_job").tolerances
        found = compare(reference, candidate, tolerances, offset=offset, noise=noise)
        folder = request.config.getoption("--vibrissa-report")
        if folder is not None:
            reported += 1
            name = re.sub(r"[^\w.-]+", "-", f"{request.node.nodeid}-{reported}")
            record_property(_RECORD, json.dumps(_report(found, folder, name)))
        demand(found, budget)
        return found

    return agree


def _report(found: Comparison, folder: Path, name: str) -> dict[str, Any]:
    """Write the report of one comparison, and tell what the summary says of it."""
    from compare.show.report import write_report

    write_report(found, folder / name)
    return {
        "name": name,
        "reference": found.reference.source,
        "candidate": found.candidate.source,
        "agrees": found.agrees,
        "rms": {reading: d.rms for reading, d in found.disagreement.items()},
        "failures": list(found.failures),
        "likely": found.likely,
    }


class _Summary:
    """What the tests of this session, in whatever process, recorded of their comparisons."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._rows: list[dict[str, Any]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take what a test recorded."""
        if report.when == "call":
            said = (value for key, value in report.user_properties if key == _RECORD)
            self._rows.extend(json.loads(str(value)) for value in said)

    def pytest_sessionfinish(self) -> None:
        """Write ``summary.json`` and ``summary.md``."""
        rows = sorted(self._rows, key=lambda row: str(row["name"]))
        self._folder.mkdir(parents=True, exist_ok=True)
        (self._folder / "summary.json").write_text(json.dumps(rows, indent=2), encoding="utf-8")
        lines = [
            "| comparison | verdict | force_x | force_y | moment_z | likely |",
            "|---|---|---|---|---|---|",
        ]
        for row in rows:
            rms = " | ".join(f"{x:.1e}" for x in row["rms"].values())
            lines.append(
                f"| [{row['candidate']} against {row['reference']}]({row['name']}/report.html) "
                f"| {'agrees' if row['agrees'] else 'disagrees'} | {rms} | {row['likely'] or ''} |"
            )
        text = "\n".join([*lines, "", "Numbers: rms over each reading's largest magnitude.", ""])
        (self._folder / "summary.md").write_text(text, encoding="utf-8")

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Say where it is."""
        terminalreporter.write_line(
            f"{len(self._rows)} comparisons reported in {self._folder / 'summary.md'}"
        )
