"""Draws the picture of an entry: the measurements on the faithful firmware, with the entry's correction, and with all
corrections."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from hil.audit.run import DemonstrationOutcome
from hil.client.plot import save

#: The most points of a line that are drawn with markers.
MARKED: Final = 60


def save_picture(outcome: DemonstrationOutcome, file: Path) -> None:
    """Write the picture.  Raises ValueError if the entry has none."""
    sides = [("faithful", outcome.faithful), ("corrected", outcome.corrected), ("all corrected", outcome.all_corrected)]
    pictures = [(name, side.picture) for name, side in sides if side is not None and side.picture is not None]
    if not pictures:
        raise ValueError(f"{outcome.id} has no picture")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5 * len(pictures), 4.5), layout="constrained")
    plots = figure.subplots(1, len(pictures), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (name, picture) in zip(plots, pictures, strict=True):
        first, *others = picture.series
        axes.plot(first.x, first.y, label=first.label, marker="." if len(first.x) <= MARKED else None)
        for series in others:
            axes.plot(series.x, series.y, "--", label=series.label)
        axes.set(title=name, xlabel=picture.x_label, ylabel=picture.y_label)
        axes.grid(alpha=0.3)
        axes.legend()
        if picture.plane:
            axes.set_aspect("equal", adjustable="box")
    figure.suptitle(f"{outcome.id}: {pictures[0][1].title}")
    save(figure, file, dpi=100)
