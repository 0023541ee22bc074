"""The syntax tree of real C: every node with its place, what TI's compiler has besides C99, one good error."""

from __future__ import annotations

import gc
import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.readers.c.parser import ParserLimits, parse, parse_expression
from emulator.c28x.readers.c.preprocessor import preprocess_text
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Where

c_ast = pytest.importorskip("pycparser.c_ast", reason="pycparser is not installed: pip install c2000-hil[c]")


def tree(text: str, **options: Any) -> Any:
    return parse(preprocess_text(text, "t.c").tokens, **options)


def refused(text: str, **options: Any) -> str:
    with pytest.raises(SourceError) as error:
        tree(text, **options)
    return str(error.value)


def nodes(node: Any) -> list[Any]:
    return [node, *(found for _, child in node.children() for found in nodes(child))]


def body(text: str) -> list[Any]:
    """The statements of a function that has `text`."""
    return list(tree("void f(void) { " + text + " }").ext[0].body.block_items)


# ---- places


def test_every_node_has_the_place_of_its_file() -> None:
    text = """
    #define GAIN(x) (3 * (x))
    typedef struct { int a[3]; unsigned b : 4; } S;
    enum e { ONE, TWO = 2 };
    int g(int, char *name);
    S s = { .a = { [1] = GAIN(ONE), 2 }, 7 };
    int f(S *p, int n) {
        for (int i = 0; i < n; i++) { p->a[i] += GAIN(i) ? sizeof(int *) : -1; }
        switch (n) { case 1: case 2: break; default: return g(n, "a" "b"); }
        do n--; while (n);
        return (int) p->b;
    }
    """
    found = nodes(tree(text))
    assert len(found) > 100
    assert all(isinstance(node.coord, Where) and node.coord.file == "t.c" for node in found)


def test_a_node_out_of_a_macro_has_both_ends() -> None:
    product = tree("#define GAIN(x) 3 * (x)\nint y =\n  GAIN(z);").ext[0].init
    assert product.left.coord == Where("t.c", 3, 3, Where("t.c", 1, 17))
    assert product.right.coord == Where("t.c", 3, 8)


# ---- what TI's compiler has besides


def test_interrupt_is_kept_wherever_it_stands() -> None:
    text = """
    interrupt void a(void);
    __interrupt void b(void) { }
    static void interrupt c(void) { }
    __attribute__((interrupt)) void d(void);
    int no; void e(void) __attribute__((__interrupt__));
    void plain(void) { }
    """
    marked = {}
    for node in tree(text).ext:
        declaration = node.decl if isinstance(node, c_ast.FuncDef) else node
        marked[declaration.name] = "interrupt" in declaration.funcspec
    assert marked == {"a": True, "b": True, "c": True, "d": True, "no": False, "e": True, "plain": False}


def test_interrupt_in_types_of_pointers_is_read() -> None:
    text = "typedef interrupt void (*PINT)(void); struct V { interrupt void (*T)(void); };"
    assert len(tree(text + "PINT p = (interrupt void (*)(void)) 0;").ext) == 3


def test_registers_of_the_core_are_qualified() -> None:
    assert tree("extern cregister volatile unsigned int IER;").ext[0].quals == ["cregister", "volatile"]


def test_far_and_near_are_dropped_where_they_qualify_and_names_elsewhere() -> None:
    text = "far int a; int far *b; int near = 1; int f(void) { int far, y = near * 2; far = near + y; return far; }"
    assert [getattr(node, "name", None) for node in tree(text).ext[:3]] == ["a", "b", "near"]


def test_assembler_is_a_call_in_a_function_and_outside() -> None:
    outside, function = tree('asm(" .global x");\nvoid f(void) { __asm(" NOP"); asm volatile (" ESTOP0"); }').ext
    calls = [outside, *function.body.block_items]
    assert [(call.name.name, call.args.exprs[0].value) for call in calls] == [
        ("__asm", '" .global x"'), ("__asm", '" NOP"'), ("__asm", '" ESTOP0"'),
    ]  # fmt: skip


def test_other_spellings_of_keywords_and_digraphs() -> None:
    function = tree("static __inline int f(int *__restrict p) <% return p<:0:>; %>").ext[0]
    assert function.decl.funcspec == ["inline"]
    assert isinstance(function.body.block_items[0].expr, c_ast.ArrayRef)


def test_attributes_are_dropped() -> None:
    assert tree("struct __attribute__((packed)) S { int a __attribute__((aligned(4))); };").ext[0].type.name == "S"


def test_adjacent_strings_stay_apart() -> None:
    # Joined without a boundary "\1" "2" would be one character.
    assert tree('char *s = "\\1" "2" "b";').ext[0].init.value == '"\\1" "2" "b"'


def test_pragmas_change_nothing_wherever_they_stand() -> None:
    text = "int a[] = { 1,\n#pragma x\n2 };\nint f(void)\n#pragma y\n{ if (a)\n#pragma z\nreturn 1; return 2; }"
    assert len(tree(text).ext[1].body.block_items) == 2


def test_types_of_ours_are_known_and_may_be_hidden() -> None:
    assert tree("Uint16 x; void f(void) { int Uint16 = 1; Uint16++; }", typedefs={"Uint16"}).ext[0].name == "x"
    assert tree("typedef unsigned Uint16; Uint16 x;", typedefs={"Uint16"}).ext[1].name == "x"


def test_a_type_is_hidden_only_in_its_block() -> None:
    inner, outer = body("typedef int T; { int T = 1; T * 2; } T * p;")[1:]
    assert isinstance(inner.block_items[1], c_ast.BinaryOp)
    assert isinstance(outer, c_ast.Decl)


def test_a_macro_is_read_as_an_expression() -> None:
    unit = preprocess_text("#define SIZE (4 * WIDTH)\n#define WIDTH 8u\n#define BAD 4 +\n", "t.c")
    product = parse_expression(unit.expansion("SIZE"))
    assert (product.op, product.left.value, product.right.value) == ("*", "4", "8u")
    with pytest.raises(SourceError, match="expected an expression"):
        parse_expression(unit.expansion("BAD"))
    with pytest.raises(ValueError, match="no tokens"):
        parse_expression([])


def test_nothing_is_an_empty_file() -> None:
    assert tree("").ext == []


# ---- errors


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("int x\nint y;", "t.c:1:6: expected ';' after 'x'; found 'int' in line 2"),
        (
            "#define A 0\nenum E {\n  A = 1 };",
            "t.c:2:9: expected a name after '{'; found '0' in line 3, out of the macro text at t.c:1:11",
        ),
        ("int x = 5 6;", "t.c:1:11: expected ';', found '6'"),
        ("void f(void) { x = ; }", "t.c:1:20: expected an expression, found ';'"),
        ("void f(void) { g(1,); }", "t.c:1:20: expected an expression, found ')'"),
        ("void f(void) { if (x { } }", "t.c:1:22: expected ')', found '{'"),
        ("void f(void) { a ? b; }", "t.c:1:21: expected ':', found ';'"),
        ("void f(void) { else x(); }", "t.c:1:16: 'else' without 'if'"),
        ("void f(void) { ) }", "t.c:1:16: expected a statement, found ')'"),
        (
            "void f(void) {\n  return; ",
            "t.c:2:10: expected '}' after ';'; the file ends, and the { at t.c:1:14 is open",
        ),
        ("}", "t.c:1:1: expected a declaration, found '}': one closing brace too many?"),
        ("for (;;);", "t.c:1:1: expected a declaration, found 'for'"),
        ("x = 5;", "t.c:1:3: expected a declaration or a function's body: 'x' has no type, found '='"),
        ("int a[3;", "t.c:1:8: expected ']', found ';'"),
        ("enum { 1 };", "t.c:1:8: expected a name, found '1'"),
        ("struct 3;", "t.c:1:8: expected a name or { after struct or union, found '3'"),
        ("int struct S x;", "t.c:1:12: two types in one declaration"),
        ("typedef int T; int T;", "t.c:1:20: non-typedef 'T' previously declared as typedef in this scope"),
        ("int x = 08;", "t.c:1:9: 08 starts with 0: it is octal and has a digit 8 or 9"),
        ("int x = 1abc;", "t.c:1:9: 1abc is not a number of C"),
        ("int @;", "t.c:1:5: the character '@' (U+0040) has no place in C here"),
        ("int \0;", "t.c:1:5: the character '\\x00' (U+0000) has no place in C here"),
        ('char *s = "abc\n;', 't.c:1:11: the quote " has no end in its line'),
        ("int x = \\ 3;", "t.c:1:9: a stray \\: it joins two lines only as the very last character of a line"),
        ("int x = # 3;", "t.c:1:9: # stands outside a directive"),
    ],
)
def test_an_error_says_where_what_stands_there_and_what_was_expected(text: str, message: str) -> None:
    assert refused(text) == message


@pytest.mark.parametrize(
    ("text", "column"),
    [
        ("uint33 x;", 1),
        ("uint33 *x;", 1),
        ("static uint33 x;", 8),
        ("void f(uint33 x);", 8),
        ("void f(int a, uint33 *x);", 15),
        ("struct { uint33 x; };", 10),
        ("void f(void) { uint33 x; }", 16),
        ("void f(void) { int x = (uint33) 3; }", 25),
    ],
)
def test_a_type_that_is_not_known_is_named(text: str, column: int) -> None:
    assert refused(text) == (
        f"t.c:1:{column}: 'uint33' is not a type: no typedef of that name was read (is its header included?)"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("int x = ({ 1; });", "1:10: ({ ... }) is an extension of gcc: write a function, or statements before"),
        ("typeof(1) x;", "1:1: typeof is an extension of gcc: write the type"),
        ("void f(void) { switch (a) { case 1 ... 5: ; } }", "1:36: a range with ... is an extension of gcc: "
         "write each value"),
        ("int a[] = { [1 ... 5] = 2 };", "1:16: a range with ... is an extension of gcc: write each value"),
        ("void f(void) { int g(int x) { } }", "1:29: a function within a function is an extension of gcc: move it out"),
        ("int x = _Generic(1, int: 2);", "1:9: _Generic is C11"),
        ('asm("x" : "=r"(y));', "1:9: assembler with operands is an extension of gcc that this chip's compiler lacks"),
        ("_Complex float x;", "1:1: complex numbers are not supported"),
    ],
)  # fmt: skip
def test_what_is_no_c_of_this_chip_is_refused_by_name(text: str, message: str) -> None:
    assert refused(text) == "t.c:" + message


def test_an_error_behind_a_macro_names_both_ends() -> None:
    assert refused("#define SQ(x) ((x) * (x)\nint y = SQ(3);") == (
        "t.c:2:14: expected ')', found ';' after ')', which the macro text at t.c:1:24 ends in"
    )
    assert refused("#define HALF 1 +\nint y[HALF];") == "t.c:2:11: expected an expression, found ']'" + (
        " after '+', which the macro text at t.c:1:16 ends in"
    )
    assert refused("#define OOPS = )\nint y OOPS;") == (
        "t.c:2:7: expected an expression, found ')' after '=', which the macro text at t.c:1:14 ends in"
        " (out of the macro text at t.c:1:16)"
    )


# ---- depth


def test_depths_beyond_what_c99_asks_for_are_read() -> None:
    # C99, 5.2.4.1: 63 levels of brackets in an expression, 127 blocks.
    inner = "int y = " + "(" * 200 + "1" + ")" * 200 + ";"
    assert len(body("{" * 127 + inner + "}" * 127)) == 1
    assert len(body("if (a) b();" + " else if (a) b();" * 500)) == 1
    assert len(body("switch (a) {" + "".join(f"case {n}:" for n in range(500)) + " break; }")) == 1
    assert len(tree("int x = 1" + " + 1" * 5000 + ";").ext) == 1
    assert len(tree("int x = " + "- " * 900 + "1;").ext) == 1


DEEP = {
    "round brackets": "int x = " + "(" * 100_000,
    "braces": "void f(void) " + "{" * 100_000,
    "square brackets": "int a" + "[" * 100_000,
    "else if": "void f(void) { if (a) b();" + " else if (a) b();" * 20_000 + "}",
    "if": "void f(void) {" + "if (a)" * 20_000 + ";}",
    "signs": "int x = " + "- " * 50_000 + "1;",
    "casts": "int x = " + "(int)" * 50_000 + "1;",
    "assignments": "void f(void) {" + "x = " * 50_000 + "1;}",
    "terms": "int x = 1" + "+1" * 50_000 + ";",
    "stars": "int " + "*" * 50_000 + "x;",
    "calls": "void f(void) { f" + "()" * 50_000 + ";}",
    "members": "void f(void) { x" + ".a" * 50_000 + ";}",
    "dimensions": "int x" + "[1]" * 50_000 + ";",
    "labels": "void f(void) {" + "a: " * 50_000 + "}",
    "cases": "void f(void) { switch (x) {" + "case 1: " * 50_000 + "}}",
    "choices": "int x = " + "1 ? 1 : " * 50_000 + "1;",
    "sizeof": "int x = " + "sizeof " * 50_000 + "1;",
    "words": "const " * 50_000 + "int a, b;",
    "parameters": "int f(" + "int (*)(" * 1_000 + ")" * 1_001 + ";",
    "types in types": "int x = " + "(int[sizeof" * 150 + "(int)" + "]){0}" * 150 + ";",
    "attributes": "int " + "f() __attribute__((interrupt)), " * 5_000 + "g;",
}


@pytest.mark.parametrize("text", DEEP.values(), ids=DEEP)
def test_depth_without_bound_is_an_error_with_a_place(text: str) -> None:
    limit = sys.getrecursionlimit()
    assert refused(text).startswith("t.c:1:")
    assert sys.getrecursionlimit() == limit
    assert gc.isenabled()


def test_more_tokens_than_a_unit_may_have() -> None:
    # Six times `int a;` are 18 tokens; the 21st is the seventh semicolon, in column 6 * 6 + 6.
    assert refused("int a;" * 10, limits=ParserLimits(tokens=20)) == (
        "t.c:1:42: the file has more than 20 tokens with its headers"
    )


WORDS = """
    int char struct union enum typedef static const volatile void if else while do for switch case default break
    continue return goto sizeof interrupt cregister asm far T x y f 1 08 1.5 'a' "s" ( ) ( ) [ ] { } { } ; ; , . ... ->
    ++ -- * & + - ~ ! / % << < == ? : = += ^ | && || __attribute__ ((interrupt)) _Bool @ offsetof inline #
    static_assert _Static_assert __asm \\ __builtin_va_arg
"""


@given(st.lists(st.sampled_from(WORDS.split()), max_size=40), st.booleans())
def test_no_soup_of_tokens_is_anything_but_read_or_refused(words: list[str], inside: bool) -> None:
    text = " ".join(words)
    found = None
    try:
        tree("void f(int x) {" + text + "}" if inside else text, typedefs={"T"})
    except SourceError as error:
        found = error
    assert found is None or (found.line == 1 and found.column >= 1)
