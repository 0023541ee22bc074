"""pycparser's grammar with our own places, errors and limits.  It is imported only if pycparser is installed.

A hostile file can make pycparser's backtracking, its walks over declarators and its name look-ups take very long.
Here, everything that can grow faster than the file has a limit.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Final, NoReturn

from pycparser import c_ast
from pycparser.c_parser import CParser

from emulator.c28x.readers.c.parser import KEYWORDS, PUNCTUATORS, Lexeme, ParsedHeaders
from emulator.c28x.readers.c.tokens import error_at
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Where

#: The limits for pointers, arrays and parameter lists of one declarator (C99 requires 12), and for words before it.
_DECLARATOR: Final = 200
_SPECIFIERS: Final = 100

_SPELLED: Final = {kind: text for text, kind in reversed(PUNCTUATORS.items())} | {
    kind: word for word, (kind, spelling) in KEYWORDS.items() if word == spelling and kind not in ("ID", "INLINE")
}
_SAID: Final = {
    "Invalid expression": "expected an expression",
    "Invalid declarator": "expected a name",
    "Invalid specifier list": "expected a type",
    "Invalid declaration": "expected a declaration",
    "Missing type in declaration": "the declaration has no type",
    "Invalid multiple types specified": "two types in one declaration",
    "Invalid typedef": "a typedef cannot be a function's definition",
    "Invalid struct/union declaration": "expected a name or { after struct or union",
    "Invalid struct reference": "expected the name of a member",
    "Expected identifier": "expected a name",
    "At end of input": "expected more",
}
#: The kinds of lexemes that can come before the type of a declaration.
_BEFORE_A_TYPE: Final = frozenset((
    "SEMI", "LBRACE", "RBRACE", "LPAREN", "COMMA", "COLON", "STATIC", "EXTERN", "TYPEDEF", "REGISTER", "AUTO", "CONST",
    "VOLATILE", "RESTRICT", "INLINE",
))  # fmt: skip


class _Lexer:
    """A replacement for the lexer of pycparser, which has no text to read."""

    filename = ""

    def __init__(self, error_func: Any = None, **options: Any) -> None:
        """The arguments of pycparser are ignored."""

    def input(self, text: str, filename: str = "") -> None:
        """Do nothing: the grammar already has its lexemes."""

    def token(self) -> Lexeme | None:
        """Return nothing: the grammar gets its lexemes itself."""
        return None


class Parenthesised(c_ast.Assignment):  # type: ignore[misc]
    """An assignment in its own parentheses, which state that its value is used on purpose."""


class EmptyBody(c_ast.EmptyStatement):  # type: ignore[misc]
    """The `;` directly behind the parentheses of an if or a loop."""

    def __init__(self, coord: Where, behind: Where, block: bool) -> None:
        """`behind`: where the next token is; `block`: it is the brace of a block."""
        super().__init__(coord)
        self.behind = behind
        self.block = block


class IfElse(c_ast.If):  # type: ignore[misc]
    """An if with an else: `otherwise` is the place of the word."""

    def __init__(self, node: c_ast.If, otherwise: Where) -> None:
        """The same as `node`."""
        super().__init__(node.cond, node.iftrue, node.iffalse, node.coord)
        self.otherwise = otherwise


class Grammar(CParser):  # type: ignore[misc]
    """The parser of one sequence of lexemes."""

    def __init__(
        self, lexemes: list[Lexeme], typedefs: Collection[str], depth: int, headers: ParsedHeaders | None = None
    ) -> None:
        """`depth`: the limit for nodes from the root to a leaf.  `headers`: what the lexemes begin with, if parsed."""
        super().__init__(lexer=_Lexer)
        self._lexemes = lexemes
        #: The lexemes, with enough None at the end for look-ahead.
        self._stream: list[Lexeme | None] = [*lexemes, None, None, None]
        self._index = len(headers.lexemes) if headers else 0
        self._else = Where("", 0)
        self._headers = headers
        self._typedefs = typedefs
        self._depth = depth
        self._again = 20 * len(lexemes) + 100_000
        #: Visible name -> whether it is a type; for each scope, what the names it hides were outside.
        self._visible: dict[str, bool] = {}
        self._hidden: list[dict[str, bool | None]] = []

    def unit(self) -> c_ast.FileAST:
        """The tree of the translation unit.  Raises SourceError."""
        tree = self._guarded(super()._parse_translation_unit_or_empty)
        if self._headers is None:
            return tree
        return c_ast.FileAST(self._headers.tree.ext + tree.ext, self._headers.tree.coord)

    @property
    def names(self) -> dict[str, bool]:
        """The names of the file scope -> whether each is a type."""
        return dict(self._scope_stack[1])

    def expression(self) -> c_ast.Node:
        """The tree of the one expression that the lexemes are.  Raises SourceError."""
        return self._guarded(self._parse_expression)

    def _guarded(self, rule: Any) -> Any:
        """The tree that `rule` reads.  It must consume all lexemes; every node gets a place."""
        # The public `parse` sets up the stream; it ends in this method, which is replaced by the wanted rule.
        self._parse_translation_unit_or_empty = lambda: self._with_typedefs(rule)
        try:
            tree = self.parse("")
        except RecursionError:
            raise self._here().error("nested too deeply to be read") from None
        except (AssertionError, AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
            if isinstance(error, SourceError):
                raise
            # pycparser's own code fails on some malformed declarations.
            raise self._wrong("this is no declaration or expression of C") from None
        return _placed(tree, self._depth)

    def _with_typedefs(self, rule: Any) -> Any:
        names = dict(self._headers.names) if self._headers is not None else {}
        self._scope_stack = [dict.fromkeys(self._typedefs, True), names]
        self._visible = dict.fromkeys(self._typedefs, True) | names
        self._hidden = [{}, {}]
        tree = rule()
        if (lexeme := self._peek()) is not None:
            raise self._expected("an operator or the end", lexeme)
        return tree

    # ---- the stream: that of pycparser takes twice as long as all the rest

    def _peek(self, k: int = 1) -> Lexeme | None:
        lexeme = self._stream[self._index + k - 1]
        if lexeme is not None and (lexeme.type == "ID" or lexeme.type == "TYPEID"):
            lexeme.type = "TYPEID" if self._visible.get(lexeme.value) else "ID"
        return lexeme

    # `_peek` once more, without the call: the grammar asks for a type again and again.  It is a fifth faster a call.
    def _peek_type(self, k: int = 1) -> str | None:
        lexeme = self._stream[self._index + k - 1]
        if lexeme is None:
            return None
        if lexeme.type == "ID" or lexeme.type == "TYPEID":
            lexeme.type = "TYPEID" if self._visible.get(lexeme.value) else "ID"
        return lexeme.type

    def _advance(self) -> Lexeme:
        lexeme = self._peek()
        if lexeme is None:
            raise self._expected("more", None)
        self._index += 1
        return lexeme

    def _accept(self, token_type: str) -> Lexeme | None:
        if self._peek_type() != token_type:
            return None
        lexeme = self._stream[self._index]
        self._index += 1
        return lexeme

    def _mark(self) -> int:
        return self._index

    def _reset(self, mark: int) -> None:
        self._again -= self._index - mark
        if self._again < 0:
            raise self._here().error("declarators and types nested in a way that takes too long to be read")
        self._index = mark

    # ---- places

    def _tok_coord(self, tok: Lexeme) -> Where:
        return tok.token.where

    # ---- names of types: a single look-up, however many blocks are open

    def _push_scope(self) -> None:
        super()._push_scope()
        self._hidden.append({})

    def _pop_scope(self) -> None:
        super()._pop_scope()
        for name, former in self._hidden.pop().items():
            if former is None:
                del self._visible[name]
            else:
                self._visible[name] = former

    def _add_typedef_name(self, name: str, coord: Any) -> None:
        super()._add_typedef_name(name, coord)
        self._see(name, True)

    def _add_identifier(self, name: str, coord: Any) -> None:
        super()._add_identifier(name, coord)
        self._see(name, False)

    def _see(self, name: str, is_type: bool) -> None:
        self._hidden[-1].setdefault(name, self._visible.get(name))
        self._visible[name] = is_type

    def _is_type_in_scope(self, name: str) -> bool:
        return self._visible.get(name, False)

    # ---- bounds

    def _type_modify_decl(self, decl: Any, modifier: Any) -> Any:
        walk: Any = decl
        for _ in range(_DECLARATOR):
            if isinstance(walk, c_ast.TypeDecl):
                return super()._type_modify_decl(decl, modifier)
            walk = walk.type
        raise self._here().error(f"a declarator of more than {_DECLARATOR} parts")

    def _add_declaration_specifier(self, declspec: Any, newspec: Any, kind: Any) -> Any:
        spec = super()._add_declaration_specifier(declspec, newspec, kind)
        if len(spec[kind]) > _SPECIFIERS:
            raise self._here().error(f"a declaration of more than {_SPECIFIERS} words before the name")
        return spec

    # ---- extensions of TI's compiler

    def _parse_external_declaration(self) -> Any:
        lexeme = self._peek()
        if lexeme is not None and lexeme.type == "ID" and lexeme.value == "__asm":
            return [self._parse_expression_statement()]
        if lexeme is not None and not self._starts_declaration(lexeme):
            if lexeme.type == "RBRACE":
                raise lexeme.token.error("expected a declaration, found '}': one closing brace too many?")
            if lexeme.type not in ("ID", "TIMES", "LPAREN", "SEMI", "_STATIC_ASSERT"):
                raise self._expected("a declaration", lexeme)
        return super()._parse_external_declaration()

    def _parse_function_definition(self, spec: Any, decl: Any) -> Any:
        old_style = isinstance(decl, c_ast.FuncDecl) and decl.args and isinstance(decl.args.params[0], c_ast.ID)
        found = self._peek()
        if not isinstance(decl, c_ast.FuncDecl) or (not old_style and (found is None or found.type != "LBRACE")):
            raise self._expected("';'", found)
        return super()._parse_function_definition(spec, decl)

    def _parse_specifiers(self, *, allow_storage_and_function: bool) -> Any:
        if not allow_storage_and_function:
            # `(interrupt void (*)(void))` and members of that type: for TI's compiler, it is part of a function type.
            while (lexeme := self._peek()) is not None and lexeme.value == "interrupt" and lexeme.type == "INLINE":
                self._advance()
        return super()._parse_specifiers(allow_storage_and_function=allow_storage_and_function)

    def _parse_selection_statement(self) -> Any:
        node = super()._parse_selection_statement()
        # The last `else` whose statement has ended is that of this `if`.
        return IfElse(node, self._else) if isinstance(node, c_ast.If) and node.iffalse is not None else node

    def _parse_pragmacomp_or_statement(self) -> Any:
        before, found = self._before(), self._peek()
        node = super()._parse_pragmacomp_or_statement()
        if before is not None and before.type == "ELSE":
            self._else = before.token.where
        behind = self._peek()
        if before is None or found is None or (before.type, found.type) != ("RPAREN", "SEMI"):
            return node
        if behind is None or behind.type == "RBRACE" or (behind.type == "LBRACE" and self._peek_type(2) == "RBRACE"):
            return node  # nothing is behind it, or an empty block: TI's driverlib has room for a comment so
        closing, end = before.token, found.token
        between = closing.source.text[closing.at + 1 : end.at]
        if closing.use or end.use or closing.source is not end.source or between.strip(" \t"):
            return node  # a macro without text may stand between
        return EmptyBody(node.coord, behind.token.where, behind.type == "LBRACE")

    def _parse_primary_expression(self) -> Any:
        opened = self._peek_type() == "LPAREN"
        node = super()._parse_primary_expression()
        if opened and isinstance(node, c_ast.Assignment):
            return Parenthesised(node.op, node.lvalue, node.rvalue, node.coord)
        return node

    def _parse_unified_string_literal(self) -> Any:
        first = self._advance()
        parts = [first.value]
        while self._peek_type() in ("STRING_LITERAL", "WSTRING_LITERAL"):
            parts.append(self._advance().value)
        return c_ast.Constant("string", " ".join(parts), self._tok_coord(first))

    # ---- errors

    def _here(self) -> Any:
        """The next token, or the last one at the end."""
        return self._lexemes[min(self._index, len(self._lexemes) - 1)].token

    def _before(self, back: int = 1) -> Lexeme | None:
        index = self._index - back
        return self._lexemes[index] if 0 <= index < len(self._lexemes) else None

    def _wrong(self, message: str) -> SourceError:
        lexeme = self._peek()
        if lexeme is None:
            return self._here().error(f"{message}; {self._end()}")  # type: ignore[no-any-return]
        return lexeme.token.error(f"{message}, found {_shown(lexeme)}")

    def _expect(self, token_type: str) -> Any:
        lexeme = self._peek()
        if lexeme is not None and lexeme.type == token_type:
            self._index += 1
            return lexeme
        what = "a name" if token_type == "ID" else repr(_SPELLED.get(token_type, token_type))
        raise self._expected(what, lexeme)

    def _expected(self, what: str, found: Lexeme | None) -> SourceError:
        """The error that `what` was expected but `found` is there; it names the usual cause."""
        before = self._before()
        if found is not None and (unknown := self._unknown_type(found)) is not None:
            return unknown
        if found is not None and found.value == "...":
            return found.token.error("a range with ... is an extension of gcc: write each value")
        if before is None:
            return self._wrong(f"expected {what}")
        if found is not None and before.value == "extern" and found.value == '"C"':
            return found.token.error('extern "C" is C++: only C is read; put it within #ifdef __cplusplus')
        inside = len(self._scope_stack) > 2
        if found is not None and what == "';'" and found.type == "LBRACE" and before.type == "RPAREN" and inside:
            return found.token.error("a function within a function is an extension of gcc: move it out")
        if found is not None and what == "';'" and before.type in ("LBRACE", "RBRACE", "SEMI", "COLON"):
            if found.type == "ELSE":
                return found.token.error("'else' without 'if'")
            what = "a statement"
        last = before.token.where
        if found is None or (found.token.where.line != last.line and last.macro is None):
            # The missing text belongs to the end of the line before.
            column = last.column + (len(before.token.text) if last.macro is None else 0)
            rest = self._end() if found is None else f"found {_shown(found)} in line {found.token.where.line}"
            if found is not None and found.token.where.macro is not None:
                rest += f", out of the macro text at {found.token.where.macro}"
            at = Where(last.file, last.line, column, last.macro)
            return error_at(at, f"expected {what} after {_shown(before)}; {rest}")
        after = f" after {_shown(before)}, which the macro text at {last.macro} ends in" if last.macro else ""
        return found.token.error(f"expected {what}, found {_shown(found)}{after}")

    def _end(self) -> str:
        """The text that the file ends, and which brace is still open."""
        waiting: list[Lexeme] = []
        for lexeme in self._lexemes:
            if lexeme.type == "LBRACE":
                waiting.append(lexeme)
            elif lexeme.type == "RBRACE" and waiting:
                waiting.pop()
        return f"the file ends, and the {{ at {waiting[-1].token.where} is open" if waiting else "the file ends"

    def _unknown_type(self, found: Lexeme) -> SourceError | None:
        """The error about an unknown name that is used as a type; None if `found` does not show such a use."""
        before, second, third = self._before(), self._before(2), self._before(3)
        name = opening = None
        starts = ("ID", "INT_CONST_DEC", "INT_CONST_HEX", "FLOAT_CONST")
        if before is None or found.type not in (*starts, "TIMES"):
            return None
        if before.type == "ID" and found.type in ("ID", "TIMES"):
            name, opening = before, second
        elif found.type == "ID" and (following := self._peek(2)) is not None and following.type in ("ID", "TIMES"):
            name, opening = found, before
        elif (
            before.type == "RPAREN" and second is not None and third is not None and second.type == "ID"
            and third.type == "LPAREN" and found.type in starts
        ):  # fmt: skip
            name = second
        if name is None or name.value == "__asm" or (opening is not None and opening.type not in _BEFORE_A_TYPE):
            return None
        message = "no typedef of that name was read (is its header included?)"
        return name.token.error(f"{_shown(name)} is not a type: {message}")

    def _parse_error(self, msg: str, coord: Any) -> NoReturn:
        found = self._peek()
        if not msg.startswith(("Typedef", "Non-typedef")) and found is not None:
            unknown = self._unknown_type(found)
            if unknown is not None:
                raise unknown
        if msg == "Invalid function definition" and isinstance(coord, Where):
            before = self._before()
            name = _shown(before) if before is not None else "it"
            raise self._wrong(f"expected a declaration or a function's body: {name} has no type")
        said = _SAID.get(msg)
        if said is not None and said.startswith("expected"):
            raise self._expected(said.removeprefix("expected "), found)
        if isinstance(coord, Where):
            raise error_at(coord, said or msg[:1].lower() + msg[1:])
        raise self._wrong(said or msg[:1].lower() + msg[1:])


def _shown(lexeme: Lexeme) -> str:
    text = lexeme.token.text
    return repr(text if len(text) <= 40 else text[:37] + "...")


def _placed(tree: Any, limit: int) -> Any:
    """`tree`, in which every node gets a place: if the grammar gives none, that of its first child or of its parent.

    Raises SourceError if the tree is deeper than `limit`.
    """
    #: Pairs of a node and its parent of which one has no place: parents first, children in reverse order.
    missing: list[tuple[Any, Any]] = []
    stack: list[tuple[Any, int]] = [(tree, 0)]
    fields: dict[type, list[str]] = {}
    while stack:
        node, depth = stack.pop()
        kind = type(node)
        names = fields.get(kind)
        if names is None:
            leave = ("coord", "__weakref__", *kind.attr_names)
            names = fields[kind] = [name for name in reversed(kind.__slots__) if name not in leave]
        if depth >= limit:
            raise error_at(node.coord or Where("", 0), f"an expression or statement of more than {limit:,} levels")
        for name in names:
            below = getattr(node, name)
            if below is None:
                continue
            for child in reversed(below) if isinstance(below, list) else (below,):
                if isinstance(child, c_ast.Node):
                    stack.append((child, depth + 1))
                    if child.coord is None or node.coord is None:
                        missing.append((child, node))
    for node, parent in reversed(missing):
        if parent.coord is None:
            parent.coord = node.coord
    for node, parent in missing:
        if node.coord is None:
            node.coord = parent.coord
    return tree
