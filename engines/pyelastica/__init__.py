"""PyElastica's Cosserat rod, damped to rest, with a contact of our own."""
