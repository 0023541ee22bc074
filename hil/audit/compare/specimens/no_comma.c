/* A search that relies on finding something: here it finds what stands behind the frame. */
char frame[8] = "0.2\r";
char text_behind[8] = "1,2";

int comma(const char *text)
{
    int i = 0;
    while (text[i] != ',') /* DEFECT */
        i++;
    return i;
}

int main(void)
{
    return comma(frame) > 16 || text_behind[0] != '1';
}
