/* What a PC has in the place of this chip: words of memory, and calls that do nothing. */
#ifndef CHIP_H
#define CHIP_H

typedef struct { volatile unsigned short ADCCTL1, ADCINTFLG; } ADC;
typedef struct { volatile unsigned short SPIBRR; } SPI;

static ADC AdcaRegs;
static SPI SpiaRegs;
static int sem;

static inline void DelayUs(unsigned us) { (void)us; }
static inline void Semaphore_post(int s) { (void)s; }
static inline void Semaphore_pend(int s) { (void)s; }
static inline int read_gyro(void) { (void)AdcaRegs; (void)SpiaRegs; (void)sem; return 0; }

#endif
