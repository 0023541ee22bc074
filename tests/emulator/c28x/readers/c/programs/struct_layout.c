// Members in order, 32-bit ones at even words, the size rounded up to the alignment.
// avr: it aligns nothing and counts octets
// offset_of_long() == 2: behind the int at 0, a word is left out
// offset_of_last() == 4: behind the long at 2
// size() == 6: 5 words, rounded up to even
// array_step() == 6: the next element
// of_long_long() == 4: a long long has 4 words and even alignment; size of { int; long long } is 6, less 2
#include <stddef.h>
struct s { int a; long b; int c; };
struct q { int a; long long b; };
static struct s list[2];
int offset_of_long(void)
{
    return offsetof(struct s, b);
}
int offset_of_last(void)
{
    return (int)((unsigned long)&list[0].c - (unsigned long)&list[0]);
}
int size(void)
{
    return sizeof(struct s);
}
int array_step(void)
{
    return (int)((unsigned long)&list[1] - (unsigned long)&list[0]);
}
int of_long_long(void)
{
    return sizeof(struct q) - 2;
}
