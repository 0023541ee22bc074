"""C that is refused, each with line and column of the construct and a message that names it.

`@` marks the place: it is taken out before the text is read.  Columns count characters from 1.  A statement stands at
its first word, an operation at its first operand, an operator with one operand at that operand, what is declared or
named at its name; where the grammar breaks, the place is the token that does not fit.
"""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import refused, run_c

STRUCT = "struct s { int x; unsigned int b : 3; };\nstruct s o;\nint v[3];\nint *p;\n"


def body(*lines: str) -> str:
    """A function of the lines, with an object of each kind around it."""
    return STRUCT + "int g(int a);\nint f(int n)\n{\n" + "".join(f"    {line}\n" for line in lines) + "}\n"


#: Name, text, words that the message holds (in any case).
CASES: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    # Not modelled, or not C99
    ("goto", body("@goto in;", "while (n) {", "in:", "n--;", "}", "return n;"), ("goto in", "into a block")),
    ("va_start without an ellipsis", "#include <stdarg.h>\nint f(int n)\n{\n    va_list p;\n"
     "    @va_start(p, n);\n    return 0;\n}\n", ("va_start", "...")),
    ("structure behind the parameters", "#include <stdarg.h>\nstruct t { int a, b; };\nint f(int n, ...)\n{\n"
     "    return n;\n}\nint g(struct t s)\n{\n    return @f(1, s);\n}\n", ("struct t", "address")),
    ("initial value beyond its type", "const long x = @200 * 300;\n", ("200 * 300", "int", "16", "200L")),
    ("initial value divided by zero", "const int x = @5 / 0;\n", ("zero",)),
    ("enumerator beyond its type", "enum { A = @32767 + 1 };\n", ("A", "32767 + 1", "16", "32767L")),
    ("enumerator shifted out", "enum { A = @2 << 15 };\n", ("A", "2 << 15", "2L")),
    ("enumeration that is nowhere", "@enum nosuch x;\n", ("nosuch", "not defined")),
    ("declaration before a body of no parameter", "int f(a) int a; int @b; { return a; }\n", ("b", "not a parameter")),
    ("flexible array member", "struct t { int n; int @body[]; };\n", ("body", "length", "give")),
    ("variable length", body("int w[@n];", "return 0;"), ("length", "constant")),
    ("statement expression", body("return (@{ n; });"), ("{",)),
    ("typeof", body("@typeof(n) m = n;", "return m;"), ("typeof",)),
    ("case range", body("switch (n) {", "case 1 @... 3:", "return 1;", "}", "return 0;"), ("...",)),
    ("?: without a middle", body("return n ? @: 5;"), (":",)),
    ("function within a function", body("int h(void) @{ return 1; }", "return h();"), ("function", "gcc")),
    ("complex", "@_Complex float z;\n", ("complex",)),
    ("octet type", "#include <stdint.h>\n@uint8_t x;\n", ("uint8_t", "uint16_t")),
    ("signed octet type", "#include <stdint.h>\n@int8_t x;\n", ("int8_t", "int16_t")),
    ("assembler", body('@asm(" MOV AL, #1");', "return n;"), ("asm", "NOP", "#if")),
    ("assembler on the stack", body('@asm(" PUSH ST1");', "return n;"), ("PUSH ST1", "__disable_interrupts")),
    ("assembler, second line", body('@asm(" NOP\\n MOV AL, #1");', "return n;"), ("MOV AL",)),
    ("repeated too often", body('@asm(" RPT #256 || NOP");', "return n;"), ("RPT #256",)),
    ("constant beyond 64 bits", "long double x = @1e400L;\n", ("long double", "1.79")),
    ("member of an unnamed structure twice", "struct t { int a; struct @{ int a; }; };\n", ("a", "twice")),
    # Preprocessor
    ("no such header", '#include @"nosuch.h"\n', ("nosuch.h",)),
    ("no such system header", "#include @<nosuch.h>\n", ("nosuch.h", "-I")),
    ("header of C that is not there", "#include @<setjmp.h>\n", ("setjmp.h", "C's library", "not modelled")),
    ("header of SYS/BIOS that is not there", "#include @<ti/sysbios/heaps/HeapTrack.h>\n", ("HeapTrack.h", "SYS/BIOS")),
    ("header by an absolute path", '#include @"/etc/hostname"\n', ("/etc/hostname",)),
    ("header outside", '#include @"../../../../etc/hostname"\n', ("etc/hostname",)),
    ("#error", "int x;\n#@error choose a board\n", ("choose a board",)),
    ("header that SysConfig makes", '#include @"board.h"\n', ("board.h", "SysConfig")),
    ("C++", 'extern @"C" {\nint f(void);\n}\n', ("C++", "__cplusplus")),
    ("way into a register of older headers",
     '#include "F28x_Project.h"\nvoid f(void) { @EPwm1Regs.CMPA.half.CMPA = 1; }\n',
     ("EPwm1Regs.CMPA.all", ".bit", "older")),
    ("#if without #endif", "int x;\n#@if 1\nint y;\n", ("#endif",)),
    ("#endif without #if", "int x;\n#@endif\n", ("#endif", "#if")),
    ("#else twice", "#if 1\n#else\n#@else\n#endif\n", ("#else",)),
    ("unknown directive", "#@nosuch\n", ("nosuch",)),
    ("#if that is no expression", "#if 1 @+\nint x;\n#endif\n", ("condition", "+")),
    ("#if with a division by zero", "#if 1 @/ 0\nint x;\n#endif\n", ("zero",)),
    ("#define without a name", "#define @5 6\n", ("name",)),
    ("too few macro arguments", "#define ADD(a, b) a + b\nint x = ADD@(1);\n", ("ADD", "2")),
    ("too many macro arguments", "#define ADD(a, b) a + b\nint x = ADD@(1, 2, 3);\n", ("ADD", "2")),
    ("macro call without its end", "#define ADD(a, b) a + b\nint x = @ADD(1,\n", ("ADD", ")")),
    ("# before no parameter", "#define F(a) @#b\n", ("#",)),
    # Tokens
    ("comment without its end", "int x;\n@/* no end\n", ("comment",)),
    ("string without its end", 'const char *s = @"abc;\n', ("quote",)),
    ("character without its end", "int x = @'a;\n", ("quote",)),
    ("empty character", "int x = @'';\n", ("quote",)),
    ("stray character", "int x = 1 @$ 2;\n", ("$",)),
    ("bad octal", "int x = @08;\n", ("08",)),
    ("bad suffix", "int x = @5q;\n", ("5q",)),
    ("constant too large", "long long x = @99999999999999999999;\n", ("99999999999999999999", "64")),
    # Syntax
    ("missing semicolon", body("n = 1@", "return n;"), (";", "return")),
    ("missing parenthesis", body("if (n @{", "}", "return n;"), ("{",)),
    ("missing brace", "int f(void)\n{\n    return 1;@\n", ("end", "drv.c:2:1")),
    ("missing brace of a block", body("if (n) {", "n = 1;", "return n;")[:-1] + "@", ("end", "drv.c:7:1")),
    ("else without if", body("@else", "n = 1;", "return n;"), ("else",)),
    ("no operand", body("return n + @;"), (";",)),
    # Names
    ("not declared", body("return @y;"), ("y is not declared",)),
    ("mistyped", body("int count = n;", "return @cuont;"), ("cuont is not declared", "count?")),
    ("function that is nowhere", body("return @nosuch(1);"), ("nosuch is not declared", "no file")),
    ("no member", body("return o.@z;"), ("struct s has no member z",)),
    ("mistyped member", "struct t { int length; };\nint f(struct t *q)\n{\n    return q->@lenght;\n}\n", ("length?",)),
    ("no structure", body("return @n.x;"), ("structure",)),
    ("arrow on an object", body("return @o->x;"), ("->",)),
    ("declared twice", body("int a;", "int @a;", "return n;"), ("a is declared twice", "first at drv.c:8:9")),
    ("parameter again", body("int @n;", "return n;"), ("n is declared twice", "first at drv.c:6:11")),
    ("volatile before", "extern volatile int g;\nint @g = 0;\n", ("g", "volatile before and not here")),
    ("const here", "extern int v[2];\nconst int @v[2] = {1, 2};\n", ("v", "const here and not before")),
    ("defined twice", "int f(void)\n{\n    return 1;\n}\nint @f(void)\n{\n    return 2;\n}\n", ("f", "twice")),
    ("two values", "int x = 1;\nint @x = 2;\n", ("x", "twice")),
    ("another type", "int x;\nlong @x;\n", ("x", "int", "long")),
    ("another prototype", "int f(int a);\nlong @f(int a);\n", ("f", "int", "long")),
    ("enumerator twice", "enum { A, @A };\n", ("A is declared twice, first at drv.c:1:8",)),
    ("enumerator and function", "int f(void);\nenum { @f };\n", ("f is declared twice, first at drv.c:1:5",)),
    ("object and enumerator", "enum { A };\nint @A;\n", ("A is declared again", "first at drv.c:1:8")),
    ("member twice", "struct t { int a; int @a; };\n", ("a", "twice")),
    ("no type", "@nosuch x;\n", ("nosuch",)),
    ("incomplete", "struct nosuch @x;\n", ("nosuch",)),
    ("void object", "void @x;\n", ("void",)),
    # Statements
    ("break nowhere", body("@break;", "return n;"), ("break",)),
    ("continue nowhere", body("@continue;", "return n;"), ("continue",)),
    ("continue in a switch alone", body("switch (n) {", "case 1:", "@continue;", "}", "return n;"), ("continue",)),
    ("case nowhere", body("@case 1:", "return n;"), ("case",)),
    ("case twice", body("switch (n) {", "case 1:", "case @1:", "return 1;", "}", "return n;"), ("1", "twice")),
    ("case twice by conversion", body("switch (n) {", "case -1:", "case @0xFFFF:", "return 1;", "}", "return n;"),
     ("twice",)),
    ("default twice", body("switch (n) {", "default:", "@default:", "return 1;", "}", "return n;"),
     ("default", "twice")),
    ("case not constant", body("switch (n) {", "case @n:", "return 1;", "}", "return n;"), ("constant",)),
    ("switch on a float", body("switch (@1.5f) {", "case 1:", "return 1;", "}", "return n;"), ("integer",)),
    ("value from void", "void f(void)\n{\n    @return 1;\n}\n", ("void",)),
    ("structure as a test", body("if (@o)", "return 1;", "return n;"), ("structure",)),
    # Expressions
    ("assignment to a value", body("@n + 1 = 2;", "return n;"), ("assign",)),
    ("assignment to an array", body("@v = 0;", "return n;"), ("assign",)),
    ("assignment to a constant", "const int c = 1;\nvoid f(void)\n{\n    @c = 2;\n}\n", ("const",)),
    ("++ of a value", body("(@n + 1)++;", "return n;"), ("++",)),
    ("address of a constant", body("p = &@5;", "return n;"), ("&",)),
    ("address of a bit-field", body("return &o.@b != 0;"), ("bit-field",)),
    ("size of a bit-field", body("return sizeof(o.@b);"), ("bit-field",)),
    ("* of an int", body("return *@n;"), ("pointer",)),
    ("index of an int", body("return @n[0];"), ("index",)),
    ("index that is a float", body("return v[@1.5f];"), ("index", "integer")),
    ("call of an int", body("return @n(1);"), ("function",)),
    ("too few arguments", body("return @g();"), ("g takes 1",)),
    ("too many arguments", body("return @g(1, 2);"), ("g takes 1",)),
    ("structure for an int", body("return g(@o);"), ("struct s",)),
    ("% of a float", body("return @1.5f % 2;"), ("%",)),
    ("shift of a float", body("return @1.5f << 2;"), ("<<",)),
    ("~ of a float", body("return ~@1.5f;"), ("~",)),
    ("pointer plus pointer", body("return @p + p != 0;"), ("+",)),
    ("pointer times int", body("return @p * 2;"), ("*",)),
    ("structures compared", body("return @o == o;"), ("==",)),
    ("structure added", body("return @o + 1;"), ("+",)),
    ("value of a void call", "void g(void);\nint f(void)\n{\n    return @g();\n}\n", ("void",)),
    ("cast to an array", body("return (@int[3])p;"), ("cast",)),
    ("cast of a structure", body("return (int)@o;"), ("cast",)),
    # Objects
    ("length 0", "int x[@0];\n", ("element",)),
    ("negative length", "int x[-@1];\n", ("element",)),
    ("too large for the memory", "int @x[200000000];\n", ("x", "memory")),
    ("length out of reason", "int x[@1LL << 62];\n", ("memory",)),
    ("start value not constant", "int g(void);\nint x = @g();\n", ("constant",)),
    ("too many values", "int x[2] = { 1, 2, @3 };\n", ("2",)),
    ("text too long", 'char s[2] = @"abc";\n', ("2",)),
    ("no such designator", STRUCT + "struct s q = { .@z = 1 };\n", ("z",)),
    ("designator outside", "int x[2] = { [@5] = 1 };\n", ("5",)),
    ("bit-field too wide", "struct t { unsigned int a : @17; };\n", ("16",)),
    ("bit-field of a float", "struct t { @float a : 3; };\n", ("bit-field",)),
    ("enumerator not constant", "int x;\nenum { A = @x };\n", ("constant",)),
    ("structure within itself", "struct t { struct t @x; };\n", ("struct t",)),
    ("array of functions", "int @x[2](void);\n", ("function",)),
    # Within a macro: the place where it is used, and its definition's line in the message.
    ("in a macro", "#define BAD nosuch + 1\nint f(void)\n{\n    return @BAD;\n}\n", ("nosuch", "macro", "1:13")),
    ("in a macro's argument", "#define SAME(x) (x)\nint f(void)\n{\n    return SAME(@nosuch);\n}\n",
     ("nosuch",)),
)  # fmt: skip


def marked(text: str) -> tuple[str, int, int]:
    """The text without its mark, and the mark's line and column."""
    before, after = text.split("@")
    return before + after, before.count("\n") + 1, len(before) - before.rfind("\n")


@pytest.mark.parametrize(("text", "words"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_what_is_no_c_of_this_chip_is_refused_at_its_place(text: str, words: tuple[str, ...]) -> None:
    text, line, column = marked(text)
    at_line, at_column, message = refused(text)
    assert (at_line, at_column) == (line, column), message
    missing = [word for word in words if word.lower() not in message.lower()]
    assert not missing, message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("int f(void)\n{\n    return " + "(" * 5000 + "1" + ")" * 5000 + ";\n}\n", ("nest",)),
        ("int f(void)\n" + "{" * 5000 + "}" * 5000 + "\n", ("nest",)),
        ("int f(int n)\n{\n    return " + "- " * 5000 + "n;\n}\n", ("nest",)),
        ("int " + "*" * 5000 + "p;\n", ("nest",)),
        ("".join(f"#define M{i + 1} M{i} M{i}\n" for i in range(40)) + "int M0 = 1; M40\n", ()),
        ("#if 1\n" * 5000 + "#endif\n" * 5000, ("nest",)),
        ('#include "drv.c"\n', ("drv.c",)),
        ("int x = 1 << 10000000000;\n", ()),
        ("int x[3] = { [0 ? 1 : 4000000000] = 1 };\n", ()),
    ],
    ids=["parentheses", "blocks", "minuses", "stars", "macros", "conditions", "itself", "shift", "designator"],
)
def test_what_is_out_of_measure_is_refused_with_a_place(text: str, words: tuple[str, ...]) -> None:
    line, column, message = refused(text)
    assert line > 0
    assert column > 0
    assert not [word for word in words if word.lower() not in message.lower()], message


def test_a_long_sum_is_no_deep_one() -> None:
    # 5,000 terms of 1 and a start of 0: an ordinary, if long, sum.
    assert run_c("int f(void)\n{\n    return 0" + " + 1" * 5000 + ";\n}\n", "f") == 5000
