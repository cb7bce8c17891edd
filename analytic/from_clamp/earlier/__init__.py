"""How others found the contact from the same readings, before there was a closed form.

Dimensionless, L = EI = 1; the vibrissa stands upright on its foot and is bent to the right.
"""
