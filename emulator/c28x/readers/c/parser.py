"""From tokens to a syntax tree: pycparser reads our own tokens, so that every node has its place.

    unit = preprocess("us.c")
    tree = parse(unit.tokens, typedefs={"Uint16"})

`coord` of every node is a `Where`.  pycparser is the extra `[c]`; it is imported when a file is parsed.

Extensions of TI's compiler to C99, in the tree:

* `interrupt`, `__interrupt`, `__attribute__((interrupt))`: "interrupt" in a declaration's `funcspec`;
* `cregister`: "cregister" in its `quals`;
* `asm("...")`, `__asm("...")`: a call of `__asm`, also at file scope;
* `far`, `near`, `__attribute__((...))`, `__extension__`: removed, because nothing on this chip depends on them;
* adjacent string literals: one Constant; its value contains them as they are written, separated by blanks.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.readers.c.tokens import BAD, CHAR, NAME, NUMBER, PUNCT, STRING, Token
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import SourceError

if TYPE_CHECKING:
    from pycparser import c_ast

#: Frames for the deepest file: about nine per bracket, three per `else if`.
_FRAMES: Final = 20_000


@dataclass(frozen=True)
class ParserLimits:
    """Limits of one translation unit.  C99 (5.2.4.1) requires 63 nested brackets and 127 nested blocks."""

    #: Tokens of the unit.  All of TI's headers for this chip together have about 150,000.
    tokens: int = 500_000
    #: Nested brackets of every kind.
    nesting: int = 400
    #: Nodes from the root to a leaf: a recursive walk over the tree needs so many levels.
    depth: int = 10_000


class NoParser(ValueError):
    """pycparser is not installed, or has a version that this reader does not know."""


def parse(
    tokens: Sequence[Token], *, typedefs: Collection[str] = (), limits: ParserLimits = ParserLimits()
) -> c_ast.FileAST:  # fmt: skip
    """The tree of a translation unit.

    `typedefs`: names of types that no token declares.  Raises SourceError for the first error, NoParser.
    """
    _within(tokens, limits)
    headers = None if typedefs or limits != ParserLimits() else _headers_of(tokens)
    if headers is None:
        grammar = _grammar(lexemes_of(tokens, limits), typedefs, limits)
    else:
        rest = lexemes_of(tokens[headers.tokens :], limits)
        grammar = _grammar([*headers.lexemes, *rest], typedefs, limits, headers)
    with reading(_FRAMES):
        return grammar.unit()


@dataclass(frozen=True)
class ParsedHeaders:
    """Headers of ours that a unit begins with: hundreds of declarations, half of the time for a short file."""

    tokens: int
    lexemes: list[Lexeme]
    tree: c_ast.FileAST
    #: The names of the file scope -> whether each is a type.
    names: dict[str, bool]


def _headers_of(tokens: Sequence[Token]) -> ParsedHeaders | None:
    """What `tokens` begin with, parsed once per process; None: no header of ours, or one that ends in a declaration."""
    own = takewhile(lambda token: (token.use or token).source.file.startswith("<"), tokens)
    run = _Run(list(own))
    return _parsed(run) if run.tokens and run.tokens[-1].text in (";", "}") else None


class _Run:
    """Tokens that are equal to others with the same texts at the same places."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self._key = tuple((t.text, t.at, t.source.file, t.use.at if t.use else None) for t in tokens)

    def __hash__(self) -> int:
        return hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Run) and self._key == other._key


@lru_cache(maxsize=16)
def _parsed(run: _Run) -> ParsedHeaders | None:
    limits = ParserLimits()
    try:
        lexemes = lexemes_of(run.tokens, limits)
        grammar = _grammar(lexemes, (), limits)
        with reading(_FRAMES):
            tree = grammar.unit()
    except SourceError:
        return None  # the error of the whole unit says more
    return ParsedHeaders(len(run.tokens), lexemes, tree, grammar.names)


def parse_expression(
    tokens: Sequence[Token], *, typedefs: Collection[str] = (), limits: ParserLimits = ParserLimits()
) -> c_ast.Node:  # fmt: skip
    """The tree of one expression, as a macro's text has it.

    Raises SourceError, NoParser, and ValueError if there are no tokens, because an error would have no place.
    """
    if not tokens:
        raise ValueError("no tokens, no expression")
    _within(tokens, limits)
    grammar = _grammar(lexemes_of(tokens, limits), typedefs, limits)
    with reading(_FRAMES):
        return grammar.expression()


def _within(tokens: Sequence[Token], limits: ParserLimits) -> None:
    if len(tokens) > limits.tokens:
        raise tokens[limits.tokens].error(f"the file has more than {limits.tokens:,} tokens with its headers")


def _grammar(
    lexemes: list[Lexeme], typedefs: Collection[str], limits: ParserLimits, headers: ParsedHeaders | None = None
) -> Any:
    try:
        from emulator.c28x.readers.c.grammar import Grammar
    except ImportError as error:
        raise NoParser("reading C needs pycparser: pip install 'c2000-hil[c]'") from error
    return Grammar(lexemes, typedefs, limits.depth, headers)


class Lexeme:
    """A token in the form that pycparser needs: its kind (the parser changes that of type names) and its text."""

    __slots__ = ("token", "type", "value")

    def __init__(self, kind: str, value: str, token: Token) -> None:
        self.type = kind
        self.value = value
        self.token = token


#: pycparser's names of the punctuators; digraphs (C99, 6.4.6) have the name of the punctuator they replace.
PUNCTUATORS: Final = {
    "...": "ELLIPSIS", "<<=": "LSHIFTEQUAL", ">>=": "RSHIFTEQUAL", "++": "PLUSPLUS", "--": "MINUSMINUS", "->": "ARROW",
    "&&": "LAND", "||": "LOR", "<<": "LSHIFT", ">>": "RSHIFT", "<=": "LE", ">=": "GE", "==": "EQ", "!=": "NE",
    "*=": "TIMESEQUAL", "/=": "DIVEQUAL", "%=": "MODEQUAL", "+=": "PLUSEQUAL", "-=": "MINUSEQUAL", "&=": "ANDEQUAL",
    "|=": "OREQUAL", "^=": "XOREQUAL", "=": "EQUALS", "+": "PLUS", "-": "MINUS", "*": "TIMES", "/": "DIVIDE",
    "%": "MOD", "|": "OR", "&": "AND", "~": "NOT", "^": "XOR", "!": "LNOT", "<": "LT", ">": "GT", "?": "CONDOP",
    "(": "LPAREN", ")": "RPAREN", "[": "LBRACKET", "]": "RBRACKET", "{": "LBRACE", "}": "RBRACE", ",": "COMMA",
    ".": "PERIOD", ";": "SEMI", ":": "COLON",
    "<:": "LBRACKET", ":>": "RBRACKET", "<%": "LBRACE", "%>": "RBRACE",
}  # fmt: skip

_PLAIN: Final = """
    auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while offsetof
"""
#: Keywords -> pycparser's kind, and the spelling in the tree.
KEYWORDS: Final[dict[str, tuple[str, str]]] = {
    **{word: (word.upper(), word) for word in _PLAIN.split()},
    "_Bool": ("_BOOL", "_Bool"),
    "_Static_assert": ("_STATIC_ASSERT", "_Static_assert"),
    "_Noreturn": ("_NORETURN", "_Noreturn"),
    "__builtin_va_arg": ("__BUILTIN_VA_ARG", "__builtin_va_arg"),
    "__inline": ("INLINE", "inline"), "__inline__": ("INLINE", "inline"),
    "__restrict": ("RESTRICT", "restrict"), "__restrict__": ("RESTRICT", "restrict"),
    "__const": ("CONST", "const"), "__const__": ("CONST", "const"),
    "__volatile": ("VOLATILE", "volatile"), "__volatile__": ("VOLATILE", "volatile"),
    "__signed": ("SIGNED", "signed"), "__signed__": ("SIGNED", "signed"),
    "interrupt": ("INLINE", "interrupt"), "__interrupt": ("INLINE", "interrupt"),
    "cregister": ("CONST", "cregister"), "__cregister": ("CONST", "cregister"),
    "asm": ("ID", "__asm"), "__asm": ("ID", "__asm"), "__asm__": ("ID", "__asm"),
}  # fmt: skip

#: Words that are not supported, each with its error.
REFUSED: Final = {
    "_Generic": "_Generic is C11", "_Atomic": "_Atomic is C11", "_Thread_local": "_Thread_local is C11",
    "_Alignas": "_Alignas is C11", "_Alignof": "_Alignof is C11", "__thread": "__thread is an extension of gcc",
    "_Complex": "complex numbers are not supported", "_Imaginary": "complex numbers are not supported",
    "__int128": "__int128 does not exist on this chip", "__label__": "__label__ is an extension of gcc",
    "__auto_type": "__auto_type is an extension of gcc: write the type",
}  # fmt: skip
_TYPEOF: Final = ("typeof", "__typeof", "__typeof__")
_DROPPED: Final = ("__far", "__near", "__extension__")
_OPENING: Final = {"LPAREN": "RPAREN", "LBRACKET": "RBRACKET", "LBRACE": "RBRACE"}
_CLOSING: Final = {"RPAREN": ")", "RBRACKET": "]", "RBRACE": "}"}
_EXPRESSION_WORDS: Final = frozenset(("return", "case", "else", "do", "sizeof", "goto"))

_SUFFIX = r"(?:[uU](?:ll|LL|[lL])?|(?:ll|LL|[lL])[uU]?)?"
_NUMBERS: Final = re.compile(
    rf"(0[xX][0-9a-fA-F]+{_SUFFIX})|(0[bB][01]+{_SUFFIX})|(0[0-7]*{_SUFFIX})|([1-9][0-9]*{_SUFFIX})"
    r"|((?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?[fFlL]?|[0-9]+[eE][+-]?[0-9]+[fFlL]?)"
    r"|(0[xX](?:[0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)[pP][+-]?[0-9]+[fFlL]?)"
)
_NUMBER_KINDS: Final = (
    "", "INT_CONST_HEX", "INT_CONST_BIN", "INT_CONST_OCT", "INT_CONST_DEC", "FLOAT_CONST", "HEX_FLOAT_CONST",
)  # fmt: skip
_LONGEST_NUMBER: Final = 400
#: Tokens of a declaration that ends in `__attribute__((interrupt))`.
_LONGEST_DECLARATION: Final = 300


def lexemes_of(tokens: Sequence[Token], limits: ParserLimits) -> list[Lexeme]:
    """`tokens` as lexemes.  Raises SourceError for text that is not C or not supported, and for too deep nesting."""
    out: list[Lexeme] = []
    late: set[int] = set()
    index = 0
    count = len(tokens)
    while index < count:
        token = tokens[index]
        kind = token.kind
        text = token.text
        index += 1
        if kind == PUNCT:
            name = PUNCTUATORS.get(text)
            if name is None:
                raise token.error(f"{text} stands outside a directive")
            if name == "LBRACE" and out and out[-1].type == "LPAREN":
                raise token.error("({ ... }) is an extension of gcc: write a function, or statements before")
            out.append(Lexeme(name, text, token))
        elif kind == NAME:
            if (word := KEYWORDS.get(text)) is not None:
                if word[0] == "VOLATILE" and out and out[-1].value == "__asm":
                    continue
                out.append(Lexeme(*word, token))
                if word[1] == "__asm":
                    _check_asm(tokens, index, token)
            elif text in REFUSED:
                raise token.error(REFUSED[text])
            elif text in _DROPPED or (text in ("far", "near") and _is_far(tokens, index - 1)):
                continue
            elif text in ("__attribute__", "__attribute"):
                end = _attribute_end(tokens, index)
                if any(t.text.strip("_") == "interrupt" for t in tokens[index:end]):
                    if out and out[-1].type == "RPAREN":
                        late.add(len(out) - 1)
                    else:
                        out.append(Lexeme("INLINE", "interrupt", token))
                index = end
            elif text in _TYPEOF and index < count and tokens[index].text == "(":
                raise token.error(f"{text} is an extension of gcc: write the type")
            elif text == "static_assert" and index < count and tokens[index].text == "(":
                out.append(Lexeme("_STATIC_ASSERT", text, token))
            else:
                out.append(Lexeme("ID", text, token))
        elif kind == NUMBER:
            out.append(Lexeme(_number_kind(token), text, token))
        elif kind == STRING:
            out.append(Lexeme("WSTRING_LITERAL" if text[0] == "L" else "STRING_LITERAL", text, token))
        elif kind == CHAR:
            out.append(Lexeme("WCHAR_CONST" if text[0] == "L" else "CHAR_CONST", text, token))
        elif kind == BAD:
            raise token.error(f"the quote {text[0]} has no end in its line")
        elif text == "\\":
            raise token.error("a stray \\: it joins two lines only as the very last character of a line")
        else:
            raise token.error(f"the character {text!r} (U+{ord(text):04X}) has no place in C here")
    _check_nesting(out, limits.nesting)
    return _with_interrupts(out, late) if late else out


def _number_kind(token: Token) -> str:
    text = token.text
    if len(text) > _LONGEST_NUMBER:
        raise token.error(f"a number of {len(text):,} characters")
    match = _NUMBERS.fullmatch(text)
    if match is not None:
        return _NUMBER_KINDS[match.lastindex or 0]
    if re.fullmatch(rf"0[0-9]+{_SUFFIX}", text):
        raise token.error(f"{text} starts with 0: it is octal and has a digit 8 or 9")
    raise token.error(f"{text} is not a number of C")


def _is_far(tokens: Sequence[Token], index: int) -> bool:
    """Whether `far` or `near` is the old type qualifier here, not the name of an object."""
    if index + 1 >= len(tokens):
        return False
    following = tokens[index + 1]
    if following.kind == NAME:
        return True
    former = tokens[index - 1] if index else following
    return following.text == "*" and former.kind == NAME and former.text not in _EXPRESSION_WORDS


def _attribute_end(tokens: Sequence[Token], index: int) -> int:
    """The index after `((...))`, which starts at `index`."""
    depth = 0
    for end in range(index, len(tokens)):
        text = tokens[end].text
        depth += (text == "(") - (text == ")")
        if depth <= 0:
            if end == index:
                break
            return end + 1
    raise tokens[index - 1].error("expected ((...)) after __attribute__")


def _check_asm(tokens: Sequence[Token], index: int, token: Token) -> None:
    while index < len(tokens) and tokens[index].text.strip("_") == "volatile":
        index += 1
    if index >= len(tokens) or tokens[index].text != "(":
        raise token.error(f'expected ("...") after {token.text}')
    index += 1
    while index < len(tokens) and tokens[index].kind == STRING:
        index += 1
    if index < len(tokens) and tokens[index].text == ":":
        raise tokens[index].error("assembler with operands is an extension of gcc that this chip's compiler lacks")


def _check_nesting(lexemes: list[Lexeme], limit: int) -> None:
    """Raises SourceError if too many brackets are open at once."""
    open_brackets: list[Lexeme] = []
    for lexeme in lexemes:
        kind = lexeme.type
        if kind in _OPENING:
            open_brackets.append(lexeme)
            if len(open_brackets) > limit:
                raise lexeme.token.error(f"brackets nested deeper than {limit}")
        elif open_brackets and _OPENING[open_brackets[-1].type] == kind:
            # The grammar has better errors for a bracket that closes nothing, or the wrong one.
            open_brackets.pop()


def _with_interrupts(lexemes: list[Lexeme], late: set[int]) -> list[Lexeme]:
    """`lexemes` with "interrupt" before the declaration whose parameters end at each index of `late`."""
    before: dict[int, Lexeme] = {}
    for end in late:
        start = end
        depth = 0
        while start >= 0:
            kind = lexemes[start].type
            if not depth and kind in ("SEMI", "RBRACE", "LBRACE"):
                break
            depth += (kind in _CLOSING) - (kind in _OPENING)
            start -= 1
            if end - start > _LONGEST_DECLARATION:
                raise lexemes[end].token.error("a declaration too long for __attribute__((interrupt)) at its end")
        before[start + 1] = Lexeme("INLINE", "interrupt", lexemes[end].token)
    out = []
    for index, lexeme in enumerate(lexemes):
        if index in before:
            out.append(before[index])
        out.append(lexeme)
    return out


__all__ = ["Lexeme", "NoParser", "ParserLimits", "SourceError", "lexemes_of", "parse", "parse_expression"]
