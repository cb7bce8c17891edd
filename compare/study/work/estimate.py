"""What a study will take, before it is started."""

from statistics import mean

from compare.study.grid.plan import Plan
from compare.study.work.perform import perform

_PROBES = 3  # runs that are done to see how long one takes
_BYTES_A_ROW = 1500  # in both files
_BYTES_A_STATION = 100  # of kept readings, in either engine


def estimate(plan: Plan, workers: int) -> str:
    """Estimate a study's time and size; a few runs, spread over the plan, are timed."""
    study = plan.study
    last = len(plan) - 1
    probes = sorted({round(i * last / (_PROBES - 1)) for i in range(_PROBES)})
    rows = [perform(study, plan[index]).row for index in probes]
    seconds = mean(row["seconds"] for row in rows) * len(plan) / workers
    stations = (
        study.base["path.stations" if study.in_space else "sweep.stations"]
        if study.keep_readings
        else 0
    )
    size = len(plan) * (_BYTES_A_ROW + 2 * stations * _BYTES_A_STATION)
    trouble = sum(row["outcome"] != "done" for row in rows)
    return (
        f"{len(plan)} runs, about {_time(seconds)} on {workers} workers and {size / 1e6:.3g} MB; "
        f"{len(rows)} runs tried, {trouble} of them not done"
        + next((f" ({row['reason']})" for row in rows if row["reason"]), "")
    )


def _time(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
