// A state machine with enumerations, a switch and a table of functions.
// run() == 3: IDLE, START, RUN, then STOP at the third event
// by_table() == 12: the entries called in order: 1, then * 10 + 2
typedef enum { IDLE, START, RUN, STOP } state_t;
static int trace;
static void enter(void)
{
    trace = 1;
}
static void leave(void)
{
    trace = trace * 10 + 2;
}
static void (*const actions[])(void) = { enter, leave };
static state_t next(state_t s)
{
    switch (s) {
    case IDLE:
        return START;
    case START:
        return RUN;
    case RUN:
    case STOP:
        return STOP;
    }
    return IDLE;
}
int run(void)
{
    state_t s = IDLE;
    int events = 0;
    while (s != STOP) {
        s = next(s);
        events++;
    }
    return events;
}
int by_table(void)
{
    unsigned int i;
    for (i = 0; i < sizeof(actions) / sizeof(*actions); i++)
        actions[i]();
    return trace;
}
