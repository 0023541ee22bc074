// A switch in a switch: each break leaves its own.
// f(1, 1) == 11: inner case 1, then 10
// f(1, 2) == 10: inner default
// f(2, 1) == 20: the outer case 2
int f(int x, int y)
{
    int r = 0;
    switch (x) {
    case 1:
        switch (y) {
        case 1:
            r = 1;
            break;
        default:
            break;
        }
        r += 10;
        break;
    case 2:
        r = 20;
    }
    return r;
}
