// __byte designates an octet of an array of words: an even one is the lower half of its word.
// avr: it does not know it
// low() == 52: 0x34 of 0x1234
// high() == 18: 0x12
// second() == 120: 0x78, octet 2, is the lower half of word 1
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
