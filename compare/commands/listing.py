"""The command ``list``: what there is to name in other commands."""

from collections.abc import Callable, Iterator
from typing import Annotated, Literal

import typer


def list_what_there_is(
    what: Annotated[
        Literal["cases", "engines", "methods", "studies", "models"] | None,
        typer.Argument(help="One of them; all if left out.", show_default=False),
    ] = None,
) -> bool:
    """List cases, engines, methods, studies or models."""
    for name, lines in _LISTS.items():
        if what is None:
            typer.echo(f"{name}:")
        if what in (None, name):
            for line in lines():
                typer.echo(line if what else f"  {line}")
    return True


def _cases() -> Iterator[str]:
    from dataclasses import astuple

    import numpy as np

    from analytic.problem.clamp_path import Whisk
    from analytic.problem.named import NAMED_TABLES, named_case, named_contour
    from analytic.problem.support import beyond_the_paper

    for name in NAMED_TABLES:
        profile = named_contour(name)
        lowest = profile.at(profile.parameter(np.array([0.0])))
        place = f"lowest at x = {lowest.xi[0]:g} L, y = {lowest.eta[0]:.4g} L"
        case = named_case(name)
        beyond = beyond_the_paper(case.beam, case.support)
        parts = [place, *(f"{what} {value:g}" for what, value in beyond.items())]
        if case.friction:
            parts.append("runs with --engine exact; in MuJoCo by a case file with [motion]")
        if isinstance(case.sweep, Whisk):
            foot, start, stop, _ = astuple(case.sweep)
            parts.append(f"foot at {foot:g} L, its clamp turns from {start:g} to {stop:g} rad")
        yield f"{name:18}{profile.label:42}{'; '.join(parts)}"


def _engines() -> Iterator[str]:
    from engines import list_engines

    engines = list_engines()
    width = 2 + max(len(found.name) for found in engines)
    yield f"{'exact':{width}}{'reference':14}the closed form"
    for found in engines:
        yield f"{found.name:{width}}{found.role:14}{found.trouble or found.version or ''}"


def _methods() -> Iterator[str]:
    from analytic.from_clamp.earlier import NAMES

    yield from NAMES


def _studies() -> Iterator[str]:
    from compare.study.grid.file import load_study, shipped_studies

    for name in shipped_studies():
        study = load_study(name)
        axes = ", ".join(" and ".join(axis.keys) for axis in study.axes)
        yield f"{name:22}{study.case}: {axes}"


def _models() -> Iterator[str]:
    from mujoco_models import shipped_models

    for name, path in shipped_models().items():
        yield f"{name:22}{path}"


_LISTS: dict[str, Callable[[], Iterator[str]]] = {
    "cases": _cases,
    "engines": _engines,
    "methods": _methods,
    "studies": _studies,
    "models": _models,
}
