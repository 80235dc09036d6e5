"""What records say, in numbers: sums, shares, intervals and comparisons; no words, no pictures."""
