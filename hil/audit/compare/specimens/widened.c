/* A product widened after it was cut to 16 bits. */
long area(unsigned width, unsigned height)
{
    return width * height; /* DEFECT */
}

int main(void)
{
    return area(300, 300) != 90000;
}
