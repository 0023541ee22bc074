"""What the view shows of the robot and its world.  Map: README.md."""
