"""A picture of a comparison: both paths, and each quantity of both runs against time."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hil.client.plot import save
from hil.recording.compare import QUANTITIES, PairedRuns, RecordedRun


def plot_comparison(path: Path, comparison: PairedRuns) -> None:
    """Draw a comparison and write it to `path` (PNG, SVG or PDF by its suffix).

    Runs without times are drawn against the number of the frame.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 8), layout="constrained")
    FigureCanvasAgg(figure)
    halves: Any = figure.subfigures(1, 2, width_ratios=(5, 6))
    left, right = halves
    runs = (comparison.first, comparison.second)
    styles: tuple[dict[str, Any], ...] = (
        {"color": "tab:blue", "linewidth": 2.5, "alpha": 0.6},
        {"color": "tab:orange", "linewidth": 1.2},
    )
    plan = left.subplots()
    for run, style in zip(runs, styles, strict=True):
        xs, ys = [frame.x_mm / 1e3 for frame in run.frames], [frame.y_mm / 1e3 for frame in run.frames]
        plan.plot(xs, ys, label=run.name, **style)
        plan.plot(xs[-1], ys[-1], "o", color=style["color"])
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_xlabel("x (m)")
    plan.set_ylabel("y (m)")
    plan.set_title(f"odometry, aligned by {comparison.aligned_by}", fontsize="small")
    plan.legend(fontsize="small")
    timed = all(run.timed for run in runs)
    axes = right.subplots(len(QUANTITIES), 1, sharex=True)
    for axis, (name, unit, value) in zip(axes, QUANTITIES, strict=True):
        for index, (run, style) in enumerate(zip(runs, styles, strict=True)):
            axis.plot(_abscissa(comparison, run, index, timed), [value(frame) for frame in run.frames], **style)
        axis.set_ylabel(f"{name} ({unit})", fontsize="small")
        axis.tick_params(labelsize="x-small")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("time (s)" if timed else "frame")
    save(figure, path)


def _abscissa(comparison: PairedRuns, run: RecordedRun, index: int, timed: bool) -> list[float]:
    if timed:
        return [time - comparison.zero_s[index] for time in run.times_s]
    partners = [float(pair[0]) for pair in comparison.pairs]
    if index == 0 or len(partners) != len(run.frames):
        return [float(number) for number in range(len(run.frames))]
    return partners
