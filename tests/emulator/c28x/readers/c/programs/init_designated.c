// Designated initialisers: members and elements by name, in any order; the next value goes behind.
// members() == 305: y is 5, x is 3, z is left 0: 300 + 0 + 5
// elements() == 10020: v[4] = 1, v[1] = 2, the others 0: as digits from v[4] down
// goes_on() == 789: [1] = 7, then 8 at [2] and 9 at [3]
// last_wins() == 6: [0] twice, the last counts
// inner() == 42: a member of an element: list[1].x
// of_enum() == 20: the element of COLOUR_GREEN
// length() == 8: [7] is the largest index
struct point { int x, y, z; };
enum colour { COLOUR_RED, COLOUR_GREEN, COLOUR_BLUE, COLOURS };
static const struct point p = { .y = 5, .x = 3 };
static const int v[5] = { [4] = 1, [1] = 2 };
static const int w[] = { [1] = 7, 8, 9 };
static const int twice[2] = { [0] = 5, [0] = 6 };
static const struct point list[2] = { [1] = { .x = 42 }, [0].z = 1 };
static const int of[COLOURS] = { [COLOUR_BLUE] = 30, [COLOUR_GREEN] = 20, [COLOUR_RED] = 10 };
static const int long_list[] = { [7] = 0 };
int members(void)
{
    return p.x * 100 + p.z * 10 + p.y;
}
int elements(void)
{
    return v[4] * 10000 + v[3] * 1000 + v[2] * 100 + v[1] * 10 + v[0];
}
int goes_on(void)
{
    return w[0] * 1000 + w[1] * 100 + w[2] * 10 + w[3];
}
int last_wins(void)
{
    return twice[0];
}
int inner(void)
{
    return list[1].x + list[1].y + list[0].x;
}
int of_enum(void)
{
    return of[COLOUR_GREEN];
}
int length(void)
{
    return sizeof(long_list) / sizeof(long_list[0]);
}
