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


def states(*models):
    return {row.state for row in record.verify(sources(*models))}


def test_there_are_sources_enough():
    given = record.sources()
    assert len(given) >= 12
    assert sum(one.get("contact", False) for one in given) >= 6
    rows = [{**one, **row} for one in given for row in one["row"]]
    assert all(row["why"] for row in rows if "within" in row or row.get("open"))


def test_quick_sources_hold():
    assert "differs" not in states(*QUICK)


@pytest.mark.slow
def test_all_sources_hold(tmp_path):
    done = vibrissa("verify", "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 0, done.stdout
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


def test_a_source_of_another_rigidity_differs():
    (source,) = sources("pressed")
    given = dict(source["given"], rigidity=1.2 * source["given"]["rigidity"])
    assert "differs" in {row.state for row in record.verify([{**source, "given": given}])}


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
    assert states("self_buckling") == {"differs"}


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
    assert "differs" in states(model)


@pytest.mark.parametrize("reading", ["force_x", "force_y", "moment_z", "contact_arc_length"])
def test_a_wrong_reading_of_the_solver_differs(reading, monkeypatch):
    true = contacts.solve_contact

    def wrong(*given, **named):
        table = true(*given, **named)
        table[reading] *= 1.001
        return table

    monkeypatch.setattr(contacts, "solve_contact", wrong)
    assert "differs" in states("level", "tangential", "peg")


def test_the_exit_code_says_what_differs(tmp_path, monkeypatch):
    wrong = sources("level")[0] | {"row": [{"what": "A", "value": "A", "quoted": "1.4"}]}
    monkeypatch.setattr(record, "sources", lambda: [wrong])
    done = vibrissa("verify", cwd=tmp_path)
    assert done.returncode == 1
    assert "differs: Todd 1975, A: 1.4, here 1.31" in done.stdout


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
