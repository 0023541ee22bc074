"""A notice: what was wrong with an entry, or what came of it, in the page below the controls that it is about."""

from __future__ import annotations

from nicegui import ui


class Notice(ui.label):
    """A line of text that covers nothing; it takes no room while there is nothing to say."""

    def __init__(self) -> None:
        super().__init__()
        self.classes("notice w-full").props("role=status")
        self.tell("")

    def tell(self, text: str, *, wrong: bool = True) -> None:
        """Replace the text; empty: nothing is to be said.  `wrong`: an entry was refused."""
        if self.text != text:
            self.text = text
        self.classes(add="wrong" if wrong else "", remove="" if wrong else "wrong")
        self.visible = bool(text)
