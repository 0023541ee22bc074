#ifndef LIMITS_OF_ROBOT
#define LIMITS_OF_ROBOT
#define ROBOT_LIMIT 10
#endif
