// Tags, members and ordinary names do not get in each other's way.
// f() == 15: the tag x, the member x and the object x
// scope(2) == 42: a parameter hides the object of the file
// enum_in_block() == 8: a constant hides one outside
struct x { int x; };
static int hidden = 100;
enum { K = 5 };
int f(void)
{
    struct x x = { 10 };
    enum y { y = 5 };
    return x.x + y;
}
int scope(int hidden)
{
    return hidden + 40;
}
int enum_in_block(void)
{
    enum { K = 8 };
    return K;
}
int unused(void)
{
    return hidden + K;
}
