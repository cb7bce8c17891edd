"""What others printed: all of it holds, and planted errors are found."""

from dataclasses import replace

import numpy as np
import pytest

from analytic.space.checks import rod
from compare.verify import contacts, record, rods
from tests.compare.command import vibrissa

QUICK = ("tip_load", "column", "level", "tangential", "sliding_sleeve", "peg", "first_touch",
         "pressed", "elastica3d", "self_buckling")  # fmt: skip


def sources(*models):
    return [one for one in record.sources() if one["model"] in models]


def differs(*given):
    """The first row that does ends it."""
    return any(row.state == "differs" for row in record.verify(given))


def test_quick_sources_hold():
    assert not differs(*sources(*QUICK))


@pytest.mark.slow
def test_all_sources_hold(tmp_path):
    vibrissa("verify", "--out", tmp_path / "out", cwd=tmp_path).ended(0)
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"report.html", "verify.png", "verify.csv"}
    assert "Kynema" in (tmp_path / "out" / "report.html").read_text()


def test_digits_are_those_of_the_printed_number():
    (source,) = sources("tip_load")
    rows = list(record.verify([source]))
    assert {row.state for row in rows} == {"all digits"}
    assert [row.digits for row in rows[:2]] == [5, 4]
    wrong = dict(source["row"][0], quoted="0.30182")
    (row,) = record.verify([{**source, "row": [wrong]}])
    assert (row.state, row.digits) == ("differs", 3)


@pytest.mark.slow
def test_a_reason_that_is_computed_must_make_the_number():
    (source,) = (
        one for one in record.sources() if one["name"].startswith("Nachbagauer et al. 2011")
    )
    small = {**source, "row": source["row"][:2]}
    rows = list(record.verify([small]))
    assert [row.state for row in rows] == ["explained", "explained"]
    assert f"{rows[1].because:.8e}" == "8.09900305e-04"
    coarse = [{**row, "because": {"elements": 128}} for row in small["row"]]
    assert [row.state for row in record.verify([{**small, "row": coarse}])] == ["differs"] * 2


@pytest.mark.slow
def test_elements_have_the_rod_for_their_limit():
    given = 1.0, 0.1, 0.1, 1e6, 0.3, [0.0, -0.4, 0.3]
    rod, *coarse = (rods.rectangle(*given, elements=n)["y"] for n in (None, 8, 16, 32))
    missed = np.abs(np.array(coarse) - rod)
    assert np.log2(missed[:-1] / missed[1:]) == pytest.approx([2, 2], abs=0.05)


def test_two_by_two_cells_of_a_section_stiffen_its_torsion():
    """Saint-Venant's warping by biquadratic cells: what the Princeton beam's reason says."""
    height, width, cells = 12.3777e-3, 3.2024e-3, 2
    at = np.linspace(-0.5, 0.5, 2 * cells + 1)
    points, weights = np.polynomial.legendre.leggauss(3)
    shape = np.stack([points * (points - 1) / 2, 1 - points**2, points * (points + 1) / 2])
    slope = np.stack([points - 0.5, -2 * points, points + 0.5])
    places = np.arange(at.size**2).reshape(at.size, -1)
    stiff, load, polar = np.zeros((at.size**2,) * 2), np.zeros(at.size**2), 0.0
    half = np.array([height, width]) / cells / 2
    for i, j in np.ndindex(cells, cells):
        these = places[2 * i : 2 * i + 3, 2 * j : 2 * j + 3].ravel()
        for p, q in np.ndindex(3, 3):
            size = weights[p] * weights[q] * half.prod()
            y, z = (
                height * at[2 * i + 1] + half[0] * points[p],
                width * at[2 * j + 1] + half[1] * points[q],
            )
            along = np.outer(slope[:, p], shape[:, q]).ravel() / half[0]
            across = np.outer(shape[:, p], slope[:, q]).ravel() / half[1]
            stiff[np.ix_(these, these)] += size * (
                np.outer(along, along) + np.outer(across, across)
            )
            load[these] += size * (z * along - y * across)
            polar += size * (y**2 + z**2)
    constant = polar - load @ np.linalg.lstsq(stiff, load, rcond=None)[0]
    assert constant / 1.1340719e-10 == pytest.approx(1.0333, abs=5e-5)


def test_a_source_of_another_rigidity_differs():
    (source,) = sources("pressed")
    given = dict(source["given"], rigidity=1.2 * source["given"]["rigidity"])
    assert differs({**source, "given": given})


@pytest.mark.slow
def test_a_stiffer_rod_differs(monkeypatch):
    march = rod.Cantilever.march
    monkeypatch.setattr(
        rod.Cantilever,
        "march",
        lambda self, moment, load=1.0: march(
            replace(self, bending=0.999 * self.bending), moment, load
        ),
    )
    gerstmayr = [one for one in record.sources() if one["name"].startswith("Gerstmayr")]
    assert [row.state for row in record.verify(gerstmayr)][:2] == ["differs", "differs"]
    assert {row.state for row in record.verify(sources("self_buckling"))} == {"differs"}


@pytest.mark.parametrize("quantity", ["q", "C"])
def test_a_closed_form_off_by_a_millionth_differs(quantity, monkeypatch):
    true = rods.span

    def off(*given):
        loaded = true(*given)
        return loaded._replace(**{quantity: (1 + 1e-6) * getattr(loaded, quantity)})

    monkeypatch.setattr(rods, "span", off)
    assert differs(*sources("column"))


@pytest.mark.parametrize("model", ["tip_load", "column", "pressed", "elastica3d"])
def test_a_wrong_sign_in_the_closed_form_differs(model, monkeypatch):
    for module in (rods, contacts):
        true = module.frame
        monkeypatch.setattr(
            module, "frame", lambda s, a, f=true: f(s, a)._replace(across=-f(s, a).across)
        )
    true_span = contacts.tangent_span
    monkeypatch.setattr(
        contacts, "tangent_span", lambda a: true_span(a)._replace(C=-true_span(a).C)
    )
    assert differs(*sources(model))


@pytest.mark.parametrize("factor", [1 + 1e-6, pytest.param(np.nan, marks=pytest.mark.slow)])
@pytest.mark.parametrize("reading", ["force_x", "force_y", "moment_z", "contact_arc_length"])
def test_a_wrong_reading_of_the_solver_differs(reading, factor, monkeypatch):
    true = contacts.solve_contact

    def wrong(*given, **named):
        table = true(*given, **named)
        table[reading] *= factor
        return table

    monkeypatch.setattr(contacts, "solve_contact", wrong)
    assert differs(*sources("level", "tangential", "peg"))


def test_a_solver_that_gives_up_differs(tmp_path, monkeypatch):
    monkeypatch.setattr(contacts, "solve_space", lambda case: (_ for _ in ()).throw(IndexError))
    (source,) = sources("sliding_sleeve")
    monkeypatch.setattr(record, "sources", lambda: [source])
    done = vibrissa("verify", cwd=tmp_path)
    done.ended(1, "differs: Bigoni et al. 2013, past a sphere: M^2/2EI, here nan")


def test_the_exit_code_says_what_differs(tmp_path, monkeypatch):
    wrong = sources("level")[0] | {"row": [{"what": "A", "value": "A", "quoted": "1.4"}]}
    monkeypatch.setattr(record, "sources", lambda: [wrong])
    vibrissa("verify", cwd=tmp_path).ended(1, "differs: Todd 1975, A: 1.4, here 1.31")


def test_the_surplus_of_the_measured_force_is_no_offset():
    """Chi-squared of the axial readings after the best constant offset, on three."""
    (source,) = sources("pressed")
    axial = [row for row in source["row"] if row["value"] == "along"]
    stated = {0.05: 0.002, 0.10: 0.0013, 0.15: 0.00075, 0.20: 0.0014}
    surplus, weight = [], []
    for row in axial:
        made = contacts.pressed(**source["given"], **row["at"])["along"]
        surplus.append(float(row["quoted"]) - made)
        weight.append(stated[row["at"]["s"]] ** -2)
    left = np.array(surplus) - np.average(surplus, weights=weight)
    assert np.sum(np.array(weight) * left**2) == pytest.approx(22, abs=0.6)


def test_a_rod_that_does_not_come_to_rest_says_so(monkeypatch):
    monkeypatch.setattr(rod, "_MISSED", -1.0)
    with pytest.raises(ArithmeticError, match="misses its moment"):
        rods.rectangle(1.0, 0.1, 0.1, 1e6, 0.0, [0.0, -1.0, 0.0])


def test_a_slender_rod_is_the_elastica():
    found = rods.bend(1e9, 1e-9 * 180 / np.pi, 2.0, [1e16] * 3, [1.0] * 3)
    exact = rods.tip_load(2.0)
    assert found["w"] == pytest.approx(exact["w"], rel=1e-8)
    assert 1 - found["x"] == pytest.approx(exact["u"], rel=1e-7)
