/* Millimetres straight on, metres in a turn. */
float way(float speed, float rate, float period_ms)
{
    float angle = rate * period_ms / 1000;
    if (rate == 0)
        return speed * period_ms;
    return speed / rate * angle; /* DEFECT */
}

int main(void)
{
    return way(0.3f, 0.5f, 250) > 1.0f;
}
