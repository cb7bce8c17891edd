"""Speed, side by side in one run; nothing here is asserted, machines differ."""
