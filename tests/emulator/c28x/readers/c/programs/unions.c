// Unions: members share their words; the low word of a long comes first.
// halves() == 4660: 0x12345678: its second word is 0x1234
// low() == 22136: its first word is 0x5678
// build() == 131073: words 1 and 2: 2 * 65536 + 1
// float_bits() == 1069547520: 1.5f is 0x3FC00000
// first_member() == 3: an initialiser is for the first member
// in_struct() == 77: a union in a structure
// copied() == 5: unions are assigned as a whole
union both { long l; unsigned int w[2]; };
union number { float f; unsigned long bits; };
struct tagged { int kind; union { int i; float f; } u; };
unsigned int halves(void)
{
    union both b;
    b.l = 0x12345678L;
    return b.w[1];
}
unsigned int low(void)
{
    union both b;
    b.l = 0x12345678L;
    return b.w[0];
}
long build(void)
{
    union both b;
    b.w[0] = 1;
    b.w[1] = 2;
    return b.l;
}
unsigned long float_bits(void)
{
    union number n;
    n.f = 1.5f;
    return n.bits;
}
long first_member(void)
{
    union both b = { 3 };
    return b.l;
}
int in_struct(void)
{
    struct tagged t;
    t.kind = 1;
    t.u.i = 77;
    return t.u.i;
}
long copied(void)
{
    union both a, b;
    a.l = 5;
    b = a;
    a.l = 6;
    return b.l;
}
