// Check values that are published: CRC-16/CCITT-FALSE and CRC-32 of "123456789", Fletcher-16 of "abcde".
// ccitt() == 10673: 0x29B1
// crc32() == 3421780262: 0xCBF43926
// fletcher() == 51440: 0xC8F0
static const char text[] = "123456789";
unsigned int ccitt(void)
{
    unsigned int crc = 0xFFFF;
    const char *p;
    int i;
    for (p = text; *p; p++) {
        crc ^= (unsigned int)*p << 8;
        for (i = 0; i < 8; i++)
            crc = crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1;
    }
    return crc;
}
unsigned long crc32(void)
{
    unsigned long crc = ~0ul;
    const char *p = text;
    int i;
    while (*p) {
        crc ^= *p++;
        for (i = 8; i; i--)
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320ul : crc >> 1;
    }
    return ~crc;
}
unsigned int fletcher(void)
{
    const char *p = "abcde";
    unsigned int a = 0, b = 0;
    do {
        a = (a + *p) % 255;
        b = (b + a) % 255;
    } while (*++p);
    return b << 8 | a;
}
