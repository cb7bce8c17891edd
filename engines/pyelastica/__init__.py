"""PyElastica's Cosserat rod at rest, with a contact of our own."""
