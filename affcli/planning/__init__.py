"""Which row of the affordance table to use next."""
