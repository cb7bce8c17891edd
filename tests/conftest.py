"""Sweeps that many tests look at, made once a process."""

import signal
from functools import cache

import pytest

from analytic import CASE_NAMES, Case, Readings, named_case, solve_sweep
from mujoco_models import Settings, simulate_sweep
from tests.in_turn import InTurn

collect_ignore = ["examples/test_my_simulator.py"]  # run as users do by testing/test_plugin.py


def pytest_collection_modifyitems(items):
    """What takes longest comes first: in the end one core would wait for the other."""
    items.sort(key=lambda item: "test_wheel.py" not in item.nodeid)


@pytest.fixture(autouse=True, scope="session")
def nothing_is_ignored():
    """A shell in the background ignores interrupts, and so would commands that tests start."""
    for way in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(way) is signal.SIG_IGN:
            signal.signal(way, signal.default_int_handler)


@pytest.fixture
def in_turn(monkeypatch):
    """Budgets are swept in this process."""
    monkeypatch.setattr("compare.simulate.workers.Workers", InTurn)
    monkeypatch.setattr("compare.simulate.workers.start_server", lambda preload: None)


@cache
def exact_sweep(name: str) -> Readings:
    return solve_sweep(named_case(name))


def simulated_sweep(name: str, settings: Settings = Settings()) -> Readings:  # noqa: B008
    return _simulated_sweep(name, settings)


@cache  # with all arguments: to it a default is not the same as that value, given
def _simulated_sweep(name: str, settings: Settings) -> Readings:
    return simulate_sweep(named_case(name), settings)


@pytest.fixture(params=CASE_NAMES)
def case_name(request) -> str:
    return request.param


@pytest.fixture
def case(case_name) -> Case:
    return named_case(case_name)


@pytest.fixture
def exact(case_name) -> Readings:
    return exact_sweep(case_name)


@pytest.fixture
def simulated(case_name) -> Readings:
    return simulated_sweep(case_name)
