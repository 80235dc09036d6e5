"""One page that holds everything: results, tools, replays, and why each row was chosen."""
