"""The same chain of rigid links as MuJoCo's, by Pinocchio and coal: a twin."""
