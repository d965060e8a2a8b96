# An orbit in the closed magnetic square.
import carom

square = carom.system("magnetic-square").closed()
run = carom.run(square, position=(0.3, 0.2), velocity=(0.6, 0.8), collisions=150)
run.plot().figure.savefig("magnetic_square_orbit.png")
