// `long double` has 64 bits: what a float cannot hold, it holds.
struct sample { int number; long double value; float rough; };
static struct sample last;
long double total;

static long double sum_of(long double a, long double b) { return a + b; }

// avr: whether its long double has 64 bits depends on how its compiler was built
// size() == 84: four words; in the structure, from the second word on, and its size is even
int size(void) { return (int)sizeof(long double) + 10 * (int)sizeof(struct sample); }
// delay(1000) == 39998: ((1000 / (1000000 / 200000000)) - 9) / 5, truncated
// delay(3) == 118: (600 - 9) / 5 = 118.2
unsigned long delay(unsigned long us)
{
    return (unsigned long)(((((long double)us) / (1000000.0L / (long double)200000000L)) - 9.0L) / 5.0L);
}
// kept(16777217) == 16777217: a float has 24 bits
long kept(long x) { last.value = x; return (long)last.value; }
// cut(16777217) == 16777216: beside it, a float
long cut(long x) { last.rough = (float)x; return (long)last.rough; }
// compared() == 1: 0.1L is not 0.1f, and larger than nothing
int compared(void) { long double a = 0.1L; float b = 0.1f; return a != b && a < b && -a < 0 && !(a == 0); }
// billions() == 3000000001: above 32 bits of a float's digits
long long billions(void) { long double x = 3000000000.0L; x++; return (long long)x; }
// added() == 5: 3 + 2 by a function, through memory
int added(void) { long double v[2] = { 1.0L, 2.0L }; total = sum_of(v[0] * 3, v[1]); return (int)total; }
// upper_word() == 16368: 0x3FF0, the upper word of 1.0
unsigned int upper_word(void) { union { long double d; unsigned int w[4]; } u; u.d = 1.0L; return u.w[3]; }
