// Enumerations: counted on, with values, with expressions of earlier constants; anonymous; as ints.
// values() == 129: A, B, C, D, E, F are 0, 1, 10, 11, 22, -5: 0 + 1 + 10 + 11 + 22 * 5 - 5 + 2
// variable() == 11: an object of the type
// anonymous() == 32: LIMIT from an enumeration without a name
// as_size() == 3: the number of constants as a length
// arithmetic() == 2: a constant is an int: 10 / 4, truncated
enum e { A, B, C = 10, D, E = C + D + B, F = -5 };
enum { LIMIT = 1 << 5 };
typedef enum { RED, GREEN, BLUE, COLOURS } colour;
static const int weights[COLOURS] = { 1, 2, 3 };
int values(void)
{
    return A + B + C + D + E * 5 + F + 2;
}
int variable(void)
{
    enum e x = C;
    colour c = GREEN;
    return x + c;
}
int anonymous(void)
{
    return LIMIT;
}
int as_size(void)
{
    return sizeof(weights) / sizeof(weights[0]);
}
int arithmetic(void)
{
    return C / 4;
}
