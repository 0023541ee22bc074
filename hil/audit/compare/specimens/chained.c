/* A range written as in mathematics. */
int near(float cm)
{
    return 25 < cm < 90; /* DEFECT */
}

int main(void)
{
    return near(300.0f) == 0;
}
