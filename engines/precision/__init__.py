"""MuJoCo's own states at rest in MuJoCo Warp and MJX: what their precision makes of them."""
