"""Colours, names, symbols and units: the same in every picture.

The colours are Okabe and Ito's: every kind of colour vision distinguishes them, and so does print.
"""

from typing import NamedTuple

INK, PAPER = "#000000", "#ffffff"
GREY, FAINT, BODY = "#555555", "#999999", "#dddddd"
BLUE, ORANGE, GREEN, PINK = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
YELLOW, SKY = "#e69f00", "#56b4e9"

REFERENCE, CANDIDATE = INK, PINK
SERIES = (BLUE, ORANGE, GREEN, PINK, YELLOW, SKY)
"""For lines that have no colour of their own, in this order."""
LINE_STYLES = ("-", "--", ":", "-.")
"""For lines that may lie on each other."""

PHASE_COLOURS = {"free": FAINT, "tip": BLUE, "tangent": ORANGE}
PHASE_LETTERS = {"free": "free", "tip": "A", "tangent": "B"}
PHASE_NAMES = {"free": "free", "tip": "A: tip contact", "tangent": "B: tangential contact"}

READING_COLOURS = {"force_x": BLUE, "force_y": ORANGE, "moment_z": GREEN}
READING_MARKERS = {"force_x": "o", "force_y": "s", "moment_z": "^"}
SYMBOLS = {name: name for name in READING_COLOURS} | {"contact_arc_length": "$s_1$"}
UNITS = dict.fromkeys(("force_x", "force_y"), "$EI/L^2$")
UNITS |= {"moment_z": "$EI/L$", "contact_arc_length": "$L$"}
FOOT = "foot_x / $L$"


class Along(NamedTuple):
    """What is said of a column over which sweeps run."""

    axis: str
    at: str  # of one place
    name: str
    places: str


ALONG = {
    "foot_x": Along(FOOT, "foot at {} L", "foot position", "Foot positions / L"),
    "clamp_angle": Along(
        r"clamp angle $\beta$ / rad", "clamp at {} rad", "clamp angle", "Clamp angles / rad"
    ),
    "travel": Along("travel / $L$", "foot {} L on its way", "travel", "Travel / L"),
}

SMALL, NORMAL, LARGE = 9, 10, 11
"""Sizes of text in points."""
PAGE_WIDTH = 9.0
"""Of a picture across the page, in inches."""

_LONGEST = 60  # characters of a name; more would leave no room for the picture


def axis_label(name: str) -> str:
    unit = UNITS[name]
    return f"{SYMBOLS[name]} / {f'({unit})' if '/' in unit else unit}"


def label(text: object) -> str:
    """A user's name as matplotlib may draw it."""
    line = " ".join("".join(c if c.isprintable() else " " for c in str(text)).split())
    if len(line) > _LONGEST:
        line = line[: _LONGEST - 1] + "…"
    return (" " + line if line.startswith("_") else line).replace("$", r"\$")
