"""The budget of a sweep in motion: all the sweeps that it takes, on all cores."""

from collections.abc import Callable, Mapping
from concurrent.futures import BrokenExecutor

from analytic import Case, Readings, solve_sweep
from compare.explain.motion import MotionBudget, motion_budget, slower_and_finer
from compare.simulate.controlled import sweep_alone
from compare.simulate.workers import Workers, available_cores
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings


def measure_motion_budget(
    case: Case,
    motion: Motion,
    settings: Settings,
    at_rest: Settings,
    advance: Callable[[], None] = lambda: None,
) -> tuple[MotionBudget, Mapping[str, Readings]]:
    """Measure what the disagreement of a sweep in motion with the closed form is made of.

    Parameters
    ----------
    case : Case
        The problem.
    motion, settings
        Of the sweep in question.
    at_rest : Settings
        Of the sweep at rest that it is compared with.
    advance : callable, optional
        Called after every sweep, for progress bars.

    Returns
    -------
    MotionBudget
        The parts.
    mapping of Readings
        The sweeps, by the names of `slower_and_finer`, and ``rest``.

    Raises
    ------
    InputError
        If no station is in contact and trusted in all sweeps.
    MemoryError
        If the system ends a worker.
    """
    motions = slower_and_finer(motion)
    with Workers(min(len(motions), available_cores())) as pool:
        slowest_first = sorted(motions, key=lambda name: motions[name].speed)
        sweeps = {name: pool.submit(move_alone, case, motions[name], settings)
                  for name in slowest_first}  # fmt: skip
        sweeps["rest"] = pool.submit(sweep_alone, case, at_rest)
        for sweep in sweeps.values():
            sweep.add_done_callback(lambda _: advance())
        try:
            runs = {name: sweeps[name].result() for name in (*motions, "rest")}
        except BrokenExecutor as error:
            raise MemoryError("the system ended a worker process") from error
    return motion_budget(solve_sweep(case), runs), runs


def move_alone(case: Case, motion: Motion, settings: Settings) -> Readings:
    """One sweep in motion, in a process of its own.

    Parameters
    ----------
    case : Case
        The problem.
    motion, settings
        The numerics.

    Returns
    -------
    Readings
        Of the sweep.
    """
    from mujoco_models import simulate_motion  # MuJoCo is imported only where it is used

    return simulate_motion(case, motion, settings)
