# Nineteen charges in a harmonic well: the ground state and the next minimum.
import carom

found = carom.relax("wigner", particles={"count": 19}, starts=100)
found.plot(most=2).figure.savefig("molecule.png")
