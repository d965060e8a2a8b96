# One orbit in Bunimovich's mushroom: a chaotic one visits the stem.
import carom

run = carom.run(carom.mushroom(1, 0.5, 1), position=(0.2, 0.3), velocity=(0.6, 0.8), collisions=80)
run.plot().figure.savefig("mushroom.png")
