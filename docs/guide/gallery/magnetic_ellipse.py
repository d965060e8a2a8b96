# Boundary map of an ellipse in a weak magnetic field: islands, and chaos between them.
import carom

section = carom.section("ellipse-magnetic", orbits=40, points=1000)
section.plot().figure.savefig("magnetic_ellipse.png")
