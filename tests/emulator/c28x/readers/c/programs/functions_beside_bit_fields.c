// Pointers to functions in structures with bit-fields and in unions keep what they point to.
// called() == 10: dbl(5)
// by_copy() == -5: the whole structure is copied
// in_union() == -5: read back as what was written
// by_words() == -5: copied as 32 bits
// compared() == 1: all three hold
// of_void() == 6: a `void *` in such a structure holds a function too
typedef int (*fn)(int);
typedef struct { fn f; void *arg; unsigned on : 1; unsigned id : 7; } entry;
union either { fn f; unsigned long raw; };
static entry made, copy;
static int dbl(int x) { return 2 * x; }
static int neg(int x) { return -x; }
int called(void)
{
    made.f = dbl;
    made.on = 1;
    return made.f(5);
}
int by_copy(void)
{
    made.f = neg;
    made.on = 1;
    copy = made;
    return copy.f(5);
}
int in_union(void)
{
    union either u;
    u.f = neg;
    return u.f(5);
}
int by_words(void)
{
    union either u, v;
    u.f = neg;
    v.raw = u.raw;
    return v.f(5);
}
int compared(void)
{
    entry e;
    e.f = dbl;
    return e.f == dbl && e.f != neg && e.f != 0;
}
int of_void(void)
{
    entry e;
    e.arg = (void *)dbl;
    return ((fn)e.arg)(3);
}
