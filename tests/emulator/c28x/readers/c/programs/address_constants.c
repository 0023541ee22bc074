// An object of the file may start from an address as a number: TI's compiler takes it, data lies in 22 bits.
// avr: pointers have 16 bits there, and an address as a long is no constant
// data() == 1: the number is the address
// code() == 12: the number is that of the function: 3 * 4
static int here;
static int triple(int x) { return 3 * x; }
static unsigned long where = (unsigned long)&here;
static const unsigned long what[2] = { 0, (unsigned long)triple };
int data(void)
{
    return (int *)where == &here;
}
int code(void)
{
    return ((int (*)(int))what[1])(4);
}
