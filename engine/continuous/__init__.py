"""Continuous collision: what is fast stops where it would begin to go through something, with the velocity that it has.

After the substeps, and before bodies are put where these took them: bodies that went further than a part of their width
are looked for (fast.py); what lies in their way (paths.py); when outlines meet on the way (impact.py); and who stops
when (stops.py). docs/continuous.md is the whole on one screen.
"""
