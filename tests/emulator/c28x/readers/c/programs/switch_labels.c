// Labels: of a #define, of an enumeration, an expression, a character, a negative number.
// f(16) == 1: START is 0x10
// f(5) == 2: MODE_B is 4 + 1
// f(24) == 3: START + 8
// f(65) == 4: 'A'
// f(-3) == 5: its label
// f(0) == 0: the default
#define START 0x10
enum mode { MODE_A = 4, MODE_B };
int f(int x)
{
    switch (x) {
    case START:
        return 1;
    case MODE_B:
        return 2;
    case START + 8:
        return 3;
    case 'A':
        return 4;
    case -3:
        return 5;
    default:
        return 0;
    }
}
