/* The drivers' work on an ATmega1284p with 16 MHz, for drivers.py: TURNS turns of 5 ms, then an end.
 *
 * Ours, written for this chip: three distances of twelve conversions each with the same filter, the gyro's rate by three
 * transfers of SPI, four values that are shared with interrupts off.
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdint.h>

static float slope[3] = {1.0f, 1.0f, 1.0f}, bias[3];
static volatile float shared[4];

ISR(TIMER1_COMPA_vect) {}

static uint16_t converted(uint8_t channel)
{
    ADMUX = _BV(REFS0) | channel;
    ADCSRA |= _BV(ADSC);
    while (ADCSRA & _BV(ADSC)) {
    }
    return ADC;
}

static float distance(uint8_t sensor)
{
    float v[12], sum = 0.0f;
    uint8_t i;

    for (i = 0; i < 12; i++) {
        v[i] = converted(sensor);
        if (i && v[i - 1] > v[i] + 5 && v[i] > 350)
            v[i - 1] = v[i];
        if (i && v[i] > v[i - 1] + 5 && v[i] > 350)
            v[i] = v[i - 1];
        sum += v[i];
    }
    return (sum / 12 / 2.3f) * slope[sensor] + bias[sensor];
}

static uint8_t transferred(uint8_t byte)
{
    SPDR = byte;
    while (!(SPSR & _BV(SPIF))) {
    }
    return SPDR;
}

static float rate(void)
{
    uint8_t low, high;
    float w;

    PORTB &= (uint8_t)~_BV(PB4);
    transferred(0xEC);
    low = transferred(0);
    high = transferred(0);
    PORTB |= _BV(PB4);
    w = (float)(int16_t)(high << 8 | low) * (250.0f / 32767.0f) * 0.0174f;
    return w <= 0.01f && w >= -0.01f ? 0.0f : w;
}

static void share(uint8_t which, float value)
{
    uint8_t status = SREG;

    cli();
    shared[which] = value;
    SREG = status;
}

int main(void)
{
    uint16_t turn;
    uint8_t i;

    ADCSRA = _BV(ADEN) | _BV(ADPS2);
    DDRB = _BV(PB4) | _BV(PB5) | _BV(PB7);
    SPCR = _BV(SPE) | _BV(MSTR);
    SPSR = _BV(SPI2X);
    OCR1A = 10000 - 1; /* 16 MHz / 8 / 200 Hz */
    TIMSK1 = _BV(OCIE1A);
    TCCR1B = _BV(WGM12) | _BV(CS11);
    sei();
    for (turn = 0; turn < TURNS; turn++) {
        for (i = 0; i < 3; i++)
            share(i, distance(i));
        share(3, rate());
        sleep_mode();
    }
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
