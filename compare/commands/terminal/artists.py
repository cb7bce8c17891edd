"""Matplotlib's artists without the lists of their properties, for commands.

It writes one into the docstrings of each kind as it loads: a fiftieth of a run, which nobody reads.
"""

import matplotlib.artist


def _none(artist: object) -> str:
    return ""


matplotlib.artist.kwdoc = _none
