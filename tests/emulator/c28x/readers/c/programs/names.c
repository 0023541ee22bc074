// Names that mean something to a translator, and the longest ones, are ordinary names in C.
// f(1) == 16: 1 + 2 + 3 + 4 + 1 + 5
// lambda(3) == 4: a function of that name
// def() == 6: the sum of its locals
// _cpu_x() == 9: names that begin with an underscore
static int None = 2, True = 3, is = 4;
struct self { int class, pass; };
int lambda(int print)
{
    return print + 1;
}
int f(int len)
{
    struct self self = { 1, 5 };
    return len + None + True + is + self.class + self.pass;
}
int def(void)
{
    int in = 1, from = 2, import = 3;
    return in + from + import;
}
int _cpu_x(void)
{
    int _cpu = 4, _range = 5;
    return _cpu + _range;
}
