"""MuJoCo Warp as a subject: what single precision makes of MuJoCo's own states at rest."""
