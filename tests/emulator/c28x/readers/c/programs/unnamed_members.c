// Structures and unions without a name: their members are found as if they were those of the outer one (C11 6.7.2.1).
struct range {
    int first;
    struct { int low, high; };
    union { long both; int half[2]; };
    int last;
};
struct range given = { 1, { 2, 3 }, { 0x20005L }, 7 };
struct range flat = { 1, 2, 3, 4, 5 };
struct range named = { .low = 4, 5, .last = 6 };
struct outer { int before; struct { int a, b; } inner; int after; };
struct outer led = { .inner.a = 1, 2, 3 };

// members() == 237: low 2, high 3, last 7
int members(void) { return given.low * 100 + given.high * 10 + given.last; }
// halves(1) == 5: the lower word of 0x20005
// halves(2) == 3: its upper word, one more
int halves(int which)
{
    struct range *p = &given;
    struct range copy = *p;
    copy.half[1]++;
    return which == 1 ? copy.half[0] : copy.half[1];
}
// without_braces() == 12345: a list without inner braces goes on from member to member
int without_braces(void)
{
    return flat.first * 10000 + flat.low * 1000 + flat.high * 100 + (int)flat.both * 10 + flat.last;
}
// designated() == 4506: the item behind `.low = 4` is for the member behind it
int designated(void) { return named.low * 1000 + named.high * 100 + named.first * 10 + named.last; }
// behind_an_inner_one() == 123: so it is behind `.inner.a`
int behind_an_inner_one(void) { return led.inner.a * 100 + led.inner.b * 10 + led.after; }
// fields() == 14: the bits of 0x1234 above the lower 4, and its lower 4, with 0xA in their place
int fields(void)
{
    union { unsigned int all; struct { unsigned int low : 4; unsigned int high : 12; }; } word;
    word.all = 0x1234;
    word.low = 0xA;
    return (int)(word.low + (word.high == 0x123 ? 4 : 0));
}
// avr: objects of 32 bits are not aligned there, and sizes are in octets
// size() == 8: three words, one that aligns the long, the long, one, and one that aligns the whole
int size(void) { return (int)sizeof(struct range); }
