// A file-scope object may be declared several times, once with a value; types may be completed later.
// value() == 5: the one with the initialiser
// length() == 3: int v[] is completed behind
// forward() == 8: a structure used by pointer before it is known
int x;
int x = 5;
int x;
extern int v[];
int v[3] = { 1, 2, 3 };
struct later;
static int get(struct later *p);
int value(void)
{
    return x;
}
int length(void)
{
    return sizeof(v) / sizeof(v[0]);
}
struct later { int n; };
int forward(void)
{
    struct later s = { 8 };
    return get(&s);
}
static int get(struct later *p)
{
    return p->n;
}
