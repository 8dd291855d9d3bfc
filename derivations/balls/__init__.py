"""Ball arithmetic for certify.py and other proofs.

Every number is a ball that certainly holds the true number (Arb, by python-flint). A comparison that is True is proved, and a
question that cannot be decided raises an error. The only result taken from another program is golden/derived/corner_map.json: its
formula must agree with the map that is computed here.

    numbers     decimals as exact rationals, balls as text, signs
    flight      the follower in free flight
    laws        lift laws of the cam, with their derivatives
    profiles    the [cam] table of a model as laws, and how they meet
    cam         the cam: which law holds at a ball of angles, its corners
    motion      one flight over the cam: its gap, its first contact, and the impact map with its derivative
    duals       numbers with derivatives, for implicit differentiation
    krawczyk    a root near a guess, proved to exist and to be the only one
    corner_impact  an orbit with an impact on a corner, and its map on either side
    nearby      the range about a corner impact in which the fixed point of each side is proved to exist
    verdict     the verdict on a border collision, every sign proved
    roots       all roots of a system in a box
    orbits      all orbits of one impact and of two in one revolution
    branches    the number of orbits of one impact at every speed of a range
    resting     the motion after a follower has rested on the cam
    covering    boxes of impacts that the impact map stretches across each other, and the cones that it keeps
"""
