"""Comparisons in space: their verdicts, and the command with its exit codes."""

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from analytic import Beam, InputError
from analytic.space import (
    FootPath,
    SpatialCase,
    SpatialReadings,
    convex_mesh,
    solve_space,
    sphere,
)
from analytic.space.problem.readings import FORCE, MOMENT, SENSED_IN_SPACE
from compare import SpatialTolerances, assert_agreement, compare, measure_budget
from compare.align.frames import COMPONENTS, clamp_axes, components, from_frame
from compare.explain.budget import budget_in_space, changes_in_space
from compare.show.report import summary_of
from compare.show.spatial_page import spatial_verdict
from mujoco_models import SpatialSettings
from tests.compare.case_files import BALL, BALL_OF_50_MM, WIRE
from tests.compare.command import reported_again, vibrissa
from tests.conftest import exact_sweep

CASE = SpatialCase(
    body=sphere(1.0, (0.0, 1.4, 0.0)), path=FootPath([[1.1, 0.3], [0.2, 0.3]], stations=20)
)


def changed(readings, **columns):
    table = readings.table.assign(**columns)
    return SpatialReadings(table, readings.beam, readings.tangent, "other", readings.provenance)


def as_if_foreign(readings, **columns):
    """What another simulator writes: nine columns, no events."""
    table = readings.table[[*SENSED_IN_SPACE]].assign(**columns)
    return SpatialReadings(table, readings.beam, readings.tangent, "foreign")


@pytest.fixture(scope="module")
def exact():
    return solve_space(CASE)


def test_what_lacks_a_number_is_counted(exact):
    force = exact.values("force_x").copy()
    force[4:6] = np.nan
    found = compare(exact, as_if_foreign(exact, force_x=force))
    assert found.to_dict()["stations"]["status"]["candidate"] == {"ok": 18, "missing": 2}


def test_stations_without_a_number_are_no_end_of_the_contact(exact):
    """Its stations were a second touch, which led the verdict; a column of travel is not needed."""
    lacking = np.flatnonzero(exact.touching)[3]
    status = np.where(np.arange(20) == lacking, "diverged", "ok")
    found = compare(exact, as_if_foreign(exact, status=status))
    assert [one.name for one in found.exceeded] == ["stations"]
    assert "1 diverged, travel" in "".join(found.remarks)


def test_a_stage_has_a_last_digit(exact):
    """To 1e-4 L its stations are the case's; of others the line says how far they are off."""
    rounded = {n: exact.values(n).round(4) for n in ("foot_x", "foot_z")}
    assert compare(exact, as_if_foreign(exact, **rounded)).agrees
    with pytest.raises(InputError, match=r"up to 0\.9 L from"):
        compare(exact, as_if_foreign(exact, foot_x=exact.values("foot_x")[::-1]))


def test_a_sweep_agrees_with_itself_and_json_holds_it(exact):
    found = compare(exact, exact)
    assert found.agrees
    assert found.contact.max == 0
    assert found.phase_agreement == 1
    kept = json.loads(json.dumps(found.to_dict()))
    assert kept["verdict"] == "agrees"
    assert kept["stations"]["status"]["candidate"] == {"ok": 20}
    assert kept["tolerance_reasons"].keys() == kept["tolerances"].keys()


def test_nothing_is_said_of_contacts_that_are_not_there(exact):
    """Neither tiles nor a table of nothing; the stations that each sweep trusts are counted."""
    found = compare(exact, changed(exact, status="lost"))
    said = str([vars(block) for block in summary_of(found)])
    assert "contacts apart" not in said
    assert "nan" not in said
    assert "candidate 20 lost" in found.worst.found
    assert "over 0 stations" in spatial_verdict(found).said


def test_planted_differences_are_found_by_name(exact):
    softer = solve_space(replace(CASE, beam=Beam(flexural_rigidity=0.98)))
    softer = SpatialReadings(softer.table, exact.beam, exact.tangent, "softer", softer.provenance)
    found = compare(exact, softer)
    assert not found.agrees
    largest = max(one.max for one in found.disagreement.values())
    assert largest == pytest.approx(0.02, rel=0.02)
    turned = compare(exact, changed(exact, force_z=-exact.values("force_z")))
    assert {one.name for one in turned.exceeded} == {"force_z"}
    assert turned.worst.excess > 10
    assert "at" in turned.failures[-1]
    assert "L of the way" in turned.failures[-1]
    lost = changed(exact, status=exact.table["status"].mask(exact.touching, "unsettled"))
    found = compare(exact, lost)
    assert {"contact", "stations"} <= {one.name for one in found.exceeded}
    assert found.statuses["candidate"]["unsettled"] == exact.touching.sum()


def test_each_limit_is_the_one_that_fails(exact):
    """Half of what is found is too little, and twice as much is enough, limit by limit."""
    shift = changed(exact, contact_x=exact.values("contact_x") + 1e-3)
    late = dict(exact.provenance)
    late["events"] = [dict(e, travel=e["travel"] + 4e-3) for e in late["events"]]
    other = exact.table["phase"].replace({"tip": "tangent", "tangent": "tip"})
    part = other.where(np.arange(20) < 8, exact.table["phase"])
    for name, candidate, found in (
        ("contact", shift, 1e-3),
        ("event", SpatialReadings(exact.table, exact.beam, exact.tangent, "late", late), 4e-3),
        ("force_x.rms", changed(exact, force_x=exact.values("force_x") * 1.001), None),
    ):
        kind = name.partition(".")[0]
        size = found or compare(exact, candidate).disagreement[kind].rms
        for factor, agrees in ((0.5, False), (2.0, True)):
            limits = {name: size * factor} if found else {"special": {name: size * factor}}
            judged = compare(exact, candidate, SpatialTolerances(**limits))
            assert judged.agrees == agrees, name
    found = compare(exact, changed(exact, phase=part))
    assert [one.name for one in found.exceeded] == ["phases"]


def test_a_foreign_file_is_compared_by_its_clamp_alone(exact):
    found = compare(exact, as_if_foreign(exact))
    assert found.agrees
    assert found.contact.from_clamp == ("foreign",)
    assert found.contact.max < 1e-12
    assert found.phase_agreement is None
    (touch,) = found.events.values()
    assert abs(touch.difference) <= touch.uncertainty == pytest.approx(0.9 / 19 / 2)
    # What touches three stations late is found, though no event is recorded.
    late = exact.touching & (np.cumsum(exact.touching) > 3)
    columns = {n: np.where(late, exact.values(n), 0.0) for n in (*FORCE, *MOMENT)}
    found = compare(exact, as_if_foreign(exact, **columns))
    assert [one.name for one in found.exceeded] == ["touch"]


def with_noise(readings, share, seed, size=1.0):
    random = np.random.default_rng(seed)
    columns = {}
    for names in (FORCE, MOMENT):
        scale = share * np.nanmax(np.abs(readings.values(*names)))
        columns |= {n: size * readings.values(n) + random.normal(0, scale, len(readings.table))
                    for n in names}  # fmt: skip
    return as_if_foreign(readings, **columns)


@pytest.fixture(scope="module")
def passed():
    return solve_space(replace(CASE, path=FootPath([[1.3, 0.3], [-1.5, 0.3]], stations=60)))


@pytest.mark.slow
@pytest.mark.parametrize("share", [pytest.param(1e-3, marks=pytest.mark.slow), 1e-2])
def test_noise_neither_touches_nor_fails_what_agrees(passed, share):
    for seed in range(5):
        noisy = with_noise(passed, share, seed)
        for noise in (share, 0.0):
            found = compare(passed, noisy, noise=noise)
            names = {one.name for one in found.exceeded}
            assert not names & {"touch", "leaving", "touch 2", "leaving 2"}
        assert assert_agreement(passed, noisy, noise=share).compared.sum() >= 30
        assert not compare(passed, with_noise(passed, share, seed, 1.05), noise=share).agrees
    unwidened = compare(passed, with_noise(passed, 1e-2, 0))
    assert not unwidened.agrees  # a limit is widened only by noise that is stated or asked for
    auto = compare(passed, with_noise(passed, share, 0), noise="auto")
    assert 0.5 * share < auto.noise.level["force_x"] < 3 * share


def test_a_touch_that_is_late_is_found_beside_noise(passed):
    noisy = with_noise(passed, 1e-3, 0)
    late = passed.touching & (np.cumsum(passed.touching) > 6)
    columns = {n: np.where(late, noisy.values(n), noisy.values(n) - passed.values(n))
               for n in (*FORCE, *MOMENT)}  # fmt: skip
    columns = {n: np.where(passed.touching, v, noisy.values(n)) for n, v in columns.items()}
    found = compare(passed, as_if_foreign(passed, **columns), noise=1e-3)
    assert "touch" in {one.name for one in found.exceeded}


def test_frames_turn_the_components_and_nothing_else(exact):
    tangent = np.array([0.3, 0.9, -0.2]) / np.linalg.norm([0.3, 0.9, -0.2])
    axes = clamp_axes(tangent)
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert np.allclose(axes[1], tangent)
    assert np.allclose(clamp_axes(np.array([0.0, -1.0, 0.0]))[1], [0, -1, 0])
    leaning = solve_space(replace(CASE, path=replace(CASE.path, tangent=tangent)))
    clamp, world = components(leaning, "clamp"), components(leaning)
    touching = leaning.touching
    assert np.abs(world["moment_y"][touching]).max() > 1e-2
    assert np.abs(clamp["moment_y"][touching]).max() < 1e-14  # nothing twists the vibrissa
    for names in (FORCE, MOMENT):
        sizes = [sum(x[n] ** 2 for n in names) for x in (world, clamp)]
        assert np.allclose(*sizes, rtol=1e-13, atol=1e-30)
    foreign = as_if_foreign(leaning, **clamp)
    assert not compare(leaning, foreign).agrees
    back = from_frame(foreign, "clamp")
    assert compare(leaning, back, frame="clamp").disagreement["moment_y"].max < 1e-14
    with pytest.raises(InputError, match="frame"):
        components(leaning, "tool")


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda a, _: compare(a, changed(a, foot_x=a.values("foot_x") + 0.1)), "the same foot pos"),
        (lambda a, _: SpatialTolerances(special={"force_w.rms": 1.0}), "force_w"),
        (
            lambda a, _: compare(a, replace(a, beam=Beam(flexural_rigidity=2.0))),
            "vibrissae of the two",
        ),
        (lambda a, _: compare(a, replace(a, tangent=(0.1, 1, 0))), "tangent"),
        (lambda a, _: compare(a, a, offset=0.1), "offset"),
        (lambda a, b: compare(a, b), r"candidate = a \w*Readings: must be"),
        (lambda a, b: compare(b, a), r"candidate = a \w*Readings: must be"),
        (lambda _, b: compare(b, b, frame="clamp"), "frame"),
    ],
)
def test_what_cannot_be_compared_is_refused(exact, made, said):
    """Sweeps in space that are not of one way, and one in space with one in the plane."""
    with pytest.raises(InputError, match=said):
        made(exact, exact_sweep("catenary"))


def test_the_gate_raises_with_every_limit(exact):
    assert assert_agreement(exact, exact).agrees
    with pytest.raises(AssertionError, match="moment_z: rms"):
        assert_agreement(exact, changed(exact, moment_z=1.01 * exact.values("moment_z")))
    with pytest.raises(InputError, match="noise"):
        assert_agreement(exact, exact, noise=1.5)


@pytest.mark.parametrize(("segments", "stiffness"), [(40, 1e7), (300, 1e9)])
def test_planted_parts_are_found(exact, segments, stiffness):
    """Off by 2/N^2, by 1e-3 for its contact and, planted, by 1e-3: each is found."""

    def sweep(settings):
        size = 1 + 2 / settings.segments**2 + 1e-3 * stiffness / settings.contact_stiffness + 1e-3
        columns = {name: size * exact.values(name) for name in (*FORCE, *MOMENT)}
        return changed(exact, **columns)

    changes = changes_in_space(SpatialSettings(segments=segments, contact_stiffness=stiffness))
    found = budget_in_space(exact, {name: sweep(one) for name, one in changes.items()}, changes)
    assert found.stations == exact.touching.sum()
    assert (found.closes, found.undecided) == (False, segments == 300)
    planted = {"discretisation": 2 / segments**2, "softness": 1e-3, "unexplained": 1e-3}
    for name in COMPONENTS:
        share = found.disagreement[name] / (2 / segments**2 + 2e-3)
        for part, size in planted.items():
            assert found.parts[part][name].rms == pytest.approx(size * share, rel=1e-9)


@pytest.mark.slow
def test_the_parts_are_mostly_the_discretisation():
    found, _ = measure_budget(CASE, SpatialSettings(segments=10))
    most = {name: max(one.rms for one in part.values()) for name, part in found.parts.items()}
    assert most["discretisation"] == pytest.approx(max(found.disagreement.values()), rel=0.3)
    assert most["unexplained"] < 0.5 * most["discretisation"]
    assert most["softness"] < 1e-4


@pytest.mark.slow
def test_the_command_compares_and_ends_with_the_right_code(tmp_path, request):
    """The first report of a run, and the first of files, are drawn."""
    text = (
        f"{BALL}"
        "[path]\npoints = [[1.1, 0.3], [0.2, 0.3]]\nstations = 20\n[mujoco]\nsegments = {}\n"
    )

    def runs(segments, code, says):
        (tmp_path / "case.toml").write_text(text.format(segments))
        out = f"of-{segments}"
        vibrissa("run", "case.toml", "--film", "--out", out, cwd=tmp_path).ended(code, says)

    def compares(*arguments):
        return vibrissa("compare", *arguments, "--out", "again", cwd=tmp_path)

    runs(40, 0, "agrees with")
    for name in ("report.html", "comparison.json", "components.png", "contacts.png"):
        assert (tmp_path / "of-40" / name).stat().st_size > 100
    with Image.open(tmp_path / "of-40" / "animation.gif") as film:
        assert film.n_frames == 20
    # What was saved compares as another simulator's text file does.
    saved = SpatialReadings.read(tmp_path / "of-40" / "mujoco-chain.parquet")
    foreign = saved.table[[*SENSED_IN_SPACE]].rename(columns={"force_x": "Fx", "foot_x": "X"})
    foreign.to_csv(tmp_path / "other.txt", sep=";", index=False)
    named = ("case.toml", "other.txt", "--column", "force_x=Fx", "--column", "foot_x=X")
    compares(*named).ended(0, "agrees with")
    assert (tmp_path / "again" / "contacts.png").stat().st_size > 100
    request.getfixturevalue("undrawn")
    runs(3, 1, "disagrees with")
    stored = "of-40/analytic.parquet"
    compares(stored, "of-40/mujoco-chain.parquet").ended(0, "agrees with")
    compares(stored, "of-3/mujoco-chain.parquet").ended(1, "disagrees with")
    compares(*named, "--noise", "0.01").ended(0, "agrees with")
    compares("case.toml", "other.txt").refused("--column")
    compares(*named, "--noise", "2").refused("noise")
    compares("catenary", stored).refused("in space")
    for wrong in (["--engine", "drake"], ["--engine", "exact", "--budget"]):
        vibrissa("run", "case.toml", *wrong, cwd=tmp_path).refused()


RUN = f"""
{WIRE}{BALL_OF_50_MM}[path]
points = [["55 mm", "15 mm"], ["10 mm", "15 mm"]]
tangent = [0.1, 1, 0]
stations = 20
[mujoco]
segments = 10
[tolerances]
rms = {{ limit = 1e-3, reason = "stricter than ten segments are" }}
force_x.max = {{ limit = 0.3, reason = "for the controller" }}
"""


@pytest.mark.slow
def test_the_report_of_a_run_again(tmp_path, request):
    """Limits with their reasons, frame, parts, body and animation are those of the run."""
    (tmp_path / "case.toml").write_text(RUN)
    words = ("--film", "--budget", "--frame", "clamp", "--out", "out")
    done = vibrissa("run", "case.toml", *words, cwd=tmp_path)
    again = reported_again(done, tmp_path / "out", "report.html", "contacts.png")
    assert "disagrees with" in again.stdout
    body = convex_mesh(tmp_path / "out" / "body.ply", hull=True)
    apart = np.linalg.norm(body.vertices - [0, 0.07, 0], axis=1)
    assert apart.max() == pytest.approx(0.05, rel=1e-2)
    assert body.vertices[:, 1].min() == pytest.approx(0.02, rel=0.05)
    request.getfixturevalue("undrawn")  # those before were drawn
    # Without what the run wrote beside the sweeps there is a report, too.
    for name in ("comparison.json", "budget.json", "body.ply", "animation.gif"):
        (tmp_path / "out" / name).unlink()
    vibrissa("report", "out", cwd=tmp_path).ended(0)
    for name, content in (("body.ply", b"ply\n"), ("comparison.json", b'{"frame": "clamp"}')):
        (tmp_path / "out" / name).write_bytes(content)
        vibrissa("report", "out", cwd=tmp_path).refused(name)
