"""The world: arm, tools, puck, table friction, and the person who serves the robot."""
