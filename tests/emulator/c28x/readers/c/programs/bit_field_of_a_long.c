// A bit-field lies across a word where a unit of its declared type does (SPRAC71 2.8), as in TI's ADCSOCxCTL.
// avr: its alignment is one octet
// size() == 2: 9 + 6 + 4 + 1 + 5 + 7 bits are 32
// chsel() == 163840: 5 << 15
// trigsel() == 15728640: 15 << 20
// back(163855) == 5: bits 18 to 15 of 5 << 15 | 15
// beside() == 2: 16 bits, and 16 more of the same unit
// next() == 4: 20 bits and 16 more do not go into one unit of 32, so the second begins the next one
// odd() == 32771: 3 in the first word, 1 in the highest bit of it: 3 | 1 << 15
struct soc {
    unsigned int acqps : 9, : 6;
    unsigned long chsel : 4;
    unsigned int : 1, trigsel : 5, : 7;
};
union both { unsigned long all; struct soc bit; };
struct beside { unsigned int a; unsigned long b : 16; };
struct next { unsigned long a : 20; unsigned long b : 16; };
struct odd { unsigned int a : 15; unsigned long b : 1; };
union word { unsigned int word; struct odd bit; };
int size(void) { return sizeof(struct soc); }
unsigned long chsel(void) { union both x; x.all = 0; x.bit.chsel = 5; return x.all; }
unsigned long trigsel(void) { union both x; x.all = 0; x.bit.trigsel = 15; return x.all; }
int back(unsigned long all) { union both x; x.all = all; return x.bit.chsel; }
int beside(void) { return sizeof(struct beside); }
int next(void) { return sizeof(struct next); }
unsigned int odd(void) { union word x; x.word = 0; x.bit.a = 3; x.bit.b = 1; return x.word; }
