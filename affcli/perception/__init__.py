"""From the scene to the observation vector."""
