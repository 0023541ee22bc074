// typedef of a scalar, a structure, a pointer, an array and a function pointer; a name of it reused in a block.
// scalar(65535) == 0: word is unsigned int: 65535 + 1 wraps
// structure() == 7: 3 + 4
// array() == 6: a row is three ints
// function(5) == 10: through a pointer of the type
// hidden() == 12: in the block `word` is an int
// self() == 2: a structure that points to its own kind
typedef unsigned int word;
typedef struct { int x, y; } point;
typedef point *point_p;
typedef int row[3];
typedef int (*action)(int);
typedef struct node { int value; struct node *next; } node;
word scalar(word w)
{
    return w + 1;
}
int structure(void)
{
    point p = { 3, 4 };
    point_p q = &p;
    return q->x + q->y;
}
int array(void)
{
    row r = { 1, 2, 3 };
    return r[0] + r[1] + r[2];
}
static int twice(int x)
{
    return 2 * x;
}
int function(int x)
{
    action a = twice;
    return a(x);
}
int hidden(void)
{
    int word = 12;
    return word;
}
int self(void)
{
    node b = { 2, 0 };
    node a = { 1, &b };
    return a.next->value;
}
