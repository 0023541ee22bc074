// sizeof counts 16-bit words; its operand is not evaluated; it is an unsigned long.
// avr: it counts octets
// of_types() == 1111: char, short, int, unsigned char: 1 each
// of_wide() == 2242: long 2, float 2, long long 4, double 2 (COFF)
// of_pointers() == 22: data and function pointers have 32 bits
// of_array() == 10: 5 longs
// of_struct() == 4: int at 0, long at 2 (even), 4 in all
// of_struct_end() == 4: long at 0, int at 2, rounded up to the alignment of long
// of_expression() == 2: int + long is a long
// of_constant() == 2: 40000 is a long
// of_character() == 1: 'a' is an int
// of_string() == 4: "abc" with its 0
// not_evaluated() == 5: i is not incremented
// of_parameter() == 2: an array parameter is a pointer
// of_enum() == 1: an int
// unsigned_result() == 1: sizeof(int) - 2 is above 0
struct a { int i; long l; };
struct b { long l; int i; };
enum e { ONE };
int of_types(void)
{
    return sizeof(char) * 1000 + sizeof(short) * 100 + sizeof(int) * 10 + sizeof(unsigned char);
}
int of_wide(void)
{
    return sizeof(long) * 1000 + sizeof(float) * 100 + sizeof(long long) * 10 + sizeof(double);
}
int of_pointers(void)
{
    return sizeof(int *) * 10 + sizeof(int (*)(void));
}
int of_array(void)
{
    long v[5];
    return sizeof(v);
}
int of_struct(void)
{
    return sizeof(struct a);
}
int of_struct_end(void)
{
    return sizeof(struct b);
}
int of_expression(void)
{
    int i = 1;
    return sizeof(i + 1L);
}
int of_constant(void)
{
    return sizeof 40000;
}
int of_character(void)
{
    return sizeof 'a';
}
int of_string(void)
{
    return sizeof "abc";
}
int not_evaluated(void)
{
    int i = 4, n;
    n = sizeof(i++);
    return i + n;
}
static int size_of(int v[7])
{
    return sizeof(v);
}
int of_parameter(void)
{
    int v[7] = { 0 };
    return size_of(v);
}
int of_enum(void)
{
    return sizeof(enum e);
}
int unsigned_result(void)
{
    return sizeof(int) - 2 > 0;
}
