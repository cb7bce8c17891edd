"""Fixtures for users' own tests: cases, sweeps, and whether they agree (`compare/gates.md`).

The package registers this module as a pytest plugin, so every run of pytest in an environment that
has the package imports it. It imports nothing but pytest until a fixture or option is used; and it
is no part of a package, so that a ``compare.py`` of the user's own is in nobody's way.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import pytest

if TYPE_CHECKING:
    from analytic import Case, Readings
    from analytic.space import SpatialCase, SpatialReadings
    from compare.comparison import Comparison, SpatialComparison
    from compare.explain.budget import Budget
    from compare.judge.tolerances import SpatialTolerances, Tolerances
    from compare.read.job import Job
    from mujoco_models.allowed import BeamKind

    AnyComparison = Comparison | SpatialComparison
    AnyReadings = Readings | SpatialReadings

_PACKAGES = ("analytic", "mujoco_models", "engines", "compare")
_RECORD = "vibrissa"
_JOBS = pytest.StashKey[dict[str, Any]]()  # what is chosen, by fixture


class _Choice(NamedTuple):
    """What a fixture is run for, once each."""

    fixture: str
    option: str
    metavar: str
    what: str
    default: str
    read: Callable[[str], Any]
    every: Callable[[], Iterable[str]]  # without marker and option

    @property
    def marker(self) -> str:
        return self.fixture.removesuffix("_case")


_CASE = _Choice(
    "vibrissa_case",
    "--vibrissa-case",
    "NAME|FILE",
    "case, named or a TOML file,",
    " (default: all named)",
    lambda name: _ours("compare.read.case").load_job(name),
    lambda: _ours("analytic").CASE_NAMES,
)
_ENGINE = _Choice(
    "vibrissa_engine",
    "--vibrissa-engine",
    "NAME",
    "engine",
    " (default: all that are known)",
    lambda name: _ours("engines.known").named_engines(name),
    lambda: [found.name for found in _ours("engines").list_engines()],
)
_SPACE_CASE = _Choice(
    "vibrissa_space_case",
    "--vibrissa-space",
    "FILE",
    "case in space",
    "",
    lambda name: _ours("compare.read.case").load_space_job(name),
    lambda: (),  # there are no named ones: the fixture says how to choose
)
_CHOICES = (_CASE, _ENGINE, _SPACE_CASE)


def pytest_addoption(parser: pytest.Parser) -> None:
    """The plugin's options."""
    group = parser.getgroup("vibrissa", "sweeps of a vibrissa")
    for one in _CHOICES:
        group.addoption(
            one.option,
            action="append",
            metavar=one.metavar,
            help=f"{one.what} of tests that use `{one.fixture}` and have no marker `{one.marker}`; "
            f"repeat it{one.default}",
        )
    group.addoption(
        "--vibrissa-report",
        type=Path,
        metavar="DIR",
        help="write a report of every comparison of `vibrissa_agreement`, and a summary",
    )


def pytest_configure(config: pytest.Config) -> None:
    """The plugin's markers; its options, checked; its summary, if asked for."""
    for one in _CHOICES:
        config.addinivalue_line(
            "markers",
            f"{one.marker}({one.metavar}, ...): each {one.what} of the `{one.fixture}` fixture",
        )
        for name in config.getoption(one.option) or ():
            try:
                one.read(name)
            except (ValueError, OSError, pytest.fail.Exception) as error:  # InputError is the first
                raise pytest.UsageError(f"{one.option}: {error}") from None
    folder = config.getoption("--vibrissa-report")
    if folder is not None and not hasattr(config, "workerinput"):  # xdist's workers have that
        config.pluginmanager.register(_Summary(folder))


@pytest.hookimpl(trylast=True)
def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test a case and an engine, unless the user's own hook has chosen them."""
    for one in _CHOICES:
        if one.fixture not in metafunc.fixturenames:
            continue
        marker = metafunc.definition.get_closest_marker(one.marker)
        # A marker's file is beside its test, or where pytest was started.
        beside = metafunc.definition.path.parent
        marked = [path if (path := beside / str(name)).is_file() else name
                  for name in (marker.args if marker else ())]  # fmt: skip
        asked = marked or metafunc.config.getoption(one.option)
        names = [str(name) for name in asked or one.every()]
        if names:
            ids = [Path(name).stem for name in names]
            try:
                metafunc.parametrize(one.fixture, names, ids=ids, indirect=True)
            except (ValueError, pytest.Collector.CollectError) as error:
                if "duplicate parametrization" not in str(error):  # which somebody else has chosen
                    raise


@pytest.fixture
def vibrissa_case(request: pytest.FixtureRequest) -> Case:
    """The problem: an `analytic.Case`, one test for each that marker or option names."""
    return cast("Case", _chosen(request, _CASE))


@pytest.fixture
def vibrissa_job(request: pytest.FixtureRequest, vibrissa_case: Case) -> Job:
    """The case with MuJoCo's settings and the tolerances that its file states."""
    return cast("Job", request.node.stash[_JOBS][_CASE.fixture])


class _Sweeps(dict[object, Any]):
    """By case, settings (None: the closed form) and engine."""

    def once(self, key: object, make: Callable[[], Any]) -> Any:  # noqa: ANN401
        return self[key] if key in self else self.setdefault(key, make())


@pytest.fixture(scope="session")
def vibrissa_sweeps() -> _Sweeps:
    """The sweeps of this session."""
    return _Sweeps()


@pytest.fixture
def vibrissa_sweep(vibrissa_case: Case, vibrissa_sweeps: _Sweeps) -> Callable[..., Readings]:
    """``vibrissa_sweep()`` is the closed form's sweep of `vibrissa_case`.

    ``vibrissa_sweep("chain", segments=80)`` is MuJoCo's; further words are those of
    `mujoco_models.Settings`. Each sweep is made once a session.
    """
    solve, ours = _ours("analytic").solve_sweep, _ours("mujoco_models")
    numerics, key = ours.Settings(), vibrissa_case.digest
    return _swept(vibrissa_sweeps, key, vibrissa_case, numerics, solve, ours.simulate_sweep)


@pytest.fixture
def vibrissa_engine(request: pytest.FixtureRequest) -> str:
    """Name of the engine, one test for each that marker or option names; skipped without it."""
    name = str(request.param)
    known = {one.name: one for one in _ours("engines").list_engines()}
    if name not in known:
        pytest.fail(f"vibrissa_engine: {name!r} is none of {', '.join(known)}", pytrace=False)
    trouble = known[name].trouble
    if trouble is not None:
        pytest.skip(f"engine {name}: {trouble}")
    return name


@pytest.fixture
def vibrissa_engine_sweep(
    vibrissa_engine: str, vibrissa_job: Job, vibrissa_sweeps: _Sweeps
) -> Callable[..., Readings]:
    """``vibrissa_engine_sweep(segments=80)`` is the sweep of `vibrissa_case` in the engine.

    Words are those of `mujoco_models.Settings`, and change the settings of the case. Each sweep is
    made once a session. A case that the engine refuses is skipped, with what it says.
    """

    def made(**settings: Any) -> Any:  # noqa: ANN401
        case, numerics = vibrissa_job.case, replace(vibrissa_job.settings, **settings)
        engine = _ours("engines").find_engine(vibrissa_engine)

        def sweep() -> Any:  # noqa: ANN401
            try:
                found = engine.sweep(case, numerics)
            except _ours("analytic").InputError as error:
                pytest.skip(f"engine {vibrissa_engine}: {error}")
            return _ours("engines.apart").checked(found, case)

        return vibrissa_sweeps.once((case.digest, numerics, vibrissa_engine), sweep)

    return made


@pytest.fixture
def vibrissa_space_case(request: pytest.FixtureRequest) -> SpatialCase:
    """A problem in space: an `analytic.space.SpatialCase`, one test for each that is chosen."""
    return cast("SpatialCase", _chosen(request, _SPACE_CASE))


@pytest.fixture
def vibrissa_space_sweep(
    request: pytest.FixtureRequest, vibrissa_space_case: SpatialCase, vibrissa_sweeps: _Sweeps
) -> Callable[..., SpatialReadings]:
    """``vibrissa_space_sweep()`` is the closed form's sweep of `vibrissa_space_case`.

    ``vibrissa_space_sweep("chain", segments=80)`` is MuJoCo's; further words are those of
    `mujoco_models.SpatialSettings`, and change the settings of the case. Each sweep is made once a
    session.
    """
    job = request.node.stash[_JOBS][_SPACE_CASE.fixture]
    name = request.node.callspec.params[_SPACE_CASE.fixture]
    solve = _ours("analytic.space").solve_space
    simulate = _ours("mujoco_models").simulate_space
    return _swept(vibrissa_sweeps, name, vibrissa_space_case, job.settings, solve, simulate)


@pytest.fixture
def vibrissa_agreement(
    request: pytest.FixtureRequest, record_property: Callable[[str, object], None]
) -> Callable[..., AnyComparison]:
    """``vibrissa_agreement(candidate)`` fails unless the candidate agrees with the closed form.

    ``vibrissa_agreement(candidate, reference, tolerances, offset=, noise=, budget=)``, as
    `compare.assert_agreement` takes them. Without a reference it is the closed form's sweep of
    ``vibrissa_case``, which the test then has to use; without tolerances those of the case's file
    hold. Readings in space are compared in the same way, with ``vibrissa_space_case``, and with
    ``frame=`` for the components. The comparison is reported either way.
    """
    reported = 0

    def closed_form(asked: _Choice) -> AnyReadings:
        if asked.fixture not in request.fixturenames:
            pytest.fail(
                f"vibrissa_agreement: give a reference, or let the test use `{asked.fixture}`",
                pytrace=False,
            )
        sweep = request.getfixturevalue(asked.fixture.replace("case", "sweep"))
        return cast("AnyReadings", sweep())

    def agree(
        candidate: AnyReadings,
        reference: AnyReadings | None = None,
        tolerances: Tolerances | SpatialTolerances | None = None,
        *,
        budget: Budget | None = None,
        **how: Any,  # noqa: ANN401
    ) -> AnyComparison:
        __tracebackhide__ = True
        nonlocal reported
        in_space = isinstance(candidate, _ours("analytic.space").SpatialReadings)
        asked = _SPACE_CASE if in_space else _CASE
        if reference is None:
            reference = closed_form(asked)
        job = request.node.stash.get(_JOBS, {}).get(asked.fixture)
        if tolerances is None and job is not None:
            tolerances = job.tolerances
        found: AnyComparison = _ours("compare").compare(reference, candidate, tolerances, **how)
        folder = request.config.getoption("--vibrissa-report")
        if folder is not None:
            reported += 1
            name = re.sub(r"[^\w.-]+", "-", f"{request.node.nodeid}-{reported}")
            body = None if job is None else job.body
            row = _ours("compare.testing.summary").report(found, folder, name, body)
            record_property(_RECORD, json.dumps(row))
        _ours("compare.testing.gates").demand(found, budget)
        return found

    return agree


def _chosen(request: pytest.FixtureRequest, one: _Choice) -> Any:  # noqa: ANN401
    """The case that a fixture is run for; its job is kept beside it."""
    if not hasattr(request, "param"):
        pytest.fail(
            f"{one.fixture}: no case is chosen; name some with {one.option} {one.metavar} or "
            f"@pytest.mark.{one.marker}({one.metavar}), and let the test itself use it",
            pytrace=False,
        )
    try:
        job = one.read(request.param)
    except _ours("analytic").InputError as error:
        raise pytest.fail.Exception(str(error), pytrace=False) from None
    request.node.stash.setdefault(_JOBS, {})[one.fixture] = job
    return job.case


def _swept(
    sweeps: _Sweeps,
    key: object,
    case: Any,  # noqa: ANN401
    settings: Any,  # noqa: ANN401
    solve: Callable[[Any], Any],
    simulate: Callable[[Any, Any], Any],
) -> Callable[..., Any]:
    """Sweeps of a case: the closed form's; with a beam, or words of settings, MuJoCo's."""

    def made(beam: BeamKind | None = None, **words: Any) -> Any:  # noqa: ANN401
        if beam is None and not words:
            return sweeps.once((key, None), lambda: solve(case))
        numerics = replace(settings, **({} if beam is None else {"beam": beam}), **words)
        return sweeps.once((key, repr(numerics)), lambda: simulate(case, numerics))

    return made


def _ours(module: str) -> Any:  # noqa: ANN401
    """A module of the packages beside this file, which the user's own may hide."""
    here = Path(__file__).parent
    for package in _PACKAGES:
        found = sys.modules[package].__spec__ if package in sys.modules else find_spec(package)
        origin = Path(found.origin) if found and found.origin else None
        if origin is None or origin.resolve() != (here / package / "__init__.py").resolve():
            pytest.fail(
                f"vibrissa: {origin or 'a folder'} hides the package `{package}` of "
                "vibrissa-testbed from these tests; give it another name",
                pytrace=False,
            )
    return import_module(module)


class _Summary:
    """What the tests of this session, in whatever process, recorded of their comparisons."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._rows: list[dict[str, Any]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take what a test recorded."""
        if report.when == "call":
            recorded = (value for key, value in report.user_properties if key == _RECORD)
            self._rows.extend(json.loads(str(value)) for value in recorded)

    def pytest_sessionfinish(self) -> None:
        """Write ``summary.json`` and ``summary.md``."""
        _ours("compare.testing.summary").write_summary(self._rows, self._folder)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Say where it is."""
        terminalreporter.write_line(
            f"{len(self._rows)} comparisons reported in {self._folder / 'summary.md'}"
        )
