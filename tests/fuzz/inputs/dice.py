"""What people, and mishaps, write: numbers, quantities, words, and files damaged since."""

import numpy as np

NUMBERS = (
    "0", "-0.0", "1", "-1", "2.5", "1e-320", "1e308", "-1e308", "1e999", "nan", "inf", "-inf",
    "99999999999999999999", "9" * 5000, "0x" + "f" * 5000, "1_000", "0.5", "1e-9", "3", "true",
    "false", "[]", "{}", "[1, 2]", "[[1, 2], [3]]", '""', "1979-05-27T07:32:00Z", "1e150", "1e-150",
    "-9223372036854775809", "0b1", "1e5", "[true, false]", "[0.001, nan]", "{ from = 1 }",
)  # fmt: skip
QUANTITIES = (
    '"1 m"', '"50 mm"', '"1 parsnip"', '"1 kg"', '"0 m"', '"m"', '"-1 m"', '"1e400 m"',
    '"9**9**9 m"', '"m**9**9"', '"((((1 m"', '"1 m)"', "'\"\"\"'", '"1 m/0"', '"1 m^-1"',
    '"' + "(" * 3000 + '"', '"' + "m*" * 3000 + 'm"', '"1 degC"', '"1 __import__(\'os\')"',
    '"5 5 m"', '"1 m\\n2 m"', '"\\u0000"', '"1 km*"', '"1e5"', '"½ m"', '"1 µm"', '"1,5 m"',
    '"1 m²"', '"1 1/m"', '"2 /m"', '"1 dB"', '"1 m m/m"', '"٣ m"', '"1e-3 km"', '"1 N m^2"',
)  # fmt: skip
WORDS = (
    "", "catenary", "x", "-", "--", ".", "..", "/", "../../../x", "a/b", "a\\b", "nul\x01", "é",
    "[bold]", "[/b]", "$$", "%s", "{0}", "<script>", "name with blanks", "x" * 300, "\n", "\udcff",
    "chain", "rod", "cable", "mesh", "primitive", "auto", "1", "0.5", "-1", "nan", "1e400",
    "~", "$HOME", "\u202e", "é" * 99, "x" * 5000, "con", "{{ 7 * 7 }}", "`id`",
)  # fmt: skip


class Dice:
    """Chance, the same for the same seed and number."""

    def __init__(self, seed: int, number: int) -> None:
        self.rng = np.random.default_rng([seed, number])

    def pick(self, *choices):
        return choices[self.rng.integers(len(choices))]

    def some(self, choices, most: int) -> list:
        count = self.rng.integers(0, min(most, len(choices)) + 1)
        return [choices[i] for i in self.rng.choice(len(choices), count, replace=False)]

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def below(self, most: int) -> int:
        return int(self.rng.integers(most))

    def number(self) -> float:
        """Of any size, and of either sign."""
        return float(self.rng.standard_normal() * 10.0 ** self.rng.integers(-12, 12))

    def text(self) -> str:
        """A word as TOML writes it."""
        word = self.pick(*WORDS)
        written = word.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{written}"'.replace("\x01", "\\u0001")

    def value(self) -> str:
        """Whatever may stand in TOML behind an equals sign."""
        drawn = self.pick(*NUMBERS), self.pick(*QUANTITIES), self.text(), f"{self.number():g}"
        return self.pick(*drawn)

    def nudged(self, written: str) -> str:
        """Another number where there is one: somewhat, or much, larger or smaller."""
        try:
            number = float(written)
        except ValueError:
            return self.value()
        return f"{number * 10.0 ** self.pick(-4, -1, -0.1, 0.1, 0.5, 1, 3) * self.pick(1, 1, -1):g}"

    def toml(self, tables: dict[str, dict[str, str]]) -> str:
        """Tables as a file has them; now and then with a line twice."""
        lines = []
        for name, table in tables.items():
            lines += [f"[{name}]"] if name else []
            lines += [f"{key} = {value}" for key, value in table.items()]
        if self.chance(0.05):
            lines.insert(self.below(len(lines)), self.pick(*lines))
        return "\n".join(lines)

    def damaged(self, content: bytes) -> bytes:
        """Cut off, with flipped bytes, with a piece twice, or with junk in it."""
        if not content:
            return content
        at = self.below(len(content))
        match self.below(6):
            case 0:
                return content[:at]
            case 1:
                changed = bytearray(content)
                for i in self.rng.integers(0, len(content), self.rng.integers(1, 20)):
                    changed[i] = self.rng.integers(256)
                return bytes(changed)
            case 2:
                return content[:at] + content[max(0, at - 100) :]
            case 3:
                return content[:at] + bytes(200) + content[at:]
            case 4:
                junk = self.pick(
                    b"null", b"[]", b'{"a": [', b"NaN", b"\xff\xfe", b'"', b"-1", b"{}", b"1e999"
                )
                return content[:at] + junk + content[at + len(junk) :]
        return self.pick(b"", b"{}", b"[]", b"null", b"0", content[at:])
