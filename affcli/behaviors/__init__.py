"""What the robot can do, one file a family; the registry finds behaviors and bindings by PARTS."""
