"""Small drivers with one defect each, in C for the tools of a PC and in C-shaped Python for this one."""
