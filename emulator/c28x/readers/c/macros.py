"""The definition of a macro: name, parameters, and body, prepared for its use (ISO/IEC 9899:1999, 6.10.3)."""

from __future__ import annotations

from dataclasses import dataclass, field

from emulator.c28x.readers.c.tokens import NAME, PUNCT, Token, spelled
from emulator.c28x.tree import Where


@dataclass(slots=True, eq=False)
class Macro:
    """A macro's definition."""

    name: str
    #: None: object-like.
    parameters: tuple[str, ...] | None
    #: The last parameter takes all remaining arguments, including the commas.
    variadic: bool
    body: list[Token]
    token: Token
    #: It is `__FILE__` or `__LINE__`: the text depends on the place of use.
    special: bool = False
    #: The pieces of the body; `#` and `##` are already interpreted.
    pieces: list[Piece] = field(default_factory=list)
    joins: bool = False

    @property
    def where(self) -> Where:
        """The place of its name in the `#define`."""
        return self.token.where

    def same(self, other: Macro) -> bool:
        """Whether a second definition is the same (6.10.3)."""
        return (
            self.parameters == other.parameters and self.variadic == other.variadic
            and spelled(self.body) == spelled(other.body)
        )  # fmt: skip


@dataclass(slots=True)
class Piece:
    """One token of the body of a macro; `parameter` is the index of a parameter, or -1."""

    token: Token
    parameter: int
    string: bool = False
    joins_left: bool = False
    joins_right: bool = False


def definition(name: Token, line: list[Token]) -> Macro:
    """The macro that the `#define` in `line` defines.  Raises SourceError."""
    if name.text == "defined":
        raise name.error("defined cannot be the name of a macro")
    parameters: tuple[str, ...] | None = None
    variadic = False
    start = 3
    if len(line) > 3 and line[3].text == "(" and not line[3].space:
        parameters, variadic, start = _parameters(line)
    macro = Macro(name.text, parameters, variadic, line[start:], name)
    macro.pieces = _pieces(macro)
    macro.joins = any(piece.joins_left for piece in macro.pieces)
    return macro


def _parameters(line: list[Token]) -> tuple[tuple[str, ...], bool, int]:
    """The parameters of a `#define NAME(...)`, whether the last one takes the rest, and the index of the body."""
    names: list[str] = []
    known: set[str] = set()
    index = 4
    if len(line) > 4 and line[4].text == ")":
        return (), False, 5
    while index < len(line):
        token = line[index]
        following = line[index + 1].text if index + 1 < len(line) else ""
        if token.text == "..." and following == ")":
            return (*names, "__VA_ARGS__"), True, index + 2
        if token.kind != NAME:
            raise token.error(f"expected the name of a parameter, found {token.text[:40]!r}")
        if token.text in known:
            raise token.error(f"the macro has two parameters {token.text}")
        known.add(token.text)
        names.append(token.text)
        if following == ")":
            return tuple(names), False, index + 2
        if following == "..." and index + 2 < len(line) and line[index + 2].text == ")":
            return tuple(names), True, index + 3
        if following != ",":
            wrong = line[min(index + 1, len(line) - 1)]
            raise wrong.error(f"expected , or ) after the parameter {token.text}")
        index += 2
    raise line[3].error(f"the parameters of the macro {line[2].text} have no end: ) is missing")


def _pieces(macro: Macro) -> list[Piece]:
    """The pieces of the body of `macro`, with `#` and `##` interpreted.  Raises SourceError."""
    numbers = {name: number for number, name in enumerate(macro.parameters or ())}
    pieces: list[Piece] = []
    hash_token: Token | None = None
    join: Token | None = None
    for token in macro.body:
        if token.kind == PUNCT and token.text in ("##", "%:%:"):
            if not pieces or join is not None or hash_token is not None:
                raise token.error("## needs a token on each side")
            pieces[-1].joins_right = True
            join = token
            continue
        if macro.parameters is not None and token.kind == PUNCT and token.text in ("#", "%:") and hash_token is None:
            hash_token = token
            continue
        number = numbers.get(token.text, -1) if token.kind == NAME else -1
        if hash_token is not None and number < 0:
            raise hash_token.error("# needs a parameter of the macro after it")
        if token.text == "__VA_ARGS__" and number < 0:
            raise token.error("__VA_ARGS__ stands only in a macro whose parameters end in ...")
        piece = Piece(token, number, hash_token is not None, join is not None)
        if hash_token is not None:
            piece.token = Token(token.kind, token.text, hash_token.source, hash_token.at, hash_token.space)
        pieces.append(piece)
        hash_token = join = None
    wrong = hash_token or join
    if wrong is not None:
        raise wrong.error("# needs a parameter after it" if hash_token else "## needs a token on each side")
    return pieces
