"""Commands with arguments and options that are nonsense, or extreme, and with their own files."""

from typer.main import get_command

from compare.commands.main import app
from tests.fuzz.inputs.dice import NUMBERS, WORDS, Dice
from tests.fuzz.inputs.sound import good_csv, outputs
from tests.fuzz.inputs.trial import Trial


def options(dice: Dice) -> Trial:
    """Any command with any options."""
    known = get_command(app).commands
    name = dice.pick(*known, *known, "fly", "--help", "--version")
    words = [name]
    files = {"file": b"", "good.csv": good_csv(), "short.csv": good_csv()[:300]}
    usual = ("catenary", "parabola", "good.csv", "short.csv", "file", ".", "resolution",
             "nowhere.toml", "/dev/zero", "good.csv/")  # fmt: skip
    extreme = (*(n for n in NUMBERS if len(n) < 30), "9" * 5000, "/proc/x/y", "/dev/full")
    if name in known:
        for parameter in known[name].params:
            option = parameter.opts[0]
            if not option.startswith("-"):
                given = dice.pick(*usual, *usual, dice.pick(*WORDS))
                words += [given] * dice.pick(1, 1, 1, 0, 2)
            elif dice.chance(0.3):
                valued = not getattr(parameter, "is_flag", False)
                value = dice.pick("out", *usual, dice.pick(*WORDS), dice.pick(*extreme))
                words += [option, value] if valued else [option]
    if dice.chance(0.1):
        words.append(dice.pick("--help", "--version", "--nonsense", *WORDS))
    # What would be right, and take long, must have one thing wrong at least.
    if name in ("run", "view"):
        words += ["--stations", dice.pick("1", "-5", "1e3", "99999999999999999999", "x")]
    if name == "study":
        words.append("--dry-run")
    return Trial("options", words, files)


def written(dice: Dice) -> Trial:
    """What the commands themselves have written, damaged since."""
    files = dict(outputs())
    for name in dice.some(sorted(files), 2) or [sorted(files)[0]]:
        files[name] = dice.damaged(files[name])
    for name in dice.some(sorted(files), 1) if dice.chance(0.2) else []:
        del files[name]
    words = dice.pick(["report", "runs"], ["report", "runs", "--out", "page"],
                      ["report", "small"], ["study", "small/study.toml", "--dry-run"],
                      ["compare", "runs/one/analytic.parquet", "runs/one/mujoco-chain.parquet"],
                      ["compare", "runs/one/written.csv", "runs/one/mujoco-chain.parquet"],
                      ["reconstruct", "runs/one/mujoco-chain.parquet"],
                      ["calibrate", "runs/one/mujoco-chain.parquet", "parabola"],
                      ["reconstruct", "runs/one/written.csv"],
                      ["report", "runs/one"],
                      ["compare", "catenary", "runs/one/mujoco-chain.parquet",
                       "runs/one/analytic.parquet"])  # fmt: skip
    return Trial("written", words, files)
