"""A rig's pass that cannot be: planted nonsense is refused, noise and drift are not."""

from functools import cache

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, InputError, Sweep, circle, solve_sweep
from analytic.from_clamp.noise import scatter
from compare.measure.repeats import repeats
from compare.read.nonsense import check_ahead, spikes
from compare.read.passes import look_at_passes, usable
from compare.read.rig_file import read_rig
from compare.show.passes import passes_summary, repeats_summary
from tests.compare.command import vibrissa

RIG = """
[beam]
length = 1.0
[columns]
foot_x = { column = "x" }
force_x = { column = "fx" }
force_y = { column = "fy" }
moment_z = { column = "mz" }
[passes]
free_before = BEFORE
free_after = AFTER
"""


@cache
def exact():
    case = Case(Beam(), circle(1.0, lowest=(0.0, 0.4)))
    start, stop = case.foot_x[[0, -1]]
    swept = solve_sweep(Case(Beam(), case.profile, Sweep(700, start + 0.3, stop - 0.3)))
    return np.stack([swept.values(name) for name in ("foot_x", *CLAMP_READINGS)])


def rig(folder, change=lambda x: x, before=0.2, after=0.2, kind="white", seed=0):
    """A pass with 1 % of noise, 3 % of drift and a zero, with something planted."""
    values, rng = exact().copy(), np.random.default_rng(seed)
    size = np.abs(values[1:]).max(axis=1, keepdims=True)
    noise = rng.standard_normal((3, values.shape[1]))
    if kind == "walk":
        noise = np.cumsum(noise, axis=1) / np.sqrt(values.shape[1])
    values[1:] += size * (0.01 * noise + 0.05 + 0.03 * np.linspace(0, 1, values.shape[1]))
    table = change(values).T
    lines = ["x,fx,fy,mz", *(",".join(f"{x:.6f}" for x in row) for row in table)]
    (folder / "pass.csv").write_text("\n".join(lines))
    text = RIG.replace("BEFORE", str(before)).replace("AFTER", str(after))
    (folder / "rig.toml").write_text(text)
    return [folder / "pass.csv"], read_rig(folder / "rig.toml")


@pytest.mark.parametrize("kind", [pytest.param("white", marks=pytest.mark.slow), "walk"])
def test_a_zero_is_handed_on_with_its_uncertainty(tmp_path, kind):
    """In the middle of the pass the line of two stretches has 1/sqrt(2) of the error of one.

    Noise and drift are no fault, and have no spikes.
    """
    size, errors = np.abs(exact()[1:]).max(axis=1), []
    for seed in range(12):
        (one,) = usable(look_at_passes(*rig(tmp_path, kind=kind, seed=seed)))
        assert one.dropped["spikes"] == 0  # nor where it snaps off and grows ever faster
        middle = exact().shape[1] // 2
        stated = np.array([*one.readings.provenance["zero_uncertainty"].values()])
        line = size * (0.05 + 0.03 * middle / (exact().shape[1] - 1))
        errors.append((one.taken[:, middle] - line) / stated)
        left = np.stack([one.readings.values(name) for name in CLAMP_READINGS]) - exact()[1:]
        assert (np.abs(left).mean(axis=1) < 0.03 * size).all()
    assert 0.1 < np.mean(np.square(errors)) < (1.2 if kind == "white" else np.inf)
    assert not spikes(exact()[1:]).any()


def test_without_a_free_stretch_a_column_has_the_zero_that_is_stated(tmp_path):
    files, described = rig(tmp_path, before=0.0, after=0.0)
    text = (tmp_path / "rig.toml").read_text().replace('"fy"', '"fy", zero = 0.5, gain = 2.0')
    (tmp_path / "rig.toml").write_text(text)
    read, stated = (
        look_at_passes(files, one)[0].readings.values("force_y")
        for one in (described, read_rig(tmp_path / "rig.toml"))
    )
    np.testing.assert_allclose(stated, 2 * (read - 0.5), atol=1e-12)
    for before, left in ((0.0, True), (0.2, False)):
        passes = look_at_passes(*rig(tmp_path, before=before, after=0.0))
        said = " ".join(map(str, passes_summary(passes, [])))
        assert ("no zero is taken off: state free_before" in said) == left


@pytest.mark.parametrize(
    ("values", "noise"),
    [
        (np.zeros(50), 0.0),
        (np.ones(50), 1e-14),
        (np.linspace(0, 1, 200).round(1), 0.1 / np.sqrt(12)),
    ],
)
def test_what_is_rounded_off_is_noise(values, noise):
    """Of a tenth of an interval most rows are as the one before: no noise was seen."""
    assert scatter(values) == pytest.approx(noise)


@pytest.mark.parametrize("share", [0.005, 0.02, 0.05])
def test_a_coarse_converter_is_no_channel_that_is_stuck(tmp_path, share):
    """A force that hardly changes while another does was called saturated, of 2 % steps."""
    step = share * np.abs(exact()[1:]).max(axis=1, keepdims=True)

    def rounded(values):
        rng = np.random.default_rng(3)
        quiet = exact()[1:] + 0.1 * step * rng.standard_normal((3, 1)) + 0.3 * step
        return np.vstack([values[:1], np.round(quiet / step) * step])

    (one,) = usable(look_at_passes(*rig(tmp_path, rounded)))
    for known in ("free_noise", "zero_uncertainty"):  # to a step at best
        stated = np.array([*one.readings.provenance[known].values()])
        assert np.all(stated >= 0.99 * step[:, 0] / np.sqrt(12))


def test_passes_of_other_units_are_named(tmp_path):
    """Of a thousandth of the size: "4 passes say the same", for no place of the foot differed."""
    rig(tmp_path)
    milli = (tmp_path / "pass.csv").rename(tmp_path / "milli.csv")
    rows = np.loadtxt(milli, delimiter=",", skiprows=1) * [1, 1e-3, 1e-3, 1e-3]
    np.savetxt(milli, rows, "%.9f", ",", header="x,fx,fy,mz", comments="")
    files, described = rig(tmp_path, seed=1)
    with pytest.raises(InputError, match=r"of milli at most 1\.0e-03 times as large as of pass"):
        usable(look_at_passes([*files, milli], described))


def lines(folder, several):
    """A file of passes with a column that distinguishes them."""
    rows = [f"{k},{line}" for k, one in enumerate(several) for line in one]
    (folder / "pass.csv").write_text("\n".join(["k,x,fx,fy,mz", *rows]))
    text = (
        (folder / "rig.toml").read_text().replace("[passes]\nfree", '[passes]\ncolumn = "k"\nfree')
    )
    (folder / "rig.toml").write_text(text)
    return [folder / "pass.csv"], read_rig(folder / "rig.toml")


def test_a_reading_of_another_unit_or_sign_in_one_pass_is_named(tmp_path):
    """Of 10^10, or of the other sign: "2 passes say the same", for the others did."""
    rig(tmp_path)
    rows = np.loadtxt(tmp_path / "pass.csv", delimiter=",", skiprows=1)
    for factor in (1e3, -1.0):
        several = [[",".join(map(str, row)) for row in rows * [1, x, 1, 1]] for x in (1, factor)]
        passes = look_at_passes(*lines(tmp_path, several))
        if factor > 0:
            with pytest.raises(InputError, match=r"force_x = of pass-1 at most 1\.0e-03 times"):
                usable(passes)
        else:
            found = repeats([one.readings for one in usable(passes)])
            said = " ".join(str(getattr(one, "said", "")) for one in repeats_summary(found))
            assert "but force_x differs by" in said


def test_no_pass_is_lost_without_a_word(tmp_path):
    """Rows of a pass that is too short counted nowhere, and of two of one name one was left."""
    rig(tmp_path)
    rows = (tmp_path / "pass.csv").read_text().splitlines()[1:]
    files, described = lines(tmp_path, [rows, rows[:3], rows])
    first, second = look_at_passes(files, described)
    assert (first.rows, second.rows) == (703, 700)
    assert first.dropped["of_too_short_passes"] == 3
    (tmp_path / "pass-2.csv").write_text("\n".join(["k,x,fx,fy,mz", *(f"0,{x}" for x in rows)]))
    with pytest.raises(InputError, match=r"two that are called pass-2.*rename"):
        look_at_passes([*files, tmp_path / "pass-2.csv"], described)


def times(of_foot, of_moment=1):
    return lambda values: values * [[of_foot], [1], [1], [of_moment]]


def saturated(values):
    return np.vstack([values[:2], np.minimum(values[2:3], 0.8 * values[2].max()), values[3:]])


def stuck(values):
    values[3, 250:330] = values[3, 250]
    return values


def jumped(row, by):
    return lambda values: values + by * (np.arange(values.shape[1]) >= row) * [[1], [0], [0], [0]]


def test_a_channel_that_is_late_over_a_gap_is_no_clock_that_jumps():
    """Four rows late force_y does not jump where the foot does, but the others do."""
    even = np.linspace(0, 0.8, 320)
    foot_x = even + 0.2 * (even > 0.5)

    def seen(place):
        noise = np.random.default_rng(1).standard_normal((3, len(place)))
        slope, start = np.array([[0.3], [1.0], [0.8]]), np.array([[2.0], [0.1], [2.0]])
        return start + slope * place + 1e-4 * noise

    late = seen(foot_x)
    late[1, 4:] = late[1, :-4]
    for values in (seen(foot_x), late):
        check_ahead(foot_x, values, "pass")
    with pytest.raises(InputError, match=r"jump by \+0\.2.*ahead"):
        check_ahead(foot_x, seen(even), "pass")


def without_contact(values):
    rng = np.random.default_rng(7)
    values[1:] = 0.05 + 0.01 * rng.standard_normal(values[1:].shape)
    return values


def two_units(values):
    values[1:, 350:] *= 1e-3
    return values


@pytest.mark.parametrize(
    ("change", "stretches", "why"),
    [
        (np.asarray, (9.0, 0.2), r"passes.free_before = 9, of a pass .*shorter than the pass"),
        (np.asarray, (0.7, 0.2), r"passes.free_before = 0.7, of which pass is loaded from about 0"),
        (np.asarray, (0.2, 1.0), r"passes.free_after = 1, of which pass is loaded from about 0"),
        (lambda x: x[:, :500], (0.2, 0.05), "passes.free_"),
        (saturated, (0.2, 0.2), r"force_y = .* rows of pass: it saturates"),
        (stuck, (0.2, 0.2), r"moment_z = .* over 80 rows of pass: it is stuck"),
        (jumped(250, -0.2), (0.2, 0.2), r"foot_x = a jump by -0\.2.* ahead, while"),
        (jumped(350, 0.15), (0.2, 0.2), r"foot_x = a jump by \+0\.14.* back.*\[passes\] column"),
        (without_contact, (0.2, 0.2), "pass = under load at 0 rows: .* touches no object"),
        (lambda x: x[:, ::-1], (0.2, 0.2), "pass = to the right by foot_x, .* reverse its rows"),
        (two_units, (0.2, 0.2), r"changes 0\.001\d* times between them: .* has two units"),
        (lambda x: x[:, :1], (0.2, 0.2), r"1, of which 1 to a pass: must be 5 or more"),
        (times(0), (0.2, 0.2), r"foot_x of .*pass.csv = -?0 in all rows.* its column, unit"),
        (times(1e4), (0.2, 0.2), r"foot_x of .*pass.csv = over 2.* lengths of the vibrissa"),
        (times(1, 1e9), (0.2, 0.2), r"moment_z of measured, pass = up to .*e\+09 .* 6 decades"),
    ],
)  # fmt: skip
def test_nonsense_is_refused(tmp_path, change, stretches, why):
    with pytest.raises(InputError, match=why) as found:
        usable(look_at_passes(*rig(tmp_path, change, *stretches)))
    assert "\n" not in str(found.value)


def test_a_refused_pass_has_a_picture_and_leaves_the_others_as_they_are(tmp_path):
    (file,), described = rig(tmp_path)
    (tmp_path / "good.csv").write_text(file.read_text())
    rig(tmp_path, stuck)
    faults = {one.name: one.fault for one in look_at_passes([tmp_path], described)}
    assert faults["good"] is None
    assert "is stuck" in str(faults["pass"])
    done = vibrissa("rig", file, "--rig", "rig.toml", "--out", "out", cwd=tmp_path)
    done.refused("is stuck")
    assert (tmp_path / "out" / "pass.png").stat().st_size > 10_000
    assert not (tmp_path / "out" / "pass.parquet").exists()


CELLS = [(300,), (0,), (699,), (300, 302), (300, 301, 303)]


@pytest.mark.parametrize(
    ("channel", "size", "rows"),
    [
        *((2, 0.15, rows) for rows in ((300,), (300, 301, 302), (30,))),
        *((channel, 9999999.0, rows) for channel in (0, 2) for rows in CELLS),
    ],
)
def test_spikes_are_left_out_and_counted_wherever_they_are(tmp_path, channel, size, rows):
    """One cell of 9999999 was kept: a fit found a foot that jitters by a tenth of the length.

    At an end, beside another or without a number beside it it stayed, and of foot_x the line said
    that a free stretch had one row.
    """

    def spiked(values):
        step = np.arange(len(rows)) if size > 1 else 0.0
        values[channel, list(rows)] += size * max(1.0, np.abs(values[channel]).max()) + step
        values[3, [299, 304]] = np.nan
        return values

    one, *_ = look_at_passes(*rig(tmp_path, spiked))
    assert one.fault is None
    assert one.dropped["without_foot_x" if channel == 0 else "spikes"] == len(rows)
    if channel:
        assert not np.isfinite(one.readings.values("force_y")[list(rows)]).any()
    assert np.nanmax(np.abs(one.readings.table.to_numpy())) < 100


def test_what_a_table_is_not_is_said(tmp_path):
    files, described = rig(tmp_path)
    text = files[0].read_text()
    files[0].write_text(text.replace(".", ","))
    with pytest.raises(InputError, match=r"8 cells for 4 names.*its commas divide cells"):
        look_at_passes(files, described)
    german = text.replace(",", ";").replace(".", ",")
    files[0].write_text(german.replace("\n0,4", "\n1.000,4", 1))
    with pytest.raises(InputError, match=r"'1\.000,4.*without a separator of thousands"):
        look_at_passes(files, described)
    files[0].write_text(german)
    (tmp_path / "other.xlsx").write_bytes(b"PK\x03\x04")
    with pytest.raises(InputError, match=r"other\.xlsx.*export it as text"):
        look_at_passes([tmp_path], described)
    files[0].write_bytes(b"PK\x03\x04" + bytes(range(256)))
    with pytest.raises(InputError, match=r"a workbook.*CSV"):
        look_at_passes(files, described)


def test_channels_of_zeros_are_named_without_a_warning(tmp_path):
    files, described = rig(tmp_path, lambda values: values * [[1.0], [0.0], [0.0], [0.0]])
    assert "touches no object" in str(look_at_passes(files, described)[0].fault)
