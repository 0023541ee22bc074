// #if with expressions and defined, #ifdef, #ifndef, #elif, #else, nested; what is left out is not read.
// level() == 2: 3 is not below 2, but below 4
// nested() == 11: the outer branch is taken, the inner #else
// unknown() == 0: a name without a definition is 0
// undefined() == 5: #undef takes a definition away
// character() == 1: 'A' is 65
#define LEVEL 3
#if LEVEL < 2
#define CHOICE 1
#elif LEVEL < 4 && defined(LEVEL)
#define CHOICE 2
#else
#error this is not read
#endif
#ifdef NOT_THERE
this is not C $ at all "
#endif
int level(void)
{
    return CHOICE;
}
int nested(void)
{
#ifndef NOT_THERE
#if defined NOT_THERE || LEVEL == 2
    return 10;
#else
    return 11;
#endif
#else
    return 12;
#endif
}
int unknown(void)
{
#if NOT_THERE
    return 1;
#else
    return 0;
#endif
}
#define GONE 4
#undef GONE
#ifndef GONE
#define GONE 5
#endif
int undefined(void)
{
    return GONE;
}
int character(void)
{
#if 'A' == 65 && (1 ? 2 : 3) == 2 && -1 < 0u + 1 - 1 == 0
    return 1;
#else
    return 0;
#endif
}
