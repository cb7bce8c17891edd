"""The commands ``study`` and ``report``: many runs, and pages from what is stored of them."""

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import For, flag, option, out_folder, require_use
from compare.commands.output import Ended, page_folder, waiting, warn

HERE, ON_A_CLUSTER, COUNTED = "a study done here", "a study done on a cluster", "a dry run"
_REMEDY = "make one: vibrissa run CASE --out DIR, or vibrissa study FILE --out DIR"


def study(
    context: typer.Context,
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="A TOML file, or the name of a shipped study.")
    ],
    dry_run: Annotated[
        bool, flag("--dry-run", "Check, count and estimate; store nothing.")
    ] = False,
    out: Annotated[Path | None, out_folder("results/NAME")] = None,
    workers: Annotated[
        int | None,
        typer.Option(min=1, metavar="N", help="Processes.", show_default="one a core"),
        For((HERE, COUNTED)),
    ] = None,
    scheduler: Annotated[
        str | None,
        option(
            "Of a Dask cluster, as tcp://host:8786. Dask listens on all interfaces and lets "
            "anyone run code there; outside a trusted network use tls:// with certificates.",
            "ADDR",
        ),
        For((ON_A_CLUSTER,)),
    ] = None,
) -> bool:
    """Do the runs of a study that are not done yet.

    The exit code is 0 if all are done then, 1 if any failed, diverged, did not settle or took too
    long: those are tried again the next time.
    """
    require_use(context, COUNTED if dry_run else ON_A_CLUSTER if scheduler else HERE)
    from compare.study.grid.file import load_study

    read = load_study(file)
    from compare.study.grid.plan import Plan

    plan = Plan.of(read)
    from compare.commands.terminal import print_line, progress
    from compare.simulate.workers import available_cores
    from compare.study.work.execute import carry_out, dask_crew, estimate, local_crew

    cores = workers or available_cores()
    if dry_run:
        print_line(estimate(plan, cores))
        return True
    from compare.study.keep.store import Store

    folder = out or Path("results") / plan.study.name
    crew = local_crew(cores) if scheduler is None else dask_crew(scheduler)
    counts: dict[str, int] = {}
    with Store(folder, plan, warn) as store:
        done = store.done()
        todo = (run for run in plan if run.id not in done)
        count = len(plan) - len(done)
        print_line(f"{len(plan)} runs, {len(done)} of them done already")
        try:
            with (
                progress(plan.study.name, count) as advance,
                closing(carry_out(todo, plan.study.recipe, crew)) as results,
            ):
                for result in results:
                    store.add(result)
                    counts[result.row["outcome"]] = counts.get(result.row["outcome"], 0) + 1
                    advance()
        except KeyboardInterrupt as error:
            kept = len(done) + sum(counts.values())
            how = f"kept {kept} of {len(plan)} runs in {folder}: the same command does the others"
            raise Ended(f"{error or 'interrupted'}; {how}") from error
    said = ", ".join(f"{number} {outcome}" for outcome, number in sorted(counts.items()))
    print_line(f"{said or 'nothing to do'}; in {folder}")
    return counts.keys() <= {"done"}


def report(
    folder: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Folder of a run or a study, or with folders of runs."),
    ],
    out: Annotated[Path | None, out_folder("DIR")] = None,
) -> bool:
    """Write the page of a run, of a study, or of many runs.

    A run may be in the plane or in space, or be two sweeps with one --out that nobody compared yet;
    a study may be under way. The exit code of a run is that of its comparison.
    """
    if not folder.is_dir():
        raise InputError("DIR", folder, "a folder that is there", _REMEDY)
    if not any(folder.glob("*.parquet")) and not any(folder.rglob("*.json")):
        raise InputError("DIR", folder, "the folder of a run, a study, or of runs", _REMEDY)
    from compare.commands import terminal
    from compare.show.report import summary_of
    from compare.study.report import write_report

    with page_folder(out or folder), waiting("reading"):
        found = write_report(folder, out, warn)
    if found.comparison is not None:
        terminal.show(*summary_of(found.comparison))
    terminal.print_report(found.path)
    return found.comparison is None or found.comparison.agrees
