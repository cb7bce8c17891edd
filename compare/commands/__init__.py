"""The command line ``vibrissa``.

A command states its options, checks the input, and only then loads what does the work: help and
complaints must not wait for pandas, matplotlib and MuJoCo. So imports of other rooms stand in the
command functions, after the checks; nowhere else.
"""
