"""Generated arguments: which values, and how many elements stand behind a pointer."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.arithmetic import f32
from emulator.c28x.ctypes import BOOL, FLOAT, INT, LONG, UINT, ArrayType, CType, FloatType, IntType, make_struct
from hil.drivers.values import NotGenerated, Parameter, arguments, boundaries, parameters
from hil.image import Build

INTEGERS = [INT, UINT, LONG, BOOL]


class TestValues:
    def test_boundaries_of_an_int_are_its_ends_and_powers_of_two(self) -> None:
        values = boundaries(INT)
        assert values[:2] == (0, 1)
        # 2**15 does not fit into a signed int of 16 bits, -2**15 does.
        assert {-1, 32767, -32768, 16384, 16383, -16384} <= set(values)
        assert 32768 not in values

    def test_an_unsigned_one_has_no_negative_values(self) -> None:
        assert min(boundaries(UINT)) == 0
        assert max(boundaries(UINT)) == 65535

    def test_an_enumeration_has_its_constants_only(self) -> None:
        colour = Parameter("c", INT, constants=(2, 5, 7))
        assert {values[0].scalars for values in arguments([colour], 30, "1")} == {(2,), (5,), (7,)}

    def test_first_all_zero_then_all_one(self) -> None:
        lists = arguments([Parameter("a", INT), Parameter("x", FLOAT)], 10, "1")
        assert [[value.text() for value in values] for values in lists[:2]] == [["0", "0"], ["1", "1"]]

    def test_a_function_without_parameters_has_one_list(self) -> None:
        assert arguments([], 30, "1") == [()]

    @given(st.lists(st.sampled_from([*INTEGERS, FLOAT]), min_size=1, max_size=4), st.integers(1, 60), st.text())
    def test_every_value_is_one_of_its_type_and_no_list_comes_twice(
        self, types: list[CType], count: int, seed: str
    ) -> None:
        wanted = [Parameter(f"p{n}", ctype) for n, ctype in enumerate(types)]
        lists = arguments(wanted, count, seed)
        assert len(set(lists)) == len(lists) <= count
        assert lists == arguments(wanted, count, seed)
        for values in lists:
            for ctype, value in zip(types, values, strict=True):
                (number,) = value.scalars
                if isinstance(ctype, FloatType):
                    assert abs(number) <= 1000.0
                    assert f32(number) == number
                else:
                    assert isinstance(ctype, IntType)
                    assert ctype.low <= number <= (1 if ctype == BOOL else ctype.high)

    def test_an_object_behind_a_pointer_is_written_as_c(self) -> None:
        pair = make_struct("PAIR", [("a", INT), ("x", FLOAT)])
        _, second, *_ = arguments([Parameter("p", LONG, pointed=pair)], 2, "1")
        assert second[0].text() == "&{1, 1}"
        assert second[0].text({"PAIR": None}) == "the PAIR from before"
        _, second, *_ = arguments([Parameter("p", LONG, pointed=ArrayType("int[3]", INT, 3))], 2, "1")
        assert second[0].text() == "{1, 1, 1}"


class TestPointers:
    """How many elements `F` wants behind its parameter."""

    @pytest.fixture
    def elements_of(self, tmp_path: Path) -> object:
        pytest.importorskip("pycparser")

        def elements(text: str) -> int:
            file = tmp_path / "p.c"
            file.write_text(text, encoding="utf-8")
            build = Build([str(file)])
            functions = {f.path: f for module in build.modules for f in module.functions}
            (parameter, *_) = parameters(functions["p.F"], functions)
            pointed = parameter.pointed
            return pointed.length if isinstance(pointed, ArrayType) else 1

        return elements

    @pytest.mark.parametrize(
        ("text", "count"),
        [
            ("int F(int *p) { return *p; }", 1),
            ("int F(int *p) { return p[0] + p[3]; }", 4),
            ("int F(int *p) { int i, s = 0; for (i = 0; i < 8; i++) s += p[i] >> 4; return s; }", 8),
            ("int F(int p[5]) { return p[0]; }", 5),
            ("int G(int *q) { return q[6]; }\nint F(int *p) { return G(p); }", 7),
            ("int F(int *p) { if (p == 0) return 0; return p[1]; }", 2),
            ("struct S { int a; }; int F(struct S *p) { return p->a; }", 1),
            ("struct S { int a; }; int F(struct S *p) { return p[2].a; }", 3),
        ],
    )
    def test_known_indices_tell(self, text: str, count: int, elements_of: object) -> None:
        assert callable(elements_of)
        assert elements_of(text) == count

    @pytest.mark.parametrize(
        ("text", "why"),
        [
            ("struct S { struct S *next; }; int F(struct S *p) { return p->next != 0; }", "holds a "),
            ("void G(void *p); void F(void *p) { G(p); }\nvoid G(void *p) { }", "has no size"),
            ("struct S { int a; }; int F(void *p) { return ((struct S *)p)->a + *(long *)p; }", "has no size"),
            ("int F(int *(*p)(void)) { return *p(); }", "is a pointer to a function"),
            ("int F(int **p) { return **p; }", "has no size"),
            ("int F(long at) { return *(volatile int *)(at + 2); }", "at is a number that is used as an address"),
            ("int G(long to) { return *(int *)to; }\nint F(int *p, long at) { return *p + G(at); }", "as an address"),
        ],
    )
    def test_what_cannot_be_told_is_not_called(self, text: str, why: str, elements_of: object) -> None:
        assert callable(elements_of)
        with pytest.raises(NotGenerated, match=why):
            elements_of(text)


class TestGuesses:
    """What `F` gets where the C does not tell how much its parameter points to."""

    @pytest.fixture
    def parameters_of(self, tmp_path: Path) -> Callable[[str], list[Parameter]]:
        pytest.importorskip("pycparser")

        def of(text: str) -> list[Parameter]:
            file = tmp_path / "p.c"
            file.write_text(text, encoding="utf-8")
            functions = {f.path: f for module in Build([str(file)]).modules for f in module.functions}
            return parameters(functions["p.F"], functions)

        return of

    @pytest.mark.parametrize(
        ("text", "numbers"),
        [
            ("int F(int n) { return n <= 300; }", (300, 301, 299)),
            ("int F(unsigned n) { return n ? 1 : 0 == n; }", (0, 1)),  # -1 is no unsigned
            ("int F(int n) { switch (n) { case 77: return 1; } return 0; }", (77, 78, 76)),
            ("int v[40]; int F(int n) { return (unsigned)n < sizeof v; }", (40, 41, 39)),
        ],
    )
    def test_a_number_that_the_function_compares_with_is_given_and_its_neighbours(
        self, text: str, numbers: tuple[int, ...], parameters_of: Callable[[str], list[Parameter]]
    ) -> None:
        (wanted,) = parameters_of(text)
        given = {values[0].scalars[0] for values in arguments([wanted], 30, "1")}
        assert wanted.compared == numbers
        assert given >= set(numbers)

    @pytest.mark.parametrize(
        "text",
        [
            "int F(int *p, int n) { return p[n]; }",
            "int F(int *p) { int s = 0; while (*p) s = *p++; return s; }",
            "int *kept; void F(int *p) { kept = p; }",
            "void F(void *p) { }",
            "int F(void *p) { return ((int *)p)[2]; }",
        ],
    )
    def test_room_for_256_elements(self, text: str, parameters_of: Callable[[str], list[Parameter]]) -> None:
        first = parameters_of(text)[0]
        assert first.guessed
        assert isinstance(first.pointed, ArrayType)
        assert first.pointed.length == 256

    def test_products_of_integers_beside_one_stay_within_it(
        self, parameters_of: Callable[[str], list[Parameter]]
    ) -> None:
        wanted = parameters_of("void F(float *m, unsigned int rows, int columns) { m[rows * columns - 1] = 0; }")
        for _, rows, columns in arguments(wanted, 60, "1"):
            # 16 * 16 = 256: the last element of as many is [255].
            assert 0 <= rows.scalars[0] <= 16
            assert 0 <= columns.scalars[0] <= 16

    def test_what_the_c_tells_has_integers_of_all_sizes_beside_it(
        self, parameters_of: Callable[[str], list[Parameter]]
    ) -> None:
        wanted = parameters_of("int F(int p[4], int n) { return p[3] + n; }")
        assert not any(parameter.guessed for parameter in wanted)
        assert max(n.scalars[0] for _, n in arguments(wanted, 60, "1")) == 32767

    def test_texts_of_the_files_come_before_others(self, parameters_of: Callable[[str], list[Parameter]]) -> None:
        (wanted,) = parameters_of(
            '#include <string.h>\nint F(const char *s) { return strcmp(s, "ON"); }\n'
            'int G(void) { return F("AT+RST"); }\n'
        )
        texts = [values[0].text() for values in arguments([wanted], 20, "1")]
        assert texts[:3] == ['""', '"ON"', '"AT+RST"']
        assert all(values[0].scalars[-1] == 0 for values in arguments([wanted], 20, "1"))  # each has its NUL

    def test_a_function_is_one_that_does_nothing(self, parameters_of: Callable[[str], list[Parameter]]) -> None:
        (wanted,) = parameters_of("int F(int (*p)(void)) { return p(); }")
        assert [values[0].text() for values in arguments([wanted], 20, "1")] == ["a function that does nothing"]
