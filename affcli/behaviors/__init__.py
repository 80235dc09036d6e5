"""What the robot can do: motor schemas, and the behaviors composed of them."""
