"""A net under a change: some 270 sweeps, made and stored by any commit, and compared.

``python -m tests.net make OUT`` makes the set of the checkout that it is run in, and
``python -m tests.net compare OLD NEW`` says what differs. A checkout without a net is swept by
another's: ``cd FIRST && python OTHER/tests/net/__main__.py make OUT``. So exported names alone are
used here, and nothing else of `tests`.
"""
