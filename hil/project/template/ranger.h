/* ranger.h */
#ifndef RANGER_H
#define RANGER_H

#include "F28x_Project.h"

void Ranger_Init(void);
Uint16 Ranger_Mean(void);
Uint16 Ranger_Distance_Mm(void);

#endif
