"""Fixtures for users' own tests: ``vibrissa_case``, ``vibrissa_sweep``, ``vibrissa_agreement``.

And ``vibrissa_engine_sweep``, for a test that runs with every engine; ``vibrissa_space_case`` and
``vibrissa_space_sweep`` for sweeps in space.

The package registers this module as a pytest plugin, so every run of pytest in an environment that
has the package imports it. It imports nothing but pytest until a fixture or option is used; and it
is no part of a package, so that a ``compare.py`` of the user's own is in nobody's way.

``--vibrissa-case NAME|FILE`` (repeat it) or the marker ``@pytest.mark.vibrissa(NAME, ...)`` choose
the cases that a test is run for, by default all named ones; where there are both, the marker's.
``--vibrissa-engine NAME`` and ``@pytest.mark.vibrissa_engine(NAME, ...)`` choose the engines in the
same way, for tests that use `vibrissa_engine_sweep`; by default all that are known.
``--vibrissa-space FILE`` and ``@pytest.mark.vibrissa_space(FILE, ...)`` choose the cases in space.
``--vibrissa-report DIR`` writes the report of every comparison that `vibrissa_agreement` makes, and
``DIR/summary.md``.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pytest

if TYPE_CHECKING:
    from analytic import Case, Readings
    from analytic.space import SpatialCase, SpatialReadings
    from compare.align.frames import Frame
    from compare.comparison import Comparison
    from compare.comparison_in_space import SpatialComparison
    from compare.explain.budget import Budget
    from compare.judge.spatial import SpatialTolerances
    from compare.judge.tolerances import Tolerances
    from compare.read.case import Job
    from compare.read.space import SpaceJob
    from mujoco_models import Settings
    from mujoco_models.allowed import BeamKind

    Sweeps = dict[tuple[str, Settings | None], Readings]
    EngineSweeps = dict[tuple[str, Settings, str], Readings]
    SpaceSweeps = dict[tuple[str, str], SpatialReadings]

_PACKAGES = ("analytic", "mujoco_models", "engines", "compare")
_RECORD = "vibrissa"
_JOB = pytest.StashKey["Job"]()
_SPACE_JOB = pytest.StashKey["SpaceJob"]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """The plugin's options."""
    group = parser.getgroup("vibrissa", "sweeps of a vibrissa")
    group.addoption(
        "--vibrissa-case",
        action="append",
        metavar="NAME|FILE",
        help="case of tests that use `vibrissa_case` and have no marker `vibrissa`, named or a "
        "TOML file; repeat it (default: all named)",
    )
    group.addoption(
        "--vibrissa-engine",
        action="append",
        metavar="NAME",
        help="engine of tests that use `vibrissa_engine_sweep` and have no marker "
        "`vibrissa_engine`; repeat it (default: all that are known)",
    )
    group.addoption(
        "--vibrissa-space",
        action="append",
        metavar="FILE",
        help="case in space of tests that use `vibrissa_space_case` and have no marker "
        "`vibrissa_space`; repeat it",
    )
    group.addoption(
        "--vibrissa-report",
        type=Path,
        metavar="DIR",
        help="write a report of every comparison of `vibrissa_agreement`, and a summary",
    )


def pytest_configure(config: pytest.Config) -> None:
    """The plugin's marker; its options, checked; its summary, if asked for."""
    config.addinivalue_line(
        "markers",
        "vibrissa(case, ...): the cases, named or TOML files, of the `vibrissa_case` fixture",
    )
    config.addinivalue_line(
        "markers",
        "vibrissa_engine(name, ...): the engines of the `vibrissa_engine_sweep` fixture",
    )
    config.addinivalue_line(
        "markers",
        "vibrissa_space(file, ...): the cases of the `vibrissa_space_case` fixture",
    )
    for name in config.getoption("--vibrissa-engine") or ():
        try:
            _ours("engines.known").named_engines(name)
        except (ValueError, pytest.fail.Exception) as error:
            raise pytest.UsageError(f"--vibrissa-engine: {error}") from None
    for name in config.getoption("--vibrissa-case") or ():
        try:
            _ours("compare.read.case").load_job(name)
        except (ValueError, OSError, pytest.fail.Exception) as error:  # InputError is a ValueError
            raise pytest.UsageError(f"--vibrissa-case: {error}") from None
    for name in config.getoption("--vibrissa-space") or ():
        try:
            _ours("compare.read.space").load_space_job(name)
        except (ValueError, OSError, pytest.fail.Exception) as error:
            raise pytest.UsageError(f"--vibrissa-space: {error}") from None
    folder = config.getoption("--vibrissa-report")
    if folder is not None and not hasattr(config, "workerinput"):  # xdist's workers have that
        config.pluginmanager.register(_Summary(folder))


@pytest.hookimpl(trylast=True)
def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test a case and an engine, unless the user's own hook has chosen them."""
    _choose_engines(metafunc)
    _choose_in_space(metafunc)
    if "vibrissa_case" not in metafunc.fixturenames:
        return
    # Without a public way to ask what is parametrized already, a user's `case` would be crossed
    # with all named cases.
    chosen = {name for call in metafunc._calls for name in call.params}
    asked = {"vibrissa_sweep", "vibrissa_job"}.intersection(metafunc.fixturenames)
    if "vibrissa_case" in signature(metafunc.function).parameters:
        asked.add("vibrissa_case")
    if "vibrissa_case" in chosen or ("case" in chosen and not asked):
        return
    marker = metafunc.definition.get_closest_marker("vibrissa")
    names = (marker.args if marker else ()) or metafunc.config.getoption("--vibrissa-case")
    names = [str(name) for name in names or _ours("analytic").CASE_NAMES]
    metafunc.parametrize("vibrissa_case", names, ids=[Path(n).stem for n in names], indirect=True)


def _choose_engines(metafunc: pytest.Metafunc) -> None:
    chosen = {name for call in metafunc._calls for name in call.params}
    if "vibrissa_engine" not in metafunc.fixturenames or "vibrissa_engine" in chosen:
        return
    marker = metafunc.definition.get_closest_marker("vibrissa_engine")
    names = (marker.args if marker else ()) or metafunc.config.getoption("--vibrissa-engine")
    names = list(names or [one.name for one in _ours("engines").list_engines()])
    metafunc.parametrize("vibrissa_engine", names, indirect=True)


def _choose_in_space(metafunc: pytest.Metafunc) -> None:
    chosen = {name for call in metafunc._calls for name in call.params}
    if "vibrissa_space_case" not in metafunc.fixturenames or "vibrissa_space_case" in chosen:
        return
    marker = metafunc.definition.get_closest_marker("vibrissa_space")
    names = (marker.args if marker else ()) or metafunc.config.getoption("--vibrissa-space")
    if names:  # there are no named ones: the fixture says how to choose
        names = [str(name) for name in names]
        metafunc.parametrize(
            "vibrissa_space_case", names, ids=[Path(name).stem for name in names], indirect=True
        )


@pytest.fixture
def vibrissa_case(request: pytest.FixtureRequest) -> Case:
    """The problem: an `analytic.Case`, one test for each that marker or option names."""
    if not hasattr(request, "param"):
        pytest.fail("vibrissa_case: no case is chosen; let the test itself use it", pytrace=False)
    job: Job = _stated(_ours("compare.read.case").load_job, request.param)
    request.node.stash[_JOB] = job
    return job.case


@pytest.fixture
def vibrissa_job(request: pytest.FixtureRequest, vibrissa_case: Case) -> Job:
    """The case with MuJoCo's settings and the tolerances that its file states."""
    job: Job = request.node.stash[_JOB]
    return job


@pytest.fixture(scope="session")
def vibrissa_sweeps() -> Sweeps:
    """The sweeps of this session, by case and by MuJoCo's settings (None: the closed form)."""
    return {}


@pytest.fixture
def vibrissa_sweep(vibrissa_case: Case, vibrissa_sweeps: Sweeps) -> Callable[..., Readings]:
    """``vibrissa_sweep()`` is the closed form's sweep of `vibrissa_case`.

    ``vibrissa_sweep("chain", segments=80)`` is MuJoCo's; further words are those of
    `mujoco_models.Settings`. Each sweep is made once a session.
    """
    return _sweep_of(vibrissa_case, vibrissa_sweeps)


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
    vibrissa_engine: str, vibrissa_job: Job, vibrissa_engine_sweeps: EngineSweeps
) -> Callable[..., Readings]:
    """``vibrissa_engine_sweep(segments=80)`` is the sweep of `vibrissa_case` in the engine.

    Words are those of `mujoco_models.Settings`, and change the settings of the case. Each sweep is
    made once a session. A case that the engine refuses is skipped, with what it says.
    """

    def made(**settings: Any) -> Readings:  # noqa: ANN401
        case, numerics = vibrissa_job.case, replace(vibrissa_job.settings, **settings)
        key = case.digest, numerics, vibrissa_engine
        if key not in vibrissa_engine_sweeps:
            engine = _ours("engines").find_engine(vibrissa_engine)
            try:
                found = engine.sweep(case, numerics)
            except _ours("analytic").InputError as error:
                pytest.skip(f"engine {vibrissa_engine}: {error}")
            vibrissa_engine_sweeps[key] = _ours("engines.apart").checked(found, case)
        return vibrissa_engine_sweeps[key]

    return made


@pytest.fixture(scope="session")
def vibrissa_engine_sweeps() -> EngineSweeps:
    """The engines' sweeps of this session, by case, settings and engine."""
    return {}


@pytest.fixture
def vibrissa_space_case(request: pytest.FixtureRequest) -> SpatialCase:
    """A problem in space: an `analytic.space.SpatialCase`, one test for each that is chosen."""
    if not hasattr(request, "param"):
        pytest.fail(
            "vibrissa_space_case: no case is chosen; name files with --vibrissa-space FILE or "
            "@pytest.mark.vibrissa_space(FILE), and let the test itself use it",
            pytrace=False,
        )
    job: SpaceJob = _stated(_ours("compare.read.space").load_space_job, request.param)
    request.node.stash[_SPACE_JOB] = job
    return job.case


@pytest.fixture(scope="session")
def vibrissa_space_sweeps() -> SpaceSweeps:
    """The sweeps in space of this session, by file and MuJoCo's settings."""
    return {}


@pytest.fixture
def vibrissa_space_sweep(
    request: pytest.FixtureRequest,
    vibrissa_space_case: SpatialCase,
    vibrissa_space_sweeps: SpaceSweeps,
) -> Callable[..., SpatialReadings]:
    """``vibrissa_space_sweep()`` is the closed form's sweep of `vibrissa_space_case`.

    ``vibrissa_space_sweep("chain", segments=80)`` is MuJoCo's; further words are those of
    `mujoco_models.SpatialSettings`, and change the settings of the case. Each sweep is made once a
    session.
    """
    return _space_sweep_of(request, vibrissa_space_sweeps)


@pytest.fixture
def vibrissa_agreement(
    request: pytest.FixtureRequest, record_property: Callable[[str, object], None]
) -> Callable[..., Comparison | SpatialComparison]:
    """``vibrissa_agreement(candidate)`` fails unless the candidate agrees with the closed form.

    ``vibrissa_agreement(candidate, reference, tolerances, offset=, noise=, budget=)``, as
    `compare.assert_agreement` takes them. Without a reference it is the closed form's sweep of
    ``vibrissa_case``, which the test then has to use; without tolerances those of the case's file
    hold. Readings in space are compared in the same way, with ``vibrissa_space_case``, and with
    ``frame=`` for the components. The comparison is reported either way.
    """
    return _agreement("vibrissa_case", request, record_property)


@pytest.fixture
def case(request: pytest.FixtureRequest, vibrissa_case: Case) -> Case:
    """The old name of `vibrissa_case`."""
    _warn(request, "case")
    return vibrissa_case


@pytest.fixture
def sweep(
    request: pytest.FixtureRequest, case: Case, vibrissa_sweeps: Sweeps
) -> Callable[..., Readings]:
    """The old name of `vibrissa_sweep`."""
    _warn(request, "sweep")
    return _sweep_of(_checked("sweep", case), vibrissa_sweeps)


@pytest.fixture
def agreement(
    request: pytest.FixtureRequest, record_property: Callable[[str, object], None]
) -> Callable[..., Comparison | SpatialComparison]:
    """The old name of `vibrissa_agreement`."""
    _warn(request, "agreement")
    return _agreement("case", request, record_property)


def _warn(request: pytest.FixtureRequest, name: str) -> None:
    request.node.warn(
        DeprecationWarning(
            f"fixture `{name}` of vibrissa-testbed is called `vibrissa_{name}` now; the old name "
            "will go, since it may be one of your own"
        )
    )


def _checked(fixture: str, case: object) -> Case:
    """The case, if it is one: the user may have a fixture `case` for something else."""
    checked: type[Case] = _ours("analytic").Case
    if not isinstance(case, checked):
        pytest.fail(
            f"{fixture}: the fixture `case` in use here is your own and gives a "
            f"{type(case).__name__}, no analytic.Case; use `vibrissa_case` and "
            f"`vibrissa_{fixture}`",
            pytrace=False,
        )
    return case


def _sweep_of(case: Case, sweeps: Sweeps) -> Callable[..., Readings]:
    def made(beam: BeamKind | None = None, **settings: Any) -> Readings:  # noqa: ANN401
        mujoco_models = _ours("mujoco_models")
        numerics = None if beam is None else mujoco_models.Settings(beam=beam, **settings)
        key = case.digest, numerics
        if key not in sweeps:
            sweeps[key] = (
                _ours("analytic").solve_sweep(case)
                if numerics is None
                else mujoco_models.simulate_sweep(case, numerics)
            )
        return sweeps[key]

    return made


def _space_sweep_of(
    request: pytest.FixtureRequest, sweeps: SpaceSweeps
) -> Callable[..., SpatialReadings]:
    job = request.node.stash[_SPACE_JOB]

    def made(beam: str | None = None, **settings: Any) -> SpatialReadings:  # noqa: ANN401
        numerics = None if beam is None else replace(job.settings, beam=beam, **settings)
        key = str(request.node.callspec.params["vibrissa_space_case"]), repr(numerics)
        if key not in sweeps:
            sweeps[key] = (
                _ours("analytic.space").solve_space(job.case)
                if numerics is None
                else _ours("mujoco_models").simulate_space(job.case, numerics)
            )
        return sweeps[key]

    return made


def _agreement(
    named: str, request: pytest.FixtureRequest, record: Callable[[str, object], None]
) -> Callable[..., Comparison | SpatialComparison]:
    reported = 0

    def closed_form(in_space: bool) -> Readings | SpatialReadings:
        asked = "vibrissa_space_case" if in_space else named
        if asked not in request.fixturenames:
            pytest.fail(
                f"agreement: give a reference, or let the test use `{asked}`", pytrace=False
            )
        case = request.getfixturevalue(asked)
        if in_space:
            return _space_sweep_of(request, request.getfixturevalue("vibrissa_space_sweeps"))()
        sweeps = request.getfixturevalue("vibrissa_sweeps")
        return _sweep_of(_checked("agreement", case), sweeps)()

    def agree(
        candidate: Readings | SpatialReadings,
        reference: Readings | SpatialReadings | None = None,
        tolerances: Tolerances | SpatialTolerances | None = None,
        *,
        offset: float | Literal["auto"] = 0.0,
        noise: float | Literal["auto"] = 0.0,
        budget: Budget | None = None,
        frame: Frame = "world",
    ) -> Comparison | SpatialComparison:
        __tracebackhide__ = True
        nonlocal reported
        in_space = isinstance(candidate, _ours("analytic.space").SpatialReadings)
        if reference is None:
            reference = closed_form(in_space)
        job = request.node.stash.get(_SPACE_JOB if in_space else _JOB, None)
        if tolerances is None and job is not None:
            tolerances = job.tolerances
        found: Comparison | SpatialComparison = _ours("compare.comparison").compare(
            reference, candidate, tolerances, offset=offset, noise=noise, frame=frame
        )
        folder = request.config.getoption("--vibrissa-report")
        if folder is not None:
            reported += 1
            name = re.sub(r"[^\w.-]+", "-", f"{request.node.nodeid}-{reported}")
            body = job.case.body if in_space and job is not None else None
            row = _ours("compare.testing.summary").report(found, folder, name, body)
            record(_RECORD, json.dumps(row))
        _ours("compare.testing.gates").demand(found, budget)
        return found

    return agree


def _stated(load: Callable[[str], Any], file: str) -> Any:  # noqa: ANN401
    """What a marker names; what is wrong with it fails the test in a line."""
    try:
        return load(file)
    except _ours("analytic").InputError as error:
        pytest.fail(str(error), pytrace=False)


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
