"""The beam with its mass, moved by MuJoCo's own integrators: how fast is quasi-static?"""
