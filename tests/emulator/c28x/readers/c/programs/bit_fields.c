// Bit-fields: values wrap to their width, signed ones are sign-extended, small ones promote to int.
// wraps() == 3: 11 in 3 bits is 011
// sign() == -1: 3 in 2 signed bits
// independent() == 531: each field keeps its own
// promoted() == 1: a 4-bit unsigned field promotes to int, so 0 - 1 is below 0
// full() == 0: a 16-bit unsigned field promotes to unsigned int, so 0 - 1 is not
// compound() == 1: 7 + 2 in 3 bits: 9 is 001
// post() == 76: the old value 7 of a 3-bit field, then 0; 70 + 6
// value_of_assignment() == 2: the value of (f.a = 10) is that of the field: 10 in 3 bits
// initial() == 123: as members in order
struct flags { unsigned int a : 3; unsigned int b : 5; unsigned int c : 8; };
struct narrow { signed int s : 2; unsigned int u : 4; unsigned int full : 16; };
int wraps(void)
{
    struct flags f = { 0, 0, 0 };
    f.a = 11;
    return f.a;
}
int sign(void)
{
    struct narrow n = { 0, 0, 0 };
    n.s = 3;
    return n.s;
}
int independent(void)
{
    struct flags f = { 0, 0, 0 };
    f.a = 1;
    f.b = 3;
    f.c = 5;
    return f.c * 100 + f.b * 10 + f.a;
}
int promoted(void)
{
    struct narrow n = { 0, 0, 0 };
    return n.u - 1 < 0;
}
int full(void)
{
    struct narrow n = { 0, 0, 0 };
    return n.full - 1 < 0;
}
int compound(void)
{
    struct flags f = { 7, 0, 0 };
    f.a += 2;
    return f.a;
}
int post(void)
{
    struct flags f = { 7, 0, 0 };
    int old = f.a++;
    return old * 10 + f.a + 6;
}
int value_of_assignment(void)
{
    struct flags f = { 0, 0, 0 };
    int x = (f.a = 10);
    return x;
}
int initial(void)
{
    struct flags f = { 1, 2, 3 };
    return f.a * 100 + f.b * 10 + f.c;
}
