// Bit-fields fill a 16-bit word from bit 0; one that does not fit begins the next word; : 0 too.
// avr: it packs them into octets
// word() == 17193: 0x4329: a 9 (4 bits), b 2 (4 bits), c 3 (4 bits), d 4 (4 bits), from bit 0 upwards
// next_word() == 3: b (10 bits) does not fit behind a (10 bits): word 0 is 1, word 1 is 2: 1 + 2
// forced() == 7: : 0 closes the word: a is word 0, b bit 0 of word 1: 3 + 4
// unnamed() == 513: 0x201: bits 1 to 8 have no name: a is bit 0, b bit 9
// size() == 2: 10 + 10 bits are two words
// size_one() == 1: 16 bits are one
union four { struct { unsigned int a : 4, b : 4, c : 4, d : 4; } bit; unsigned int all; };
union wide { struct { unsigned int a : 10, b : 10; } bit; unsigned int w[2]; };
union closed { struct { unsigned int a : 4; unsigned int : 0; unsigned int b : 4; } bit; unsigned int w[2]; };
union holes { struct { unsigned int a : 1; unsigned int : 8; unsigned int b : 7; } bit; unsigned int all; };
unsigned int word(void)
{
    union four u;
    u.bit.a = 9;
    u.bit.b = 2;
    u.bit.c = 3;
    u.bit.d = 4;
    return u.all;
}
unsigned int next_word(void)
{
    union wide u;
    u.w[0] = 0;
    u.w[1] = 0;
    u.bit.a = 1;
    u.bit.b = 2;
    return u.w[0] + u.w[1];
}
unsigned int forced(void)
{
    union closed u;
    u.w[0] = 0;
    u.w[1] = 0;
    u.bit.a = 3;
    u.bit.b = 4;
    return u.w[0] + u.w[1];
}
unsigned int unnamed(void)
{
    union holes u;
    u.all = 0;
    u.bit.a = 1;
    u.bit.b = 1;
    return u.all;
}
int size(void)
{
    return sizeof(union wide);
}
int size_one(void)
{
    return sizeof(union four);
}
