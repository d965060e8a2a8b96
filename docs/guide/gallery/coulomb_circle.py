# Fifteen charges in a circle: between hits they repel each other.
import carom

run = carom.run("coulomb-circle", t_max=2, sample=0.005)
run.plot().figure.savefig("coulomb_circle.png")
