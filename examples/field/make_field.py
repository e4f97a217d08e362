"""Writes field.csv: directions that turn half as fast as one walks around the middle, and distances that grow outward.

    python3 make_field.py > field.csv

Any program that knows a direction and a distance at the nodes of a grid can write such a file.
"""

import math

print("x_mm,y_mm,angle_deg,spacing_mm")
for y in range(-20, 21, 2):
    for x in range(-20, 21, 2):
        angle = 0.5 * math.degrees(math.atan2(y, x))
        spacing = 2.2 + 0.04 * math.hypot(x, y)
        print(f"{x},{y},{angle:.3f},{spacing:.3f}")
