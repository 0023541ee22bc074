// Headers of one's own: found whatever the case of their name, guarded, one that is included twice on purpose.
// avr: its file names tell capitals from small letters
// limit() == 10: from the header, whose name is written in another case
// twice() == 3: a list of names, read once as constants and once as values: 1 + 2
#include "Limits_Of_Robot.h"
#include "limits_of_robot.h"
#define ITEM(name, value) name = value,
enum {
#include "items.h"
    END
};
#undef ITEM
#define ITEM(name, value) value,
static const int values[] = {
#include "items.h"
};
#undef ITEM
int limit(void)
{
    return ROBOT_LIMIT;
}
int twice(void)
{
    return FIRST + values[1];
}
