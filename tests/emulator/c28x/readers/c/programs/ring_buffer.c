// A driver's ring buffer: structure, indices modulo a power of two, results by pointer.
// run() == 28: of 12 values 8 places less one hold the first 7: 1 + 2 + .. + 7
#define SIZE 8
typedef struct { unsigned int head, tail; int data[SIZE]; } ring_t;
static ring_t rx = { 0, 0, { 0 } };
static int put(ring_t *r, int x)
{
    unsigned int next = (r->head + 1) & (SIZE - 1);
    if (next == r->tail)
        return 0;
    r->data[r->head] = x;
    r->head = next;
    return 1;
}
static int get(ring_t *r, int *x)
{
    if (r->head == r->tail)
        return 0;
    *x = r->data[r->tail++];
    r->tail &= SIZE - 1;
    return 1;
}
int run(void)
{
    int i, x, sum = 0;
    for (i = 1; i <= 12; i++)
        put(&rx, i);
    while (get(&rx, &x))
        sum += x;
    return sum;
}
