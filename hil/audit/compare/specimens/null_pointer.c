/* An integrator that points nowhere. */
static float *integral = 0;

float integrate(float error)
{
    *integral = *integral + error; /* DEFECT */
    return *integral;
}

int main(void)
{
    return integrate(1.0f) > 2.0f;
}
