"""What ``reconstruct`` does with readings: the contour in the plane, the body in space."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from analytic import (
    CLAMP_READINGS,
    InputError,
    Readings,
    estimate_friction,
    fit_object,
    reconstruct,
    relative_noise,
    require_beam,
)
from analytic.from_clamp.fitted import NoFamilyError, check_family
from analytic.from_clamp.passes import as_passes
from analytic.from_clamp.reconstruct import doubt, scatter_of_contacts
from analytic.problem.support import check_support
from analytic.space import SpatialReadings, convex_band, fit_body
from analytic.space.from_clamp.fit_body import BODY_FAMILIES
from compare.align.offset import checked_offset, without_offset
from compare.commands import terminal
from compare.commands.options import number_or_auto
from compare.commands.output import output_folder, waiting
from compare.commands.sweeping import RigFiles as RigFiles
from compare.commands.sweeping import deviations, keep_scene, note_rows, print_reconstruction
from compare.commands.sweeping import find_body as find_body
from compare.sense.record import without_dropouts
from compare.show.fits import band_document, band_summary, object_document, object_summary
from compare.show.numbers import quantity
from compare.show.passes import consistency_line, lag_remembered
from compare.show.scene import SweepScene, solid_ply

CONVEX = "convex"


def check_body(family: str) -> None:
    """Refuse what is no family of bodies, before anything is written."""
    check_family(family, (*BODY_FAMILIES, CONVEX))


def body_of(sweeps: list[SpatialReadings], place: Path, noise: float, family: str) -> bool:
    """Fit the body of a family to all sweeps, write and print it; whether it explains them."""
    if family == CONVEX:
        return _band_of(sweeps, place, noise)
    with waiting("fitting"):
        fitted = fit_body(sweeps, family, deviations(sweeps, noise))
    with output_folder(place) as folder:
        terminal.show(*object_summary(fitted, sweeps[0].beam.si))
        terminal.keep(folder / "object.json", object_document(fitted))
        keep_scene(folder / "object.png", SweepScene.of(sweeps[0], fitted.body))
    return fitted.explains


def _band_of(sweeps: list[SpatialReadings], place: Path, noise: float) -> bool:
    """Write and print the two bodies that bound any convex one; whether there is one."""
    with waiting("fitting"):
        found = convex_band(sweeps, deviations(sweeps, noise))
    with output_folder(place) as folder:
        terminal.show(*band_summary(found, sweeps[0].beam))
        terminal.keep(folder / "object.json", band_document(found))
        for name, body in (("inner", found.inner), ("outer", found.outer)):
            terminal.keep(folder / f"{name}.ply", solid_ply(body.corners))
        inner, outer = (SweepScene.of(sweeps[0], one) for one in (found.inner, found.outer))
        keep_scene(folder / "object.png", inner, outer.faces)
    return found.explains


def without_faults(readings: Readings, offset: float) -> Readings:
    """A sweep without dropouts and offset, NaN where a station is not to be trusted."""
    readings = without_dropouts(readings)
    if offset:
        readings = without_offset(readings, checked_offset(offset))
    known = {
        name: np.where(readings.trusted, readings.values(name), np.nan) for name in CLAMP_READINGS
    }
    return replace(readings, table=readings.table.assign(**known))


def in_the_plane(
    passes: list[Readings],
    place: Path,
    noise: float | None,
    friction: str | None,
    methods: list[str],
    family: str | None,
) -> bool:
    """Find the contour by each method, from all passes, and write and print it.

    And the object of a family, if one is named; whether it explains the readings of all passes.
    """
    for one in as_passes(passes):
        if not one.trusted.any():
            allowed = "with a finite force_x, force_y and moment_z, and status ok, at some"
            remedy = "see which column lacks its numbers"
            raise InputError(one.source, f"{len(one.table)} stations", allowed, remedy)
    level = None if noise is None else relative_noise(passes, noise)
    if friction is not None:
        passes = _rubbing(passes, friction, level)
    contacts = {name: [reconstruct(one, level, method=name) for one in passes] for name in methods}
    for found, one in zip(contacts.get("elastica", ()), passes, strict=False):
        require_beam(found, one)
    fitted = none = None
    with waiting("fitting"):
        try:
            beside = ("friction",) if friction == "auto" else ()
            fitted = None if family is None else fit_object(passes, family, level, beside)
        except NoFamilyError as error:
            none = error
    # The fit takes 60 MB, and what draws 50: it is loaded when the fit has gone.
    from compare.show.figures.geometry import reconstruction

    with output_folder(place) as folder:
        for one in passes:
            note_rows(one)
        if (said := lag_remembered(passes)) is not None:
            terminal.print_line(said)
        for name, each in contacts.items():
            end = "" if name == "elastica" else f"-{name}"
            for one, found in zip(passes, each, strict=True):
                print_reconstruction(one, found, name)
                if name == "elastica" and (why := doubt(found, one)) is not None:
                    terminal.print_line(str(why))
            if len(passes) > 1 and (apart := scatter_of_contacts(passes, each)) is not None:
                terminal.print_line(
                    f"{len(passes)} passes: at one foot position their contact points scatter by "
                    f"{quantity(apart, 'length', passes[0].beam)} in the median"
                )
            names = [one.provenance.get("pass", one.source) for one in passes]
            points = pd.concat(
                found.assign(foot_x=one.values("foot_x"), **{"pass": name})
                for name, one, found in zip(names, passes, each, strict=True)
            )
            shown = points if len(passes) > 1 else points.drop(columns="pass")
            terminal.keep(folder / f"points{end}.csv", shown)
            with waiting("drawing"):
                picture = reconstruction(passes[0], points, fitted)
            terminal.keep(folder / f"reconstruction{end}.png", picture)
        if fitted is not None:
            terminal.show(*object_summary(fitted, passes[0].beam.si))
            terminal.keep(folder / "object.json", object_document(fitted))
    if none is not None:
        terminal.print_line(str(none))
    if fitted is None:
        return none is None
    return fitted.explains and (fitted.passes is None or fitted.passes.consistent)


def _rubbing(
    passes: list[Readings], said: str, noise: Mapping[str, float] | None
) -> list[Readings]:
    friction = number_or_auto("--friction", said)
    if friction == "auto":
        found = estimate_friction(passes, noise)
        terminal.print_line(
            f"friction coefficient {found.coefficient:.4f} +- {found.uncertainty:.1g}, "
            f"from {found.stations} stations of Phase B"
        )
        if found.passes is not None and not found.passes.consistent:
            terminal.print_line(f"friction: {consistency_line(found.passes)}")
        friction = found.coefficient
    for one in passes:
        check_support(one.support._replace(friction=friction), one.beam, signed=True)
    return [one.with_friction(friction) for one in passes]
