"""A driver's C text with its tree and its types, and edits of the text that leave every line where it is.

The tree is that of the text before the preprocessor: a macro is a name in it, or a call.
"""

from __future__ import annotations

import copy
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from pycparser import c_ast
from pycparser.c_generator import CGenerator

from emulator.c28x import tree
from emulator.c28x.ctypes import CType, IntType
from emulator.c28x.readers.c.declarators import declarator
from emulator.c28x.readers.c.grammar import Grammar
from emulator.c28x.readers.c.parser import Lexeme, ParserLimits, lexemes_of
from emulator.c28x.readers.c.tokens import NAME, SourceText, Token, TokenBudget, spelled
from emulator.c28x.symbols import CoreRegister, Module, RegisterBlock, Symbol
from emulator.c28x.tree import Function, Stmt
from emulator.c28x.tree_queries import statements, within
from emulator.registers.fields import R0W1, RSV, RW, R
from hil.board import Board
from hil.image import program

_LIMITS: Final = ParserLimits()
#: The rules of the grammar whose nodes are expressions, and those whose nodes are statements or declarations.
_EXPRESSIONS: Final = (
    "_parse_primary_expression", "_parse_postfix_expression", "_parse_unary_expression", "_parse_cast_expression",
    "_parse_conditional_expression", "_parse_assignment_expression", "_parse_expression", "_parse_constant_expression",
    "_parse_initializer",
)  # fmt: skip
_STATEMENTS: Final = (
    "_parse_statement", "_parse_declaration", "_parse_external_declaration", "_parse_compound_statement",
)  # fmt: skip
Span = tuple[int, int]


class _SpannedGrammar(Grammar):
    """The grammar, which notes from which lexeme to which a node extends: an expression with its parentheses."""

    def __init__(self, lexemes: list[Lexeme], typedefs: set[str]) -> None:
        super().__init__(lexemes, typedefs, _LIMITS.depth)
        self.expressions: dict[Any, Span] = {}
        self.statements: dict[Any, Span] = {}
        for names, spans in ((_EXPRESSIONS, self.expressions), (_STATEMENTS, self.statements)):
            for name in names:
                setattr(self, name, self._noting(getattr(self, name), spans))

    def _noting(self, rule: Callable[..., Any], spans: dict[Any, Span]) -> Callable[..., Any]:
        def noting(*arguments: Any, **named: Any) -> Any:
            start = self._mark()
            found = rule(*arguments, **named)
            for node in found if isinstance(found, list) else [found]:
                spans[node] = start, self._mark() - 1
            return found

        return noting


@dataclass(frozen=True)
class FieldOf:
    """The bits of a field of a register.

    `plain`: it reads as it was written, writing back the others does nothing, and it is no half of the register.
    """

    mask: int
    lo: int
    wide: bool
    plain: bool

    def number(self, value: int) -> str:
        """A number that is as wide as the register."""
        return f"0x{value:X}{'UL' if self.wide else 'U'}"


class Source:
    """The text of a driver, and its edits.

    Nodes are those of pycparser.  Edits that enclose others are asked for first.
    """

    def __init__(self, name: str, text: str, board: type[Board]) -> None:
        """`name`: that of its file.  Raises SourceError."""
        self.name = name
        self.text = text
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / name
            file.write_text(text, encoding="utf-8")
            project = board.project
            header, library = (project.header, project.library) if project is not None else (None, None)
            read = program([str(file)], header=header, library=library)
            read.translate()
            self.module: Module = read.modules[file.stem]
        source = SourceText(name, text)
        lines = list(source.lines(TokenBudget(_LIMITS.tokens)))
        #: The tokens of each directive of the preprocessor.
        self.directives: list[list[Token]] = [line for line in lines if line[0].text == "#"]
        self._lexemes = lexemes_of([token for line in lines if line[0].text != "#" for token in line], _LIMITS)
        types = {name for name, symbol in self.module.symbols.items() if isinstance(symbol, CType)}
        grammar = _SpannedGrammar(self._lexemes, types | self._enumerations())
        self.tree: c_ast.FileAST = grammar.unit()
        self._expressions = grammar.expressions
        self._statements = grammar.statements
        self._at = {(lexeme.token.where.line, lexeme.token.where.column): i for i, lexeme in enumerate(self._lexemes)}
        self._edits: list[tuple[int, int, int, int, str]] = []
        self._names = 0
        #: Line -> the lines to which something of it moves.
        self.moved: defaultdict[int, set[int]] = defaultdict(set)

    def _enumerations(self) -> set[str]:
        return {name for name, symbol in self.module.symbols.items() if type(symbol).__name__ == "EnumType"}

    # ---- what stands where

    @property
    def functions(self) -> list[Any]:
        """The definitions of functions."""
        return [node for node in self.tree.ext if isinstance(node, c_ast.FuncDef)]

    def symbol(self, name: str) -> Symbol | None:
        """The meaning of a name at file scope."""
        return self.module.symbols.get(name)

    def span(self, node: Any, *, statement: bool = False) -> Span:
        """The first and the last lexeme of an expression, with its parentheses; or of a statement, with its `;`."""
        if statement and node not in self._statements:  # the block of a `switch`, which is made anew
            first = self._lexeme(node)
            return first, self._closing(first)
        if statement:
            return self._statements[node]
        known = self._expressions.get(node)
        if known is not None:
            return known
        below = [self.span(child) for _, child in node.children()]
        first = self._lexeme(node)
        if not below:
            return first, first
        last = max(end for _, end in below)
        if isinstance(node, c_ast.FuncCall):
            last += 1 if node.args is not None else 2
        elif isinstance(node, c_ast.ArrayRef) or (isinstance(node, c_ast.UnaryOp) and node.op in ("p++", "p--")):
            last += 1
        return min(first, *(start for start, _ in below)), last

    def _lexeme(self, node: Any) -> int:
        """The lexeme at the place of a node."""
        return self._at[node.coord.line, node.coord.column]

    def of(self, node: Any, *, statement: bool = False) -> str:
        """The text of a node in one line."""
        first, last = self.span(node, statement=statement)
        return spelled([lexeme.token for lexeme in self._lexemes[first : last + 1]])

    def within(self, block: Any, names: Mapping[str, str]) -> str:
        """The text in the braces of a block in one line, with other texts for some names."""
        first, last = self.span(block, statement=True)
        others = {self._lexeme(name): names[name.name] for name in named(block) if name.name in names}
        tokens = []
        for index in range(first + 1, last):
            token = copy.copy(self._lexemes[index].token)
            token.text = others.get(index, token.text)
            tokens.append(token)
        return spelled(tokens)

    def brace(self, block: Any, text: str, *, closing: bool = False) -> None:
        """Replace the opening or the closing brace of a block."""
        brace = self.span(block, statement=True)[closing]
        self.replace_lexemes(brace, brace, text)

    def operand(self, node: Any) -> str:
        """The text of an expression as an operand: in parentheses if they may be needed."""
        text = self.of(node)
        first, last = self.span(node)
        simple = isinstance(node, c_ast.ID | c_ast.Constant | c_ast.StructRef | c_ast.ArrayRef | c_ast.FuncCall)
        return text if simple or self._closing(first) == last else f"({text})"

    def _closing(self, first: int) -> int:
        """The lexeme that closes the parenthesis or brace `first`; `first`: it is none."""
        depth = 0
        for index in range(first, len(self._lexemes)):
            kind = self._lexemes[index].type
            depth += (kind in ("LPAREN", "LBRACE")) - (kind in ("RPAREN", "RBRACE"))
            if not depth:
                return index
        raise ValueError("the parenthesis is not closed")

    def line(self, node: Any, *, statement: bool = False) -> int:
        """The line in which a node begins."""
        return self._lexemes[self.span(node, statement=statement)[0]].token.where.line

    def last_line(self, node: Any, *, statement: bool = False) -> int:
        """The line in which a node ends."""
        return self._lexemes[self.span(node, statement=statement)[1]].token.where.line

    # ---- types

    @cached_property
    def _typed(self) -> dict[tuple[int, int], Stmt]:
        """Statements of the typed tree by line and column: the first one at each place."""
        found: dict[tuple[int, int], Stmt] = {}
        for function in self.module.functions:
            for s in statements(function.body):
                if s.where.macro is None:
                    found.setdefault((s.where.line, s.where.column), s)
        return found

    @cached_property
    def _calls(self) -> dict[tuple[int, int, str], tree.Call]:
        found: dict[tuple[int, int, str], tree.Call] = {}
        for function in self.module.functions:
            for node in within(function.body):
                if isinstance(node, tree.Call):
                    found.setdefault((node.where.line, node.where.column, node.function.name), node)
        return found

    def called(self, call: Any) -> Function | None:
        """The function of a call; None: it is a macro, or a pointer."""
        symbol = self.symbol(call.name.name) if isinstance(call.name, c_ast.ID) else None
        return symbol if isinstance(symbol, Function) else None

    def declared(self, function: Any) -> dict[str, Any]:
        """The declarations of the parameters and locals of a function; None for two of one name."""
        found: dict[str, Any] = {}
        for node in nodes(function):
            if isinstance(node, c_ast.Decl) and node is not function.decl and node.name:
                found[node.name] = None if node.name in found else node
        return found

    @cached_property
    def objects(self) -> dict[str, Any]:
        """The declarations of objects at file scope that define them."""
        return {
            node.name: node for node in self.tree.ext
            if isinstance(node, c_ast.Decl) and node.name and not isinstance(node.type, c_ast.FuncDecl)
            and "extern" not in node.storage
        }  # fmt: skip

    def settled(self) -> set[str]:
        """The names of objects that must stay as they are: directives, initialisers or locals have their names."""
        names = {token.text for directive in self.directives for token in directive}
        for node in self.tree.ext:
            if isinstance(node, c_ast.FuncDef):
                names |= self.declared(node).keys()
            elif isinstance(node, c_ast.Decl):
                names |= {part.name for part in named(node)}
        return names

    def target_type(self, assignment: Any, name: str, declared: dict[str, Any]) -> str | None:
        """The declaration of `name` with the type of the target of an assignment; None: the type is not known."""
        if isinstance(assignment.lvalue, c_ast.ID):
            object_name = assignment.lvalue.name
            declaration = declared[object_name] if object_name in declared else self.objects.get(object_name)
            if declaration is not None and (text := value_declaration(declaration, name)) is not None:
                return text
        where = assignment.coord
        found = self._typed.get((where.line, where.column))
        return declaration_of(found.target.ctype, name) if isinstance(found, tree.Assign) else None

    def subject_type(self, switch: Any, name: str, declared: dict[str, Any]) -> str | None:
        """The declaration of `name` with the type of what a `switch` decides on; None: the type is not known."""
        if isinstance(switch.cond, c_ast.ID):
            declaration = declared.get(switch.cond.name) or self.objects.get(switch.cond.name)
            if declaration is not None and (text := value_declaration(declaration, name)) is not None:
                return text
        found = self._typed.get((switch.coord.line, switch.coord.column))
        return declaration_of(found.subject.ctype, name) if isinstance(found, tree.Switch) else None

    def is_register(self, node: Any) -> bool:
        """Whether an lvalue begins with the name of a register block or of a register of the core."""
        while not isinstance(node, c_ast.ID):
            if isinstance(node, c_ast.StructRef | c_ast.ArrayRef):
                node = node.name
            else:
                return False
        return isinstance(self.symbol(node.name), RegisterBlock | CoreRegister)

    def field(self, node: Any) -> tuple[str, FieldOf] | None:
        """The text of the whole register and the bits of a field of it, `Regs.R.bit.F`; None: it is none."""
        match node:
            case c_ast.StructRef(
                type=".", field=c_ast.ID(name=name), name=c_ast.StructRef(
                    type=".", field=c_ast.ID(name="bit"), name=c_ast.StructRef(
                        type=".", field=c_ast.ID(name=register), name=c_ast.ID(name=block) as base
                    ),
                ),
            ) if isinstance(symbol := self.symbol(block), RegisterBlock):  # fmt: skip
                description = symbol.layout[register].register
                fields = description.fields
                plain = (
                    all(each.access in (RW, R, R0W1, RSV) for each in fields.values()) and fields[name].access is RW
                    and fields[name].width < 16
                )  # fmt: skip
                bits = FieldOf(fields[name].mask, fields[name].lo, description.bits == 32, plain)
                return f"{self.of(base)}.{register}.all", bits
        return None

    def reads_volatile(self, node: Any) -> bool:
        """Whether an expression may read something volatile, or call, or change something."""
        for part in nodes(node):
            match part:
                case c_ast.FuncCall() | c_ast.Assignment() | c_ast.UnaryOp(op="++" | "--" | "p++" | "p--" | "*"):
                    return True
                case c_ast.StructRef(type="->"):
                    return True
                case c_ast.ID(name=name):
                    symbol = self.symbol(name)
                    if isinstance(symbol, RegisterBlock | CoreRegister) or getattr(symbol, "volatile", False):
                        return True
        return False

    def free(self, node: Any, declared: dict[str, Any]) -> list[str]:
        """The parameters and locals (`declared`) that an expression or statement names and does not declare itself."""
        own = {part.name for part in nodes(node) if isinstance(part, c_ast.Decl)}
        names = dict.fromkeys(part.name for part in named(node))
        return [name for name in names if name in declared and name not in own]

    # ---- edits

    def fresh(self, stem: str) -> str:
        """A name that the driver does not use."""
        while True:
            self._names += 1
            name = f"{stem}{self._names}"
            if name not in self.text:
                return name

    def replace(self, node: Any, text: str, *, statement: bool = False) -> None:
        """Replace a node; what follows it stays in its line."""
        start, end = self._offsets(node, statement)
        self._edit(start, 2, end, text + "\n" * self.text.count("\n", start, end))

    def replace_name(self, name: Any, text: str) -> None:
        """Replace a name, not the parentheses around it."""
        lexeme = self._lexeme(name)
        self.replace_lexemes(lexeme, lexeme, text)

    def replace_lexemes(self, first: int, last: int, text: str) -> None:
        """Replace the lexemes from number `first` to number `last`."""
        start, end = self._start(first), self._end(last)
        self._edit(start, 2, end, text + "\n" * self.text.count("\n", start, end))

    def replace_target(self, assignment: Any, text: str) -> None:
        """Replace the target of an assignment and its operator."""
        self.replace_lexemes(self.span(assignment.lvalue)[0], self.span(assignment.rvalue)[0] - 1, text)

    def add_first(self, opening: int, text: str) -> None:
        """Write the first parameter or argument behind the parenthesis `opening`, in the place of `void`."""
        following = self._lexemes[opening + 1]
        if following.value == "void" and self._lexemes[opening + 2].type == "RPAREN":
            self.replace_lexemes(opening + 1, opening + 1, text)
        else:
            end = self._end(opening)
            self._edit(end, 1, end, text if following.type == "RPAREN" else f"{text}, ")

    def opening(self, name: Any) -> int:
        """The parenthesis behind the name of a called function, or behind that of a defined one."""
        if not isinstance(name, c_ast.FuncDef):
            return self._lexeme(name) + 1
        first, last = self.span(name, statement=True)
        return next(i for i in range(first, last) if self._lexemes[i].value == name.decl.name) + 1

    def expand(self, texts: Mapping[str, str]) -> None:
        """Replace macros by texts."""
        for index, lexeme in enumerate(self._lexemes):
            member = index and self._lexemes[index - 1].type in ("PERIOD", "ARROW")
            if lexeme.value in texts and lexeme.token.kind == NAME and not member:
                self.replace_lexemes(index, index, texts[lexeme.value])

    def remove_word(self, statement: Any, word: str) -> None:
        """Remove a word of a declaration."""
        first, last = self.span(statement, statement=True)
        for index in range(first, last):
            if self._lexemes[index].value == word:
                self.replace_lexemes(index, index, "")
                return

    def remove_initialiser(self, declaration: Any) -> None:
        """Remove `= ...` of a declaration."""
        first, last = self.span(declaration.init)
        self.replace_lexemes(first - 1, last, "")

    def header(self, node: Any, text: str) -> None:
        """Replace what is in front of the body of a loop or a `switch`."""
        self.replace_lexemes(self.span(node, statement=True)[0], self.span(node.stmt, statement=True)[0] - 1, text)

    def label(self, case: Any, text: str) -> None:
        """Replace the label of a `case` or a `default`, with its colon."""
        first = self._lexeme(case)
        last = first + 1 if isinstance(case, c_ast.Default) else self.span(case.expr)[1] + 1
        self.replace_lexemes(first, last, text)

    def before(self, node: Any, text: str, *, statement: bool = True) -> None:
        """Write text in front of a node."""
        start, _ = self._offsets(node, statement)
        self._edit(start, 1, start, text)

    def after(self, node: Any, text: str, *, statement: bool = True) -> None:
        """Write text behind a node."""
        _, end = self._offsets(node, statement)
        self._edit(end, 0, end, text)

    def above(self, function: Any, text: str) -> None:
        """Write text in front of a function, in the line in which that begins."""
        self.before(function, text)

    def move(self, node: Any, line: int, *, statement: bool = False) -> None:
        """Note that a node moves to a line, or is there also."""
        for each in range(self.line(node, statement=statement), self.last_line(node, statement=statement) + 1):
            self.moved[each].add(line)

    def _edit(self, start: int, rank: int, end: int, text: str) -> None:
        serial = len(self._edits)
        self._edits.append((start, rank, serial if rank else -serial, end, text))

    def _start(self, lexeme: int) -> int:
        where = self._lexemes[lexeme].token.where
        return self._line_starts[where.line - 1] + where.column - 1

    def _end(self, lexeme: int) -> int:
        return self._start(lexeme) + len(self._lexemes[lexeme].token.text)

    def _offsets(self, node: Any, statement: bool) -> Span:
        first, last = self.span(node, statement=statement)
        return self._start(first), self._end(last)

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        for line in self.text.splitlines(keepends=True):
            starts.append(starts[-1] + len(line))
        return starts

    @property
    def edited(self) -> str:
        """The text with its edits.  Raises ValueError for edits that overlap."""
        pieces = []
        at = 0
        for start, _, _, end, text in sorted(self._edits):
            if start < at:
                raise ValueError(f"{self.name}: two edits at {self.text[start:end]!r}")
            pieces += [self.text[at:start], text]
            at = end
        return "".join([*pieces, self.text[at:]])


def nodes(node: Any) -> Iterator[Any]:
    """A node and all below it, the outer ones first."""
    yield node
    for _, child in node.children():
        yield from nodes(child)


def named(node: Any) -> Iterator[Any]:
    """The names in an expression or a statement that can be those of objects and functions, not those of members."""
    if isinstance(node, c_ast.ID):
        yield node
    for part, child in node.children():
        if not (isinstance(node, c_ast.StructRef) and part == "field"):
            yield from named(child)


def declaration_of(ctype: CType, name: str) -> str:
    """The declaration of `name` with a type; with that of its word for a bit-field."""
    if isinstance(ctype, IntType) and ":" in ctype.name:
        return f"{'unsigned ' * (not ctype.signed)}{'int' if ctype.bits <= 16 else 'long'} {name}"
    return declarator(ctype, name)


def value_declaration(declaration: Any, name: str, *, parameter: bool = False) -> str | None:
    """The declaration of `name` with the type of the value of a declared object; None: it cannot be said twice.

    An array has no value; it is passed to a `parameter` as a pointer.
    """
    if any(isinstance(node, c_ast.Enum) or getattr(node, "decls", None) for node in nodes(declaration.type)):
        return None
    made = copy.deepcopy(declaration)
    made.name, made.quals, made.storage, made.funcspec, made.init = name, [], [], [], None
    outer = made.type
    if isinstance(outer, c_ast.FuncDecl) or (isinstance(outer, c_ast.ArrayDecl) and not parameter):
        return None
    if isinstance(outer, c_ast.ArrayDecl):
        outer = made.type = c_ast.PtrDecl([], outer.type)
    outer.quals = []
    inner = outer
    while not isinstance(inner, c_ast.TypeDecl):
        inner = inner.type
    inner.declname = name
    return str(CGenerator().visit(made))
