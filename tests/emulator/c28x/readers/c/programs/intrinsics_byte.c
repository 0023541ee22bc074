// __byte designates an octet of an array of words: an even one is the lower half of its word.
// avr: it does not know it
// low() == 52: 0x34 of 0x1234
// high() == 18: 0x12
// second() == 120: 0x78, octet 2, is the lower half of word 1
// each() == 276: 0x34 + 0x12 + 0x78 + 0x56
// swapped(2) == 30806: the octets of word 1 change places: 0x7856
// added() == 4610: 0xFF + 2 is 1 in an octet, 0x1201, and i is 1
// written() == 43828: octet 1 set to 0xAB: 0xAB34
static int v[2] = { 0x1234, 0x5678 };
int low(void)
{
    return __byte(v, 0);
}
int high(void)
{
    return __byte(v, 1);
}
int second(void)
{
    return __byte(v, 2);
}
unsigned int written(void)
{
    int w[1] = { 0x1234 };
    __byte(w, 1) = 0xAB;
    return (unsigned int)w[0];
}
unsigned int each(void)
{
    unsigned int sum = 0, i;
    for (i = 0; i < 4; i++) {
        sum += __byte(v, i);
    }
    return sum;
}
unsigned int swapped(int octet)
{
    int w[2] = { 0x1234, 0x5678 };
    int kept = __byte(w, octet);
    __byte(w, octet) = __byte(w, octet + 1);
    __byte(w, ++octet) = kept;
    return (unsigned int)w[1];
}
int added(void)
{
    int w[1] = { 0x12FF };
    int i = 0;
    __byte(w, i++) += 2;
    return w[0] + i;
}
