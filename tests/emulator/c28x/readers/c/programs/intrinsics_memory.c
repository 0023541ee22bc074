// Intrinsics of TI's compiler that only touch memory or compute.
static int m;
static long l;
static unsigned int words[4] = { 0x1234, 0xABCD, 0, 0 };
static unsigned long far_words[2];

// avr: another compiler does not have them
// in_place() == 9: 5 + 3 + 1 - 1 + 1
int in_place(void) { m = 5; __add(&m, 3); __inc(&m); __dec(&m); __sub(&m, -1); return m; }
// reversed() == 6: 10 - 4
int reversed(void) { m = 4; __subr(&m, 10); return m; }
// bits() == 29: 0x0F & 0x3C is 0x0C, | 1 is 0x0D, ^ 0x10 is 0x1D
int bits(void) { m = 0x0F; __and(&m, 0x3C); __or(&m, 1); __xor(&m, 0x10); return m; }
// longs() == 29996: 100000 - (70000 + 5 - 1)
long longs(void) { l = 70000; __addl(&l, 5); __subl(&l, 1); __subrl(&l, 100000); return l; }
// product(-300, 300) == -90000: 32 bits of 16 by 16
long product(int a, int b) { return __mpy(a, b); }
// product_of_unsigned(65535, 65535) == 4294836225: 65535 squared
unsigned long product_of_unsigned(unsigned int a, unsigned int b) { return __mpyu(a, b); }
// mixed_product(-2, 65535) == -131070: a signed one by an unsigned one
long mixed_product(int a, unsigned int b) { return __mpyxu(a, b); }
// limits(3, 9) == 9003: the larger, and the smaller
long limits(int a, int b) { return __max(a, b) * 1000L + __lmin(a, b); }
// magnitude(-32768) == 32767: it saturates
// magnitude(-5) == 5: the absolute value
int magnitude(int a) { return __abs16_sat(a); }
// octet(0) == 52: 0x34, the lower half
// octet(3) == 171: 0xAB, the upper half of the second word
int octet(unsigned int n) { return __mov_byte((int *)words, n); }
// bit(4, 2) == 1: it is set
// bit(4, 1) == 0: it is not
int bit(int of, int number) { return __tbit(of, number); }
// beyond_22_bits() == 305419903: 0x12345678 + 7
unsigned long beyond_22_bits(void)
{
    __addr32_write_uint32((unsigned long)&far_words[1], 0x12345678UL);
    __addr32_write_uint16((unsigned long)&words[2], 7);
    return __addr32_read_uint32((unsigned long)&far_words[1]) + __addr32_read_uint16((unsigned long)&words[2]);
}
// scaled(7) == 21: 3.0 in 16.16, times 7
long scaled(long a) { return __qmpy32(3L << 16, a, 16); }
