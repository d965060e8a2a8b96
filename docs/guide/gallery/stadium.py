# A chaotic orbit of the stadium and its section: for a long time it bounces between the straight walls.
import matplotlib.pyplot as pyplot

import carom

pyplot.style.use(carom.plot.STYLE)
table = carom.stadium(half_length=1, radius=1)
figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
carom.run(table, position=(0.1, 0.2), velocity=(0.6, 0.8), collisions=60).plot(ax=left, by="time")
carom.section(table, orbits=1, points=20_000).plot(ax=right)
figure.savefig("stadium.png", dpi=100)
