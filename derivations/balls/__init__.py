"""Ball arithmetic: what certify.py and other proofs are made of.

Every number is a ball that certainly holds the true one (Arb, by python-flint), every comparison that comes out true is
proved, and what cannot be decided raises. Nothing here knows a result of another program of the project.

    numbers     decimals as they are written, balls as text, signs
    flight      the follower in free flight
    laws        lift laws of the cam, with their derivatives
    profiles    the [cam] table of a model as laws, and how they meet
    cam         the cam: which law holds at a ball of angles, its corners
    motion      one flight over the cam: its gap, its first contact, and the impact map with its derivative
    duals       numbers with derivatives, for implicit differentiation
    krawczyk    a root near a guess, proved to be there and alone
    corner_impact  an orbit with an impact on a corner, and its map on either side
    nearby      how far from a corner impact the fixed points of both sides are followed
    verdict     what a border collision does, every sign proved
    roots       all roots of a system in a box
    orbits      all orbits of one impact and of two in one revolution
    branches    how many orbits of one impact there are at every speed of a range
    resting     what becomes of a follower that rests on the cam
    covering    boxes of impacts that the impact map stretches across each other, and the cones that it keeps
"""
