"""Where rows go and how they survive whatever kills the study."""
