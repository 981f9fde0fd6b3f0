"""Joints: one file a kind, each with the verbs `prepare` and `solve`."""
