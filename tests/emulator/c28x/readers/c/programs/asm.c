// asm of an instruction without effect on C.
// f(3) == 4: 3 + 1
int f(int x)
{
    asm(" NOP");
    __asm(" NOP");
    return x + 1;
}
