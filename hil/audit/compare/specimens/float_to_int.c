/* Millimetres beyond an int of 16 bits. */
int whole(float millimetres)
{
    return (int)millimetres; /* DEFECT */
}

int main(void)
{
    return whole(40000.0f) < 0;
}
