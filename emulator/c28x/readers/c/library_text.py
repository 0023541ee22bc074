"""Functions of C's library that our headers define in C: header -> function -> its text.

If a program uses them, they are read like the user's own functions.  So their arguments are checked, and `qsort` calls
the comparison function of the user.
CHOICE: each file has its own copy, so the state of `strtok` and `rand` is per file; their time is that of this text.
There is no `errno`.  Sources: ISO C99 7.12; ISO C 7.20 and 7.21; the example of 7.20.2.2 for `rand`.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

#: The common part of `strtol` and `strtoul`: blanks, the sign, the base.
_NUMBER: Final = """
static inline const char *_number_begins(const char *text, int *base, int *minus)
{
    while (*text == ' ' || (*text >= '\\t' && *text <= '\\r')) text++;
    *minus = *text == '-';
    if (*text == '-' || *text == '+') text++;
    if ((*base == 0 || *base == 16) && *text == '0' && (text[1] == 'x' || text[1] == 'X')) { *base = 16; text += 2; }
    else if (*base == 0) *base = *text == '0' ? 8 : 10;
    return text;
}
static inline int _digit_of(int c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'z' ? c - 'a' + 10 : c >= 'A' && c <= 'Z' ? c - 'A' + 10
        : 36;
}
static inline unsigned long _number(const char *text, char **end, int base, int *minus, int *beyond)
{
    const char *at = _number_begins(text, &base, minus), *first = at;
    unsigned long value = 0, most = 0xFFFFFFFFUL / (unsigned int)base;
    *beyond = 0;
    for (; _digit_of(*at) < base; at++) {
        unsigned long digit = (unsigned long)_digit_of(*at);
        if (value > most || digit > 0xFFFFFFFFUL - value * (unsigned int)base) *beyond = 1;
        else value = value * (unsigned int)base + digit;
    }
    if (end != 0) *end = (char *)(at == first ? text : at);
    return value;
}
"""

TEXT: Final = MappingProxyType({
    "math.h": MappingProxyType({
        "fmin": "static inline float fmin(float x, float y) { return x < y || !(y == y) ? x : y; }\n",
        "fmax": "static inline float fmax(float x, float y) { return x > y || !(y == y) ? x : y; }\n",
        "trunc": "static inline float trunc(float x) { return x < 0 ? ceil(x) : floor(x); }\n",
        "round": """
static inline float round(float x)
{
    float size = fabs(x), whole = floor(size);
    if (size - whole >= 0.5f) whole += 1;
    return x < 0 ? -whole : whole;
}
""",
        "lround": "static inline long lround(float x) { return (long)round(x); }\n",
    }),
    "stdlib.h": MappingProxyType({
        "strtol": _NUMBER + """
static inline long strtol(const char *text, char **end, int base)
{
    int minus, beyond;
    unsigned long value = _number(text, end, base, &minus, &beyond);
    if (beyond || value > 0x7FFFFFFFUL) return minus ? -2147483647L - 1 : 2147483647L;
    return minus ? -(long)value : (long)value;
}
""",
        "strtof": """
static inline float strtof(const char *text, char **end)
{
    return (float)strtold((char *)text, end);
}
""",
        "strtoul": """
static inline unsigned long strtoul(const char *text, char **end, int base)
{
    int minus, beyond;
    unsigned long value = _number(text, end, base, &minus, &beyond);
    if (beyond) return 0xFFFFFFFFUL;
    return minus ? 0UL - value : value;
}
""",
        "rand": """
static inline unsigned long *_rand_state(void) { static unsigned long next = 1; return &next; }
static inline int rand(void)
{
    *_rand_state() = *_rand_state() * 1103515245UL + 12345UL;
    return (int)(*_rand_state() / 65536UL % 32768UL);
}
""",
        "srand": "static inline void srand(unsigned int seed) { *_rand_state() = seed; }\n",
        "qsort": """
static inline void qsort(void *base, size_t n, size_t size, int (*compare)(const void *a, const void *b))
{
    void *memcpy(void *to, const void *source, size_t n);
    int *begin = (int *)base, *a;
    void *kept[8];
    size_t i, j, k, part;
    for (i = 1; i < n; i++) {
        for (j = i; j > 0 && compare(begin + (j - 1) * size, begin + j * size) > 0; j--) {
            a = begin + (j - 1) * size;
            for (k = 0; k < size; k += part, a += part) {
                part = size - k < sizeof kept ? size - k : sizeof kept;
                memcpy(kept, a, part);
                memcpy(a, a + size, part);
                memcpy(a + size, kept, part);
            }
        }
    }
}
""",
        "bsearch": """
static inline void *bsearch(
    const void *key, const void *base, size_t n, size_t size, int (*compare)(const void *a, const void *b))
{
    const int *begin = (const int *)base;
    size_t low = 0, middle;
    while (low < n) {
        int order = compare(key, begin + (middle = low + (n - low) / 2) * size);
        if (order == 0) return (void *)(begin + middle * size);
        if (order < 0) n = middle; else low = middle + 1;
    }
    return 0;
}
""",
    }),
    "string.h": MappingProxyType({
        "strspn": """
static inline size_t strspn(const char *text, const char *set)
{
    size_t n = 0;
    while (text[n] != 0 && strchr(set, text[n]) != 0) n++;
    return n;
}
""",
        "strcspn": """
static inline size_t strcspn(const char *text, const char *set)
{
    size_t n = 0;
    while (text[n] != 0 && strchr(set, text[n]) == 0) n++;
    return n;
}
""",
        "strpbrk": """
static inline char *strpbrk(const char *text, const char *set)
{
    text += strcspn(text, set);
    return (char *)(*text != 0 ? text : 0);
}
""",
        "strtok": """
static inline char *strtok(char *text, const char *marks)
{
    static char *rest = 0;
    char *token;
    if (text == 0) text = rest;
    if (text == 0) return 0;
    text += strspn(text, marks);
    token = *text != 0 ? text : 0;
    text += strcspn(text, marks);
    if (*text != 0) *text++ = 0;
    rest = token != 0 ? text : 0;
    return token;
}
""",
    }),
})  # fmt: skip
