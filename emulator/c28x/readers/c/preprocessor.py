"""C99's preprocessor (ISO/IEC 9899:1999, 6.10) as TI's compiler has it, from a file to tokens with their places.

    unit = preprocess("us.c", PreprocessorOptions(include=["headers"], defines=["LAB=3"]))
    unit.tokens, unit.macros, unit.pragmas, unit.remarks

A macro is not expanded within its own expansion.  It is busy while its text is being read; its name found there is
painted: it is never expanded later (6.10.3.4).  The file may be hostile: a budget limits the tokens that are read,
written or read again, and depths have limits.  Exceeding one is an error with a place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from emulator.c28x.readers.c.conditions import evaluate
from emulator.c28x.readers.c.includes import IncludePath, Refused
from emulator.c28x.readers.c.macro_precedence import loosest, torn_by
from emulator.c28x.readers.c.macros import Macro, definition
from emulator.c28x.readers.c.same_bits import same_bits
from emulator.c28x.readers.c.tokens import (
    BAD,
    CHAR,
    END,
    NAME,
    NUMBER,
    PLACE,
    PUNCT,
    STRING,
    SourceRemark,
    SourceText,
    Token,
    TokenBudget,
    error_at,
    kind_of,
    spelled,
)
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Where

#: The macros that TI's compiler predefines for this chip (SPRU514, "Predefined Macro Names"), version 22.6.0.LTS.
PREDEFINED: Final = {
    "__STDC__": "1", "__STDC_VERSION__": "199901L", "__STDC_HOSTED__": "1", "__STDC_NO_THREADS__": "1",
    "__DATE__": '"Jan  1 2020"', "__TIME__": '"00:00:00"',
    "__TMS320C2000__": "1", "__TMS320C28XX__": "1", "__TMS320C28XX_FPU32__": "1", "__little_endian__": "1",
    "__LARGE_MODEL__": "1", "__TI_COMPILER_VERSION__": "22006000", "__TI_GNU_ATTRIBUTE_SUPPORT__": "1",
    "__TI_STRICT_ANSI_MODE__": "0", "__TI_STRICT_FP_MODE__": "1", "__SIZE_T_TYPE__": "unsigned long",
    "__PTRDIFF_T_TYPE__": "long", "__WCHAR_T_TYPE__": "int",
}  # fmt: skip
#: The macros that `--abi eabi` adds or changes.
PREDEFINED_EABI: Final = {"__TI_EABI__": "1", "__WCHAR_T_TYPE__": "long"}

#: Frames for the deepest expansion and the deepest condition that the limits allow.
_FRAMES: Final = 6_000


@dataclass(frozen=True)
class Limits:
    """Limits of one translation unit, all far beyond the needs of a program for this chip."""

    #: Tokens that are read, written by macros, or read again.
    tokens: int = 1_500_000
    #: Nested `#include`s; all files that are read.
    include_depth: int = 64
    includes: int = 5_000
    #: Nested macro calls within arguments.
    macro_depth: int = 200
    #: Nested `#if`s.
    conditions: int = 200
    #: Characters of a token that `#` or `##` creates.
    token_length: int = 65_536
    file_bytes: int = 4 << 20


@dataclass(frozen=True)
class PreprocessorOptions:
    """How a file is preprocessed: `-I`, `-D`, the ABI, our own headers."""

    include: Sequence[str | Path] = ()
    #: `NAME` (1), `NAME=VALUE` or `NAME(x)=VALUE`.
    defines: Sequence[str] = ()
    #: Source folders in addition to that of the file itself.
    sources: Sequence[str | Path] = ()
    #: Name in lower case, with `/` -> the text of our header; None: not one of ours.
    builtin: Callable[[str], str | None] = lambda name: None
    #: Name -> the text of a header that is in no folder.
    fallback: Callable[[str], str | None] = lambda name: None
    #: Name -> whether it is a header of C's library: the user may have a file of that name.
    standard: Callable[[str], bool] = lambda name: False
    eabi: bool = False
    limits: Limits = Limits()


@dataclass(frozen=True, slots=True)
class Pragma:
    """A `#pragma` or `_Pragma`: its text, its place, and the number of tokens of the unit before it."""

    text: str
    where: Where
    before: int


@dataclass
class Unit:
    """A translation unit after preprocessing."""

    file: str
    tokens: list[Token]
    #: The macros defined at its end, without the compiler's own.
    macros: dict[str, Macro]
    pragmas: list[Pragma]
    remarks: list[SourceRemark]
    #: Every file that was read, by its resolved path, without our own headers.
    files: dict[str, SourceText]
    limits: Limits
    #: The macros defined at its end, including the compiler's own.
    known: dict[str, Macro]

    def expansion(self, name: str) -> list[Token]:
        """The complete expansion of the object-like macro `name`, with the macros at the unit's end; maybe empty."""
        preprocessor = _Preprocessor(IncludePath((), (), lambda name: None, 0), self.limits)
        preprocessor.macros.update(self.known)
        with reading(_FRAMES):
            token = self.macros[name].token
            return preprocessor.expand([Token(NAME, token.text, token.source, token.at)], token)


def preprocess(path: str | Path, options: PreprocessorOptions = PreprocessorOptions()) -> Unit:
    """Preprocess the file at `path`.  Raises SourceError, also where the file cannot be read."""
    folder = Path(path).parent
    include = IncludePath(
        [folder, *options.sources], options.include, options.builtin, options.limits.file_bytes, options.fallback,
        options.standard,
    )  # fmt: skip
    try:
        source = include.main(path)
    except Refused as refused:
        raise SourceError(str(path), 1, str(refused)) from None
    return _run(source, include, options)


def preprocess_text(text: str, name: str, options: PreprocessorOptions = PreprocessorOptions()) -> Unit:
    """Preprocess `text`, called `name`; its own headers come from `options` alone."""
    include = IncludePath(
        options.sources, options.include, options.builtin, options.limits.file_bytes, options.fallback,
        options.standard,
    )  # fmt: skip
    return _run(SourceText(name, text), include, options)


def _run(source: SourceText, include: IncludePath, options: PreprocessorOptions) -> Unit:
    preprocessor = _Preprocessor(include, options.limits)
    preprocessor.predefine(PREDEFINED | (PREDEFINED_EABI if options.eabi else {}))
    own = dict(preprocessor.macros)
    preprocessor.command_line(options.defines)
    with reading(_FRAMES):
        tokens = preprocessor.run(source)
    for read in {id(each): each for each in (source, *include.files.values())}.values():
        for at in sorted(set(read.swallowing)):
            message = "this comment has no end of its own: it ends with the next one, and the code between is in it"
            preprocessor.remarks.append(SourceRemark(read.where(at), message, rule="comment-open"))
    macros = {name: macro for name, macro in preprocessor.macros.items() if own.get(name) is not macro}
    preprocessor.remarks += same_bits(macros)
    return Unit(
        source.file, tokens, macros, preprocessor.pragmas, preprocessor.remarks, include.files, options.limits,
        preprocessor.macros,
    )  # fmt: skip


class _Text:
    """The tokens of an expanded macro that are still to be read, last first.  The macro is busy until they are read."""

    __slots__ = ("macro", "tokens")

    def __init__(self, tokens: list[Token], macro: str | None) -> None:
        self.tokens = tokens
        self.macro = macro


@dataclass(slots=True)
class _Condition:
    """An open `#if`.  `outer`: its surroundings are read; `taken`: one of its groups has been read."""

    token: Token
    outer: bool
    taken: bool
    otherwise: bool = False


class _OpenFile:
    """A file that is being read."""

    __slots__ = ("again", "conditions", "lines", "live", "source")

    def __init__(self, source: SourceText, lines: Iterator[list[Token]]) -> None:
        self.source = source
        self.lines = lines
        self.conditions: list[_Condition] = []
        #: Whether the present group is read, not skipped.
        self.live = True
        #: A line that was read ahead and put back.
        self.again: list[Token] | None = None


class _Preprocessor:
    """Reads files line by line, obeys directives, expands macros."""

    def __init__(self, include: IncludePath, limits: Limits) -> None:
        self.include = include
        self.limits = limits
        self.budget = TokenBudget(limits.tokens)
        self.macros: dict[str, Macro] = {}
        self.pragmas: list[Pragma] = []
        self.remarks: list[SourceRemark] = []
        self._files: list[_OpenFile] = []
        self._included = 0
        self._once: set[SourceText | str] = set()
        self._out: list[Token] = []
        #: The line of the file that is being read.
        self._line: list[Token] = []
        self._index = 0
        #: Macro text to read before the rest of the line.
        self._texts: list[_Text] = []
        self._busy: set[str] = set()
        #: Only `_texts` is read, not the file: for an argument or a directive.
        self._closed = False
        #: `_arguing`: an argument list is read, which the end of the file ends.  `_seeking`: its `(` is sought, and a
        #: directive ends the search as well.
        self._arguing = False
        self._seeking = False
        self._depth = 0
        nowhere = SourceText("", "")
        self._end = Token(END, "", nowhere, 0)

    # ---- predefined macros

    def predefine(self, macros: dict[str, str]) -> None:
        """Define the compiler's own macros."""
        text = "".join(f"#define {name} {value}\n" for name, value in macros.items())
        for line in SourceText("<compiler>", text).lines(TokenBudget(10_000)):
            self._define(line)
        for name in ("__FILE__", "__LINE__"):
            token = Token(NAME, name, SourceText("<compiler>", name), 0)
            self.macros[name] = Macro(name, None, False, [], token, special=True)

    def command_line(self, defines: Sequence[str]) -> None:
        """Define what `-D` asks for.  Raises SourceError."""
        for define in defines:
            name, equals, value = define.partition("=")
            text = f"#define {name} {value if equals else '1'}"
            source = SourceText("<command line>", text)
            if not re.fullmatch(r"[A-Za-z_]\w*(\([\w, .]*\))?", name, re.ASCII) or "\n" in value:
                raise error_at(source.where(0), f"-D {define}: expected NAME or NAME=VALUE")
            for line in source.lines(self.budget):
                self._define(line)

    # ---- tokens

    def run(self, source: SourceText) -> list[Token]:
        """The tokens of the translation unit."""
        self._files.append(_OpenFile(source, source.lines(self.budget)))
        out = self._out
        end = self._end
        while (token := self._get()) is not end:
            if token.text == "_Pragma" and token.kind == NAME:
                self._pragma_operator(token)
            else:
                out.append(token)
                if not self._texts:
                    self._take_plain(out)
        return out

    def _take_plain(self, out: list[Token]) -> None:
        """Copy the tokens of the line up to the next macro or `_Pragma`.  Most of a file is copied so."""
        line, macros = self._line, self.macros
        first = index = self._index
        for token in line[first:]:
            if token.kind == NAME and (token.text in macros or token.text == "_Pragma"):
                break
            index += 1
        out += line[first:index]
        self._index = index

    def expand(self, tokens: list[Token], at: Token) -> list[Token]:
        """`tokens` with every macro expanded, without the tokens that follow them."""
        return list(self._expanded(tokens, at))

    def _expanded(self, tokens: list[Token], at: Token, condition: bool = False) -> Iterator[Token]:
        self._depth += 1
        if self._depth > self.limits.macro_depth:
            raise at.error(f"macro calls within arguments of macro calls, deeper than {self.limits.macro_depth}")
        self.budget.spend(len(tokens), at)
        texts, closed, arguing, seeking = self._texts, self._closed, self._arguing, self._seeking
        self._texts, self._closed, self._arguing, self._seeking = [_Text(tokens[::-1], None)], True, False, False
        while (token := self._get()) is not self._end:
            yield self._defined(token) if condition and token.text == "defined" else token
        self._texts, self._closed, self._arguing, self._seeking = texts, closed, arguing, seeking
        self._depth -= 1

    def _pull(self) -> Token:
        """The next token, before expansion."""
        texts = self._texts
        while texts:
            text = texts[-1]
            if text.tokens:
                return text.tokens.pop()
            texts.pop()
            if text.macro is not None:
                self._busy.discard(text.macro)
        if self._closed:
            return self._end
        while self._index >= len(self._line):
            if not self._next_line():
                return self._end
        self._index += 1
        return self._line[self._index - 1]

    def _get(self) -> Token:
        """The next token, after expansion."""
        while True:
            token = self._pull()
            if token.kind != NAME or token.painted or (macro := self.macros.get(token.text)) is None:
                return token
            if token.text in self._busy:
                return _painted(token)
            if not self._enter(macro, token):
                return token

    def _next_line(self) -> bool:
        """Go to the next line of text.  Returns False where reading must end."""
        while True:
            file = self._files[-1]
            if file.again is not None:
                line, file.again = file.again, None
            else:
                found = next(file.lines, None)
                if found is None:
                    if file.conditions:
                        opening = file.conditions[-1].token
                        raise opening.error(f"#{opening.text} has no #endif")
                    if self._arguing or len(self._files) == 1:
                        return False
                    self._files.pop()
                    continue
                line = found
            if line[0].text in ("#", "%:"):
                if self._seeking:
                    file.again = line
                    return False
                self._directive(file, line)
            elif file.live:
                self._line = line
                self._index = 0
                return True

    # ---- macros

    def _enter(self, macro: Macro, token: Token) -> bool:
        """Read the text of `macro` next, instead of `token`.  Returns False if its arguments are missing."""
        use = token.use or token
        if macro.special:
            text = self._special(macro.name, use)
        elif macro.parameters is None and not macro.joins:
            text = [Token(t.kind, t.text, t.source, t.at, t.space, use) for t in macro.body]
        elif macro.parameters is None:
            text = self._fill(macro, [], use)
        else:
            arguments = self._arguments(macro, token)
            if arguments is None:
                return False
            text = self._fill(macro, arguments, use)
        self.budget.spend(len(text) + 1, use)
        if text:
            self._remark_torn_text(macro, text, use)
            first = text[0]
            if first.space != token.space:
                text[0] = Token(
                    first.kind, first.text, first.source, first.at, token.space, first.use, first.painted
                )  # fmt: skip
            text.reverse()
            self._texts.append(_Text(text, macro.name))
            self._busy.add(macro.name)
        return True

    def _special(self, name: str, use: Token) -> list[Token]:
        if name == "__LINE__":
            return [Token(NUMBER, str(use.where.line), use.source, use.at)]
        file = use.source.file.replace("\\", "\\\\").replace('"', '\\"')
        return [Token(STRING, f'"{file}"', use.source, use.at)]

    def _arguments(self, macro: Macro, name: Token) -> list[list[Token]] | None:
        """The arguments of a macro call; None if no `(` follows."""
        assert macro.parameters is not None
        arguing, seeking = self._arguing, self._seeking
        self._arguing = self._seeking = True
        token = self._pull()
        self._seeking = seeking
        if token.text != "(" or token.kind != PUNCT:
            if token is not self._end:
                self._texts.append(_Text([token], None))
            self._arguing = arguing
            return None
        opening = token
        count = len(macro.parameters)
        arguments: list[list[Token]] = [[]]
        depth = 0
        while True:
            token = self._pull()
            if token is self._end:
                raise name.error(f"the arguments of the macro {macro.name} have no end: ) is missing")
            if token.kind == PUNCT:
                if token.text == "(":
                    depth += 1
                elif token.text == ")":
                    if not depth:
                        break
                    depth -= 1
                elif token.text == "," and not depth and not (macro.variadic and len(arguments) >= count):
                    arguments.append([])
                    continue
            elif token.kind == NAME and token.text in self._busy and not token.painted and token.text in self.macros:
                token = _painted(token)
            arguments[-1].append(token)
        self._arguing = arguing
        if count == 0 and arguments == [[]]:
            return []
        given = len(arguments)
        if given != count and not (macro.variadic and given == count - 1):
            least = " at least" if macro.variadic else ""
            wanted = count - macro.variadic
            raise opening.error(
                f"the macro {macro.name} takes{least} {wanted} argument{'s' * (wanted != 1)}, {given} given; "
                f"it is defined at {macro.where}"
            )
        return arguments

    def _fill(self, macro: Macro, arguments: list[list[Token]], use: Token) -> list[Token]:
        """The body of `macro` with its arguments inserted, and `#` and `##` carried out."""
        out: list[Token] = []
        expanded: dict[int, list[Token]] = {}
        for number, piece in enumerate(macro.pieces):
            token = piece.token
            index = piece.parameter
            if index < 0:
                part = [Token(token.kind, token.text, token.source, token.at, token.space, use)]
            elif piece.string:
                argument = arguments[index] if index < len(arguments) else []
                part = [self._string(argument, token, use)]
            elif piece.joins_left or piece.joins_right:
                absent = index >= len(arguments)
                variadic = macro.variadic and index == len(macro.parameters or ()) - 1
                if variadic and not absent and index == 0 and not arguments[0]:
                    absent = True
                if variadic and piece.joins_left and out and out[-1].text == "," and out[-1].kind == PUNCT:
                    # `, ## __VA_ARGS__`: without arguments the comma is dropped, else nothing is joined (as in gcc).
                    if absent:
                        out.pop()
                        out.append(Token(PLACE, "", token.source, token.at, token.space, use))
                    out.extend(_spaced(arguments[index], token.space) if not absent else [])
                    self.budget.spend(0 if absent else len(arguments[index]), use)
                    continue
                argument = [] if absent else arguments[index]
                if argument:
                    part = _spaced(argument, token.space)
                else:
                    part = [Token(PLACE, "", token.source, token.at, token.space, use)]
            else:
                if index not in expanded:
                    argument = arguments[index] if index < len(arguments) else []
                    expanded[index] = self.expand(argument, use) if argument else []
                part = _spaced(expanded[index], token.space)
                self._remark_torn_argument(macro, number, part, use)
            if piece.joins_left and out:
                out.extend(self._joined(out.pop(), part[0], token, use))
                out.extend(part[1:])
            else:
                out.extend(part)
            self.budget.spend(len(part), use)
        return [token for token in out if token.kind != PLACE] if macro.joins else out

    def _remark_torn_text(self, macro: Macro, text: list[Token], use: Token) -> None:
        """Remark that operators beside the use of a macro take only a part of its text."""
        own = None if self._closed or use.source.file.startswith("<") else loosest(text)
        if own is None:
            return
        rest = self._texts[-1].tokens[-1:] if self._texts else self._line[self._index : self._index + 1]
        if by := torn_by(self._out[-2:], own, rest[0] if rest else None):
            message = (
                f"{macro.name} is {_brief(macro.body)}, without parentheses: the {by} beside it takes only a part of it"
            )
            self.remarks.append(SourceRemark(use.where, message, rule="macro-precedence", name=macro.name))

    def _remark_torn_argument(self, macro: Macro, number: int, argument: list[Token], use: Token) -> None:
        """Remark that operators in the text of a macro take only a part of an argument."""
        own = None if use.source.file.startswith("<") or len(argument) < 3 else loosest(argument)
        if own is None:
            return
        before = [piece.token for piece in macro.pieces[max(0, number - 2) : number]]
        behind = macro.pieces[number + 1].token if number + 1 < len(macro.pieces) else None
        if by := torn_by(before, own, behind):
            message = (
                f"the text of {macro.name}, {_brief(macro.body)}, has its argument {_brief(argument)} without "
                f"parentheses: the {by} beside it takes only a part of it"
            )
            self.remarks.append(SourceRemark(use.where, message, rule="macro-precedence", name=macro.name))

    def _string(self, argument: list[Token], at: Token, use: Token) -> Token:
        """`#`: the spelling of the argument as a string (6.10.3.2)."""
        parts = []
        for number, token in enumerate(argument):
            text = token.text
            if token.kind in (STRING, CHAR):
                text = text.replace("\\", "\\\\").replace('"', '\\"')
            parts.append(" " + text if token.space and number else text)
        text = '"' + "".join(parts) + '"'
        self._length(text, use)
        return Token(STRING if kind_of(text) == STRING else BAD, text, at.source, at.at, at.space, use)

    def _joined(self, left: Token, right: Token, at: Token, use: Token) -> list[Token]:
        """`##`: two tokens joined to one (6.10.3.3)."""
        text = left.text + right.text
        self._length(text, use)
        if left.kind == PLACE and right.kind == PLACE:
            return [left]
        if left.kind == PLACE or right.kind == PLACE:
            kept = right if left.kind == PLACE else left
            return [Token(kept.kind, text, kept.source, kept.at, left.space, kept.use, kept.painted)]
        kind = kind_of(text)
        if kind is None:
            where = Token(NAME, text, at.source, at.at, use=use).where
            self.remarks.append(
                SourceRemark(where, f"{left.text} ## {right.text} is not one token; the two stay apart")
            )
            return [left, right]
        return [Token(kind, text, at.source, at.at, left.space, use)]

    def _length(self, text: str, use: Token) -> None:
        if len(text) > self.limits.token_length:
            raise use.error(f"the macro {use.text} makes a token of more than {self.limits.token_length:,} characters")
        self.budget.spend(len(text) // 64, use)

    # ---- directives

    def _directive(self, file: _OpenFile, line: list[Token]) -> None:
        if len(line) == 1:
            return
        name = line[1]
        text = name.text
        if text in ("if", "ifdef", "ifndef"):
            self._open(file, line)
        elif text in ("elif", "else", "endif"):
            self._other_group(file, line)
        elif not file.live:
            return
        elif text == "define":
            self._define(line)
        elif text == "undef":
            self._undefine(line)
        elif text == "include":
            self._include(file, line)
        elif text == "error":
            raise name.error(f"#error {_rest(line)}".rstrip())
        elif text in ("warning", "warn"):
            self.remarks.append(SourceRemark(name.where, f"#warning {_rest(line)}".rstrip()))
        elif text == "pragma":
            self._pragma(spelled(line[2:]), name, file)
        elif text == "line" or name.kind == NUMBER:
            self.remarks.append(SourceRemark(name.where, "#line is ignored: places are those of this file"))
        elif text != "ident":
            raise name.error(f"#{text[:40]} is not a directive of C")

    def _open(self, file: _OpenFile, line: list[Token]) -> None:
        name = line[1]
        if len(file.conditions) >= self.limits.conditions:
            raise name.error(f"#if nested deeper than {self.limits.conditions}")
        holds = file.live and self._holds(line)
        file.conditions.append(_Condition(name, file.live, holds))
        file.live = holds

    def _other_group(self, file: _OpenFile, line: list[Token]) -> None:
        name = line[1]
        if not file.conditions:
            raise name.error(f"#{name.text} without #if")
        condition = file.conditions[-1]
        if name.text == "endif":
            file.conditions.pop()
            file.live = condition.outer
            return
        if condition.otherwise:
            raise name.error(f"#{name.text} after the #else of the #{condition.token.text} at {condition.token.where}")
        if name.text == "else":
            condition.otherwise = True
            holds = not condition.taken
        else:
            holds = condition.outer and not condition.taken and self._holds(line)
        file.live = condition.outer and holds
        condition.taken = condition.taken or holds

    def _holds(self, line: list[Token]) -> bool:
        name = line[1]
        if name.text in ("ifdef", "ifndef"):
            macro = self._name(line)
            return (macro.text in self.macros) == (name.text == "ifdef")
        if len(line) == 2:
            raise name.error(f"#{name.text} without a condition")
        return evaluate(list(self._expanded(self._without_defined(line[2:]), name, condition=True)), name)

    def _without_defined(self, tokens: list[Token]) -> list[Token]:
        """`tokens` with each `defined NAME` and `defined(NAME)` replaced by 1 or 0, before expansion."""
        out = []
        index = 0
        while index < len(tokens):
            token = tokens[index]
            if token.text == "defined" and token.kind == NAME:
                texts = [t.text for t in tokens[index + 1 : index + 4]]
                at = 2 if texts[:1] == ["("] else 1
                operand = tokens[index + at] if index + at < len(tokens) else None
                if operand is None or operand.kind != NAME or (at == 2 and texts[2:] != [")"]):
                    raise token.error("expected defined NAME or defined(NAME)")
                out.append(self._truth(operand.text in self.macros, token))
                index += 4 if at == 2 else 2
            else:
                out.append(token)
                index += 1
        return out

    def _defined(self, token: Token) -> Token:
        """The value of a `defined` in the text of a macro; its operand follows there."""
        operand = self._pull()
        bracket = operand.text == "("
        if bracket:
            operand = self._pull()
        if operand.kind != NAME or (bracket and self._pull().text != ")"):
            raise token.error("expected defined NAME or defined(NAME)")
        return self._truth(operand.text in self.macros, token)

    @staticmethod
    def _truth(holds: bool, at: Token) -> Token:
        return Token(NUMBER, "1" if holds else "0", at.source, at.at, at.space, at.use)

    @staticmethod
    def _name(line: list[Token]) -> Token:
        if len(line) < 3 or line[2].kind != NAME:
            found = f", found {line[2].text[:40]!r}" if len(line) > 2 else ""
            raise line[min(2, len(line) - 1)].error(f"expected the name of a macro after #{line[1].text}{found}")
        return line[2]

    def _define(self, line: list[Token]) -> None:
        macro = definition(self._name(line), line)
        former = self.macros.get(macro.name)
        if former is not None:
            if former.same(macro):
                return
            self.remarks.append(SourceRemark(macro.where, f"{macro.name} is defined again, first at {former.where}"))
        self.macros[macro.name] = macro

    def _undefine(self, line: list[Token]) -> None:
        self.macros.pop(self._name(line).text, None)

    def _include(self, file: _OpenFile, line: list[Token]) -> None:
        name, quoted, place = self._header(line)
        try:
            source = self.include.find(name, quoted, file.source.folder)
        except Refused as refused:
            raise place.error(str(refused)) from None
        if source in self._once or source.file.lower() in self._once:
            return
        self._included += 1
        if len(self._files) >= self.limits.include_depth:
            raise place.error(f"#include nested deeper than {self.limits.include_depth}: does {name} include itself?")
        if self._included > self.limits.includes:
            raise place.error(f"more than {self.limits.includes:,} files are included")
        self.budget.spend(len(source.text) // 32, place)
        self._files.append(_OpenFile(source, source.lines(self.budget)))

    def _header(self, line: list[Token]) -> tuple[str, bool, Token]:
        """The name in an `#include`, whether it is in quotes, and the token at which to report an error."""
        if len(line) < 3:
            raise line[1].error('expected "NAME" or <NAME> after #include')
        first = line[2]
        source = first.source.text
        text = source[first.at : (source.find("\n", first.at) + 1 or len(source) + 1) - 1]
        if first.kind == NAME:
            tokens = self.expand(line[2:], line[1])
            text = spelled(tokens)
        if match := re.match(r'"([^"]*)"|<([^>]*)>', text):
            quoted = match[1] is not None
            return (match[1] if quoted else match[2]), quoted, first
        raise first.error(f'expected "NAME" or <NAME> after #include, found {text[:40]!r}')

    def _pragma(self, text: str, token: Token, file: _OpenFile) -> None:
        self.pragmas.append(Pragma(text, token.where, len(self._out)))
        if text == "once":
            self._once.add(file.source if file.source.folder is not None else file.source.file.lower())

    def _pragma_operator(self, token: Token) -> None:
        """`_Pragma("text")` (6.10.9)."""
        opening, text, closing = self._get(), self._get(), self._get()
        if opening.text != "(" or text.kind != STRING or closing.text != ")":
            raise token.error('expected _Pragma("...")')
        body = text.text[text.text.index('"') + 1 : -1].replace('\\"', '"').replace("\\\\", "\\")
        self._pragma(body.strip(), token, self._files[-1])


def _painted(token: Token) -> Token:
    return Token(token.kind, token.text, token.source, token.at, token.space, token.use, painted=True)


def _spaced(tokens: list[Token], space: bool) -> list[Token]:
    """`tokens`, the first one with or without a blank before it."""
    if not tokens or tokens[0].space == space:
        return tokens
    first = tokens[0]
    return [Token(first.kind, first.text, first.source, first.at, space, first.use, first.painted), *tokens[1:]]


def _rest(line: list[Token]) -> str:
    """The text of a directive after its name."""
    if len(line) < 3:
        return ""
    return spelled(line[2:])[:500]


def _brief(tokens: list[Token]) -> str:
    """The text of tokens, not longer than a message has room for."""
    text = spelled(tokens)
    return text if len(text) <= 40 else f"{text[:37]}..."
