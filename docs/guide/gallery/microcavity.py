# Light in an elliptic cavity of index 2 (its edge is dashed), and the directions in which late light leaves, with standard errors.
import matplotlib.pyplot as pyplot
import numpy

import carom

pyplot.style.use(carom.plot.STYLE)

cavity = carom.plane().obstacle("ellipse", name="cavity", center=(0, 0), a=1.2, b=1).region("cavity", index=2, reflection="s")
inside = {"kind": "rectangle", "min": (-0.7, -0.7), "max": (0.7, 0.7)}
light = numpy.concatenate(list(carom.trajectories(cavity, initial=inside, trajectories=200_000, t_max=100)))
late = light[(light["time"] > 10) & (light["time"] < 100)]
count, edges = numpy.histogram(numpy.arctan2(late["end_vy"], late["end_vx"]), bins=90, range=(-numpy.pi, numpy.pi))

figure = pyplot.figure(figsize=(8, 3.6), layout="constrained")
carom.run(cavity, position=(0.9, 0.1), velocity=(0.2, 0.98), collisions=20).plot(ax=figure.add_subplot(1, 2, 1))
polar = figure.add_subplot(1, 2, 2, projection="polar")
middle = (edges[:-1] + edges[1:]) / 2
polar.fill(middle, count, alpha=0.5)
polar.errorbar(middle, count, numpy.sqrt(count), fmt="none", linewidth=0.8)  # of independent particles
polar.set(ylim=(0, None), yticks=[], title=f"Directions of the {len(late) / len(light):.0%} that leave after $t$ = 10")
figure.savefig("microcavity.png")
