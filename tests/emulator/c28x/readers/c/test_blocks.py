"""Blocks, magnitudes and assignments that the text shows to be wrong (sizes: an int has 1 word, a pointer 2)."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """#include <string.h>
#include <stdlib.h>
#include <math.h>
#include <stdio.h>
struct Frame { int head[2]; int data[4]; int sum; };
struct Frame frame, spare, many[3]; int table[3][4], *list[4], whole[4], k; volatile int live; float x;
struct Frame *at = &frame; long l; int next(void) { return 1; } char text[8]; int hidden;
long wide[3]; float one; extern int RamfuncsLoadStart, RamfuncsRunStart; union { long both; int half[2]; } either;
void f(int *p, int array[4], int unused, int **pointers, char *name, int hidden)
{
"""
LINE = HEAD.count("\n") + 1
RULES = ("memcpy-octets", "memcpy-outside", "sizeof-pointer", "float-magnitude", "self-assignment")


def told(statement: str) -> list[str]:
    """The rules about blocks at the line of a statement."""
    found = findings_of(f"{HEAD}    {statement}\n}}\n")
    return [rule for rule, line in found if line == LINE and rule in RULES]


@pytest.mark.parametrize(
    "statement",
    [
        "memset(frame.data, 0, sizeof frame.data);",
        "memcpy(frame.data, spare.data, 4);",
        "memset(&frame, 0, sizeof frame);",
        "memset(many[1].head, 0, 2);",
        "memset(at->data, 0, 4);",
        "memset(table[0], 0, sizeof table);",  # rows lie one behind the other
        "memset(frame.data, 0, k);",
        "memset(p, 0, sizeof *p);",
        "memset(whole, 0, sizeof whole);",
        "memcpy(pointers, list, sizeof p);",  # pointers are what is copied
        "memcpy(whole, &p, sizeof p);",
        "k = abs(k); l = labs(l);",
        "k = abs((int)x);",
        "x = fabs(x);",
        "unused = unused;",
        "live = live;",
        "frame.sum = spare.sum; frame.data[0] = frame.data[1]; whole[next()] = whole[next()];",
        "k = -k; x = k; k = (int)l;",
        "spare = frame; frame = *at;",
        "*at = *at;",  # where it points may be a register
        "memcpy(whole, table[1], sizeof whole);",
        "k = sizeof whole / sizeof *whole + sizeof list / sizeof *list;",
        "k = sizeof p / sizeof(unsigned int);",  # the words of the pointer itself
        "strncpy(text, name, sizeof text); strncmp(name, text, 2);",
        "for (k = 0; k < 4; k++) { whole[k] = 0; } unused = unused;",
        "memcpy(whole, list, sizeof whole); memcpy(list, whole, sizeof whole);",  # a part of the larger one
        "memmove(whole, whole + 1, 3); memmove(&whole[1], &whole[0], 3 * sizeof(int)); memset(whole + 4, 0, 0);",
        "memcpy(many, &frame, sizeof frame); memcpy(&many[1], &frame, sizeof frame); memset(&many[1], 0, 14);",
        "memset(table[1], 0, 8); memset(&table[2][1], 0, 3); memcpy(&one, whole, sizeof one);",
        "memcpy(&RamfuncsRunStart, &RamfuncsLoadStart, 100);",  # a name of the linker is an address
        "memcpy(either.half, &one, 2); memcpy(&either, &one, sizeof one); memcpy(p, &whole[k], 4); memset(at, 0, 50);",
        "int local[4]; memcpy(local, whole, sizeof local); memcpy(&local[k], whole, 1); memset(array, 0, 50);",
        "{ int n = 8; if (k < 4) n = 4; memset(whole, 0, n); }",
        'sprintf(text, "%d V %s", k, name); strcpy(text, "1234567"); strcpy(text + 1, "123456");',
        'sprintf(text, "%.0d%s%.0s", k, name, name); sprintf(name, "longer than %d", k);',
    ],
)
def test_what_fits_is_told_nothing(statement: str) -> None:
    assert told(statement) == []


@pytest.mark.parametrize(
    ("statement", "rule"),
    [
        ("memset(frame.data, 0, 5);", "memcpy-outside"),  # 4 words
        ("memset(frame.head, 0, sizeof frame);", "memcpy-outside"),  # 2 of 7
        ("memcpy(whole, frame.head, 4);", "memcpy-outside"),  # read beyond 2
        ("memmove(many[k].data, list, 1 + sizeof whole);", "memcpy-outside"),
        ("memset(at->head, 0, 3);", "memcpy-outside"),
        ("memcpy(whole, list, 2 * sizeof whole);", "memcpy-octets"),
        ("memcpy(list, whole, 8);", "memcpy-octets"),
        ("memset(whole, 0, 2 * 4);", "memcpy-octets"),
        ("memmove(&whole[1], whole, 6);", "memcpy-octets"),
        ("memcpy(wide, list, 3 * 4);", "memcpy-octets"),
        ("memcpy(whole, &one, 4);", "memcpy-octets"),  # the octets of a float
        ("if (memcmp(&frame, &spare, 14)) k = 1;", "memcpy-octets"),
        ("{ int local[4]; memcpy(local, whole, 8); whole[0] = local[1]; }", "memcpy-octets"),
        ("memset(whole, 0, 5);", "memcpy-outside"),
        ("memcpy(list, whole, 5);", "memcpy-outside"),
        ("memset(whole + 1, 0, sizeof whole);", "memcpy-outside"),
        ("memset(&table[2][1], 0, 4);", "memcpy-outside"),
        ("memset(&frame, 0, sizeof many);", "memcpy-outside"),
        ("memset(p, 0, sizeof p);", "sizeof-pointer"),
        ("memset(array, 0, sizeof array);", "sizeof-pointer"),  # an array that is a parameter
        ("memcpy(array, whole, sizeof(array));", "sizeof-pointer"),
        ("k = abs(x);", "float-magnitude"),
        ("l = labs(x * 2);", "float-magnitude"),
        ("k = k;", "self-assignment"),
        ("frame.sum = frame.sum;", "self-assignment"),
        ("whole[k] = whole[k];", "self-assignment"),
        ("frame = frame;", "self-assignment"),
        ("memcpy(whole, whole, sizeof whole);", "self-assignment"),
        ("hidden = hidden;", "self-assignment"),  # one of them was meant to be the object of the file
        ("for (k = 0; k < sizeof array / sizeof array[0]; k++) array[k] = 0;", "sizeof-pointer"),
        ("k = sizeof pointers / sizeof *pointers;", "sizeof-pointer"),
        ("strncpy(name, text, sizeof name);", "sizeof-pointer"),
        ('snprintf(name, sizeof name, "on");', "sizeof-pointer"),
        ('sprintf(text, "%d volt %d", k, k);', "memcpy-outside"),  # 8 characters at least, and the NUL
        ('sprintf(text, "%8u", k);', "memcpy-outside"),
        ('strcpy(text, "12345678");', "memcpy-outside"),
    ],
)
def test_what_does_not_fit_is_told(statement: str, rule: str) -> None:
    assert told(statement) == [rule]
