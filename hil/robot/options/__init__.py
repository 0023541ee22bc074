"""Parts that the robot of the thesis does not have, and section 4 of it proposes.  See README.md."""
