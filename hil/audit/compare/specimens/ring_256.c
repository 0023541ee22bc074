/* A ring that relies on a char of 8 bits to come round. */
static int ring[256];
static unsigned char head = 0;

void put(int value)
{
    ring[head] = value; /* DEFECT */
    head++;
}

int main(void)
{
    int i;
    for (i = 0; i < 300; i++)
        put(i);
    return ring[0] != 256;
}
