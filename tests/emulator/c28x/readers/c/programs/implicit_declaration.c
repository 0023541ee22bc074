// C89's implicit declaration: an unknown function returns int and takes its promoted arguments.
// f() == 5: defined behind, as int half(int)
int f(void)
{
    return half(10);
}
int half(int x)
{
    return x / 2;
}
