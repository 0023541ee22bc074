/* Two tasks, one object of two words, no gate. */
#include "chip.h"

static float speed, turn;

void task_order(void)
{
    speed = speed + 0.1f; /* DEFECT */
    turn = turn + 0.1f;
}

void task_wheels(void)
{
    speed = speed * 0.5f;
    turn = turn * 0.5f;
}

int main(void)
{
    task_order();
    task_wheels();
    return speed > 1.0f;
}
