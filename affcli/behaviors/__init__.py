"""What the robot can do; the registry finds behaviors and bindings by the PARTS of each file."""
