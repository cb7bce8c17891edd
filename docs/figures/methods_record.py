"""What the findings say of the methods to find the contact, from the tables that they left."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from analytic import InputError
from analytic.problem.files import regular_file
from compare.show.numbers import short
from compare.show.style import PHASE_LETTERS

_COLUMNS = ("case", "readings", "method", "noise", "phase", "contacts", "answered", "median")
_LARGEST = 10_000_000  # bytes of a table; one of all methods has 20,000
_WELL = 1e-2  # L; a contact that is found so well on the median is of use
_EXACT = 1e-6  # L; what no sensor can see
_MOST = 0.9  # share of the contacts that must have an answer


@dataclass(frozen=True)
class MethodsRecord:
    """A table of `docs.figures.methods`, and its picture."""

    folder: Path  # where they are
    case: str  # whose readings the methods were given
    table: pd.DataFrame  # as `method_errors` has it, with columns ``case`` and ``readings``

    @property
    def readings(self) -> list[str]:
        """What the readings are of, in order."""
        return list(dict.fromkeys(self.table["readings"]))

    @property
    def methods(self) -> list[str]:
        """Names of the methods, in order."""
        return list(dict.fromkeys(self.table["method"]))

    @property
    def levels(self) -> list[float]:
        """Levels of noise, ascending."""
        return sorted(self.table["noise"].unique().tolist())

    def survivors(self, readings: str, noise: float) -> list[str]:
        """Methods that find nearly all contacts of every phase to 1 % of the length."""
        found = []
        for method in self.methods:
            rows = self._rows(method, readings, noise)
            good = (rows["median"] <= _WELL) & (rows["answered"] >= _MOST)
            if len(rows) and good.all():
                found.append(method)
        return found

    def _rows(self, method: str, readings: str, noise: float) -> pd.DataFrame:
        table = self.table
        here = (table["method"] == method) & (table["readings"] == readings)
        return table[here & (table["noise"] == noise) & (table["contacts"] > 0)]


def read_methods(folder: Path) -> list[MethodsRecord]:
    """All tables of `docs.figures.methods` in the folders of `folder`."""
    return sorted((_read(file) for file in folder.glob("*/methods.csv")), key=lambda one: one.case)


def method_sentences(record: MethodsRecord) -> str:
    """Which method survives which readings, and what noise does."""
    least, *noisy = record.levels
    said = []
    for readings in record.readings:
        found = record.survivors(readings, least)
        said.append(f"{readings}: {', '.join(found) if found else 'none'}")
    text = [
        f"These methods have an answer to at least {_MOST:.0%} of the contacts of each phase, half "
        f"of them within {short(_WELL)} L, {_level(least)}. {'; '.join(said)}."
    ]
    first = record.readings[0]
    for level in noisy:
        best = [
            f"{PHASE_LETTERS[phase]} {row['method']} ({short(row['median'])})"
            for phase, row in _best(record.table, first, level)
        ]
        if best:
            text.append(
                f"{_level(level).capitalize()} the best on {first} readings: {', '.join(best)}."
            )
    return " ".join(text)


def _level(noise: float) -> str:
    return "without noise" if noise == 0 else f"at {100 * noise:g} % of noise"


def _best(table: pd.DataFrame, readings: str, noise: float) -> list[tuple[str, dict[Any, Any]]]:
    """By phase, the row of the method of the least median among those that nearly always answer."""
    rows = table[(table["readings"] == readings) & (table["noise"] == noise)]
    rows = rows[(rows["answered"] >= _MOST) & rows["median"].notna()].sort_values("median")
    return [
        (str(phase), group.to_dict("records")[0])
        for phase in ("tip", "tangent")
        for group in [rows[rows["phase"] == phase]]
        if len(group)
    ]


def _read(file: Path) -> MethodsRecord:
    try:
        regular_file(file, "file", _LARGEST)
        table = pd.read_csv(file)
        numbers = ("noise", "contacts", "answered", "median")
        whole = set(_COLUMNS) <= set(table) and len(table) > 0
        if whole and table["phase"].isin([*PHASE_LETTERS]).all():
            table = table.astype(dict.fromkeys(numbers, float))
            return MethodsRecord(file.parent, str(table["case"].iloc[0]), table)
        fault = "without its columns"
    except (OSError, ValueError) as error:
        fault = " ".join(str(error).split())[:160]
    raise InputError(
        f"file {file}",
        fault,
        "a table of `docs.figures.methods`",
        "make it again, or remove its folder",
    )
