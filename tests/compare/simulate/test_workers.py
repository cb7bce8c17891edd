"""Worker processes: they start or it is said why not, and none outlives its leader."""

import signal
import subprocess
import sys

import pytest

from analytic import InputError
from compare.simulate.workers import Workers
from tests.compare.processes import alive, wait_for_end

LEADER = """
import os, sys, time
from compare.simulate.workers import Workers

def busy(seconds):
    os.write(1, f"{os.getpid()}\\n".encode())  # whole, beside another worker's
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass

if __name__ == "__main__":
    with Workers(2) as workers:
        busies = [workers.submit(busy, 200) for _ in range(2)]
        for one in busies:
            one.result()
"""


@pytest.mark.slow
@pytest.mark.parametrize("way", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_end_with_their_leader_however_that_ends(tmp_path, way):
    (tmp_path / "leader.py").write_text(LEADER)
    command = [sys.executable, "leader.py"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen(command, cwd=tmp_path, text=True, **pipes) as leader:
        processes = [int(leader.stdout.readline()) for _ in range(2)]
        assert all(map(alive, processes))
        leader.send_signal(way)
        assert leader.wait(timeout=60) != 0
    wait_for_end(processes)  # each would be busy for 200 s


@pytest.mark.slow
def test_work_is_done_and_errors_come_through():
    with Workers(2) as workers:
        found = [workers.submit(abs, number) for number in (-1, 2, -3)]
        assert [one.result() for one in found] == [1, 2, 3]
        with pytest.raises(ZeroDivisionError):
            workers.submit(divmod, 1, 0).result()


def test_workers_that_cannot_start_are_one_line(monkeypatch):
    """A worker that dies before its first task, as one does that cannot import what it needs."""
    monkeypatch.setattr(sys.modules["__main__"], "__file__", "/nowhere/broken.py", raising=False)
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    with pytest.raises(InputError, match="the first one did not start") as caught:
        Workers(2)
    assert "\n" not in str(caught.value)


def test_a_script_without_a_guard_is_named(tmp_path):
    """Once: its workers read the script too, and would start workers of their own."""
    script = tmp_path / "study.py"
    script.write_text("from compare.simulate.workers import Workers\nWorkers(2)\n")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120)
    assert done.returncode == 1
    assert done.stderr.count("must be processes") == 1
    assert 'below `if __name__ == "__main__":`' in done.stderr.splitlines()[-1]
    assert "bootstrapping" not in done.stderr
