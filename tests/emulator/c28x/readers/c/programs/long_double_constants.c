// long double has 64 bits: constants are computed in it, and lose what the type loses that they become.
// count() == 39998: ((1000 / (1000000 / 200000000)) - 9) / 5 = (200000 - 9) / 5 = 39998.2, cut
// third() == 0.3333333432674408: 1/3 in 53 bits, then rounded to 24: 0x3EAAAAAB
// below() == -2: -2.75 is cut towards zero
// avr: its long double is chosen by an option, and has 32 bits here
// exact() == 1: 16777216 + 1 has 25 bits, which a long double holds and a float does not
#define LOOPS(us) ((((long double)(us) / (1000000.0L / (long double)200000000)) - 9.0L) / 5.0L)
unsigned long count(void)
{
    return LOOPS(1000);
}
float third(void)
{
    return (long double)1 / 3;
}
int exact(void)
{
    return (long double)16777216 + 1 > 16777216.0L;
}
int below(void)
{
    return (int)((long double)-11 / 4);
}
