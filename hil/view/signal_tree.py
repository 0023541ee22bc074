"""All signals that the scope can record, in a tree with a search; ticked signals are recorded."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final

from nicegui import events, ui

from hil.view.probes import is_words, pin_number

#: CHOICE: the most matches that a search shows; with more, a user types on.
MOST: Final = 60
GROUP: Final = "group "
#: Beginnings of names, and the group that they stand in; the rest are variables of the firmware and registers.
_GROUPS: Final = {
    "face ": "Parts", "world ": "World", "gate ": "Gates", "duty ": "PWM outputs", "edges ": "Encoders",
    "ADCIN": "Analog inputs",
}  # fmt: skip


def path_to(name: str, label: str, blocks: Iterable[str]) -> tuple[str, ...]:
    """The groups of a signal, from the outermost on, and its name there."""
    for begin, group in _GROUPS.items():
        if name.startswith(begin):
            return (group, label if begin == "ADCIN" else label.removeprefix(begin))
    if is_words(name):
        return ("Buses and serial lines", label)
    if pin_number(name) >= 0:
        return ("Pins", label) if label != name else ("Pins", "free", label)
    first, _, rest = name.partition(".")
    if first in blocks:
        register, _, field = rest.rpartition(".")
        return ("Registers", first, register, field) if register else ("Registers", first, rest)
    return ("Variables", first, rest) if rest else ("Variables", name)


class Branch:
    """A group, or a signal; a register is both."""

    def __init__(self, key: str, title: str) -> None:
        self.key = key
        self.title = title
        self.signal = False
        self.branches: dict[str, Branch] = {}

    def node(self, opened: Callable[[str], bool]) -> dict[str, Any]:
        """The node for Quasar; a group that was never opened has only a placeholder in it."""
        made: dict[str, Any] = {"id": self.key, "label": self.title}
        if not self.signal:
            made |= {"noTick": True, "selectable": False}
        if self.branches:
            shown = self.branches.values() if opened(self.key) else [*self.branches.values()][:1]
            made["children"] = [each.node(opened) for each in shown]
        return made


def tree_of(labels: Mapping[str, str], blocks: Sequence[str]) -> Branch:
    """All signals."""
    root = Branch("", "")
    known = set(blocks)
    for name, label in labels.items():
        at, way = root, path_to(name, label, known)
        for depth, title in enumerate(way):
            key = name if depth == len(way) - 1 else GROUP + " ".join(way[: depth + 1])
            if way[0] == "Registers" and depth == 2:
                key = ".".join(way[1:3])  # a register: its fields stand in it
            at = at.branches.setdefault(title, Branch(key, title))
        at.signal = True
    return root


def found(labels: Mapping[str, str], words: str) -> dict[str, str]:
    """The signals that have each of some words in their label, those that begin with them first."""
    wanted = words.lower().split()
    hits = [name for name, label in labels.items() if all(word in label.lower() for word in wanted)]
    hits.sort(key=lambda name: (not labels[name].lower().startswith(wanted[0]), len(name)))
    return {name: labels[name] for name in hits[:MOST]}


class SignalTree:
    """The tree; `on_ticked(name, on)` is called when a signal is ticked or unticked."""

    def __init__(self, on_ticked: Callable[[str, bool], None]) -> None:
        self._on_ticked = on_ticked
        self._labels: Mapping[str, str] = {}
        self._blocks: Sequence[str] = ()
        self._root = Branch("", "")
        self._ticked: list[str] = []
        self._opened: list[str] = []
        with ui.row().classes("items-center gap-2 w-full no-wrap"):
            self._search = (
                ui.input("add a signal", placeholder="search: a variable, register, pin ...", on_change=self._look)
                .props("dense clearable stack-label debounce=200").style("flex:1 1 0").mark("signal")
            )  # fmt: skip
            self._all = ui.button("all signals", on_click=self._unfold).props("no-caps dense flat").mark("all-signals")
        self._box = ui.column().classes("w-full gap-0 signals")
        with self._box:
            self._tree = ui.tree([], tick_strategy="strict", on_tick=self._tick, on_expand=self._expand)
            self._tree.on("update:selected", self._pick)
            self._tree.props('dense no-connectors selected="" no-nodes-label="no such signal"')
        self._box.visible = False

    def offer(self, labels: Mapping[str, str], blocks: Sequence[str]) -> None:
        """Offer these signals."""
        self._labels, self._blocks = labels, blocks
        self._root = tree_of(labels, blocks)
        self._draw()

    def show(self, names: Sequence[str]) -> None:
        """Show which signals are recorded."""
        if list(names) != self._ticked:
            self._ticked = list(names)
            self._tree.props["ticked"] = list(names)

    def _unfold(self) -> None:
        self._box.visible = not self._box.visible

    def _look(self) -> None:
        self._box.visible = bool(self._search.value)
        self._draw()

    def _draw(self) -> None:
        words = str(self._search.value or "").strip()
        if words:
            hits = tree_of(found(self._labels, words), self._blocks)
            nodes = [each.node(lambda _key: True) for each in hits.branches.values()]
            self._tree.props["expanded"] = _keys(nodes)
        else:
            nodes = [each.node(self._opened.__contains__) for each in self._root.branches.values()]
            self._tree.props["expanded"] = list(self._opened)
        self._tree.props["nodes"] = nodes

    def _expand(self, e: events.ValueChangeEventArguments[list[str]]) -> None:
        if not self._search.value:
            self._opened = list(e.value)
            self._draw()

    def _tick(self, e: events.ValueChangeEventArguments[list[str]]) -> None:
        wanted, before = set(e.value), set(self._ticked)
        for name in [*before - wanted, *wanted - before]:
            if name in self._labels or name in before:
                self._on_ticked(name, name in wanted)

    def _pick(self, e: events.GenericEventArguments) -> None:
        name = str(e.args)
        if name in self._labels:
            self._on_ticked(name, name not in self._ticked)


def _keys(nodes: Iterable[Mapping[str, Any]]) -> list[str]:
    return [key for node in nodes for key in (node["id"], *_keys(node.get("children", ())))]
