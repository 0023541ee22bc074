// Structures with bit-fields, and unions, start from any value: addresses at file scope, whatever is computed in a function.
// table(0, 5) == 10: dbl(5)
// table(1, 5) == -5: neg(5)
// table(2, 5) == -1: the list ends before: NULL
// text() == 110: 'n'
// local(5) == -5: a function in a local one
// fields(3, 9) == 75: 9 * 8 + 3: id lies behind three bits
// real() == 7: 3.5f twice, a float beside bit-fields
// by_union() == 16256: 1.0f is 0x3F800000, its upper word 0x3F80
// two() == 31: the last value given to a member counts: 3 * 10 + 1
// nested(4) == 4: an element of an array of them
typedef int (*fn)(int);
struct entry { fn f; unsigned on : 1; unsigned id : 7; const char *name; };
static int dbl(int x) { return 2 * x; }
static int neg(int x) { return -x; }
static const struct entry entries[3] = { { dbl, 1, 3, "dbl" }, { neg, 1, 4, "neg" } };
int table(int i, int x)
{
    return entries[i].f ? entries[i].f(x) : -1;
}
int text(void)
{
    return entries[1].name[0];
}
int local(int x)
{
    fn g = neg;
    struct entry e = { g, 1 };
    return e.f(x);
}
int fields(int low, int id)
{
    struct { unsigned low : 3; unsigned id : 5; } b = { low, id };
    union { struct { unsigned low : 3; unsigned id : 5; } bit; unsigned all; } u;
    u.all = 0;
    u.bit.low = b.low;
    u.bit.id = b.id;
    return (int)(u.all & 0xFF);
}
int real(void)
{
    float x = 3.5f;
    struct { float v; unsigned on : 1; } s = { x, 1 };
    return (int)(2.0f * s.v);
}
int by_union(void)
{
    float x = 1.0f;
    union { float f; unsigned w[2]; } u = { x };
    return u.w[1];
}
int two(void)
{
    int a = 2, b = 3;
    struct { long n; unsigned on : 1; } s = { .n = a, .on = a, .n = b, .on = b };
    return (int)s.n * 10 + s.on;
}
int nested(int x)
{
    struct entry a[2] = { { dbl, 1 }, { .f = neg, .id = x } };
    return a[1].id;
}
