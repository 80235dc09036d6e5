"""What is shown: rich tables and plain numbers, returned to the caller; never printed here."""
