"""Draws the worst activation of a task: which threads had the CPU from its release to its end, and other releases."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from textwrap import fill
from typing import Final

from hil.client.plot import save
from hil.rta.observe import NS_PER_CYCLE, Activation

_ABOVE: Final = "#9a9a9a"
_OTHER: Final = "#2a7ab8"
_OWN: Final = "#d99000"
_IN_GATE: Final = "#d33a2c"
_US: Final = NS_PER_CYCLE / 1000


def draw_moment(
    path: Path, moment: Activation, *, priorities: Mapping[str, int], gates: Mapping[str, str], computed_ns: int | None,
) -> None:  # fmt: skip
    """Draw an activation and write it to a file.

    The rows are interrupts, then tasks by falling priority.  `gates` are names that replace those of the kernel.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    above = sorted({part.who for part in moment.stretches if part.who not in priorities}, reverse=True)
    there = {part.who for part in moment.stretches} | {who for _, who in moment.releases} | {moment.task}
    tasks = sorted((name for name in priorities if name in there), key=lambda name: -priorities[name])
    rows = [*above, *tasks]
    figure = Figure(figsize=(10, 2.4 + 0.42 * len(rows)), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    for stretch in moment.stretches:
        begin = (max(stretch.begin, moment.ready) - moment.ready) * _US
        length = (stretch.end - moment.ready) * _US - begin
        row = rows.index(stretch.who)
        colour = _ABOVE if stretch.who in above else _OWN if stretch.who == moment.task else _OTHER
        axes.barh(row, length, left=begin, height=0.6, color=_IN_GATE if stretch.gate else colour)
    end = (moment.end - moment.ready) * _US
    for at, who in moment.releases:
        if who in rows:
            row = rows.index(who)
            axes.plot([(at - moment.ready) * _US] * 2, [row - 0.45, row + 0.45], color="black", linewidth=1.5)
    axes.axvline(end, color=_OWN, linestyle="--", linewidth=1)
    labels = [f"{name} ({priorities[name]})" if name in priorities else name for name in rows]
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    limit = end
    if computed_ns is not None:
        limit = max(end, computed_ns / 1000)
        axes.axvline(computed_ns / 1000, color="black", linestyle=":", linewidth=1)
    axes.set_xlim(-0.01 * limit, 1.02 * limit)
    axes.set_xlabel("microseconds since the release")
    bound = "no bound" if computed_ns is None else f"computed {computed_ns / 1000:.2f} us (dotted)"
    axes.set_title(f"{moment.task}: longest response seen {end:.2f} us (dashed), {bound}", fontsize="medium")
    axes.grid(axis="x", alpha=0.3)
    held = sorted({gates.get(part.gate, part.gate) for part in moment.stretches if part.gate})
    patches = [
        Patch(color="black", label="released"), Patch(color=_OWN, label=moment.task),
        Patch(color=_OTHER, label="another task"),
    ]  # fmt: skip
    if above:
        patches.append(Patch(color=_ABOVE, label="interrupt, Swi"))
    if held:
        patches.append(Patch(color=_IN_GATE, label=fill(f"in a gate: {', '.join(held)}", 60)))
    figure.legend(handles=patches, loc="outside lower center", ncols=len(patches), fontsize="small")
    save(figure, path, dpi=110)
