"""`keyboard.is_pressed` from the app's own Tk windows: no root, no event device, no key of another program.

The original package asks the system for the state of a key.  Tk delivers events instead, and only while the app lets it
(``update``), which differs in three ways that are made good here:

* A key held down repeats; on X11 each repetition is a release and a press.  A release counts after `SETTLE_S`.
* A press is processed in ``update``, so it would always become visible at the same point of the app's loop.  A real
  key goes down at any time, mostly while the loop sleeps.  So a press becomes visible `DELAY_S` later, and not at the
  first query within `TURN_S`: on a busy machine, that one may follow its ``update`` late.
* A tap can begin and end within one ``update``.  It stays visible until it was asked for once, at most `TAP_S`.

Only `is_pressed` is here.  It sees every Tk window of this process, those of matplotlib too.
"""

from __future__ import annotations

import time
import tkinter
from dataclasses import dataclass
from typing import Any

#: CHOICE: longer than the time between the two events of one repetition, shorter than a keystroke.
SETTLE_S = 0.02
#: CHOICE: longer than a loop takes from its ``update`` to its first query (measured: about 1 ms).
DELAY_S = 0.02
#: CHOICE: longer than a busy machine keeps a program waiting between its ``update`` and its first query.
TURN_S = 0.25
#: CHOICE: the slowest loop of the thesis console queries once a second.
TAP_S = 1.2

#: Names of the original package -> Tk's key symbols.  Other keys: their character, or Tk's own symbol.
_SYMBOLS = {
    "esc": "escape", "enter": "return", "del": "delete", "ins": "insert", "page up": "prior", "page down": "next",
    "shift": "shift_l", "ctrl": "control_l", "alt": "alt_l",
}  # fmt: skip


@dataclass
class _Key:
    pressed_s: float
    released_s: float | None = None
    #: Whether a query has come since, and whether one has seen it.
    queried: bool = False
    seen: bool = False


_keys: dict[str, _Key] = {}


def is_pressed(hotkey: str) -> bool:
    """Whether a key (``up``, ``esc``, ``a``), or each of several (``ctrl+a``), is down."""
    names = hotkey.split("+") if len(hotkey) > 1 else [hotkey]
    down = [_is_down(name) for name in names]  # each is asked, whatever the others are
    return all(down)


def _is_down(name: str) -> bool:
    plain = name.strip().lower() or name
    key = _keys.get(_SYMBOLS.get(plain, plain))
    now = time.monotonic()
    if key is None:
        return False
    delay_s = DELAY_S if key.queried else TURN_S
    key.queried = True
    if now < key.pressed_s + delay_s:
        return False
    since_release_s = -1.0 if key.released_s is None else now - key.released_s
    if since_release_s >= SETTLE_S and (key.seen or since_release_s > TAP_S):
        return False
    key.seen = True
    return True


def _symbols(event: Any) -> set[str]:
    """What a key may be asked for by: Tk's symbol, and its character."""
    return {name.lower() for name in (event.keysym, event.char) if name}


def _pressed(event: Any) -> None:
    now = time.monotonic()
    for symbol in _symbols(event):
        key = _keys.get(symbol)
        if key is not None and (key.released_s is None or now < key.released_s + SETTLE_S):
            key.released_s = None  # a repetition
        else:
            _keys[symbol] = _Key(now)


def _released(event: Any) -> None:
    now = time.monotonic()
    for symbol in _symbols(event):
        key = _keys.get(symbol)
        if key is not None and key.released_s is None:
            key.released_s = now


def _left(_event: Any) -> None:
    """The keyboard goes elsewhere: its releases will not be heard here."""
    now = time.monotonic()
    for key in _keys.values():
        if key.released_s is None:
            key.released_s = now


def _listen(root: Any) -> None:
    root.bind_all("<KeyPress>", _pressed, add="+")
    root.bind_all("<KeyRelease>", _released, add="+")
    root.bind_all("<FocusOut>", _left, add="+")


_plain_init = tkinter.Tk.__init__


def _listening_init(self: tkinter.Tk, *arguments: Any, **options: Any) -> None:
    _plain_init(self, *arguments, **options)
    _listen(self)


# Each Tk() is an interpreter of its own, and matplotlib makes one for each figure.
tkinter.Tk.__init__ = _listening_init  # type: ignore[method-assign]
if (_root := getattr(tkinter, "_default_root", None)) is not None:
    _listen(_root)
