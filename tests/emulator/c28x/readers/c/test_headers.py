"""Headers of ours: they parse, and say what the project says elsewhere."""

from __future__ import annotations

import re
import time
from typing import Any

import pytest

from emulator import device_defines
from emulator.blocks import BLOCKS
from emulator.c28x.ctypes import INT, LONG, ULONG, FunctionType, HandleType, PointerType, StructType, UnionType
from emulator.c28x.program import Program
from emulator.c28x.readers.c import headers, library_headers
from emulator.c28x.readers.c.module_header import c_header, own_symbols
from emulator.c28x.symbols import Define
from emulator.c28x.tree import Function, Variable
from emulator.registers.core import Register
from tests.emulator.c28x.readers.c.parsed import Parsed, c_ast, prototype_shape, shape


def read(*names: str) -> Parsed:
    return Parsed("\n".join(f'#include "{name}"' for name in names), headers.text)


@pytest.fixture(scope="module")
def project() -> Parsed:
    return read("F28x_Project.h")


@pytest.fixture(scope="module")
def kernel() -> Parsed:
    return read("ti/sysbios/BIOS.h")


@pytest.mark.parametrize("name", headers.names())
def test_each_header_parses_alone_and_twice(name: str) -> None:
    read(name, name)


@pytest.mark.parametrize(
    "spelling",
    [
        "F2837xS_Device.h",
        "f2837xs_device.H",
        "F2837xD_Device.h",
        "ti\\sysbios\\knl\\Task.h",
        "STDIO.H",
        "f28x_project.h",
    ],
)
def test_a_header_is_found_in_any_case_and_with_either_stroke(spelling: str) -> None:
    assert headers.text(spelling) is not None


@pytest.mark.parametrize("name", ["driverlib.h", "us.h", "F2837xS_usb.h", "../stdio.h", "", "device.h"])
def test_other_names_are_not_ours(name: str) -> None:
    assert headers.text(name) is None


def test_the_text_of_a_header_is_made_once() -> None:
    assert headers.text("F28x_Project.h") is headers.text("f28X_project.h")


def test_a_file_with_all_headers_is_read_in_moments() -> None:
    read(*headers.names())  # makes the texts
    before = time.process_time()
    read("F28x_Project.h", "ti/sysbios/BIOS.h", "stdio.h", "string.h")
    # 30 ms on a shared core, of which the parser has nearly all; TI's own headers take 600 to 1,100.
    assert time.process_time() - before < 0.5


# Types


@pytest.mark.parametrize(
    ("name", "ctype"),
    [
        ("int16", "int"), ("Uint16", "unsigned int"), ("int32", "long"), ("Uint32", "unsigned long"),
        ("int64", "long long"), ("Uint64", "unsigned long long"), ("float32", "float"), ("float64", "long double"),
        ("uint16", "unsigned int"), ("uint16_t", "unsigned int"), ("int32_t", "long"), ("size_t", "unsigned long"),
        ("bool_t", "_Bool"), ("uintptr_t", "unsigned long"),
    ],
)  # fmt: skip
def test_type_names_have_the_widths_of_the_chip(project: Parsed, name: str, ctype: str) -> None:
    assert project.shape(project.types[name]) == ctype


def test_no_type_has_eight_bits_and_a_use_says_what_to_write(project: Parsed) -> None:
    assert not {"uint8_t", "int8_t", "Uint8"} & set(project.types)
    hint = headers.hint("uint8_t")
    assert hint == "uint8_t does not exist on this chip, whose smallest type has 16 bits: write uint16_t"


def test_limits_are_those_of_the_types() -> None:
    limits = read("limits.h")
    assert limits.value("CHAR_BIT") == 16
    assert (limits.value("INT_MIN"), limits.value("INT_MAX")) == (INT.low, INT.high)
    assert (limits.value("LONG_MIN"), limits.value("ULONG_MAX")) == (LONG.low, ULONG.high)


def test_a_constant_macro_of_stdint_has_the_suffix_of_its_width() -> None:
    macros = read("stdint.h").macros
    assert macros["INT16_C"] == "value"
    assert macros["UINT32_C"] == "value##UL"


# The device


def test_every_block_of_the_chip_is_declared_with_its_type(project: Parsed) -> None:
    for name, block in BLOCKS.items():
        assert headers.block_types()[headers.tag(name)].layout is block.kind.layout, name
        assert headers.instances()[name].layout is block.kind.layout, name
        assert project.shape(project.names[name]) == ("tag", headers.tag(name)), name
    assert set(headers.instances()) == set(BLOCKS)


def _layout(parsed: Parsed, node: Any) -> tuple[int, dict[str, tuple[int, int]]]:
    """Bits of a structure as the compiler lays it out, and first bit and width of each member."""
    at, members = 0, {}
    for member in node.decls:
        if member.bitsize is not None:
            width, align = int(member.bitsize.value), 1
        else:
            count, inner = 1, member.type
            if isinstance(inner, c_ast.ArrayDecl):
                count, inner = int(inner.dim.value), inner.type
            width = count * _bits(parsed, inner)
            align = 32 if width // count == 32 else 16
        at += -at % align
        members[member.name] = (at, width)
        at += width
    return at + -at % 16, members


def _bits(parsed: Parsed, node: Any) -> int:
    kind = parsed.shape(node)
    if isinstance(kind, tuple) and kind[0] == "tag":
        tagged = parsed.structs[kind[1]]
        sizes = [_bits(parsed, m.type) for m in tagged.decls]
        return max(sizes) if isinstance(tagged, c_ast.Union) else _layout(parsed, tagged)[0]
    return {"unsigned int": 16, "unsigned long": 32}.get(str(kind), 32)  # a pointer to a routine has two words


@pytest.mark.parametrize("tag", sorted(headers.block_types()))
def test_structures_of_registers_have_the_true_offsets_and_fields(tag: str) -> None:
    before = "typedef unsigned int Uint16; typedef unsigned long Uint32; typedef void (*PINT)(void);\n"
    parsed = Parsed(before + headers.block_text(tag), headers.text)
    _, members = _layout(parsed, parsed.structs[tag])
    for name, described in headers.block_types()[tag].layout.items():
        register: type[Register] = described.register
        if described.part is not None:
            part, _, inner = name.partition(".")
            within = _layout(parsed, parsed.structs[described.part.kind.struct])[1]
            assert members[part][0] + within[inner][0] == 16 * described.offset, name
            continue
        assert members[name] == (16 * described.offset, register.bits), name
        if f"{name}_BITS" not in parsed.structs:
            continue
        size, fields = _layout(parsed, parsed.structs[f"{name}_BITS"])
        assert size == register.bits
        real = {n: f for n, f in register.fields.items() if f.access.name != "RSV"}
        assert {n: place for n, place in fields.items() if not n.startswith("rsvd")} == {
            n: (f.lo, f.width) for n, f in real.items()
        }, name


def test_the_fields_of_a_register_by_hand() -> None:
    # ADCSOC0CTL: ACQPS 8:0, CHSEL 18:15, TRIGSEL 24:20.  CHSEL lies on both words, so its type has 32 bits; what is
    # reserved between them is 14:9 (6 bits), 19 (1) and 31:25 (7).
    text = headers.block_text("ADC_REGS")
    body = re.search(r"struct ADCSOC0CTL_BITS \{\n(.*?)\};", text, re.DOTALL)
    assert body is not None
    assert [line.strip() for line in body[1].splitlines()] == [
        "Uint16 ACQPS:9;", "Uint16 rsvd1:6;", "Uint32 CHSEL:4;", "Uint16 rsvd2:1;", "Uint16 TRIGSEL:5;",
        "Uint16 rsvd3:7;",
    ]  # fmt: skip


def test_the_core_is_reached_as_in_C(project: Parsed) -> None:
    assert project.shape(project.names["IER"]) == "unsigned int"
    for name in ("EALLOW", "EDIS", "EINT", "DINT", "ERTM", "DRTM", "ESTOP0"):
        text = re.fullmatch(r'__asm\("\s*(.*?)\s*"\)', project.defines[name])
        assert text is not None
        assert headers.ASSEMBLER[text[1].upper()] == name
    assert (project.value("M_INT13"), project.value("C28X_BIT31")) == (1 << 12, 1 << 31)


def test_every_function_of_the_start_up_files_has_its_type(project: Parsed) -> None:
    core = {"EALLOW", "EDIS", "EINT", "DINT", "ERTM", "DRTM"}
    for name, symbol in own_symbols(Program().module("emulator.device_h")).items():
        # TI's takes the address of a structure, which C-shaped Python replaces by the timer's number.
        if isinstance(symbol, Function) and name not in core and name != "ConfigCpuTimer":
            assert project.shape(project.names[name]) == prototype_shape(symbol.ctype), name


def test_a_timer_is_a_structure_as_in_TIs_examples(project: Parsed) -> None:
    assert project.shape(project.names["CpuTimer0"]) == ("tag", "CPUTIMER_VARS")
    timer = ("pointer", ("tag", "CPUTIMER_VARS"))
    assert project.shape(project.names["ConfigCpuTimer"]) == ("prototype", "void", timer, "float", "float")


def test_what_defines_the_timers_is_C_and_defines_all_of_their_names() -> None:
    found = headers.definitions("ConfigCpuTimer")
    assert found is not None
    parsed = Parsed(found[1], headers.text)
    assert headers.CPU_TIMER_NAMES <= {*parsed.functions, "CpuTimer0", "CpuTimer1", "CpuTimer2"}
    assert headers.definitions("InitGpio") is None


def test_every_vector_has_a_default_routine(project: Parsed) -> None:
    assert project.shape(project.names["TIMER0_ISR"]) == ("prototype", "void")
    assert project.shape(project.types["PINT"]) == ("function", "void")


# Constants


def defined() -> list[tuple[str, int, str]]:
    """(name, value, field) of each constant, the field as the comment above its group names it."""
    found, fields = [], []
    with open(device_defines.__file__, encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                fields = re.findall(r"\w+Regs(?:\.\w+){2,3}", line)
            elif match := re.match(r"(\w+) = (\w+)$", line):
                found += [(match[1], int(match[2], 0), field) for field in fields]
    return found


def test_the_table_of_constants_is_read_here_at_all() -> None:
    # 4 of TBCTL.CTRMODE at the head, 3 of OSCCLKSRCSEL near the end.
    assert defined()[0] == ("TB_COUNT_UP", 0, "EPwmRegs.TBCTL.CTRMODE")
    assert ("XTAL_OSC", 1, "ClkCfgRegs.CLKSRCCTL1.OSCCLKSRCSEL") in defined()


@pytest.mark.parametrize("field", sorted({field for _, _, field in defined()}))
def test_the_constants_of_a_field_fit_it(field: str) -> None:
    block, rest = field.split(".", 1)
    register, name = rest.rsplit(".", 1)
    layout = next(found.kind.layout for found in BLOCKS.values() if found.kind.__name__ == block)
    width = layout[register].register.fields[name].width
    assert all(value < 1 << width for _, value, of in defined() if of == field)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        # TRM ePWM, TBCTL: 2 is up-down; AQCTLA: 2 sets; HDR: PIE group n is bit n - 1.
        ("TB_COUNT_UPDOWN", 2), ("AQ_SET", 2), ("ET_1ST", 1), ("CC_SHADOW", 0), ("PIEACK_GROUP1", 1),
        ("PIEACK_GROUP12", 0x800), ("ADC_ADCA", 0), ("ADC_RESOLUTION_12BIT", 0), ("GPIO_ASYNC", 0x30),
        ("GPIO_PULLUP", 1), ("GPY_CTRL_OFFSET", 0x20), ("IMULT_40", 40), ("PLLCLK_BY_2", 1), ("FMULT_0pt5", 2),
    ],
)  # fmt: skip
def test_constants_of_TIs_headers(project: Parsed, name: str, value: int) -> None:
    assert project.value(name) == value


def test_beside_driverlib_names_of_both_are_left_to_driverlib() -> None:
    def known(*defines: str) -> set[str]:
        names = ("ADC_RESOLUTION_12BIT", "ADC_BITRESOLUTION_12BIT", "CAN_CTL_INIT")
        tests = "".join(f"#ifdef {name}\nint has_{name};\n#endif\n" for name in names)
        text = "".join(f"#define {name}\n" for name in defines) + '#include "F28x_Project.h"\n' + tests
        parsed = Parsed(text, headers.text)
        return {name for name in names if f"has_{name}" in parsed.names}

    assert known() == {"ADC_RESOLUTION_12BIT", "CAN_CTL_INIT"}
    assert known("_DUAL_HEADERS") == {"ADC_BITRESOLUTION_12BIT"}


def test_every_constant_of_the_device_reaches_C(project: Parsed) -> None:
    for module in ("emulator.device_h", "emulator.device_defines"):
        found = own_symbols(Program().module(module))
        wanted = {name for name, s in found.items() if isinstance(s, Define) and not name.startswith("CpuTimer")}
        assert wanted <= set(project.defines)


def test_a_copy_of_a_register_has_its_fields_and_its_word() -> None:
    # ADCSOC0CTL: ACQPS 8:0, CHSEL 18:15, TRIGSEL 24:20 in a register of 32 bits.
    union = headers.register_type("ADCSOC0CTL_REG")
    assert isinstance(union, UnionType)
    word, bits = union.members
    assert (word.name, word.ctype, bits.name) == ("all", ULONG, "bit")
    assert isinstance(bits.ctype, StructType)
    named = {m.name: 16 * m.offset + m.lo for m in bits.ctype.members if not m.name.startswith("rsvd")}
    assert named == {"ACQPS": 0, "CHSEL": 15, "TRIGSEL": 20}
    assert headers.register_type("ADCSOC0CTL_BITS") == bits.ctype
    assert headers.register_type("ADCSOC0CTL") is headers.register_type("ADCRESULT0_REG") is None  # no such type


def test_registers_of_one_name_have_one_type_in_all_blocks() -> None:
    seen: dict[str, object] = {}
    for block in headers.block_types().values():
        for name, described in block.layout.items():
            if described.part is None:
                fields = {n: (f.lo, f.hi) for n, f in described.register.fields.items()}
                assert seen.setdefault(name, (described.register.bits, fields)) == (described.register.bits, fields)


def test_offsets_within_a_port_are_those_of_its_registers(project: Parsed) -> None:
    layout = headers.block_types()["GPIO_CTRL_REGS"].layout
    for name in ("QSEL1", "MUX1", "DIR", "PUD", "INV", "ODR", "GMUX1", "CSEL1", "LOCK", "CR"):
        assert 2 * project.value(f"GPY{name.rstrip('1')}") == layout[f"GPA{name}"].offset
    assert 2 * project.value("GPY_CTRL_OFFSET") == layout["GPBCTRL"].offset


# The kernel


def test_everything_of_the_kernel_has_its_type(kernel: Parsed) -> None:
    for name, symbol in own_symbols(Program().module("emulator.sysbios.headers")).items():
        match symbol:
            case Function(ctype=FunctionType() as ctype):
                assert kernel.shape(kernel.names[name]) == prototype_shape(ctype), name
            case StructType():
                assert kernel.shape(kernel.types[name]) == ("tag", name)
                assert headers.structures()[name].members == symbol.members
            case HandleType():
                assert kernel.shape(kernel.types[name]) == shape(symbol)
                assert headers.handles()[f"{name.removesuffix('_Handle')}_Object"] == symbol
            case Define():
                assert name in kernel.defines
            case PointerType(target=StructType()):
                assert kernel.shape(kernel.types[name]) == shape(symbol)
            case _ if name != "Void":
                assert kernel.shape(kernel.types[name]) == kernel.shape(kernel.types[f"xdc_{name}"]) == shape(symbol)


def test_wait_forever_is_the_16_bit_word_of_all_ones(kernel: Parsed) -> None:
    assert kernel.value("BIOS_WAIT_FOREVER") == 0xFFFF


def test_the_types_of_xdc_come_without_the_kernel() -> None:
    standard = read("xdc/std.h")
    assert "UArg" in standard.types
    assert "Task_create" not in standard.names


def test_the_casts_of_a_program_have_their_types(kernel: Parsed) -> None:
    assert kernel.shape(kernel.types["Clock_FuncPtr"]) == ("function", "void", "unsigned long")
    assert kernel.shape(kernel.types["Task_FuncPtr"]) == ("function", "void", "unsigned long", "unsigned long")
    assert kernel.shape(kernel.types["xdc_IArg"]) == "long"


# The library


def test_every_function_of_the_library_is_in_one_header_with_its_type() -> None:
    functions = own_symbols(Program().module("emulator.c28x.rts"))
    placed = [name for names in library_headers.FUNCTIONS.values() for name in names]
    assert sorted(placed) == sorted(name for name, symbol in functions.items() if isinstance(symbol, Function))
    for header, names in library_headers.FUNCTIONS.items():
        parsed = read(header)
        for name in names:
            symbol = functions[name]
            assert isinstance(symbol, Function)
            assert parsed.shape(parsed.names[name]) == prototype_shape(symbol.ctype), name


def test_memcpy_is_not_declared_without_string_h(project: Parsed) -> None:
    # us.c calls it so, which C takes for a function of an int.
    assert "memcpy" not in project.names
    assert "memcpy" not in read("stdlib.h").names


def test_functions_of_float_are_those_of_double() -> None:
    assert read("math.h").defines["sinf"] == "sin"


@pytest.mark.parametrize(
    ("character", "tests"),
    [
        ("7", {"isdigit", "isxdigit", "isalnum", "isprint", "isgraph"}),
        ("f", {"islower", "isalpha", "isxdigit", "isalnum", "isprint", "isgraph"}),
        ("Z", {"isupper", "isalpha", "isalnum", "isprint", "isgraph"}),
        (" ", {"isspace", "isprint"}),
        ("\n", {"isspace", "iscntrl"}),
        ("#", {"ispunct", "isprint", "isgraph"}),
        ("\x7f", {"iscntrl"}),
    ],
)
def test_characters_are_told_apart_as_in_the_C_locale(character: str, tests: set[str]) -> None:
    # The conditions are C; with these words they are Python too.
    text = headers.text("ctype.h")
    assert text is not None
    found = dict(re.findall(r"int (is\w+)\(int c\) \{ return (.*); \}", text))

    def holds(name: str) -> bool:
        condition = re.sub(r"'(\\?.)'", lambda m: str(ord(m[1].encode().decode("unicode_escape"))), found[name])
        condition = condition.replace("&&", " and ").replace("||", " or ").replace("!", " not ")
        scope = {n: (lambda c, n=n: holds(n)) for n in found}
        return bool(eval(condition, {**scope, "c": ord(character)}))

    assert {name for name in found if holds(name)} == tests


# Names that are unknown


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Cla1Regs", "Cla1Regs is a peripheral of this chip that is not modelled"),
        ("scanf", "scanf of C's library is not modelled"),
        ("InitAuxPll", "compile TI's source file that defines it"),
        ("HeapMem_restore", "kernel's module HeapMem is not modelled"),
        ("Task_construct", "kernel's module Task is not modelled"),
        ("ti/sysbios/heaps/HeapTrack.h", "this header of SYS/BIOS is not modelled"),
    ],
)
def test_a_name_that_is_not_modelled_says_so(name: str, said: str) -> None:
    hint = headers.hint(name)
    assert hint is not None
    assert said in hint


@pytest.mark.parametrize("name", ["EPwm1Regs", "Task_create", "sin", "my_own", "InitGpio", "ti/sysbios/BIOS.h", "_"])
def test_other_names_have_no_hint(name: str) -> None:
    assert headers.hint(name) is None


# Headers of modules


MODULE = """
from emulator.c28x.language import *
from emulator.sysbios.headers import Swi_Handle

SIZE = 0x10
LIMIT = 2.5
HELLO = "hello"


class COLOUR(enum):
    RED = 0
    BLUE = 4


class POINT(struct):
    x: float32


class LINE(struct):
    first: POINT
    colour: COLOUR
    next: ptr["LINE"]
    samples: array[int16, SIZE]


Number = uint32
count: int16 = 0


def draw(line: ptr[LINE], action: Swi_Handle, done: funcptr[int16, char]) -> Number:
    return 0


def hidden() -> void:
    pass
"""


@pytest.fixture(scope="module")
def drawing() -> str:
    module = Program().add("drawing", "drawing.py", MODULE)
    return c_header(module, "drawing.h", home=lambda name: "ti/sysbios/BIOS.h", private=("hidden",))


def test_a_module_is_written_as_a_header(drawing: str) -> None:
    parsed = Parsed(drawing, headers.text)
    assert parsed.value("SIZE") == 16
    assert (parsed.defines["LIMIT"], parsed.defines["HELLO"]) == ("2.5", '"hello"')
    line = {m.name: parsed.shape(m.type) for m in parsed.structs["LINE"].decls}
    # An enumeration is an int in the translator, and C says so too.
    assert line == {
        "first": ("tag", "POINT"), "colour": "int", "next": ("pointer", ("tag", "LINE")),
        "samples": ("array", 16, "int"),
    }  # fmt: skip
    assert [(e.name, e.value.value) for e in parsed.structs["COLOUR"].values.enumerators] == [
        ("RED", "0"),
        ("BLUE", "4"),
    ]
    assert parsed.shape(parsed.names["draw"]) == (
        "prototype", "unsigned long", ("pointer", ("tag", "LINE")), ("pointer", ("tag", "Swi_Object")),
        ("function", "int", "char"),
    )  # fmt: skip


def test_a_header_has_no_objects_and_nothing_private(drawing: str) -> None:
    parsed = Parsed(drawing, headers.text)
    assert "count" not in parsed.names
    assert "hidden" not in parsed.names


def test_a_header_includes_what_it_needs_and_not_itself() -> None:
    module = Program().add("user", "user.py", "from emulator.c28x.language import *\n"
                           "from emulator.sysbios.headers import Task_Params\n"
                           "def f(p: ptr[Task_Params]) -> void:\n    pass\n")  # fmt: skip
    assert '#include "x.h"' in c_header(module, "user.h", home=lambda name: "x.h")
    assert "#include" not in c_header(module, "user.h", home=lambda name: "user.h")
    assert isinstance(module.functions[0].ctype.parameters[0], PointerType)


def test_constants_can_be_chosen() -> None:
    module = Program().add("constants", "constants.py", "from emulator.c28x.language import *\nA = 1\nB = 2\n")
    assert "#define A 1" in c_header(module, "c.h", constants=("A",))
    assert "#define B" not in c_header(module, "c.h", constants=("A",))


def test_bit_fields_and_unions_lie_in_c_as_they_lie_in_python() -> None:
    # a and b share the first word, the width of 0 ends it, c begins the second one, and n needs a word of its own.
    text = (
        "from emulator.c28x.language import *\nclass flags(struct):\n    a: Annotated[uint16, bits(3)]\n"
        "    b: Annotated[int16, bits(5)]\n    end: Annotated[uint16, bits(0)]\n    c: Annotated[uint16, bits(9)]\n"
        "    n: int16\nclass both(union):\n    f: flags\n    w: array[uint16, 3]\n"
        "def low(b: both) -> flags:\n    return b.f\n"
    )
    module = Program().add("m", "m.py", text)
    header = c_header(module, "m.h")
    reader = Program(header=lambda name: header if name == "m.h" else None)
    user = reader.add("u", "u.c", '#include "m.h"\nflags f;\nboth b;\nflags g(void) { return low(b); }\n')
    for name, own in (("f", "flags"), ("b", "both")):
        variable, ctype = user.symbols[name], module.symbols[own]
        assert isinstance(variable, Variable)
        assert isinstance(variable.ctype, StructType)
        assert isinstance(ctype, StructType)
        assert variable.ctype.members == ctype.members
    assert [(m.name, m.offset, m.lo, m.width) for m in module.symbols["flags"].members] == [  # type: ignore[union-attr]
        ("a", 0, 0, 3), ("b", 0, 3, 5), ("c", 1, 0, 9), ("n", 2, 0, None),
    ]  # fmt: skip
