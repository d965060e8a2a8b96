# The same mushroom in phase space: regular orbits never leave the cap.
import carom

table = carom.mushroom(1, 0.5, 1)
section = carom.section(table, on="wall:cap", orbits=60, points=500)
section.plot().figure.savefig("mushroom_section.png")
