// Labels are converted to the promoted type of what is switched on.
// unsigned_label(65535) == 1: -1 as unsigned int is 65535
// wide(70000) == 2: a long keeps its value
// wide(4464) == 0: 70000 - 65536: not the same label
// effect() == 21: the value is taken once: i is 1 within, 2 behind
int unsigned_label(unsigned int x)
{
    switch (x) {
    case -1:
        return 1;
    default:
        return 0;
    }
}
int wide(long x)
{
    switch (x) {
    case 70000:
        return 2;
    default:
        return 0;
    }
}
int effect(void)
{
    int i = 1, r = 0;
    switch (i++) {
    case 1:
        r = 1;
        break;
    case 2:
        r = 2;
        break;
    }
    return i * 10 + r;
}
