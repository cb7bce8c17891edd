"""The questions that a study answers, each by one number of its runs."""

from dataclasses import dataclass

from compare.study.show.results import WORST, StudyResults


@dataclass(frozen=True)
class Question:
    """A question and the number that answers it."""

    name: str  # what its pictures' files are called
    text: str  # as a heading
    metric: str  # A column of the runs
    number: str  # what a sentence calls the number
    label: str  # what a picture calls it
    limit: float | None = None  # A value that means something, which pictures draw
    least: float = 0.0  # pictures draw what is less at this: nobody can see the difference


QUESTIONS = (
    Question(
        "disagreement", "How far are the two models apart?", WORST,
        "the worst reading's disagreement", "worst reading's rms\n/ largest magnitude",
    ),
    Question(
        "snap-off", "How far is the snap-off shifted?", "snap_off_difference",
        "the shift of the snap-off", "shift of the snap-off [length]",
    ),
    Question(
        "slip-off", "How far is the slip-off shifted?", "slip_off_difference",
        "the shift of the slip-off", "shift of the slip-off [length]",
    ),
    Question(
        "leaving", "Where does the vibrissa slip off?", "event_slip_off",
        "the foot's way to the slip-off", "way to the slip-off [length]",
    ),
    Question(
        "reconstruction", "How well is the object reconstructed?", "reconstruction_rms",
        "the rms reconstruction error", "rms reconstruction error / $L$", least=1e-6,
    ),
    Question(
        "phase-b", "Where is there a Phase B?", "contact_length_minimum",
        "the least contact length", "least contact length / $L$", limit=1.0,
    ),
)  # fmt: skip


def asked(found: StudyResults) -> list[Question]:
    """Choose the questions that a study has an answer to."""
    chosen = []
    for question in QUESTIONS:
        if question.metric in found.done:
            sizes = found.done[question.metric].dropna().abs()
            # What differs by rounding alone does not depend on anything.
            if len(sizes) and sizes.max() > 0 and sizes.max() > (1 + 1e-9) * sizes.min():
                chosen.append(question)
    return chosen
