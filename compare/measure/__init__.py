"""How far apart two aligned sweeps are; no limit is known here."""
