/* A search that relies on finding something. */
int comma(const char *text)
{
    int i = 0;
    while (text[i] != ',') /* DEFECT */
        i++;
    return i;
}

int main(void)
{
    char frame[8] = "0.2\r";
    return comma(frame) > 8;
}
