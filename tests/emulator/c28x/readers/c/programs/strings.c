// String literals: arrays of 16-bit char with a 0 at the end; escapes; neighbours are joined.
// length() == 5: a b newline c d
// escapes() == 167: '\n' 10 + '\t' 9 + '\\' 92 + '\x1f' 31 + '\101' 65 - 40
// joined() == 99: "ab" "cd" is "abcd", [2] is 'c'
// array() == 0: char s[4] = "abc" holds the 0
// without_zero() == 99: char s[3] = "abc" does not
// filled() == 0: the rest of a longer array is 0
// pointers() == 116: the t of "two"
// empty() == 0: "" has its 0 only
// wide_char() == 255: '\xff' in a string has 16 bits, so it is not negative
static const char *const names[] = { "one", "two", "three" };
static const char text[] = "ab\ncd";
int length(void)
{
    const char *p = text;
    int n = 0;
    while (*p++)
        n++;
    return n;
}
int escapes(void)
{
    const char *s = "\n\t\\\x1f\101";
    return s[0] + s[1] + s[2] + s[3] + s[4] - 40;
}
int joined(void)
{
    const char *s = "ab" "cd";
    return s[2];
}
int array(void)
{
    char s[4] = "abc";
    return s[3];
}
int without_zero(void)
{
    char s[3] = "abc";
    return s[2];
}
int filled(void)
{
    char s[8] = "abc";
    return s[3] + s[7];
}
int pointers(void)
{
    return names[1][0];
}
int empty(void)
{
    return *"";
}
int wide_char(void)
{
    const char *s = "\xff";
    return s[0];
}
