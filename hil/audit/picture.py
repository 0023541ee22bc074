"""The picture of an entry: what the demonstration measured on the faithful and on the corrected firmware."""

from __future__ import annotations

from pathlib import Path

from hil.audit.run import Outcome
from hil.client.plot import check_plot_file


def save_picture(outcome: Outcome, file: Path) -> None:
    """Write the picture.  Raises ValueError if the entry has none, or the file cannot be a picture."""
    check_plot_file(file)
    sides = [("faithful", outcome.faithful), ("corrected", outcome.corrected)]
    pictures = [(name, side.picture) for name, side in sides if side is not None and side.picture is not None]
    if not pictures:
        raise ValueError(f"{outcome.id} has no picture: its evidence is the finding")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6 * len(pictures), 4.5), layout="constrained")
    for i, (name, picture) in enumerate(pictures):
        axes = figure.add_subplot(1, len(pictures), i + 1)
        for series in picture.series:
            axes.plot(series.x, series.y, label=series.label)
        axes.set(title=f"{picture.title} ({name})", xlabel=picture.x_label, ylabel=picture.y_label)
        axes.grid(alpha=0.3)
        axes.legend()
    figure.suptitle(f"{outcome.id}: {outcome.defect.c_file}, {outcome.defect.function}")
    figure.savefig(file)
