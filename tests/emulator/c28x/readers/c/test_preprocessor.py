"""The preprocessor of real C: macros as the standard's own examples have them, conditions, directives, places."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.readers.c.preprocessor import Limits, PreprocessorOptions, Unit, preprocess_text
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Where


def unit(text: str, **options: object) -> Unit:
    return preprocess_text(text, "t.c", PreprocessorOptions(**options))  # type: ignore[arg-type]


def out(text: str, **options: object) -> str:
    return " ".join(token.text for token in unit(text, **options).tokens)


def refused(text: str, **options: object) -> str:
    with pytest.raises(SourceError) as error:
        unit(text, **options)
    return str(error.value)


# ---- macros: ISO/IEC 9899:1999, 6.10.3.5, examples 3 to 7, results as printed there


def test_rescanning_as_example_3_of_the_standard() -> None:
    assert out("""
        #define x 3
        #define f(a) f(x * (a))
        #undef x
        #define x 2
        #define g f
        #define z z[0]
        #define h g(~
        #define m(a) a(w)
        #define w 0,1
        #define t(a) a
        #define p() int
        #define q(x) x
        #define r(x,y) x ## y
        #define str(x) # x
        f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);
        g(x+(3,4)-w) | h 5) & m
        (f)^m(m);
        p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };
        char c[2][6] = { str(hello), str() };
    """) == (
        "f ( 2 * ( y + 1 ) ) + f ( 2 * ( f ( 2 * ( z [ 0 ] ) ) ) ) % f ( 2 * ( 0 ) ) + t ( 1 ) ; "
        "f ( 2 * ( 2 + ( 3 , 4 ) - 0 , 1 ) ) | f ( 2 * ( ~ 5 ) ) & f ( 2 * ( 0 , 1 ) ) ^ m ( 0 , 1 ) ; "
        "int i [ ] = { 1 , 23 , 4 , 5 , } ; "
        'char c [ 2 ] [ 6 ] = { "hello" , "" } ;'
    )


def test_strings_and_joining_as_example_4_of_the_standard() -> None:
    headers = {"vers2.h": "included"}
    assert out(
        r"""
        #define str(s) # s
        #define xstr(s) str(s)
        #define debug(s, t) printf("x" # s "= %d, x" # t "= %s", \
                                   x ## s, x ## t)
        #define INCFILE(n) vers ## n
        #define glue(a, b) a ## b
        #define xglue(a, b) glue(a, b)
        #define HIGHLOW "hello"
        #define LOW LOW ", world"
        debug(1, 2);
        fputs(str(strncmp("abc\0d", "abc", '\4') // this goes away
              == 0) str(: @\n), s);
        #include xstr(INCFILE(2).h)
        glue(HIGH, LOW);
        xglue(HIGH, LOW)
        """,
        builtin=headers.get,
    ) == (
        'printf ( "x" "1" "= %d, x" "2" "= %s" , x1 , x2 ) ; '
        'fputs ( "strncmp(\\"abc\\\\0d\\", \\"abc\\", \'\\\\4\') == 0" ": @\\n" , s ) ; '
        'included "hello" ; "hello" ", world"'
    )


def test_empty_arguments_as_example_5_of_the_standard() -> None:
    assert (
        out("""
        #define t(x,y,z) x ## y ## z
        int j[] = { t(1,2,3), t(,4,5), t(6,,7), t(8,9,), t(10,,), t(,11,), t(,,12), t(,,) };
    """)
        == "int j [ ] = { 123 , 45 , 67 , 89 , 10 , 11 , 12 , } ;"
    )


def test_hash_hash_made_by_joining_joins_nothing_as_in_6_10_3_3() -> None:
    assert (
        out("""
        #define hash_hash # ## #
        #define mkstr(a) # a
        #define in_between(a) mkstr(a)
        #define join(c, d) in_between(c hash_hash d)
        char p[] = join(x, y);
    """)
        == 'char p [ ] = "x ## y" ;'
    )


def test_variable_arguments_as_example_7_of_the_standard() -> None:
    assert out("""
        #define debug(...) fprintf(stderr, __VA_ARGS__)
        #define showlist(...) puts(#__VA_ARGS__)
        #define report(test, ...) ((test)?puts(#test): printf(__VA_ARGS__))
        debug("Flag");
        debug("X = %d\\n", x);
        showlist(The first, second, and third items.);
        report(x>y, "x is %d but y is %d", x, y);
    """) == (
        'fprintf ( stderr , "Flag" ) ; fprintf ( stderr , "X = %d\\n" , x ) ; '
        'puts ( "The first, second, and third items." ) ; '
        '( ( x > y ) ? puts ( "x>y" ) : printf ( "x is %d but y is %d" , x , y ) ) ;'
    )


def test_the_comma_before_no_variable_arguments_goes_as_gcc_has_it() -> None:
    text = "#define e(f, ...) p(f, ## __VA_ARGS__)\n"
    assert out(text + 'e("a") e("a", 1, 2) e("a",)') == 'p ( "a" ) p ( "a" , 1 , 2 ) p ( "a" , )'


def test_a_macro_without_arguments_is_only_a_name() -> None:
    assert out("#define f(x) [x]\nf ; f\n(1) ; f") == "f ; [ 1 ] ; f"


def test_the_name_of_a_function_like_macro_at_the_end_of_a_header_calls_nothing() -> None:
    assert out('#define f(x) [x]\n#include "a.h"\n(1)', builtin={"a.h": "f"}.get) == "f ( 1 )"


def test_wrong_number_of_arguments_names_call_and_definition() -> None:
    assert refused("#define f(a, b) a\n  f(1)") == (
        "t.c:2:4: the macro f takes 2 arguments, 1 given; it is defined at t.c:1:9"
    )


def test_arguments_without_end_are_reported_where_the_call_starts() -> None:
    assert refused("#define f(a) a\n  f(1\n;") == "t.c:2:3: the arguments of the macro f have no end: ) is missing"


def test_tokens_that_make_none_stay_apart_with_a_remark() -> None:
    found = unit("#define c(a, b) a ## b\nc(., x)")
    assert [token.text for token in found.tokens] == [".", "x"]
    assert [(str(r.where), r.message) for r in found.remarks] == [
        ("t.c:2:1 (macro at t.c:1:22)", ". ## x is not one token; the two stay apart")
    ]


def test_a_second_definition_that_says_something_else_is_a_remark() -> None:
    found = unit("#define A 1\n#define A 1\n#define A 2\nA")
    assert [token.text for token in found.tokens] == ["2"]
    assert [r.message for r in found.remarks] == ["A is defined again, first at t.c:1:9"]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("#define", "expected the name of a macro after #define"),
        ("#define 3", "expected the name of a macro after #define, found '3'"),
        ("#define defined", "defined cannot be the name of a macro"),
        ("#define f(a", "expected , or ) after the parameter a"),
        ("#define f(a,a) a", "the macro has two parameters a"),
        ("#define f(1) a", "expected the name of a parameter, found '1'"),
        ("#define f(a) #b", "# needs a parameter of the macro after it"),
        ("#define f(a) ## a", "## needs a token on each side"),
        ("#define f a ##", "## needs a token on each side"),
        ("#define f __VA_ARGS__", "__VA_ARGS__ stands only in a macro whose parameters end in ..."),
        ("#nonsense", "#nonsense is not a directive of C"),
        ("#error out of order: don't", "#error out of order: don't"),
        ("#endif", "#endif without #if"),
        ("#else", "#else without #if"),
        ("#if", "#if without a condition"),
        ("#ifdef 3", "expected the name of a macro after #ifdef, found '3'"),
        ("#include", 'expected "NAME" or <NAME> after #include'),
        ("#include 3", "expected \"NAME\" or <NAME> after #include, found '3'"),
    ],
)
def test_a_wrong_directive_says_what_is_wrong(line: str, message: str) -> None:
    text = refused(line)
    assert text.startswith("t.c:1:")
    assert text.endswith(": " + message)


# ---- conditions


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("1 + 2 * 3 == 7", True),
        ("-7 / 2 == -3 && -7 % 2 == -1", True),  # towards zero
        ("-1 > 0u", True),  # 2^64 - 1
        ("-1 >> 1 == -1", True),  # arithmetic
        ("1 << 63 < 0", True),  # signed, 64 bits
        ("0x7fffffffffffffff + 1 < 0", True),  # wraps in 64 bits
        ("0xffffffffffffffff == -1", True),  # does not fit signed: unsigned
        ("(2 || 1 / 0) && !(0 && 1 / 0)", True),  # what does not matter is not computed
        ("1 ? 2 : 1 / 0", True),
        ("0 ? 1 : 0 ? 1 : 2", True),
        ("undefined_name", False),
        ("'A' == 65 && '\\n' == 10 && '\\x41' == 65 && '\\101' == 65", True),
        ("010 == 8 && 0b101 == 5 && 10uL == 10", True),
        ("defined A && defined(A) && !defined B", True),
        ("HAS_A", True),
        ("~0 == -1 && !0 && - - 1 == 1", True),
        ("(1, 2)", None),
        ("1 +", None),
        ("1 2", None),
        ("1.5", None),
        ("08", None),
        ("1 / 0", None),
        ("(1", None),
        ('"text"', None),
        ("defined", None),
        ("0x10000000000000000", None),
    ],
)
def test_a_condition_is_an_integer_of_64_bits(condition: str, holds: bool | None) -> None:
    text = f"#define A\n#define HAS_A defined(A)\n#if {condition}\nyes\n#else\nno\n#endif"
    if holds is None:
        assert refused(text).startswith("t.c:3:")
    else:
        assert out(text) == ("yes" if holds else "no")


def test_only_the_first_group_that_holds_is_read() -> None:
    text = "#if 0\na\n#elif X == 2\nb\n#elif 1 / 0\nc\n#else\nd\n#endif"
    assert out(text, defines=["X=2"]) == "b"


def test_a_group_that_is_not_read_may_hold_anything_but_its_own_conditions_count() -> None:
    assert out("#if 0\ndon't @ #bad\n#nonsense\n#if 1\n#else\n#endif\n#elif 1\nyes\n#endif") == "yes"


def test_a_condition_without_end_is_reported_where_it_starts() -> None:
    assert refused("\n #ifdef A\n#if 1\n#endif\n") == "t.c:2:3: #ifdef has no #endif"


def test_else_twice_names_both() -> None:
    assert refused("#if 1\n#else\n#else\n#endif") == "t.c:3:2: #else after the #else of the #if at t.c:1:2"


# ---- places


def places(text: str, **options: object) -> list[tuple[str, str]]:
    return [(token.text, str(token.where)) for token in unit(text, **options).tokens]


def test_a_place_is_the_real_line_and_column() -> None:
    # A tab is one column; the comment and the joined line count as they are written.
    assert places("\tint /* a\n b */ x\\\n  = 1;\r\ny") == [
        ("int", "t.c:1:2"), ("x", "t.c:2:7"), ("=", "t.c:3:3"), ("1", "t.c:3:5"), (";", "t.c:3:6"), ("y", "t.c:4:1"),
    ]  # fmt: skip


def test_what_a_macro_writes_has_both_ends_and_an_argument_its_own() -> None:
    assert places("#define TWICE(x) (x + \\\n    x)\n  TWICE(n);") == [
        ("(", "t.c:3:3 (macro at t.c:1:18)"),
        ("n", "t.c:3:9"),
        ("+", "t.c:3:3 (macro at t.c:1:21)"),
        ("n", "t.c:3:9"),
        (")", "t.c:3:3 (macro at t.c:2:6)"),
        (";", "t.c:3:11"),
    ]


def test_a_macro_within_a_macro_is_used_where_the_outer_one_is() -> None:
    assert places("#define IN 7\n#define OUT IN\n\n OUT") == [("7", "t.c:4:2 (macro at t.c:1:12)")]


def test_file_and_line_are_those_of_the_use() -> None:
    assert out("#define HERE __FILE__ __LINE__\n\nHERE") == '"t.c" 3'


def test_line_directives_change_no_place() -> None:
    found = unit('#line 100 "x.c"\n__LINE__')
    assert [token.text for token in found.tokens] == ["2"]
    assert [r.message for r in found.remarks] == ["#line is ignored: places are those of this file"]


def test_an_error_out_of_a_macro_names_both_ends() -> None:
    assert refused("#define ZERO 1 / 0\n#if ZERO\n#endif") == (
        "t.c:2:5: the condition divides by zero (out of the macro text at t.c:1:16)"
    )


# ---- what goes on besides


def test_pragmas_are_listed_with_their_place_and_are_no_tokens() -> None:
    found = unit('int a;\n#pragma CODE_SECTION(f, "ramfuncs") // fast\n_Pragma("DATA_ALIGN(a, \\"x\\")") int b;')
    assert [token.text for token in found.tokens] == ["int", "a", ";", "int", "b", ";"]
    assert [(p.text, p.where, p.before) for p in found.pragmas] == [
        ('CODE_SECTION(f, "ramfuncs")', Where("t.c", 2, 2), 3),
        ('DATA_ALIGN(a, "x")', Where("t.c", 3, 1), 3),
    ]


def test_warnings_are_remarks() -> None:
    assert [r.message for r in unit("#warning mind the  gap").remarks] == ["#warning mind the gap"]


def test_the_command_line_defines() -> None:
    assert out("A B C(2)", defines=["A", "B=x y", "C(n)=n+n"]) == "1 x y 2 + 2"
    assert refused("", defines=["3=4"]) == "<command line>:1:1: -D 3=4: expected NAME or NAME=VALUE"


def test_what_the_compiler_of_this_chip_defines() -> None:
    text = "__TMS320C28XX__ __TMS320C2000__ __STDC__ __cplusplus __TI_EABI__ _DEBUG __WCHAR_T_TYPE__"
    assert out(text) == "1 1 1 __cplusplus __TI_EABI__ _DEBUG int"
    assert out(text, eabi=True) == "1 1 1 __cplusplus 1 _DEBUG long"


def test_macros_stay_known_with_their_places() -> None:
    found = unit(
        "#define A (B + 1)\n#define B 2\n#define F(x) x\n#define GONE\n#undef GONE\n#define CHIP __TMS320C28XX__"
    )
    assert sorted(found.macros) == ["A", "B", "CHIP", "F"]
    assert found.macros["A"].where == Where("t.c", 1, 9)
    assert found.macros["A"].parameters is None
    assert found.macros["F"].parameters == ("x",)
    assert [token.text for token in found.expansion("A")] == ["(", "2", "+", "1", ")"]
    assert [token.text for token in found.expansion("CHIP")] == ["1"]


def test_budgets_are_those_of_the_caller() -> None:
    assert "more than 10 tokens" in refused("a " * 20, limits=Limits(tokens=10))


WORDS = """
    # ## define undef if ifdef ifndef elif else endif include error warning pragma line _Pragma defined A B f g x
    __VA_ARGS__ __LINE__ ( ) , ... + - * / % << && || ? : ! ~ 1 0 08 0x1F 1.5 'a' "s" ' " @ /* */ // #define #if #endif
    #else #include
"""
LINES = ["\n", "\n#define A ", "\n#define f(x) ", "\n#if ", "\n#endif\n", " ", "\\", "\\\n", "\0", "ñ"]
SOUP = st.lists(st.sampled_from(WORDS.split() + LINES), max_size=60)


def answer(words: list[str]) -> Unit | SourceError:
    try:
        return unit(" ".join(words), limits=Limits(tokens=20_000))
    except SourceError as error:
        return error


@given(SOUP)
def test_no_soup_of_tokens_is_anything_but_read_or_refused(words: list[str]) -> None:
    found = answer(words)
    if isinstance(found, SourceError):
        assert found.file == "t.c"
        assert found.line >= 1
        assert found.column >= 1


@given(SOUP)
def test_what_was_preprocessed_stays_as_it_is(words: list[str]) -> None:
    once = answer(words)
    if isinstance(once, SourceError):
        return
    texts = [token.text for token in once.tokens]
    if any(token.kind in ("bad", "other") or token.text in ("#", "%:", "_Pragma") for token in once.tokens):
        return  # a directive made by a macro is none (6.10.3.4), in a file it would be
    assert out("\n".join(texts)).split() == " ".join(texts).split()
