"""Case files and studies whose tables hold what they should not, and files that are hardly TOML."""

import numpy as np

from tests.fuzz.inputs.dice import WORDS, Dice
from tests.fuzz.inputs.sound import PROFILES, body, good_csv
from tests.fuzz.inputs.trial import Trial

KEYS = {
    "beam": ("length", "flexural_rigidity", "radius", "radis", "natural_curvature", "tip_radius"),
    "support": ("rotational_stiffness", "stiffness"),
    "contact": ("friction", "mu"),
    "motion": ("speed", "timestep", "integrator", "damping_ratio", "solver", "cone"),
    "uncertainty": ("flexural_rigidity", "length", "radius", "foot_x", "force_x", "noise"),
    "profile": ("kind", "a", "c", "radius", "lowest", "semi_axes", "points", "scale", "file",
                "right_radius", "left_radius", "height", "axes", "offset", "hull", "tolerance"),
    "sweep": ("stations", "start", "stop", "direction"),
    "mujoco": ("beam", "segments", "contour_points", "contact_stiffness", "corner_radius",
               "clamp", "obstacle", "tolerance", "planar", "springs"),
    "tolerances": ("rms", "max", "snap_off", "force_x", "nonsense"),
}  # fmt: skip


def case(dice: Dice) -> Trial:
    """A case file with a few faults, or with numbers that are extreme."""
    tables = sound_tables(dice)
    for _ in range(dice.rng.integers(0, 4)):
        _spoil(dice, tables)
    text = dice.toml(tables).encode(errors="surrogateescape")
    words = ["run", "case.toml", "--out", "out", "--stations", dice.pick("4", "7")]
    if dice.chance(0.25):
        words += ["--sweep-only", "--segments", "8"]
    else:
        words += ["--engine", "exact", *dice.some(["--certified"], 1)]
    return Trial("case", words, {"case.toml": text, "body.stl": body()})


def toml(dice: Dice) -> Trial:
    """Files that are hardly TOML: deep, large, cut off, in another encoding."""
    whole = dice.toml(sound_tables(dice))
    deep = int(dice.pick(10, 100, 1000, 100_000))
    text = dice.pick(
        whole + "\nx = " + "[" * deep + "]" * deep,
        whole + "\nx = " + "{a=" * deep + "1" + "}" * deep,
        ".".join(["a"] * deep) + " = 1\n" + whole,
        "[" + ".".join(["a"] * deep) + "]\n",
        whole + "\n[tolerances." + ".".join(["a"] * deep) + "]\nx = 1\n",
        "".join(f"[a{'.a' * i}]\n" for i in range(min(deep, 1000))) + whole,
        whole.replace("\n", "\r"),
        whole.replace("\n", "\r\n"),
        whole + "\nx = " + "9" * 5000,
        whole + '\nx = """open',
        "".join(f"k{i} = 1\n" for i in range(deep)) + whole,
        whole + "\n[profile]\n" + "".join(f"k{i} = {{ a = 1 }}\n" for i in range(deep)),
        '[profile]\nkind = "points"\npoints = [\n'
        + "".join(f"[{x}, {x * x + 0.4}],\n" for x in np.linspace(-1, 1, min(deep, 3000)))
        + "]\n[beam]\nradis = 1\n",
    )
    content = text.encode()
    if dice.chance(0.2):
        content = text.encode(dice.pick("utf-16", "utf-8-sig", "utf-32"))
    if dice.chance(0.3):
        content = dice.damaged(content)
    command = dice.pick(["run", "case.toml", "--engine", "exact", "--stations", "4"],
                        ["study", "case.toml", "--dry-run"],
                        ["compare", "good.csv", "good.csv", "--tolerances", "case.toml"],
                        ["reconstruct", "good.csv", "--beam", "case.toml"],
                        ["calibrate", "good.csv", "case.toml"],
                        ["compare", "case.toml", "good.csv", "more.csv"])  # fmt: skip
    return Trial(
        "toml", command, {"case.toml": content, "good.csv": good_csv(), "more.csv": good_csv()}
    )


def study(dice: Dice) -> Trial:
    """Study files, planned only."""
    named = dice.pick("catenary", "catenary", "parabola", *WORDS[:8])
    tables = {"study": {"case": f'"{named}"', "beams": dice.pick("[]", '["chain"]')}}
    for key in dice.some(("name", "beams", "record", "keep_readings", "timeout", "zip"), 2):
        tables["study"][key] = dice.value()
    axes = [f"{table}.{key}" for table, keys in KEYS.items() for key in keys]
    usual = ["profile.a", "beam.radius", "sweep.stations", "mujoco.segments"]
    wanted = dice.some([*usual, *usual, *axes, "noise.relative", "noise.seed", "x", "a.b.c"], 4)
    tables["axes"] = {key: _axis(dice) for key in wanted}
    for name in dice.some(("sample", "noise", "beam", "sweep", "mujoco", "nonsense"), 2):
        key = dice.pick("count", "seed", "relative", "length", "stations", "segments")
        tables[name] = {key: dice.value()}
    text = dice.toml(tables).encode(errors="surrogateescape")
    words = ["study", "grid.toml", "--dry-run", *dice.pick([], [], ["--workers", "3"])]
    return Trial("study", words, {"grid.toml": text})


def sound_tables(dice: Dice) -> dict[str, dict[str, str]]:
    """A sound case file: its tables, their keys and values as they are written."""
    profile = dict(line.split(" = ", 1) for line in dice.pick(*PROFILES).splitlines())
    sound = {"": {}, "profile": profile, "beam": {"length": "1.0"}, "mujoco": {"segments": "8"}}
    if dice.chance(0.3):
        sound["beam"]["natural_curvature"] = dice.pick("-0.5", "0.3", "[[0, 0], [1, -0.4]]")
    if dice.chance(0.3):
        sound["beam"] |= {"radius": "0.01", "tip_radius": dice.pick("0.004", "0.0005")}
    if dice.chance(0.2):
        sound["support"] = {"rotational_stiffness": "8.0"}
    if dice.chance(0.2):
        sound["contact"] = {"friction": "0.3"}
    return sound


def _spoil(dice: Dice, tables: dict[str, dict[str, str]]) -> None:
    """Change a value, or add or remove a key or a table."""
    name, other = dice.pick(*tables), dice.pick(*KEYS)
    match dice.below(10):
        case 0 | 1:
            if tables[name]:
                tables[name][dice.pick(*tables[name])] = dice.value()
        case 2 | 3 | 4:
            if tables[name]:
                key = dice.pick(*tables[name])
                tables[name][key] = dice.nudged(tables[name][key])
        case 5:
            if tables[name]:
                del tables[name][dice.pick(*tables[name])]
        case 6:
            tables[""]["name"] = dice.text()
        case 7:
            tables.setdefault(other, {})[dice.pick(*KEYS[other])] = dice.value()
        case 8:
            tables[name][dice.pick(*KEYS[other])] = dice.value()
        case 9:
            points = dice.rng.standard_normal((dice.below(9), 2)) * 10.0 ** dice.pick(-3, 0, 0, 3)
            written = ", ".join(f"[{x:.4g}, {y:.4g}]" for x, y in points)
            tables["profile"] = {"kind": dice.pick('"polygon"', '"points"'),
                                 "points": f"[{written}]"}  # fmt: skip


def _axis(dice: Dice) -> str:
    few = ", ".join(dice.value() for _ in range(dice.rng.integers(0, 3)))
    ends = f"from = {dice.value()}, to = {dice.value()}"
    return dice.pick(dice.value(), f"[{few}]", f"{{ {ends}, count = {dice.value()} }}",
                     "{ from = 0.2, to = 0.4, count = 1000000000 }",
                     "{ from = 0.2, to = 0.4, count = 3 }", f"{{ {ends} }}",
                     "[0.001, 0.002]", '{ from = 1, to = 2, spacing = "log" }')  # fmt: skip
