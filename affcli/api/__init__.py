"""The door for Python: a laboratory by its database; ``import affcli`` leads here."""
