"""What baselines are told. Loaded only where they are: it takes the physics engine."""
