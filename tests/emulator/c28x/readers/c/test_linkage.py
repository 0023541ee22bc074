"""What several files mean by one name, what start-up leaves in objects, and remarks of the reader."""

from __future__ import annotations

from functools import partial

import pytest

from emulator.c28x.link import LinkError
from emulator.c28x.runtime import IllegalCall
from emulator.c28x.symbols import SourceError
from emulator.c28x.tree import Function, Variable
from tests.emulator.c28x.readers.c.workshop import CWorkshop, findings_of, read


def test_two_definitions_of_one_function_name_both_places() -> None:
    files = {"a.c": "int f(void)\n{\n    return 1;\n}\n", "b.c": "int f(void)\n{\n    return 2;\n}\n"}
    with pytest.raises(SourceError, match=r"b\.c:1:5: f is defined twice: also at .*a\.c:1:5"):
        read(files).translate()


def test_an_object_that_is_only_declared_is_refused_where_it_is_declared() -> None:
    with pytest.raises(SourceError, match="x is declared extern, and no file defines it") as caught:
        read({"drv.c": "extern int x;\nint f(void)\n{\n    return x;\n}\n"}).translate()
    assert (caught.value.line, caught.value.column) == (1, 12)


@pytest.mark.parametrize("declared", ['#include "F28x_Project.h"', "extern unsigned int RamfuncsLoadStart, "
                                      "RamfuncsLoadEnd, RamfuncsLoadSize, RamfuncsRunStart;"])  # fmt: skip
def test_what_start_up_code_copies_from_flash_to_RAM_has_no_words(declared: str) -> None:
    text = f"""{declared}
#include <string.h>
long f(void)
{{
    memcpy(&RamfuncsRunStart, &RamfuncsLoadStart, (size_t)&RamfuncsLoadSize);
    return (&RamfuncsLoadEnd - &RamfuncsLoadStart) + (long)&RamfuncsRunStart;
}}
"""
    shop = CWorkshop(text)
    assert shop.call("f") == 0x8000
    assert list(shop.findings) == []


@pytest.mark.parametrize("names", ["secureRamFuncs_loadstart secureRamFuncs_runstart secureRamFuncs_loadsize",
                                   "hwiLoadStart hwiRunStart hwiLoadSize"])  # fmt: skip
@pytest.mark.parametrize("ctype", ["unsigned int", "unsigned long"])
def test_a_project_has_its_own_names_and_types_for_what_the_linker_defines(names: str, ctype: str) -> None:
    load, run, size = names.split()
    text = f"""#include <string.h>
extern {ctype} {load}, {run}, {size};
static {ctype} *to = &{run};
long f(void)
{{
    memcpy(to, &{load}, (size_t)&{size});
    return (long)&{run};
}}
"""
    shop = CWorkshop(text)
    assert shop.call("f") == 0x8000
    assert list(shop.findings) == []


def test_a_function_is_no_symbol_of_the_linker() -> None:
    with pytest.raises(LinkError, match="motor_run_start is declared, and no file defines it"):
        CWorkshop("void motor_run_start(void);\nvoid f(void) { motor_run_start(); }\n")


@pytest.mark.parametrize(("declared", "told"), [("extern int lut[];", False), ("extern int lut[2];", True),
                                                ("extern long lut[];", True)])  # fmt: skip
def test_another_file_gives_an_array_its_length(declared: str, told: bool) -> None:
    files = {"use.c": f"{declared}\nint f(void) {{ return lut[1]; }}\n", "lut.c": "int lut[3] = {1, 2, 3};\n"}
    shop = CWorkshop(files, static=True)
    assert ("prototype-mismatch" in [finding.rule for finding in shop.findings]) is told


def test_a_library_is_asked_in_one_order_in_every_process() -> None:
    """It reads the module of each name then, and modules have their objects in the order they are read."""
    names = [f"part_{letter}" for letter in "hcafgebd"]
    asked: list[str] = []
    calls = " + ".join(f"{name}()" for name in names)
    text = "".join(f"int {name}(void);\n" for name in names) + f"int f(void) {{ return {calls}; }}\n"
    read({"drv.c": text}, library=asked.append).translate()
    assert asked[: len(names)] == sorted(names)


def test_a_function_of_ones_own_may_be_called_like_one_of_the_kernel() -> None:
    text = "int Queue_Depth(int of);\nint f(void) { return Queue_Depth(2); }\n"
    assert CWorkshop(text, externs={"Queue_Depth": lambda of: of + 5}).call("f") == 7
    with pytest.raises(LinkError, match=r"drv\.c:2:22: Queue_Depth of the kernel's module Queue is not modelled"):
        CWorkshop(text)


def test_static_objects_of_functions_are_objects_of_their_own() -> None:
    text = "int f(void) { static int n; return ++n; }\nint g(void) { static int n = 5; return ++n; }\n"
    program = read({"drv.c": text})
    program.translate()
    paths = [variable.declaration.path for variable in program.modules["drv"].variables]
    assert paths == ["drv.f.n", "drv.g.n"]


@pytest.mark.parametrize(("abi", "initial"), [("coff", None), ("eabi", [0])])
def test_start_up_clears_objects_without_a_value_under_eabi_only(abi: str, initial: list[int] | None) -> None:
    program = read({"drv.c": "int x;\n"}, abi=abi)
    program.translate()
    (variable,) = program.modules["drv"].variables
    values = None if variable.initial is None else [getattr(v, "value", None) for v in variable.initial]
    assert values == initial


def test_qualifiers_and_interrupt_are_remembered() -> None:
    program = read({"drv.c": "volatile int a;\nconst int b = 1;\nint *volatile c;\n__interrupt void f(void) { }\n"})
    symbols = program.modules["drv"].symbols
    variables = {name: symbol for name, symbol in symbols.items() if isinstance(symbol, Variable)}
    assert {name: (v.volatile, v.constant) for name, v in variables.items()} == {
        "a": (True, False), "b": (False, True), "c": (True, False),
    }  # fmt: skip
    routine = symbols["f"]
    assert isinstance(routine, Function)
    assert routine.interrupt


def test_a_call_without_a_declaration_compares_the_widths_of_its_arguments() -> None:
    text = "static char a[4], b[4] = \"abc\";\nvoid f(int n)\n{\n    memcpy(a, b, n);\n}\n"
    shop = CWorkshop(text, static=True)
    (found,) = [finding for finding in shop.findings if finding.rule == "implicit-declaration"]
    assert found.place is not None
    assert found.place.line == 4
    assert "argument 3 is passed in 1 words and taken from 2" in found.message  # an int where size_t has 32 bits


@pytest.mark.parametrize(
    ("text", "rule", "line"),
    [
        ("#pragma CODE_SECTION(f, \"ramfuncs\")\nvoid f(void) { }\n", "pragma-ignored", 1),
        ("int x;\nvoid f(void)\n{\n    long *p = &x;\n    *p = 1;\n}\n", "pointer-types", 4),
        ("asm(\" .sect x\");\nvoid f(void) { }\n", "assembler-ignored", 1),
    ],
)
def test_what_c_takes_without_a_word_is_remarked(text: str, rule: str, line: int) -> None:
    assert (rule, line) in findings_of(text)


def test_assembler_has_an_instruction_a_line_in_any_case_with_comments() -> None:
    done: list[str] = []
    externs = {name: partial(done.append, name) for name in ("DINT", "DRTM", "EINT")}
    text = (
        'void f(void) { asm(" PUSH ACC\\n MOV32 *SP++,R0H"); asm(" nop ; wait\\n setc INTM,DBGM\\n");'
        ' __asm("\\tCLRC  INTM"); }\n'
    )
    CWorkshop(text, externs=externs).call("f")
    assert done == ["DINT", "DRTM", "EINT"]


@pytest.mark.parametrize("name", ["NOP", "ESTOP0"])
def test_an_instruction_does_not_call_the_function_of_its_name(name: str) -> None:
    shop = CWorkshop(f'int n;\nvoid {name}(void) {{ n++; asm(" {name}"); }}\nint f(void) {{ {name}(); return n; }}\n')
    assert shop.call("f") == 1


def test_rpt_takes_a_cycle_more_than_it_says() -> None:
    # SPRU430, RPT: the next instruction runs N + 1 times, and NOP takes a cycle.
    text = 'void f(void) { asm(" RPT#99||NOP"); }\nvoid g(void) { asm(" RPT #199 || NOP"); }\n'
    shop = CWorkshop(text)
    passed = []
    for name in "fg":
        before = shop.clock.now
        shop.call(name)
        passed.append(shop.clock.now - before)
    assert passed[1] - passed[0] == 100


def test_a_function_of_the_rom_does_nothing_and_says_so() -> None:
    # 0x3F8000 lies in the boot ROM, 0x70282 is Device_cal, which has nothing to trim here; 0x9000 is RAM.
    shop = CWorkshop("void f(long at) { ((void (*)(void))at)(); }\n")
    shop.call("f", 0x70282)
    assert shop.rules() == []
    shop.call("f", 0x3F8000)
    assert shop.rules() == ["unmodelled"]
    with pytest.raises(IllegalCall):
        shop.call("f", 0x9000)


def test_a_declaration_that_is_not_the_definition_of_another_file_is_remarked() -> None:
    files = {"a.c": "long g(int x);\nlong f(void) { return g(1); }\n", "b.c": "int g(long x) { return 1; }\n"}
    shop = CWorkshop(files, static=True)
    (found,) = [finding for finding in shop.findings if finding.rule == "prototype-mismatch"]
    assert "declared as long g(int), defined as int g(long)" in found.message


def test_a_structure_that_only_one_file_defines_is_the_one_that_others_point_to() -> None:
    head = "typedef struct thing *thing_t;\nthing_t opened(int kind);\nint kind_of(thing_t t);\n"
    whole = "typedef struct thing { int kind; } thing;\nstatic thing one;\n"
    whole += "thing_t opened(int kind) { one.kind = kind; return &one; }\nint kind_of(thing_t t) { return t->kind; }\n"
    user = f"{head}int f(int n) {{ return kind_of(opened(n)); }}\n"
    shop = CWorkshop({"a.c": user, "b.c": head + whole}, static=True)
    assert shop.call("f", 7) == 7
    assert shop.rules() == []


def test_a_function_of_a_header_of_ours_joins_the_file_only_where_it_is_used() -> None:
    program = read({"drv.c": "#include <ctype.h>\nint f(int c)\n{\n    return isdigit(c);\n}\n"})
    program.translate()
    assert [function.name for function in program.modules["drv"].functions] == ["f", "isdigit"]


def test_both_readers_make_equal_trees_of_one_driver() -> None:
    from emulator.c28x.program import Program

    c = read({
        "drv.c": "int v[3] = { 1, 2, 3 };\nint f(int n)\n{\n    int i, s = 0;\n    for (i = 0; i < n; i++) {\n"
        "        if (v[i] > 1 && v[i] < 9 || n == 0)\n            s += v[i];\n        else\n            s = -s;\n"
        "    }\n"
        "    while (s > 100)\n        s -= 10;\n    return s;\n}\n"
    })  # fmt: skip
    python = Program()
    python.add(
        "drv", "drv.py",
        "from emulator.c28x.language import *\nv: array[int16, 3] = (1, 2, 3)\ndef f(n: int16) -> int16:\n"
        "    i: int16\n    s: int16 = 0\n    for i in range(0, n):\n        if v[i] > 1 and v[i] < 9 or n == 0:\n"
        "            s += v[i]\n        else:\n            s = -s\n    while s > 100:\n        s -= 10\n    return s\n",
    )  # fmt: skip
    trees = []
    for program in (c, python):
        program.translate()
        (function,) = program.modules["drv"].functions
        trees.append(_shown(function.body))
    assert trees[0] == trees[1]


def _shown(node: object) -> object:
    """A tree without places: variables by name and type."""
    from dataclasses import fields, is_dataclass

    from emulator.c28x.ctypes import CType

    match node:
        case Variable():
            return (node.kind, node.name, str(node.ctype), node.in_memory, node.escapes)
        case CType():
            return str(node)
        case list() | tuple():
            return [_shown(part) for part in node]
    if is_dataclass(node):
        return [type(node).__name__, *(_shown(getattr(node, f.name)) for f in fields(node) if f.compare)]
    return node


def test_no_two_objects_or_functions_end_in_one_name() -> None:
    # Module and object, function and module, a local and its namesake's number: each pair once made one name.
    objects = CWorkshop({"a.c": "int b_c = 1;\nint f(void) { return b_c; }\n",
                         "a_b.c": "int c = 2;\nint g(void) { return c; }\n"})  # fmt: skip
    assert (objects.call("f"), objects.call("g")) == (1, 2)
    inner = "int h(int n) { int i__1 = 5; int i = 1; { int i = 7; n += i; } return n + i__1 * 10 + i * 100; }\n"
    assert CWorkshop(inner).call("h", 0) == 157  # 7 + 5 * 10 + 1 * 100
    static = "static int f(void) { return 1; }\nint f__m(void) { return 2; }\n"
    static += "int k(void) { return f() * 10 + f__m(); }\n"
    assert CWorkshop({"m.c": static}).call("k") == 12


def test_an_object_that_a_header_defines_may_be_used_by_other_files() -> None:
    main = '#include "own.h"\nint spare;\nint main(void)\n{\n    return 0;\n}\n'
    (found,) = CWorkshop({"a.c": main, "own.h": "\nint shared;\n"}, static=True).findings
    assert (found.rule, found.object) == ("unused-object", "a.spare")


@pytest.mark.parametrize("name", ["main-1.c", "2nd try.c", "a.b.c", "größe.c", "x(1).c"])
def test_a_file_may_have_a_name_that_no_object_could_have(name: str) -> None:
    text = (
        "static int n = 3;\n"
        "static int next(void) { static int m; const char *s = \"a\"; m = s[0] == 97; return n + m; }\n"
        "int f(void) { return next(); }\n"
    )
    assert CWorkshop({name: text, "other.c": text.replace("int f", "int g").replace("3", "5")}).call("f") == 4


def test_there_is_no_calendar() -> None:
    # ISO C 7.23.2.4: time gives (time_t)(-1) where there is none, also to what its argument points to.
    text = (
        '#include <time.h>\n#include <stdlib.h>\ntime_t kept;\n'
        "int f(void)\n{\n    kept = 0;\n    srand((unsigned int)time(NULL));\n"
        "    return time(&kept) == (time_t)-1 && kept == (time_t)-1;\n}\n"
    )
    assert CWorkshop(text).call("f") == 1
