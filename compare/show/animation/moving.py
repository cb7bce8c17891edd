"""Pictures of what moves in a figure, over what stands still in it."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from PIL import Image


def pictures(
    canvas: Any,  # noqa: ANN401  # matplotlib does not type what is used of it
    moving: Sequence[Artist],
    show: Callable[[int], None],
    stations: Iterable[int],
    advance: Callable[[], None],
    dpi: int,
) -> Iterator[Image.Image]:
    """A picture of each station; what stands still is drawn once.

    Parameters
    ----------
    canvas : FigureCanvasAgg
        Of the figure.
    moving : sequence of Artist
        What differs from station to station, the lowest first.
    show : callable
        Puts them where they are at a station.
    stations : iterable of int
        Their numbers.
    advance : callable
        Called after every picture.
    dpi : int
        Pixels an inch.

    Yields
    ------
    Image
        In colour.
    """
    figure = canvas.figure
    figure.set_dpi(dpi)
    for artist in moving:
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    for station in stations:
        show(int(station))
        canvas.restore_region(still)
        for artist in moving:
            figure.draw_artist(artist)
        yield Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
        advance()
