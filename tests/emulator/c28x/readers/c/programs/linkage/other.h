#ifndef OTHER_H
#define OTHER_H
extern int shared;
int other_helper(void);
int square(int x);
void store(int x);
void set_both(int x);
#endif
