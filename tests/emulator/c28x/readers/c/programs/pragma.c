// Pragmas place code and data, or silence the compiler; they change no value.
// f() == 12: 5 + 7
#pragma DATA_SECTION(buffer, "ramgs0")
int buffer[2] = { 5, 7 };
#pragma CODE_SECTION(f, "ramfuncs")
#pragma diag_suppress 112
int f(void)
{
    return buffer[0] + buffer[1];
}
