/* A dead band that takes every turn to the right. */
float turn(float rate)
{
    if (rate <= 0.01f) /* DEFECT */
        return 0;
    return rate;
}

int main(void)
{
    return turn(-1.0f) > 0;
}
