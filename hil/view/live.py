"""Content that changes many times a second.

For each element that changes, the browser renders every element of the page.  This content goes into its own element.
"""

from __future__ import annotations

from nicegui.element import Element


class LiveHtml(Element, component="live.js"):
    """HTML, or the inside of another `tag`, that changes many times a second."""

    def __init__(self, content: str = "", *, tag: str = "div") -> None:
        super().__init__()
        self._props |= {"content": content, "tag": tag}

    @property
    def content(self) -> str:
        """What is shown.  It is sent when it changes."""
        return str(self._props["content"])

    @content.setter
    def content(self, content: str) -> None:
        if content == self.content:
            return
        with self._props.suspend_updates():
            self._props["content"] = content  # for a page that is mounted later
        self.run_method("show", content)
