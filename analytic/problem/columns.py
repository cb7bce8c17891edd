"""The columns of a sweep's readings, by name, and the words in two of them."""

CLAMP_READINGS = ("force_x", "force_y", "moment_z")
SENSED = ("foot_x", *CLAMP_READINGS)
CONTACT = ("contact_angle", "contact_arc_length", "contact_x", "contact_y", "tip_angle")
PHASES = ("free", "tip", "tangent")
STATUSES = (
    "ok",
    "unsettled",
    "diverged",
    "unreachable",
    "chattering",
    "lost",
    "touches again",
    "sticks",
)
COLUMNS = (*SENSED, "phase", *CONTACT, "status")
WORDS = {"phase": PHASES, "status": STATUSES}
"""The columns of words, with what may stand in them."""
PHASE_NUMBER = {word: number for number, word in enumerate(PHASES)}
STATUS_NUMBER = {word: number for number, word in enumerate(STATUSES)}
