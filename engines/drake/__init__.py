"""The same chain of rigid links as MuJoCo's, computed by Drake: a twin."""
