"""Joints solved at once: chains, bridges and frames whose joints would give way if they were visited one by one.

All rigid rows of an island of joints are one linear system, K P = -(J v + bias): block sparse, symmetric, positive
definite, with one block of up to three rows a joint. It is factored once a substep, K = L D L^T, and solved in each
pass: exact whatever the masses, where visiting joints one by one moves an impulse by one link a visit. In an order in
which chains fill in nothing, and trees little (plan.py), that takes a time that grows with the number of joints, as in
D. Baraff, "Linear-Time Dynamics using Lagrange Multipliers" (SIGGRAPH 1996), by another road: the system of joints
alone, in the order of least degree, so that loops are taken, too.

What pushes one way only, such as limits, motors and contacts, is still visited one by one, before and after.

- choose.py: which islands call for it; plan.py: the order, and where the blocks are;
- rows.py: error and Jacobian of each joint; system.py: the blocks, their factors, and the solution.
"""
