"""Pictures of what moves in a figure, over what stands still in it."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.text import Text
from PIL import Image


def pictures(
    canvas: Any,  # noqa: ANN401  # matplotlib does not type what is used of it
    moving: Sequence[Artist],
    heading: Text,
    show: Callable[[int], None],
    stations: Iterable[int],
    advance: Callable[[], None],
    dpi: int,
) -> Iterator[Image.Image]:
    """A picture of each station; what stands still is drawn once."""
    figure = canvas.figure
    figure.set_dpi(dpi)
    for artist in (*moving, heading):
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    headed: dict[str, Any] = {}
    for station in stations:
        show(int(station))
        said = heading.get_text()
        if said not in headed:
            canvas.restore_region(still)
            figure.draw_artist(heading)
            headed[said] = canvas.copy_from_bbox(figure.bbox)
        canvas.restore_region(headed[said])
        for artist in moving:
            figure.draw_artist(artist)
        pixels = canvas.buffer_rgba()
        high, wide, _ = pixels.shape
        yield Image.frombytes("RGB", (wide, high), pixels, "raw", "RGBX")  # all of it is opaque
        advance()
