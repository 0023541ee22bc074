// The trigonometric unit, by its intrinsics; an angle of "pu" is in turns.
// avr: it has no such unit
// quarter() == 1.0: the sine of a quarter turn
// half() == -1.0: the cosine of half a turn
// eighth() == 0.125: the angle whose tangent is 1, in turns
// root() == 1.5: the square root of 2.25
// quotient() == 0.25: 1 / 4
// fraction() == -0.75: what is left of -2.75, with its sign
// greater() == 2.0: of -3 and 2
// reciprocal() == 0.25: an estimate of 8 bits is exact for a power of two
// near() == 1: 1 / 3 to 8 bits, and not exactly
// of_root() == 0.5: 1 over the root of 4
float quarter(void)
{
    return __sinpuf32(0.25f);
}
float half(void)
{
    return __cospuf32(0.5f);
}
float eighth(void)
{
    return __atanpuf32(1.0f);
}
float root(void)
{
    return __sqrt(2.25f);
}
float quotient(void)
{
    return __divf32(1, 4);
}
float fraction(void)
{
    return __fracf32(-2.75f);
}
float greater(void)
{
    return __fmax(-3.0f, 2.0f);
}
float reciprocal(void)
{
    return __einvf32(4.0f);
}
int near(void)
{
    float error = __einvf32(3.0f) * 3.0f - 1.0f;
    return error != 0.0f && error < 0.004f && error > -0.004f;
}
float of_root(void)
{
    return __eisqrtf32(4.0f);
}
