"""Ball arithmetic: what certify.py and other proofs are made of.

Every number is a ball that certainly holds the true one (Arb, by python-flint), every comparison that comes out true is
proved, and what cannot be decided raises. Nothing here knows a result of another program of the project.

    numbers     decimals as they are written, balls as text, signs
    flight      the follower in free flight
    laws        lift laws of the cam, with their derivatives
    profiles    the [cam] table of a model as laws, and how they meet
    cam         the cam: which law holds at a ball of angles, its corners
    motion      one flight over the cam: its gap, its first contact, and the impact map with its derivative
"""
