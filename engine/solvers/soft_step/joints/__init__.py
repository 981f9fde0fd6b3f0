"""Joints in soft_step: rows of constraints, one file for each way in which two bodies can be held.

- point.py: the way between an anchor of each body, two rows solved together;
- line.py: the way across an axis of body1, and how the bodies turn against each other, likewise;
- turn.py, slide.py: what acts where a joint leaves them free: springs, motors and limits (free.py), each on demand.

A kind of joint is made of these (engine/joints, one file a kind). Every file has the same verbs: `prepare` writes the
rows as a step begins; `refresh` brings error, Jacobian and effective mass to where the bodies are, once a substep,
after they moved; `warm_start`, `solve` are passes over rows of one colour; `store` keeps what was given. So a pass
knows nothing of kinds of joints, and whatever solves rows solves them all.
"""
