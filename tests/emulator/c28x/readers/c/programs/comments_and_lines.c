// Comments of both kinds; a line continued within a word.
// f() == 6: 1 + 2 + 3; the rest is comment
// g() == 30: th\ irty is one word
// quotes() == 47: '/' followed by a comment; no comment begins within a string
int f(void)
{
    return 1 /* + 10 // */ + 2 // + 100 /*
        + 3; /* over
    several lines */
}
static int thirty = 30;
int g(void)
{
    return th\
irty;
}
int quotes(void)
{
    const char *s = "/* no comment */";
    return s[0] == '/' ? '/'/* 47 */ : 0;
}
