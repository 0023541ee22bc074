"""Sets of flags in which two names are the same bit: `same-bit`.

    #define EVENT_START  Event_Id_02
    #define EVENT_STOP   Event_Id_02            // copied
    #define EVENT_ALL    (EVENT_TICK | EVENT_START | EVENT_STOP)

Who lists names with `|` takes them for different ones.  A name that is defined by the other one is the same on purpose.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from emulator.c28x.readers.c.macros import Macro
from emulator.c28x.readers.c.tokens import NAME, SourceRemark, Token, spelled

_ZERO = re.compile(r"0[xXbB]?0*[uUlL]*", re.ASCII)


def same_bits(macros: Mapping[str, Macro]) -> Iterator[SourceRemark]:
    """Remarks at the definitions of names that are the same as another one of their set."""
    told = set()
    defined = {name: number for number, name in enumerate(macros)}
    for whole in macros.values():
        first: dict[str, list[Macro]] = {}
        for name in sorted(_names(whole), key=lambda name: defined.get(name, 0)):
            macro = macros.get(name)
            if macro is None or macro.parameters is not None:
                continue
            text = _resolved(macro, macros)[1]
            same = first.setdefault(text, [])
            others = [other for other in same if other is not macro and not _alias(macro, other, macros)]
            same.append(macro)
            if not others or macro in told or _ZERO.fullmatch(text):
                continue
            told.add(macro)
            message = (
                f"{name} is {text}, and so is {others[0].name}: {whole.name} has both, and nobody can tell one from "
                "the other"
            )
            yield SourceRemark(macro.where, message, rule="same-bit", name=name)


def _names(whole: Macro) -> list[str]:
    """The names that a macro lists with `|`; none if it is no such list."""
    theirs = whole.parameters is None and not whole.token.source.file.startswith("<")
    tokens = _bare(whole.body) if theirs else []
    listed = len(tokens) > 2 and all((t.kind == NAME) if n % 2 == 0 else t.text == "|" for n, t in enumerate(tokens))
    return [token.text for token in tokens[::2]] if listed and len(tokens) % 2 else []


def _resolved(macro: Macro, macros: Mapping[str, Macro]) -> tuple[list[str], str]:
    """The names that a macro stands for, one after the other, and the text at their end."""
    chain = [macro.name]
    while True:
        tokens = _bare(macros[chain[-1]].body)
        if len(tokens) != 1 or tokens[0].text not in macros or tokens[0].text in chain:
            return chain, spelled(tokens)
        if macros[tokens[0].text].parameters is not None:
            return chain, spelled(tokens)
        chain.append(tokens[0].text)


def _alias(one: Macro, other: Macro, macros: Mapping[str, Macro]) -> bool:
    """Whether one of two macros is defined by the name of the other."""
    return other.name in _resolved(one, macros)[0] or one.name in _resolved(other, macros)[0]


def _bare(tokens: list[Token]) -> list[Token]:
    """Tokens without the parentheses around all of them."""
    while len(tokens) > 2 and tokens[0].text == "(" and tokens[-1].text == ")":
        depth = 0
        for token in tokens[:-1]:
            depth += {"(": 1, ")": -1}.get(token.text, 0)
            if depth == 0:
                return tokens
        tokens = tokens[1:-1]
    return tokens
