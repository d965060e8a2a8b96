# A particle among the discs of a triangular lattice.
import carom

run = carom.run("lorentz-triangular", collisions=100)
run.plot().figure.savefig("lorentz.png")
