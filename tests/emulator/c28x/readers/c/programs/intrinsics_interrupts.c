// Intrinsics that drivers use around shared data: interrupts off and back as they were; EALLOW.
// avr: it does not know them
// f() == 7: the value written between them
static int shared = 0;
int f(void)
{
    unsigned int before = __disable_interrupts();
    shared = 7;
    __restore_interrupts(before);
    __eallow();
    __edis();
    return shared;
}
