"""Bad input of all kinds to all commands: ``python -m tests.fuzz.inputs N SEED``.

Whatever comes, a command ends with 0, 1 or 2, without a traceback; 2 comes with one line on
standard error; nothing unfinished is left behind, nothing of the user's is lost; and time and
memory stay bounded. Trial i of a seed is the same every time: ``--only i`` repeats it, and prints
what it was.
"""
