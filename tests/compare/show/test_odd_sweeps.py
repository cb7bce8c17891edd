"""Reports of what nobody would choose to report: whatever is compared, the page says what it is."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings
from compare import compare
from compare.show.figures.geometry import geometry
from compare.show.figures.readings import around_snap_off
from compare.show.plane_page import plane_tiles
from compare.show.report import summary_of
from tests.compare.show import sweeps
from tests.compare.show.pages import Page, written_page
from tests.compare.synthetic import NOTHING


def picked(stations: slice) -> tuple[Readings, Readings]:
    return tuple(
        replace(sweep, table=sweep.table.iloc[stations].reset_index(drop=True))
        for sweep in (sweeps.exact("catenary"), sweeps.candidate("catenary"))
    )


def with_gaps() -> tuple[Readings, Readings]:
    """Every third station of the candidate is missing, and so are its last ones."""
    sweep, station = sweeps.candidate("catenary"), np.arange(sweeps.STATIONS)
    table = sweep.table.copy()
    table.loc[(station % 3 == 0) | (station > 50), list(CLAMP_READINGS)] = np.nan
    return sweeps.exact("catenary"), replace(sweep, table=table)


def without_snap_off() -> tuple[Readings, Readings]:
    return tuple(
        replace(sweep, provenance={**sweep.provenance, "events": {}}) for sweep in picked(slice(40))
    )


def scaled() -> tuple[Readings, Readings]:
    """A vibrissa of 50 mm in millimetres and newtons."""

    def units(sweep: Readings) -> Readings:
        beam = replace(sweep.beam, length=50.0, flexural_rigidity=3e4, radius=0.25)
        factors = {"force_x": beam.force_unit, "force_y": beam.force_unit,
                   "moment_z": beam.moment_unit, "foot_x": 50.0}  # fmt: skip
        table = sweep.table[[*factors]] * factors
        return Readings(table, beam, sweep.source)

    return units(sweeps.exact("catenary")), units(sweeps.candidate("catenary"))


def oddly_named() -> tuple[Readings, Readings]:
    exact, found = sweeps.exact("catenary"), sweeps.candidate("catenary")
    return (
        replace(exact, source="_rig [/b] $$ $x_{$ \\frac <i>"),
        replace(found, source="ütö 触覚 \x00\n" + "long " * 100),
    )


ODD = {  # a few stations are those around the middle of the contact
    "two stations": lambda: picked(slice(30, 32)),
    "three stations": lambda: picked(slice(30, 33)),
    "eight stations": lambda: picked(slice(30, 38)),
    "gaps": with_gaps,
    "no snap-off": without_snap_off,
    "millimetres": scaled,
    "odd names": oddly_named,
    "no contact": lambda: (sweeps.exact("catenary"), sweeps.without_contact("catenary")),
    "to the right": lambda: tuple(sweep.mirrored() for sweep in picked(slice(None))),
}


@pytest.mark.parametrize("pair", ODD.values(), ids=ODD)
def test_page(pair):
    found = compare(*pair())
    page = Page(written_page(found))
    assert page.faults == []
    assert "nan" not in page.text.split("<body>")[1]
    for name in CLAMP_READINGS:
        assert name in page.text
    assert geometry(found).get_size_inches().max() <= 10
    if found.snap_off.reference is not None:
        low, high = around_snap_off(found, "force_x").axes[0].get_xlim()
        assert low < high


def test_units_are_those_of_the_beam():
    in_mm, plain = (written_page(compare(*pair)) for pair in (scaled(), picked(slice(None))))
    assert "= 50, forces in" in in_mm
    first_rows = [page.split('id="apart"')[1].split("</tr>")[0] for page in (in_mm, plain)]
    assert first_rows[0] == first_rows[1]


@pytest.mark.parametrize("made", NOTHING)
def test_nothing_is_said_of_nothing(made):
    """No table of NaN, and nothing that is alike but the three stations without contact."""
    found = compare(sweeps.exact("catenary"), made(sweeps.exact("catenary")))
    assert found.phases_alike() in (None, 3 / 60)
    blocks = [*summary_of(found)]
    assert not any("nan" in str(block).lower() for block in blocks)
    assert not any("relative to the largest" in getattr(block, "caption", "") for block in blocks)
    assert not any("disagreement" in tile.name for tile in plane_tiles(found))
