// string.h and stdlib.h count 16-bit words.
// avr: it counts octets, and its string functions read them
// copy() == 9: 2 words are 2 ints, the third stays 7: 1 + 1 + 7
// fill() == 10: memset writes whole words of 5
// compare() == 0: equal
// length() == 3: strlen("abc")
// absolute() == 5: abs(-5)
// number() == -42: atoi
// whole() == 4: sizeof counts the words of a long array of 2
#include <stdlib.h>
#include <string.h>
int copy(void)
{
    int from[3] = { 1, 1, 1 }, to[3] = { 0, 0, 7 };
    memcpy(to, from, 2);
    return to[0] + to[1] + to[2];
}
int fill(void)
{
    int v[2];
    memset(v, 5, sizeof(v));
    return v[0] + v[1];
}
int compare(void)
{
    return strcmp("abc", "abc");
}
int length(void)
{
    return (int)strlen("abc");
}
int absolute(void)
{
    return abs(-5);
}
int number(void)
{
    return atoi(" -42x");
}
int whole(void)
{
    long a[2] = { 1, 2 };
    return sizeof(a);
}
